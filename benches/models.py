#!/usr/bin/env python3
"""Plans every model of a folder with default flags, as it is and turned about x, and prints a table of what came out.

Parts of a few millimetres are enlarged until the widest side is 150 mm; files in inches or metres are said to be so. The last
column is the first finding, or why nothing was planned. Plans and refusals stay in --output to be looked at.

Usage: benches/models.py [--models FOLDER] [--angles 0,17,90] [--output FOLDER] [--binary FILE] [NAME...]
"""
import argparse, json, os, pathlib, subprocess, time

ROOT = pathlib.Path(__file__).resolve().parent.parent
# What a user says of these files, since they do not say it themselves.
FLAGS = {
    "featuretype.stl": ["--units", "in"], "iris_quad_duplicates.stl": ["--units", "m"],
    "openthruster_prop_cw.stl": ["--scale", "3.66"], "pulley_t30.stl": ["--scale", "5"], "3dbenchy.3mf": ["--scale", "3"],
    "pulley_t30_truncated.stl": ["--scale", "5", "--accept-damaged"], "rear_case.stl": ["--scale", "2"],
    "star_ascii.stl": ["--units", "mm", "--scale", "50"], "star_empty_header.stl": ["--units", "mm", "--scale", "50"],
    "moon_chinese_header.stl": ["--units", "mm", "--scale", "90"], "cube_invalid_unicode.stl": ["--units", "mm", "--scale", "40"],
    "two_objects_mixed_case.stl": ["--units", "mm", "--scale", "25"], "spider_ascii.stl": ["--units", "mm", "--scale", "20"],
    "soup.stl": ["--units", "mm", "--scale", "100"], "self_intersect.obj": ["--units", "mm", "--scale", "75"],
    "propeller_on_hub.stl": ["--scale", "4"], "ankle_base.obj": ["--scale", "2"], "nonmanifold_3dsmax.stl": ["--scale", "3"],
    "simple_vase_open.stl": ["--surface", "wall"], "wavy_vase_open.stl": ["--surface", "wall"],
    "facade_infill_open.stl": ["--surface", "wall"], "y_surface_open.obj": ["--surface", "wall"],
    "connection3legs_open_low_res.stl": ["--surface", "wall"],
}


def planned(binary, model, angle, out):
    """The row of one plan."""
    command = [binary, "plan", model, *FLAGS.get(model.name, []), "-o", out]
    command += ["--turn", f"{angle},0,0"] if angle else []
    began = time.monotonic()
    try:
        done = subprocess.run([str(c) for c in command], capture_output=True, text=True, timeout=1800)
    except subprocess.TimeoutExpired:
        return {"status": "over 30 min"}
    row = {"seconds": time.monotonic() - began}
    if done.returncode:
        said = [line for line in done.stderr.splitlines() if line.strip()] or [f"ended with status {done.returncode}"]
        reason = next((line for line in said[1:] if not line.startswith("note")), said[0]) if "no program was" in done.stderr else said[0]
        return row | {"status": f"refused ({done.returncode})", "why": reason.removeprefix("error: ")[:150]}
    metrics, plan = (json.loads((out / name).read_text()) for name in ("metrics.json", "plan.json"))
    islands = sum(len(layer["islands"]) for layer in plan["layers"])
    refilled = sum(w["count"] for w in metrics["warnings"] if w["kind"] == "refilled")
    deposit = metrics["deposit"] or {}
    findings = metrics["findings"]
    serious = [f for f in findings if f["severity"] == "serious"]
    return row | {
        "status": "planned", "layers": metrics["layers"], "islands": islands,
        "starts": metrics["arc_starts"] / max(islands, 1), "refilled": refilled, "covered": 100 * metrics["coverage"],
        "void": deposit.get("void_percent"), "overfill": deposit.get("overfill_percent"),
        "within": 100 * metrics["built"]["within"] if metrics.get("built") else None,
        "serious": len(serious), "findings": len(findings), "why": (findings[0]["text"] if findings else "")[:150],
    }


def shown(value, digits=2):
    return "" if value is None else f"{value:.{digits}f}" if isinstance(value, float) else str(value)


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("names", nargs="*")
    arguments.add_argument("--models", type=pathlib.Path, default=os.environ.get("BEADWRIGHT_MODELS", ROOT / "../shared/models"))
    arguments.add_argument("--angles", default="0,17,90")
    arguments.add_argument("--output", type=pathlib.Path, default=pathlib.Path("/tmp/beadwright-models"))
    arguments.add_argument("--binary", type=pathlib.Path, default=ROOT / "target/release/beadwright")
    given = arguments.parse_args()
    models = sorted(m for m in pathlib.Path(given.models).iterdir() if m.is_file() and m.suffix != ".md")
    models = [m for m in models if not given.names or m.name in given.names]
    rows = []
    columns = ["layers", "islands", "starts", "refilled", "covered", "void", "overfill", "within", "serious", "findings", "seconds", "why"]
    print("| model | turn | status | " + " | ".join(columns) + " |\n|" + "---|" * (len(columns) + 3), flush=True)
    for model in models:
        for angle in given.angles.split(","):
            out = given.output / f"{model.name}-{angle}"
            row = planned(given.binary, model, 0 if angle == "0" else angle, out)
            rows.append(row)
            cells = [shown(row.get(c)) for c in columns]
            print(f"| {model.name} | {angle} | {row['status']} | " + " | ".join(cells) + " |", flush=True)
    good = [r for r in rows if r["status"] == "planned"]
    islands, refilled = sum(r["islands"] for r in good), sum(r["refilled"] for r in good)
    print(f"\n{len(good)} of {len(rows)} planned; {refilled} of {islands} islands filled by another strategy "
          f"({100 * refilled / max(islands, 1):.2f} %).")


if __name__ == "__main__":
    main()
