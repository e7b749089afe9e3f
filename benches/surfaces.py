#!/usr/bin/env python3
"""Clads a pipe, a dome, a mould and a scan of the dome, repairs five damages of a block, and prints two tables.

Dome and mould are examples of the program; the scan is the dome's surface in triangles of at most 1 mm with noise of --noise mm
(standard deviation). Each base is clad with three layers, as it is and turned by 37 degrees about a slanted axis, in closed rings (loop),
zigzags and spirals (on the pipe a helix). Damages are cut out of a block by the library manifold3d; where they lie and how large they
are depends on the seed (`pip install manifold3d numpy scipy`).

What is clad is measured here, from the table of beads that `beadwright export` writes: at 1,000 places of the true surface, the metal
within one and a half stepovers, so that ridges and valleys of beads even out, and farther from the edge than that and half a bead, since
beads are round there. Columns: thickness of single layers as a share of the height asked for, mean, lowest and highest 5 % of places; the
same of all layers together, and the share of places where those are off by more than a tenth of a layer; how far beads lie from
where the surface has their layer, mm, worst of 95 %; bare in % of the surface, in the worst layer (farther from all beads than half their
width and a tenth); stretch in %, what the plan says; arc starts; seconds to clad and to plan.

Repairs: what was cut out and what the program finds missing, cm3; what is milled first; how far the scan, and then what is built,
lies from the part's surface, where it was damaged by more than 1 mm: lowest, lowest and highest 5 % of places, highest, mm (beads count as
high as their layers); and the share of places that end below the part by more than 0.1 mm, and above the allowance (one layer).

Usage: benches/surfaces.py [--only clad|repair] [--names dome,…] [--seeds 1,2] [--noise 0.1] [--allowance 2] [--output FOLDER] [--binary FILE]
"""
import argparse, csv, json, pathlib, re, subprocess, sys, time
import manifold3d
import numpy as np
from scipy.spatial import cKDTree

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import trees

LAYERS, HEIGHT, STEPOVER, WIDTH = 3, 2.0, 5.39, 7.54
REACH = 1.5 * STEPOVER
SIZE = np.array([120.0, 80.0, 40.0])
AXIS, ANGLE = np.array([1.0, 2.0, 0.5]), 37.0
PATTERNS = ["loop", "zigzag", "spiral"]


def run(*command):
    began = time.monotonic()
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    return done, time.monotonic() - began


def turn(angle):
    """Rotation about the slanted axis, degrees."""
    x, y, z = AXIS / np.linalg.norm(AXIS)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    angle = np.radians(angle)
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


# Meshes are arrays of triangles, three corners each, mm.


def read(path):
    numbers = np.frombuffer(path.read_bytes(), [("numbers", "<12f4"), ("attribute", "<u2")], offset=84)["numbers"]
    return numbers[:, 3:].reshape(-1, 3, 3).astype(float)


def write(path, corners):
    facets = np.zeros(len(corners), [("numbers", "<12f4"), ("attribute", "<u2")])
    facets["numbers"] = np.hstack([units(corners), corners.reshape(-1, 9)])
    path.write_bytes(b"\0" * 80 + np.uint32(len(facets)).tobytes() + facets.tobytes())


def vectors(corners):
    """Normals as long as their triangles are large."""
    return np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]) / 2


def units(corners):
    own = vectors(corners)
    return own / np.maximum(np.linalg.norm(own, axis=1, keepdims=True), 1e-12)


def fine(corners, longest):
    """Triangles with no edge longer than that, mm: the longest is halved first, and neighbours halve an edge alike."""
    done = []
    while len(corners):
        lengths = np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2)
        long = lengths.max(axis=1) > longest
        done.append(corners[~long])
        order = (lengths[long].argmax(axis=1)[:, None] + np.arange(3)) % 3
        a, b, c = np.moveaxis(np.take_along_axis(corners[long], order[:, :, None], axis=1), 1, 0)
        corners = np.concatenate([np.stack([a, (a + b) / 2, c], 1), np.stack([(a + b) / 2, b, c], 1)])
    return np.concatenate(done)


