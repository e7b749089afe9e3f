#!/usr/bin/env python3
"""Orders of welding and how the plate bends: what ranks orders as the elastic model does, and what order.distortion is worth.

    benches/orders.py shapes    all 24 orders of a wall of four sections and of an A of four sections, each in every layer or section by
                                section: spread of the plate's lift (released), and the rank correlation (Spearman) of several figures with it
    benches/orders.py parts     ten parts planned with order.distortion = false and true: lift, thermal eccentricity, time

Shapes are plans with their passes in another order, built by `beadwright distort`, which gives lifts and thermal eccentricities.
The figure "folds" knows nothing of temperatures: every piece of a bead folds the plate across itself, by its height above the middle of
what is there over the second moment of what is there; the folds add up to a lift.

Usage: benches/orders.py shapes|parts [--shapes wall,A,walls] [--turn 0,30] [--layers 8] [--voxel 3] [--threads 2] [--binary FILE] [--output FILE.json]
Needs numpy.
"""
import argparse, concurrent.futures, itertools, json, math, pathlib, subprocess, tempfile
import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent
PROFILE = "cmt-steel-abb"
WIDTH, HEIGHT, THICKNESS, MARGIN = 4.5, 1.8843, 12.0, 25.0
SHAPES = {
    "wall": [((-100, 0), (-50, 0)), ((-50, 0), (0, 0)), ((0, 0), (50, 0)), ((50, 0), (100, 0))],
    "A": [((-60, -60), (-20, 60)), ((-20, 60), (20, 60)), ((20, 60), (60, -60)), ((-40, 0), (40, 0))],
    "walls": [((-60, y), (60, y)) for y in (-45, -15, 15, 45)],
}
# Ten parts of several islands or long walls: boxes (x, y, length, width, height), mm.
PARTS = {
    "four pillars": [(x, y, 16, 16, 12) for x in (0, 60) for y in (0, 60)],
    "eight pillars": [(30 * x, 60 * y, 14, 14, 12) for x in range(4) for y in range(2)],
    "row of six": [(28 * x, 0, 16, 16, 12) for x in range(6)],
    "nine pillars": [(40 * x, 40 * y, 14, 14, 10) for x in range(3) for y in range(3)],
    "two walls": [(0, y, 150, 9, 20) for y in (0, 60)],
    "four walls": [(0, 30 * y, 120, 9, 15) for y in range(4)],
    "cross of walls": [(0, 55, 50, 9, 15), (70, 55, 50, 9, 15), (55, 0, 9, 50, 15), (55, 70, 9, 50, 15)],
    "large and small": [(0, 0, 60, 60, 10), (90, 0, 14, 14, 10), (90, 46, 14, 14, 10)],
    "wall in sections": [(52 * x, 0, 50, 9, 20) for x in range(4)],
    "one block": [(0, 0, 70, 50, 12)],
}


def turned(point, degrees):
    angle = math.radians(degrees)
    c, s = math.cos(angle), math.sin(angle)
    return np.array([point[0] * c - point[1] * s, point[0] * s + point[1] * c])


def sequence(order, block, layers):
    """Layer and section of each pass, in the order of welding."""
    if block:
        return [(layer, section) for section in order for layer in range(layers)]
    return [(layer, section) for layer in range(layers) for section in order]


def planned(profile, sections, order, block, layers):
    """A plan.json whose layers have one pass a section, laid back and forth."""
    def layer(index, number, passes):
        z = round(HEIGHT * (number + 1), 4)
        ends = lambda s: sections[s] if number % 2 == 0 else sections[s][::-1]
        def outline(a, b):
            side = turned((b - a) / np.linalg.norm(b - a) * WIDTH / 2, 90)
            return {"outline": [list(p) for p in (a + side, a - side, b - side, b + side)], "holes": []}
        weld = lambda s: {"kind": "wall", "closed": False, "points": [[*p, z] for p in ends(s)], "width": WIDTH, "pace": 8.0}
        return {"index": index, "z": z, "height": HEIGHT, "islands": [outline(*sections[s]) for s in passes],
                "passes": [weld(s) for s in passes]}
    if block:
        all_layers = [layer(i, number, [s]) for i, (number, s) in enumerate(sequence(order, True, layers))]
    else:
        all_layers = [layer(number, number, order) for number in range(layers)]
    profile["substrate"].update(margin=MARGIN, thickness=THICKNESS)
    return {"version": 2, "units": "mm", "part": "orders", "strategy": "wall", "profile": profile, "layers": all_layers}


