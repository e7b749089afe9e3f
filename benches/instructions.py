#!/usr/bin/env python3
"""Instructions executed for a few short plans, counted by valgrind and compared with benches/instructions.json.

Counts do not depend on what else the machine does. The command fails where a plan takes over 20 % more than stored; where
the growth is meant, or after a gain, --store writes the counts anew. The binary is that of the profile dev, which the
tests have built; parts are the examples of the command, so no models are needed.

Usage: benches/instructions.py [--store] [--binary FILE]
"""
import argparse, json, os, pathlib, re, shutil, subprocess, sys, tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
STORED = ROOT / "benches/instructions.json"
MOST = 1.2
# Name, example part, profile.
CASES = [
    ("propeller, compound", "propeller", "crates/beadwright/benches/fdm-5.39x2.toml"),
    ("vase, compound", "vase", "crates/beadwright/benches/fdm-5.39x2.toml"),
    ("cross, loop", "cross", "cmt-al2319-kuka"),
]


def counted(binary, part, profile, work):
    """Instructions of one plan on one thread."""
    command = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", binary, "plan", part, "-p", profile,
               "--no-deposit", "--allow-findings", "-o", work / "out"]
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, cwd=ROOT,
                          env={**os.environ, "RAYON_NUM_THREADS": "1"})
    found = re.search(r"Collected : (\d+)", done.stderr)
    if done.returncode or not found:
        sys.exit(f"The plan of {part} failed under valgrind:\n{done.stderr[-2000:]}")
    return int(found[1])


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--store", action="store_true")
    target = pathlib.Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
    arguments.add_argument("--binary", type=pathlib.Path, default=target / "debug/beadwright")
    given = arguments.parse_args()
    if not shutil.which("valgrind"):
        print("Instructions are not counted: valgrind is not installed (apt-get install valgrind).")
        return
    known = json.loads(STORED.read_text()) if STORED.exists() else {}
    counts, grown = {}, []
    for name, example, profile in CASES:
        with tempfile.TemporaryDirectory() as folder:
            work = pathlib.Path(folder)
            subprocess.run([given.binary, "example", example, "-o", work / "part.stl"], check=True, capture_output=True)
            counts[name] = counted(given.binary, work / "part.stl", profile, work)
        ratio = counts[name] / known[name] if name in known else 1.0
        print(f"{name:<28}{counts[name] / 1e6:10.1f} million instructions, {ratio:.3f} × the stored count")
        grown += [name] if ratio > MOST else []
    if given.store:
        STORED.write_text(json.dumps(counts, indent=1) + "\n")
    elif grown:
        sys.exit(f"More than {MOST:.2f} × the stored instructions: {', '.join(grown)}. Find out why, or store the new counts "
                 "with benches/instructions.py --store and say so in the commit.")


if __name__ == "__main__":
    main()