def smooth(corners):
    """Normals at the corners: means of the triangles that meet there."""
    _, at = np.unique(corners.reshape(-1, 3).round(4), axis=0, return_inverse=True)
    at, sums = at.ravel(), np.zeros((at.max() + 1, 3))
    np.add.at(sums, at, np.repeat(vectors(corners), 3, axis=0))
    own = sums[at] / np.linalg.norm(sums[at], axis=1, keepdims=True)
    return own.reshape(-1, 3, 3)


def rough(corners, noise, seed):
    """A scan: every corner moved by noise, but not those on the table."""
    _, at = np.unique(corners.reshape(-1, 3).round(4), axis=0, return_inverse=True)
    by = np.random.default_rng(seed).normal(0, noise, at.max() + 1)[at.ravel()].reshape(-1, 3, 1)
    return corners + by * smooth(corners) * (corners[:, :, 2:] > 0.01)


def bases(binary, out, noise, seeds):
    """Name, triangles, which of them are clad, and the radius of the cylinder that is clad, if it is one."""
    pipe = manifold3d.Manifold.cylinder(160, 45, 45, 180) - manifold3d.Manifold.cylinder(160, 35, 35, 180)
    trees.write(pipe, out / "pipe.stl")
    for name in ("dome", "mould"):
        run(binary, "example", name, "-o", out / f"{name}.stl")
    pipe, dome, mould = (read(out / f"{name}.stl") for name in ("pipe", "dome", "mould"))
    outer = (units(pipe)[:, :2] * pipe.mean(axis=1)[:, :2]).sum(axis=1) > 40
    upper = units(dome)[:, 2] > 0.7
    yield "pipe", pipe, pipe[outer], 45.0
    yield "dome", dome, dome[upper], None
    yield "mould", mould, mould[units(mould)[:, 2] > 0.7], None
    for seed in seeds:
        yield f"scan {seed}", rough(fine(dome, 1.0), noise, seed), dome[upper], None


def smeared(places, others, weights):
    """What of some weights lies within reach of each place, nearer ones counting more."""
    near = cKDTree(others).query_ball_point(places, REACH)
    apart = (np.linalg.norm(others[own] - place, axis=1) for own, place in zip(near, places))
    return np.array([np.maximum(1 - (by / REACH) ** 2, 0) @ weights[own] for own, by in zip(near, apart)])


def border(corners):
    """Ends of edges that only one triangle has, in steps of at most 1 mm."""
    edges = np.stack([corners, np.roll(corners, -1, axis=1)], 2).reshape(-1, 2, 3).round(4)
    middles = (edges[:, 0] + edges[:, 1]).round(3)
    _, at, counts = np.unique(middles, axis=0, return_inverse=True, return_counts=True)
    return edges[counts[at.ravel()] == 1].mean(axis=1)


class Beads:
    """The beads of a plan in steps of 1 mm: places on top of their layers, normals, widths, and metal in mm3."""

    def __init__(self, path, metal, lift):
        rows = list(csv.DictReader(path.open()))
        column = lambda name: np.array([float(row[name]) for row in rows])
        ends = [np.stack([column(f"{axis}{end} (mm)") for axis in "xyz"], 1) - [0, 0, lift] for end in "01"]
        length = np.linalg.norm(ends[1] - ends[0], axis=1)
        laid = length / column("pace (mm/s)") * column("wire feed (ratio)")
        counts = np.maximum(np.ceil(length).astype(int), 1)
        of = np.repeat(np.arange(len(rows)), counts)
        share = (np.concatenate([np.arange(count) for count in counts]) + 0.5) / counts[of]
        self.along = ((ends[1] - ends[0]) / np.maximum(length, 1e-9)[:, None])[of]
        self.places = ends[0][of] + (ends[1] - ends[0])[of] * share[:, None]
        self.normals = np.stack([column(f"normal {axis}") for axis in "xyz"], 1)[of]
        self.layers = column("layer").astype(int)[of]
        self.widths = column("width (mm)")[of]
        self.metal = (metal * laid / laid.sum() / counts)[of]

    def layer(self, number):
        """Places in the middle of a layer, spread over the beads' widths as the metal is, with metal and width."""
        own = self.layers == number
        middle = self.places[own] - self.normals[own] * HEIGHT / 2
        across = np.cross(self.normals[own], self.along[own])
        shares = np.linspace(-0.45, 0.45, 5)
        weights = (1 - 4 * shares**2) / (1 - 4 * shares**2).sum()
        spread = [middle + across * (share * self.widths[own])[:, None] for share in shares]
        return middle, self.widths[own], np.concatenate(spread), np.concatenate([self.metal[own] * w for w in weights])