def folds(sections, order, block, layers):
    """Lift of a plate that every piece of a bead folds across itself, in units of one bead's shrinkage."""
    ends = np.array([p for section in sections for p in section])
    low, high = ends.min(0) - MARGIN - WIDTH / 2, ends.max(0) + MARGIN + WIDTH / 2
    size, area = high - low, WIDTH * HEIGHT
    at = np.array([(x, y) for x in np.linspace(low[0], high[0], 9) for y in np.linspace(low[1], high[1], 9)])
    lift, laid = np.zeros(len(at)), []
    for number, section in sequence(order, block, layers):
        a, b = sections[section]
        length, z = np.linalg.norm(b - a), HEIGHT * (number + 0.5)
        way = (b - a) / length
        across, along = abs(way[1]) * size[0] + abs(way[0]) * size[1], abs(way[0]) * size[0] + abs(way[1]) * size[1]
        plate = across * THICKNESS
        metal = plate + sum(area * l * (d @ way) ** 4 / along for d, l, _ in laid)
        first = -plate * THICKNESS / 2 + sum(area * l * (d @ way) ** 4 / along * h for d, l, h in laid)
        second = plate * THICKNESS**2 / 3 + sum(area * l * (d @ way) ** 4 / along * h**2 for d, l, h in laid)
        middle = first / metal
        pieces = max(1, round(length / 10))
        for piece in range(pieces):
            place = a + (b - a) * (piece + 0.5) / pieces
            lift += 0.5 * np.abs((at - place) @ way) * (z - middle) / (second - metal * middle**2) * length / pieces
        laid.append((way, length, z))
    plane = np.c_[np.ones(len(at)), at]
    left = lift - plane @ np.linalg.lstsq(plane, lift, rcond=None)[0]
    return left.max() - left.min()


def figures(course):
    """Figures of a course of thermal eccentricities, seen from above."""
    time = np.array([c["time"] for c in course])
    heat, offset = np.array([c["heat"] for c in course]), np.array([c["offset"][:2] for c in course])
    steps = np.diff(time)
    over = lambda values: float(((values[1:] + values[:-1]) / 2 * steps).sum())
    far = np.linalg.norm(offset, axis=1)
    lasting = math.hypot(over(heat * offset[:, 0]), over(heat * offset[:, 1]))
    return {"mean |e|, by heat": over(heat * far) / over(heat), "mean |e|, by time": over(far) / over(np.ones(len(time))),
            "∫ |Q e| dt": over(heat * far), "largest |Q e|": float((heat * far).max()), "lasting": lasting / over(heat)}


def ranks(values):
    values = np.round(values, 9)
    return np.array([(values < v).sum() + ((values == v).sum() - 1) / 2 for v in values])


def spearman(a, b):
    a, b = ranks(a), ranks(b)
    return float(np.corrcoef(a, b)[0, 1]) if a.std() > 0 and b.std() > 0 else float("nan")


def distorted(binary, path, voxel):
    command = [binary, "distort", path, "--json", "--voxel", str(voxel)]
    return json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)


