#!/usr/bin/env python3
"""Joints of bars and pipes in the bodies that `beadwright directions` finds: what stays empty at the saddle, and pictures of sections.

The parts are those of `benches/trees.py --nodes` and of `benches/directions.py`: T, Y at 60 and at 30 degrees, four on a trunk, a node of
three; as bars, and T, Y at 60 degrees and four as pipes. Each is taken as it is and turned about z by 37 degrees. The table counts places
of the part 1 mm apart, within 10 mm of the trunk's surface and within a branch and 2 mm around it, that lie in no bead: a bead is as wide
as the plan says, one layer thick, and square, so overlaps and gaps count and the round of its top does not. The last column is the same
for the whole part.

The picture (`--picture FILE`) shows sections through the axes of trunk and first branch: layers of each body in two shades, places of the part
in no bead in pink. Needs `pip install manifold3d numpy scipy trimesh pillow`.

Usage: benches/joints.py [--turns 0,37] [--picture FILE] [--output FOLDER] [--binary FILE]
"""
import argparse, csv, json, pathlib, subprocess, sys
import numpy as np
from PIL import Image, ImageDraw
from scipy.spatial import cKDTree

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import directions, trees

NEAR, AROUND, APART = 10.0, 2.0, 1.0
# Of the places of the whole part, every eleventh is looked at.
WHOLE = 11
PIPES = ("t", "y60", "four")
PICTURED = ["t", "y60", "t, pipes", "y60, pipes"]
SHADES = [((52, 100, 230), (120, 150, 240)), ((252, 168, 48), (253, 200, 120))]
EMPTY, STEP, SIDE = (232, 0, 150), 0.25, 460


def run(*command):
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True)
    assert not done.returncode, done.stderr
    return done


class Beads:
    """Pieces of beads in steps of 1 mm."""

    def __init__(self, path, first_of):
        rows = list(csv.DictReader(path.open()))
        column = lambda name: np.array([float(row[name]) for row in rows])
        ends = [np.stack([column(f"{axis}{end} (mm)") for axis in "xyz"], 1) for end in "01"]
        counts = np.maximum(np.ceil(np.linalg.norm(ends[1] - ends[0], axis=1)).astype(int), 1)
        of = np.repeat(np.arange(len(rows)), counts)
        share = (np.concatenate([np.arange(count) for count in counts]) + 0.5) / counts[of]
        along = ends[1] - ends[0]
        self.along = (along / np.maximum(np.linalg.norm(along, axis=1), 1e-9)[:, None])[of]
        self.places = ends[0][of] + along[of] * share[:, None]
        # Level layers have no normals.
        tilted = "normal x" in rows[0]
        normals = np.stack([column(f"normal {axis}") for axis in "xyz"], 1) if tilted else np.tile([0.0, 0, 1], (len(rows), 1))
        self.normals = normals[of]
        self.widths, self.heights = column("width (mm)")[of], column("height (mm)")[of]
        self.layers = column("layer").astype(int)[of]
        self.bodies = np.searchsorted(first_of, self.layers, side="right") - 1
        self.tree = cKDTree(self.places - self.normals * self.heights[:, None] / 2)
        self.reach = float(np.hypot(self.widths.max() / 2, self.heights.max() / 2)) + 0.6

    def at(self, places):
        """The number of the piece in which each place lies, or -1."""
        found = np.full(len(places), -1)
        for k, near in enumerate(self.tree.query_ball_point(places, self.reach)):
            near = np.array(near, dtype=int)
            if not len(near):
                continue
            off = places[k] - self.places[near]
            depth = -(off * self.normals[near]).sum(1)
            across = np.cross(self.normals[near], self.along[near])
            aside = np.abs((off * across).sum(1))
            ahead = np.abs((off * self.along[near]).sum(1))
            # Beads end round; pieces are 1 mm long.
            round_ = np.hypot(aside, np.maximum(ahead - 0.5, 0)) <= self.widths[near] / 2
            inside = round_ & (depth > -0.02) & (depth < 1.02 * self.heights[near])
            if inside.any():
                found[k] = near[inside][np.argmin(aside[inside])]
        return found


def planned(binary, model, turned, folder):
    placed = ["--units", "mm", "--turn", f"0,0,{turned}"]
    run(binary, "plan", model, *placed, "--directions", "auto", "--no-deposit", "--allow-findings", "-o", folder)
    run(binary, "export", folder / "plan.json", "-o", folder / "beads.csv")
    layers = json.loads((folder / "plan.json").read_text())["layers"]
    bodies = [layer.get("body", 0) for layer in layers]
    return Beads(folder / "beads.csv", np.array([bodies.index(body) + 1 for body in sorted(set(bodies))]))