def judged(beads, truth, up, count=1000):
    """At places of the surface: thickness of each layer as a share of its height, how far beads lie from where the layer should, mm; and
    what is bare in the worst layer. `up` is the direction along which layers are stacked, None for the surface's normals."""
    truth = fine(truth, 2.5)
    normals, middles = smooth(truth), truth.mean(axis=1)
    random = np.random.default_rng(1)
    inner = cKDTree(border(truth)).query(middles)[0] > REACH + WIDTH / 2
    weights = np.linalg.norm(vectors(truth), axis=1)
    chosen = lambda wanted: random.choice(len(truth), count, p=wanted * weights / (wanted * weights).sum())
    within, everywhere = chosen(inner), chosen(np.ones(len(truth)))
    thickness, off, bare = [], [], []
    for number in range(1, LAYERS + 1):
        moved = truth + (normals if up is None else up) * (number - 0.5) * HEIGHT
        places, areas = moved.mean(axis=1), np.linalg.norm(vectors(moved), axis=1)
        centres, widths, spread, metal = beads.layer(number)
        thickness.append(smeared(places[within], spread, metal) / smeared(places[within], places, areas) / HEIGHT)
        apart, nearest = cKDTree(centres).query(places[everywhere])
        bare.append((apart > 0.6 * widths[nearest]).mean())
        normal = normals[everywhere].mean(axis=1)
        off.append(np.abs(((centres[nearest] - places[everywhere]) * normal).sum(axis=1)))
    return np.array(thickness), np.array(off), max(bare)


def clad(binary, out, name, base, truth, radius, angle, pattern):
    own = turn(angle)
    base, truth = base @ own.T, truth @ own.T
    lowest = base[:, :, 2].min()
    base, truth = base - [0, 0, lowest], truth - [0, 0, lowest]
    folder = out / f"{name} {angle:.0f} {pattern}"
    folder.mkdir(parents=True, exist_ok=True)
    write(folder / "base.stl", base)
    words = lambda vector: "/".join(f"{part:.12f}" for part in vector)
    where = ["--up", words(own[:, 2])]
    settings = ["--set", f'fill.strategy="{pattern}"']
    if radius:
        where = ["--around", f"axis={words(own[:, 2])},through={words([0, 0, -lowest])},radius={radius}"]
        settings = ["--set", 'fill.around="helix"'] if pattern == "spiral" else settings
    made, first = run(binary, "clad", folder / "base.stl", *where, "--layers", LAYERS, "-o", folder / "clad.stl")
    row = {"base": f"{name}, {angle:.0f}°", "pattern": pattern}
    if made.returncode:
        return row | {"why": " ".join(made.stderr.split())[:200]}
    done, second = run(binary, "plan", folder / "clad.stl", "--onto", folder / "base.stl", "--bodies", folder / "clad.bodies.toml",
                       *settings, "-o", folder / "plan")
    if done.returncode:
        return row | {"why": " ".join(line for line in done.stderr.splitlines() if not line.startswith("note"))[:200]}
    metrics = json.loads((folder / "plan/metrics.json").read_text())
    exported, _ = run(binary, "export", folder / "plan/plan.json", "-o", folder / "beads.csv")
    assert not exported.returncode, exported.stderr
    lift = max(-read(folder / "clad.stl")[:, :, 2].min(), 0)
    beads = Beads(folder / "beads.csv", metrics["deposited_volume_mm3"], lift)
    thickness, off, bare = judged(beads, truth, None if radius else own[:, 2])
    stretch = re.search(r"up to ([\d.]+) % farther", done.stdout + done.stderr)
    said = re.search(r"([\d.]+) cm² (is|of)", made.stdout)
    spread = lambda values: "{:.1f}, {:.1f}, {:.1f}".format(*(100 * value for value in (values.mean(), *np.percentile(values, [5, 95]))))
    whole = thickness.mean(axis=0)
    return row | {"each layer": spread(thickness), "all layers": spread(whole), "worst": f"{100 * whole.min():.0f}…{100 * whole.max():.0f}",
                  "beyond": f"{100 * (np.abs(whole - 1) * LAYERS > 0.1).mean():.1f}", "off": f"{np.percentile(off, 95):.2f}",
                  "bare": f"{100 * bare:.1f}", "left out": said[1] if said else "0", "stretch": stretch[1] if stretch else "0",
                  "starts": metrics["arc_starts"], "s": f"{first + second:.1f}"}