def shapes(arguments, folder):
    profile = base_profile(arguments.binary, folder)
    cases = [(s, t, b) for s in arguments.shapes for t in arguments.turn for b in (False, True)]
    found = []
    for shape, turn, block in cases:
        sections = [tuple(turned(p, turn) for p in section) for section in SHAPES[shape]]

        def run(order):
            path = folder / f"{''.join(map(str, order))}.json"
            path.write_text(json.dumps(planned(profile, sections, order, block, arguments.layers)))
            built = distorted(arguments.binary, path, arguments.voxel)
            own = figures(built["eccentricity"]["course"])
            return order, built["released"]["lift"]["range"], {**own, "folds": folds(sections, order, block, arguments.layers)}

        with concurrent.futures.ThreadPoolExecutor(arguments.threads) as threads:
            rows = list(threads.map(run, itertools.permutations(range(4))))
        lifts = np.array([lift for _, lift, _ in rows])
        rho = {name: spearman(np.array([row[2][name] for row in rows]), lifts) for name in rows[0][2]}
        best, worst = rows[lifts.argmin()], rows[lifts.argmax()]
        print(f"{shape}, turned by {turn:g}°, {'section by section' if block else 'layer by layer'}: lift {best[1]:.4f} mm {best[0]} to "
              f"{worst[1]:.4f} mm {worst[0]}, {100 * (worst[1] / best[1] - 1):.1f} % more", flush=True)
        print("  " + ", ".join(f"{name} {value:+.2f}" for name, value in rho.items()), flush=True)
        found.append({"shape": shape, "turn": turn, "block": block, "rho": rho,
                      "rows": [{"order": o, "lift": l, "figures": f} for o, l, f in rows]})
    return found


def base_profile(binary, folder):
    model(folder / "box.stl", [(0, 0, 40, 4.5, 6)])
    plan(binary, folder / "box.stl", folder / "box", False)
    return json.loads((folder / "box/plan.json").read_text())["profile"]


def model(path, boxes):
    """Boxes as ASCII STL."""
    faces = [(0, 2, 1), (1, 2, 3), (4, 5, 6), (5, 7, 6), (0, 1, 4), (1, 5, 4), (2, 6, 3), (3, 6, 7), (0, 4, 2), (2, 4, 6), (1, 3, 5), (3, 7, 5)]
    lines = ["solid boxes"]
    for x, y, length, width, height in boxes:
        corner = lambda i: (x + length * (i & 1), y + width * (i >> 1 & 1), height * (i >> 2))
        for face in faces:
            vertices = "".join("vertex %g %g %g\n" % corner(i) for i in face)
            lines.append(f"facet normal 0 0 0\nouter loop\n{vertices}endloop\nendfacet")
    path.write_text("\n".join(lines + ["endsolid boxes\n"]))


def plan(binary, part, output, distortion):
    command = [binary, "plan", part, "-p", PROFILE, "--no-deposit", "--quiet", "-o", output]
    if distortion:
        command += ["--set", "order.distortion=true"]
    subprocess.run(command, check=True, capture_output=True)


def parts(arguments, folder):
    found = []
    print("part, lift before and after mm, deviation rms before and after mm, eccentricity before and after mm, time before and after min")
    for name, boxes in PARTS.items():
        row = {"part": name}
        model(folder / "part.stl", boxes)
        for distortion in (False, True):
            output = folder / f"{name} {distortion}"
            plan(arguments.binary, folder / "part.stl", output, distortion)
            built = distorted(arguments.binary, output / "plan.json", arguments.voxel)
            metrics = json.loads((output / "metrics.json").read_text())
            row[distortion] = [built["released"]["lift"]["range"], built["released"]["deviation"]["rms"],
                               built["eccentricity"]["score"]["mean"], metrics["total_time_s"] / 60]
        found.append(row)
        pairs = [f"{b:.3f} {a:.3f} ({100 * (a / b - 1):+.1f} %)" for b, a in zip(row[False], row[True])]
        print(f"{name}, {', '.join(pairs)}", flush=True)
    for i, what in enumerate(["lift", "deviation", "eccentricity", "time"]):
        change = np.mean([row[True][i] / row[False][i] - 1 for row in found])
        print(f"mean change of {what}: {100 * change:+.1f} %")
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("study", choices=["shapes", "parts"])
    parser.add_argument("--shapes", type=lambda text: text.split(","), default=["wall", "A"])
    parser.add_argument("--turn", type=lambda text: [float(t) for t in text.split(",")], default=[0.0, 30.0])
    parser.add_argument("--layers", type=int, default=8)
    parser.add_argument("--voxel", type=float, default=3.0)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--binary", default=ROOT / "target/release/beadwright")
    parser.add_argument("--output", type=pathlib.Path)
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        found = (shapes if arguments.study == "shapes" else parts)(arguments, pathlib.Path(folder))
    if arguments.output:
        arguments.output.write_text(json.dumps([{str(k): v for k, v in row.items()} for row in found], indent=1))


if __name__ == "__main__":
    main()