def inside(bars, places, wall):
    """Whether places lie in the part: in a bar, and in no bore."""
    of = np.zeros(len(places), bool)
    bore = np.zeros(len(places), bool)
    for k, (start, way, radius, length) in enumerate(bars):
        off = places - start
        along = off @ way
        away = np.linalg.norm(off - along[:, None] * way, axis=1)
        of |= (along >= 0) & (along <= length) & (away <= radius)
        if wall:
            bore |= (along >= (-5 if k == 0 else 0)) & (along <= length + 5) & (away <= radius - wall)
    return of & ~bore


def at_joint(bars, places):
    (start, way, radius, _), near = bars[0], np.zeros(len(places), bool)
    off = places - start
    away = np.linalg.norm(off - (off @ way)[:, None] * way, axis=1)
    for start, way, thick, _ in bars[1:]:
        off = places - start
        along = off @ way
        near |= (along >= 0) & (np.linalg.norm(off - along[:, None] * way, axis=1) <= thick + AROUND)
    return near & (np.abs(away - radius) <= NEAR)


def turned_about_z(bars, degrees):
    sin, cos = np.sin(np.radians(degrees)), np.cos(np.radians(degrees))
    turn = np.array([[cos, -sin, 0], [sin, cos, 0], [0, 0, 1]])
    return [(turn @ start, turn @ way, radius, length) for start, way, radius, length in bars]


def section(beads, bars, wall):
    """A picture of the section through trunk and first branch."""
    across = bars[1][1] * [1, 1, 0]
    across /= np.linalg.norm(across)
    sides = np.arange(-35, 125, STEP), np.arange(0, 160, STEP)
    grid = np.stack(np.meshgrid(*sides), -1).reshape(-1, 2)
    places = grid[:, :1] * across + grid[:, 1:] * [0, 0, 1]
    part = inside(bars, places, wall)
    piece = np.full(len(places), -1)
    touched = part | (beads.tree.query(places)[0] < beads.reach)
    piece[touched] = beads.at(places[touched])
    colours = np.full((len(places), 3), 255, np.uint8)
    colours[part & (piece < 0)] = EMPTY
    laid = piece >= 0
    shades = np.array(SHADES, np.uint8)
    colours[laid] = shades[beads.bodies[piece[laid]] % 2, beads.layers[piece[laid]] % 2]
    shape = len(sides[1]), len(sides[0])
    return Image.fromarray(colours.reshape(*shape, 3)[::-1]).resize((SIDE, SIDE), Image.LANCZOS)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--turns", default="0,37")
    parser.add_argument("--picture", type=pathlib.Path)
    parser.add_argument("--output", type=pathlib.Path, default=pathlib.Path("joints"))
    parser.add_argument("--binary", type=pathlib.Path, default=trees.ROOT / "target/release/beadwright")
    given = parser.parse_args()
    binary, pictures = given.binary.resolve(), {}
    given.output.mkdir(parents=True, exist_ok=True)
    print("| part | turned | empty at the joint, % | empty in all, % |\n| --- | --- | --- | --- |")
    for name, bars in trees.nodes(0).items():
        for wall in (0, directions.WALL) if name in PIPES else (0,):
            label = f"{name}, pipes" if wall else name
            model = given.output / f"{label}.stl"
            directions.pipes(bars, model) if wall else trees.save(bars, model)
            for degrees in (float(turn) for turn in given.turns.split(",")):
                beads = planned(binary, model, degrees, given.output / f"{label} {degrees:.0f}")
                own = turned_about_z(bars, degrees)
                low, high = beads.places.min(0) - 8, beads.places.max(0) + 8
                # `plan` keeps x and y of the model.
                grid = np.stack(np.meshgrid(*(np.arange(a, b, APART) + APART / 3 for a, b in zip(low, high))), -1)
                places = grid.reshape(-1, 3)
                places = places[inside(own, places, wall)]
                empty = [100 * (beads.at(own) < 0).mean() for own in (places[at_joint(own, places)], places[::WHOLE])]
                print(f"| {label} | {degrees:.0f} | {empty[0]:.2f} | {empty[1]:.2f} |", flush=True)
                if given.picture and label in PICTURED and label not in pictures:
                    pictures[label] = section(beads, own, wall)
    if given.picture:
        whole = Image.new("RGB", (2 * SIDE, 2 * SIDE), "white")
        for k, label in enumerate(PICTURED):
            whole.paste(pictures[label], (k % 2 * SIDE, k // 2 * SIDE))
            ImageDraw.Draw(whole).text((k % 2 * SIDE + 8, k // 2 * SIDE + 8), label, fill="black")
        whole.save(given.picture, optimize=True)


if __name__ == "__main__":
    main()
