#!/usr/bin/env python3
"""Finds the bodies of random trees of round bars with `beadwright directions`, plans them, and prints a table.

A tree is an upright trunk with one to four branches at 30 to 90 degrees, on the trunk or on each other, at least 25 mm apart; the bars are
united by the library manifold3d (`pip install manifold3d numpy`). At the end: how many parts had as many bodies as bars, how many were
planned, and what the worst of them leaves open. Meshes, bodies and plans stay in --output.

With --nodes the parts are not random: a T, a Y at 60 and at 30 degrees, four bars on a trunk, and a node of three at 65 degrees, each as
it is and turned about z by 37 degrees.

Usage: benches/trees.py [--nodes] [--seed 1] [--count 20] [--output FOLDER] [--binary FILE] [--tilt 90] [--no-plan]
"""
import argparse, json, pathlib, subprocess, time
import manifold3d, numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent
APART = 25.0
# A bar has room for a bead of 7.5 mm on both sides of its axis.
THINNEST = 7.6


def square_to(way):
    """A frame whose third direction is `way`."""
    first = np.cross([1.0, 0, 0] if abs(way[0]) < 0.9 else [0, 1.0, 0], way)
    first /= np.linalg.norm(first)
    return np.stack([first, np.cross(way, first), way], 1)


def bar(start, way, radius, length):
    return manifold3d.Manifold.cylinder(length, radius, radius, 64).transform(np.hstack([square_to(way), start[:, None]]))


def between(a, b):
    """Distance of two axes, mm, from points on them."""
    part = np.linspace(0, 1, 60)
    ends = [own[0] + np.outer(part * own[3], own[1]) for own in (a, b)]
    return np.linalg.norm(ends[0][:, None] - ends[1][None], axis=2).min()


def tree(seed):
    """Bars as start, direction, radius and length, mm; the trunk first."""
    random = np.random.default_rng(seed)
    bars = [(np.zeros(3), np.array([0, 0, 1.0]), random.uniform(14, 22), random.uniform(90, 160))]
    wanted = 1 + random.integers(1, 5)
    for _ in range(400):
        if len(bars) == wanted:
            break
        k = random.integers(0, len(bars))
        start, way, radius, length = bars[k]
        lean, around = np.radians(random.uniform(30, 90)), random.uniform(0, 2 * np.pi)
        own = square_to(way) @ [np.sin(lean) * np.cos(around), np.sin(lean) * np.sin(around), np.cos(lean)]
        thick = max(radius * random.uniform(0.55, 0.8), THINNEST)
        new = (start + way * random.uniform(0.35, 0.85) * length, own, thick, random.uniform(60, 110) + radius / np.sin(lean))
        free = all(between(new, other) > thick + other[2] + APART for j, other in enumerate(bars) if j != k)
        if own[2] > 0.02 and new[0][2] - thick > 12 and free:
            bars.append(new)
    return bars


def nodes(turned):
    """Named parts, turned about z by some degrees."""
    def way(lean, around):
        lean, around = np.radians(lean), np.radians(around + turned)
        return np.array([np.sin(lean) * np.cos(around), np.sin(lean) * np.sin(around), np.cos(lean)])

    def on_trunk(*branches):
        trunk = (np.zeros(3), np.array([0, 0, 1.0]), 20.0, 140.0)
        return [trunk] + [(np.array([0, 0, height]), way(lean, around), radius, length) for height, lean, around, radius, length in branches]

    return {
        "t": on_trunk((90, 90, 0, 14, 100)), "y60": on_trunk((80, 60, 33, 14, 110)), "y30": on_trunk((60, 30, 33, 14, 120)),
        "four": on_trunk((60, 90, 10, 12, 90), (60, 80, 100, 12, 90), (95, 75, 190, 12, 90), (95, 90, 280, 12, 90)),
        "node": on_trunk(*((85, 65, around, 13, 100) for around in (20, 140, 260))),
    }