def box(low, high):
    return manifold3d.Manifold.cube(np.subtract(high, low)).translate(low)


def damages(random):
    """Name, and what is cut out of the block."""
    vary = lambda low, high: random.uniform(low, high)
    x, y, z = SIZE
    deep = vary(4, 6)
    ball = manifold3d.Manifold.sphere(60, 200).translate([x / 2 + vary(-10, 10), y / 2 + vary(-8, 8), z + 60 - deep])
    yield "pit", ball
    half, depth = vary(8, 11), vary(6, 9)
    section = manifold3d.CrossSection([[[-half, 0.0], [0.0, -depth], [half, 0.0], [half, 5.0], [-half, 5.0]]])
    groove = manifold3d.Manifold.extrude(section, 70).rotate([90, 0, vary(20, 70)])
    middle = groove.bounding_box()
    yield "groove", groove.translate([x / 2 - (middle[0] + middle[3]) / 2, y / 2 - (middle[1] + middle[4]) / 2, z])
    away = box([-100, -100, 0], [100, 100, 100])
    yield "corner", away.rotate([-vary(40, 50), vary(35, 45), 0]).translate([x - vary(8, 12), y - vary(8, 12), z - 4])
    yield "edge", away.rotate([0, vary(30, 45), 0]).translate([x - vary(6, 8), y / 2, z - 2])
    radius, depth = vary(10, 14), 12.0
    hole = manifold3d.Manifold.cylinder(depth + 1, radius, radius, 96).rotate([0, 90, 0])
    yield "hole", hole.translate([x - depth, y / 2 + vary(-10, 10), z / 2 + vary(-3, 3)])


def triangles(solid):
    mesh = solid.to_mesh()
    return np.array(mesh.vert_properties)[:, :3][np.array(mesh.tri_verts)].astype(float)


def built(places, ways, beads, base):
    """How far beads that are as high as their layers reach over places of the part along its normal, or how far places stay away from
    metal (negative), mm."""
    tree, heights = cKDTree(beads.places), np.full(len(places), -np.inf)
    for k, (place, way) in enumerate(zip(places, ways)):
        near = np.array(tree.query_ball_point(place, 25.0), int)
        by, normals = beads.places[near] - place, beads.normals[near]
        over = (by * normals).sum(axis=1)
        within = np.linalg.norm(by - over[:, None] * normals, axis=1) <= beads.widths[near] / 2
        heights[k] = np.max((over * (normals @ way))[within], initial=-np.inf)
    metal = np.concatenate([base, beads.places])
    return np.where(heights > 0, heights, np.maximum(heights, -cKDTree(metal).query(places)[0]))


def mouth(part, damaged, removed, count=600):
    """Places of the part's surface that are missing by more than 1 mm, and normals there."""
    gone = fine(triangles(removed), 1.5)
    deep, _ = cKDTree(fine(triangles(damaged), 1.5).reshape(-1, 3)).query(gone.mean(axis=1))
    on_part, _ = cKDTree(fine(triangles(part), 1.0).reshape(-1, 3)).query(gone.mean(axis=1))
    faces = gone[(deep > 1.0) & (on_part < 0.7)]
    normals = units(faces)
    # Faces of the damage itself that come near the part's surface face another way than the block's.
    faces = faces[np.abs(normals).max(axis=1) > 0.99]
    weights = np.linalg.norm(vectors(faces), axis=1)
    own = np.random.default_rng(1).choice(len(faces), count, p=weights / weights.sum())
    return faces.mean(axis=1)[own], units(faces)[own]


