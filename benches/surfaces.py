#!/usr/bin/env python3
"""Clads a pipe, a dome, a mould and a scan of the dome, repairs five damages of two parts, and prints two tables.

Dome and mould are examples of the program; the scan is the dome's surface in triangles of 1 mm with noise of --noise mm (standard
deviation). Each base is clad as it is and turned by 37 degrees about a slanted axis, with zigzags along and across, spirals, and
rings joined to one path (loop). Damages are cut out of a block and a shaft by the library manifold3d (`pip install manifold3d numpy`).

What is clad is measured here, from the table of beads that `beadwright export` writes: at points of the true surface, the metal
within a stepover of each layer. Columns: thickness as a share of the layers that were asked for, mean, lowest and highest 5 %, and
the worst; how far layers lie from where the surface has them, mm; bare area, cm2 (farther from all beads of a layer than half their
width and a tenth); stretch, what the plan says; arc starts; seconds to clad and to plan.

Repairs: what was cut out and what the program finds missing, cm3; what is milled first; the deviation of the part's surface from the
scan and of what is built from the part where it was damaged, mm.

Usage: benches/surfaces.py [--only clad|repair] [--names dome,…] [--noise 0.2] [--output FOLDER] [--binary FILE]
"""
import argparse, csv, json, pathlib, re, subprocess, sys, time
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import trees

LAYERS, HEIGHT, STEPOVER, WIDTH = 3, 2.0, 5.39, 7.54
AXIS, ANGLE = np.array([1.0, 2.0, 0.5]), 37.0
PATTERNS = {
    "along": ["fill.strategy=zigzag", "fill.raster_angle=0", "fill.raster_turn=fixed"],
    "across": ["fill.strategy=zigzag", "fill.raster_angle=90", "fill.raster_turn=fixed"],
    "spiral": ["fill.strategy=spiral"], "loop": ["fill.strategy=loop"]}


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


def rough(corners, noise):
    """A scan: every corner moved by noise."""
    _, at = np.unique(corners.reshape(-1, 3).round(4), axis=0, return_inverse=True)
    by = np.random.default_rng(1).normal(0, noise, at.max() + 1)[at.ravel()].reshape(-1, 3, 1)
    return corners + by * smooth(corners)


def bases(binary, out, noise):
    """Name, triangles, which of them are clad, and the cylinder that is clad, if it is one."""
    import manifold3d
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
    yield "scan", rough(fine(dome, 1.0), noise), dome[upper], None


def distances(places, others):
    """Distances of all others from every place, mm, some places at a time: from which place to which, and the distances."""
    some = 1 + 1_000_000 // len(others)
    for first in range(0, len(places), some):
        own = places[first:first + some]
        squares = (own**2).sum(1)[:, None] + (others**2).sum(1) - 2 * own @ others.T
        yield slice(first, first + len(own)), np.sqrt(np.maximum(squares, 0))


def smeared(places, others, weights):
    """What of some weights lies within a stepover of each place, nearer ones counting more."""
    sums = np.empty(len(places))
    for own, apart in distances(places, others):
        sums[own] = np.maximum(1 - (apart / STEPOVER) ** 2, 0) @ weights
    return sums


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
    """`up` is the direction along which layers are stacked, None for the surface's normals. At places of each layer: thickness as a share of its height, and distance from where it should lie; and bare area, cm2."""
    truth = fine(truth, 2.5)
    normals, edge, layers = smooth(truth), border(truth), []
    whole = truth.mean(axis=1)
    inner = np.concatenate([apart.min(axis=1) for _, apart in distances(whole, edge)]) > STEPOVER + WIDTH / 2
    for number in range(1, LAYERS + 1):
        moved = truth + (normals if up is None else up) * (number - 0.5) * HEIGHT
        middles, areas = moved.mean(axis=1), np.linalg.norm(vectors(moved), axis=1)
        random = np.random.default_rng(number)
        centres, widths, spread, metal = beads.layer(number)
        own = random.choice(np.flatnonzero(inner), count)
        thickness = smeared(middles[own], spread, metal) / smeared(middles[own], middles, areas) / HEIGHT
        own = random.choice(len(middles), count)
        least, off = np.empty(count), np.empty(count)
        for some, apart in distances(middles[own], centres):
            nearest = apart.argmin(axis=1)
            least[some] = (apart - 0.6 * widths).min(axis=1)
            off[some] = ((centres[nearest] - middles[own[some]]) * normals.mean(axis=1)[own[some]]).sum(axis=1)
        layers.append((thickness, off, (least > 0).mean() * areas.sum() / 100))
    thickness, off = (np.concatenate([layer[k] for layer in layers]) for k in (0, 1))
    return thickness, off, max(layer[2] for layer in layers)


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
    settings = PATTERNS[pattern]
    if radius:
        where = ["--around", f"axis={words(own[:, 2])},through={words([0, 0, -lowest])},radius={radius}"]
        settings = ["fill.around=helix"] if pattern == "spiral" else settings
    wanted = [word for setting in settings for word in ("--set", re.sub("=([a-z]+)$", r'="\1"', setting))]
    made, first = run(binary, "clad", folder / "base.stl", *where, "--layers", LAYERS, "-o", folder / "clad.stl")
    row = {"base": f"{name}, {angle:.0f}°", "pattern": pattern}
    if made.returncode:
        return row | {"why": " ".join(made.stderr.split())[:200]}
    done, second = run(binary, "plan", folder / "clad.stl", "--onto", folder / "base.stl", "--bodies", folder / "clad.bodies.toml",
                       *wanted, "-o", folder / "plan")
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
    share = lambda value: f"{100 * value:.1f}"
    low, high = np.percentile(thickness, [5, 95])
    return row | {"mean": share(thickness.mean()), "5 %": share(low), "95 %": share(high),
                  "worst": f"{share(thickness.min())}…{share(thickness.max())}", "off": f"{np.nanmin(off):+.2f}…{np.nanmax(off):+.2f}",
                  "bare": f"{bare:.1f}", "left out": said[1] if said else "0", "stretch": stretch[1] if stretch else "0",
                  "starts": metrics["arc_starts"], "covered": share(metrics["coverage"]), "s": f"{first + second:.1f}"}


def table(columns, rows):
    print("| " + " | ".join(columns) + " |\n|" + " --- |" * len(columns))
    for row in rows:
        print("| " + " | ".join(str(row.get(column, "")) for column in columns) + " |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", choices=["clad", "repair"])
    parser.add_argument("--names", default="")
    parser.add_argument("--patterns", default=",".join(PATTERNS))
    parser.add_argument("--turns", default=f"0,{ANGLE:.0f}")
    parser.add_argument("--noise", type=float, default=0.2)
    parser.add_argument("--output", type=pathlib.Path, default=pathlib.Path("surfaces"))
    parser.add_argument("--binary", type=pathlib.Path, default=trees.ROOT / "target/release/beadwright")
    given = parser.parse_args()
    given.output.mkdir(parents=True, exist_ok=True)
    binary, out = given.binary.resolve(), given.output
    is_wanted = lambda name: not given.names or name in given.names.split(",")
    if given.only != "repair":
        rows = (clad(binary, out, name, base, truth, radius, float(angle), pattern)
                for name, base, truth, radius in bases(binary, out, given.noise) if is_wanted(name)
                for angle in given.turns.split(",") for pattern in given.patterns.split(","))
        table(["base", "pattern", "mean", "5 %", "95 %", "worst", "off", "bare", "left out", "stretch", "starts", "covered", "s", "why"], rows)


if __name__ == "__main__":
    main()