def save(bars, path):
    whole = bar(*bars[0])
    for own in bars[1:]:
        whole += bar(*own)
    write(whole, path)


def write(solid, path):
    """A solid of manifold3d as a binary STL file."""
    mesh = solid.to_mesh()
    corners = np.array(mesh.vert_properties)[:, :3][np.array(mesh.tri_verts)]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    facets = np.zeros(len(corners), dtype=[("numbers", "<12f4"), ("attribute", "<u2")])
    facets["numbers"] = np.hstack([normals, corners.reshape(-1, 9)])
    path.write_bytes(b"\0" * 80 + np.uint32(len(facets)).tobytes() + facets.tobytes())


def tried(binary, name, bars, out, plan, tilt):
    model, bodies = out / f"{name}.stl", out / f"{name}.bodies.toml"
    save(bars, model)
    began = time.monotonic()
    found = subprocess.run([binary, "directions", model, "--units", "mm", "--tilt", str(tilt), "-o", bodies], capture_output=True, text=True)
    row = {"part": name, "bars": len(bars), "seconds": time.monotonic() - began, "bodies": "", "why": found.stderr.strip()[:150]}
    if found.returncode or not bodies.exists():
        return row | {"status": f"nothing found ({found.returncode})"}
    row["bodies"] = bodies.read_text().count("[[body]]")
    if not plan:
        return row | {"status": "found"}
    folder = out / name
    done = subprocess.run([binary, "plan", model, "--units", "mm", "--bodies", bodies, "-o", folder], capture_output=True, text=True)
    said = [line for line in done.stderr.splitlines() if line.strip() and not line.startswith("note")]
    row["why"] = (said[1] if done.returncode and len(said) > 1 else said[0] if said else "")[:150]
    if done.returncode:
        return row | {"status": f"refused ({done.returncode})"}
    metrics = json.loads((folder / "metrics.json").read_text())
    deposit = metrics["deposit"] or {}
    return row | {"status": "planned", "starts": metrics["arc_starts"], "covered": 100 * metrics["coverage"],
                  "void": deposit.get("void_percent"), "overfill": deposit.get("overfill_percent")}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--count", type=int, default=20)
    parser.add_argument("--output", type=pathlib.Path, default=pathlib.Path("trees"))
    parser.add_argument("--binary", type=pathlib.Path, default=ROOT / "target/release/beadwright")
    parser.add_argument("--nodes", action="store_true")
    parser.add_argument("--tilt", type=float, default=90, help="of `directions`, degrees")
    parser.add_argument("--no-plan", action="store_true")
    given = parser.parse_args()
    given.output.mkdir(parents=True, exist_ok=True)
    columns = ["part", "bars", "bodies", "status", "seconds", "starts", "covered", "void", "overfill", "why"]
    print("| " + " | ".join(columns) + " |\n|" + " --- |" * len(columns))
    rows = []
    if given.nodes:
        parts = ((f"{name}-{turned}", bars) for turned in (0, 37) for name, bars in nodes(turned).items())
    else:
        parts = ((f"tree{seed}", tree(seed)) for seed in range(given.seed, given.seed + given.count))
    for name, bars in parts:
        rows.append(row := tried(given.binary.resolve(), name, bars, given.output, not given.no_plan, given.tilt))
        shown = (row.get(column) for column in columns)
        print("| " + " | ".join("" if v is None else f"{v:.2f}" if isinstance(v, float) else str(v) for v in shown) + " |", flush=True)
    planned = [row for row in rows if row["status"] == "planned"]
    print(f"\n{sum(row['bodies'] == row['bars'] for row in rows)} of {len(rows)} with a body for each bar, {len(planned)} planned")
    for key, worst in [("covered", min), ("void", max)]:
        values = [row[key] for row in planned if row.get(key) is not None]
        if values:
            print(f"{key}: worst {worst(values):.2f} %")


if __name__ == "__main__":
    main()
