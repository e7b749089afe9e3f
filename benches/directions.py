#!/usr/bin/env python3
"""Parts in the bodies that `beadwright directions` finds, beside the same parts as preforms in level layers.

Bars and pipes that branch are united by the library manifold3d (`pip install manifold3d numpy`); hub, elbow and y-tube are our own
examples; the others are models of $BEADWRIGHT_MODELS. Each part is taken as it is and turned about z by 37 degrees. A preform gets
no stock for milling here, so that only what overhangs costs it metal; what is laid beside the part is milled off in either way.
An hour costs 90, a kilogram of wire 12, and 60 cm3 are milled in a minute.

Columns: overhang in level layers and in the bodies, cm2; largest angle of layers from level; seconds to find and to plan; shares of
the part covered and void; what the metal as built has in common with the part; then welded kg, hours of weld and mill, and price of
the bodies, and the same of the preform. A plan in which a bead would hang in the air or the torch would hit metal is refused.

Usage: benches/directions.py [--parts t,y60,…] [--turns 0,37] [--output FOLDER] [--binary FILE]
"""
import argparse, json, os, pathlib, re, subprocess, sys, time
import manifold3d, numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import trees

ROOT = trees.ROOT
MODELS = pathlib.Path(os.environ.get("BEADWRIGHT_MODELS", ROOT / "../shared/models"))
HOUR, WIRE, MILLED = 90.0, 12.0, 60.0
PRICES = ["--set", f"cost.hour={HOUR}", "--set", f"cost.wire_kg={WIRE}"]
BARE = [arg for key in ("side", "top", "bottom") for arg in ("--set", f"preform.{key}=0")]
WALL = 8.0
# Name, file, options that place it.
OTHERS = [("ankle_base", "ankle_base.obj", []), ("branches16", "branches16.stl", []),
          ("supportless", "supportless_sample.stl", []), ("propeller_on_hub", "propeller_on_hub.stl", ["--scale", "4"])]
EXAMPLES = ["hub", "elbow", "y-tube"]


def pipes(bars, path):
    """The bars as pipes whose bores meet."""
    whole, bores = trees.bar(*bars[0]), None
    for start, way, radius, length in bars:
        whole += trees.bar(start, way, radius, length)
        bore = trees.bar(start - (way * 5 if start is bars[0][0] else 0), way, radius - WALL, length + 10)
        bores = bore if bores is None else bores + bore
    trees.write(whole - bores, path)


def parts(turned, binary, out):
    """Name, file and placing options of each part."""
    placed = ["--units", "mm", "--turn", f"0,0,{turned}"]
    for name, bars in trees.nodes(0).items():
        path = out / f"{name}.stl"
        trees.save(bars, path)
        yield name, path, placed
    for name in ("t", "y60", "four"):
        path = out / f"{name}_pipes.stl"
        pipes(trees.nodes(0)[name], path)
        yield f"{name}, pipes", path, placed
    for name in EXAMPLES:
        path = out / f"{name}.stl"
        subprocess.run([binary, "example", name, "-o", path], check=True, capture_output=True)
        yield name, path, placed
    for name, file, own in OTHERS:
        yield name, MODELS / file, placed + own


def run(*command):
    began = time.monotonic()
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True)
    return done, time.monotonic() - began


def planned(binary, model, placed, how, folder):
    """Metrics of the plan, or the reason why there is none."""
    done, seconds = run(binary, "plan", model, *placed, *how, *PRICES, "-o", folder)
    if done.returncode:
        said = [line for line in done.stderr.splitlines() if line.strip() and not line.startswith("note")]
        return None, seconds, " ".join(said[:2])[:160]
    return json.loads((folder / "metrics.json").read_text()), seconds, ""


def bill(metrics, part):
    """kg welded, hours of weld and mill, price."""
    milling = max(metrics["deposited_volume_mm3"] - part, 0) / 1000 / MILLED / 60
    return metrics["wire_mass_kg"], metrics["total_time_s"] / 3600 + milling, metrics["cost"] + milling * HOUR


def tried(binary, name, model, placed, out):
    bodies = out / f"{name}.bodies.toml"
    found, seconds = run(binary, "directions", model, *placed, "-o", bodies)
    row = {"part": name, "find s": seconds}
    if found.returncode:
        return row | {"why": " ".join(found.stderr.split())[:160]}
    figures = re.findall(r"([\d.]+) cm² overhang", found.stdout)
    tilt = re.search(r"up to (\d+)° from level", found.stdout)
    row |= {"bodies": bodies.read_text().count("[[body]]"), "level cm2": figures[0],
            "left cm2": figures[1] if len(figures) > 1 else figures[0], "off level": tilt[1] if tilt else "0"}
    metrics, row["plan s"], row["why"] = planned(binary, model, placed, ["--bodies", bodies], out / name)
    whole, _, why = planned(binary, model, placed, ["--preform", *BARE], out / f"{name} preform")
    part = (metrics or {}).get("mesh_volume_mm3") or (whole or {}).get("milled_part_volume_mm3")
    if metrics:
        built = run(binary, "deviation", model, *placed, out / name / "plan.json", "--json")[0]
        deposit = metrics["deposit"] or {}
        row |= {"covered": 100 * metrics["coverage"], "void": deposit.get("void_percent")}
        row["common"] = 100 * json.loads(built.stdout)["built"]["agreement"] if not built.returncode else None
        row["kg"], row["h"], row["price"] = bill(metrics, part)
    if whole:
        row["preform kg"], row["preform h"], row["preform price"] = bill(whole, part)
    elif not row["why"]:
        row["why"] = f"preform: {why}"
    return row


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--parts", default="")
    parser.add_argument("--turns", default="0,37")
    parser.add_argument("--output", type=pathlib.Path, default=pathlib.Path("directions"))
    parser.add_argument("--binary", type=pathlib.Path, default=ROOT / "target/release/beadwright")
    given = parser.parse_args()
    binary = given.binary.resolve()
    columns = ["part", "bodies", "level cm2", "left cm2", "off level", "find s", "plan s", "covered", "void", "common",
               "kg", "h", "price", "preform kg", "preform h", "preform price", "why"]
    print("| " + " | ".join(columns) + " |\n|" + " --- |" * len(columns))
    for turned in given.turns.split(","):
        out = given.output / turned
        out.mkdir(parents=True, exist_ok=True)
        for name, model, placed in parts(turned, binary, out):
            if given.parts and name not in given.parts.split(","):
                continue
            row = tried(binary, name, model, placed, out) | {"part": f"{name}, {turned}°"}
            shown = (row.get(column) for column in columns)
            print("| " + " | ".join("" if v is None else f"{v:.2f}" if isinstance(v, float) else str(v) for v in shown) + " |", flush=True)


if __name__ == "__main__":
    main()