def repair(binary, out, name, seed, cut, noise, allowance):
    part = box([0, 0, 0], SIZE)
    damaged, removed = part - cut, part ^ cut
    angle = 0.0 if seed == 1 else ANGLE
    folder = out / f"repair {name} {seed} {allowance:g}"
    folder.mkdir(parents=True, exist_ok=True)
    cosine, sine = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    turned = np.array([[cosine, -sine, 0], [sine, cosine, 0], [0, 0, 1]]).T
    scan = rough(fine(triangles(damaged) @ turned, 1.5), noise, seed)
    write(folder / "part.stl", triangles(part) @ turned)
    write(folder / "scan.stl", scan)
    row = {"damage": f"{name}, seed {seed}", "cut out": f"{removed.volume() / 1e3:.2f}"}
    made, first = run(binary, "repair", folder / "part.stl", folder / "scan.stl", "--units", "mm",
                      "--allowance", allowance, "-o", folder / "repair.stl")
    (folder / "repair.txt").write_text(made.stdout + made.stderr)
    if made.returncode or not (folder / "repair.stl").exists():
        return row | {"why": " ".join((made.stderr + made.stdout).split())[:200]}
    found = re.findall(r"([\d.]+) cm³", made.stdout)
    done, second = run(binary, "plan", folder / "repair.stl", "--units", "mm", "--onto", folder / "repair.base.stl",
                       "--bodies", folder / "repair.bodies.toml", "-o", folder / "plan")
    if done.returncode:
        return row | {"why": " ".join(line for line in done.stderr.splitlines() if not line.startswith("note"))[:200]}
    exported, _ = run(binary, "export", folder / "plan/plan.json", "-o", folder / "beads.csv")
    assert not exported.returncode, exported.stderr
    beads = Beads(folder / "beads.csv", json.loads((folder / "plan/metrics.json").read_text())["deposited_volume_mm3"], 0)
    places, ways = (own @ turned for own in mouth(part, damaged, removed))
    faces = [fine(mesh, 0.7).reshape(-1, 3) for mesh in (scan, read(folder / "repair.base.stl"))]
    before, after = -cKDTree(faces[0]).query(places)[0], built(places, ways, beads, faces[1])
    spread = lambda own: "{:+.2f}, {:+.2f}, {:+.2f}, {:+.2f}".format(*np.nanpercentile(own, [0, 5, 95, 100]))
    return row | {"found": " / ".join(found), "before": spread(before), "after": spread(after), "low": f"{100 * (~(after >= -0.1)).mean():.1f}",
                  "high": f"{100 * (after > allowance + 0.1).mean():.1f}", "s": f"{first + second:.1f}"}


def table(columns, rows):
    print("\n| " + " | ".join(columns) + " |\n|" + " --- |" * len(columns))
    for row in rows:
        print("| " + " | ".join(str(row.get(column, "")) for column in columns) + " |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", choices=["clad", "repair"])
    parser.add_argument("--names", default="")
    parser.add_argument("--patterns", default=",".join(PATTERNS))
    parser.add_argument("--turns", default=f"0,{ANGLE:.0f}")
    parser.add_argument("--seeds", default="1,2")
    parser.add_argument("--noise", type=float, default=0.1)
    parser.add_argument("--scanned", type=float, default=0.05, help="noise of the scans of damaged blocks, mm")
    parser.add_argument("--allowance", type=float, default=HEIGHT, help="metal above the repaired block, at most, mm")
    parser.add_argument("--output", type=pathlib.Path, default=pathlib.Path("surfaces"))
    parser.add_argument("--binary", type=pathlib.Path, default=trees.ROOT / "target/release/beadwright")
    given = parser.parse_args()
    given.output.mkdir(parents=True, exist_ok=True)
    binary, out = given.binary.resolve(), given.output
    is_wanted = lambda name: not given.names or name.split()[0] in given.names.split(",")
    seeds = [int(seed) for seed in given.seeds.split(",")]
    if given.only != "repair":
        rows = (clad(binary, out, name, base, truth, radius, float(angle), pattern)
                for name, base, truth, radius in bases(binary, out, given.noise, seeds) if is_wanted(name)
                for angle in given.turns.split(",") for pattern in given.patterns.split(","))
        table(["base", "pattern", "each layer", "all layers", "worst", "beyond", "off", "bare", "left out", "stretch", "starts", "s", "why"], rows)
    if given.only != "clad":
        rows = (repair(binary, out, name, seed, cut, given.scanned, given.allowance)
                for seed in seeds for name, cut in damages(np.random.default_rng(seed)) if is_wanted(name))
        table(["damage", "cut out", "found", "before", "after", "low", "high", "s", "why"], rows)


if __name__ == "__main__":
    main()
