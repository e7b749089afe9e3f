#!/usr/bin/env bash
# Whole processes on the 1.1-million-triangle bunny: beadwright beside PrusaSlicer (Debian: prusa-slicer), same
# layer height, one perimeter, 100 % rectilinear. Prints CPU seconds, wall seconds and peak memory, median of N runs.
# Usage: benches/whole_process.sh [N]
set -euo pipefail
cd "$(dirname "$0")/.."
runs=${1:-3}
models=${BEADWRIGHT_MODELS:-../shared/models}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
gunzip -kc "$models/bunny_1114k.stl.gz" > "$work/bunny.stl"
cargo build --release --quiet

# The median by CPU time of N runs of a command.
measure() {
    local name=$1; shift
    for _ in $(seq "$runs"); do
        /usr/bin/env python3 - "$@" <<'PY'
import os, resource, subprocess, sys, time
t = time.time()
done = subprocess.run(sys.argv[1:], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
u = resource.getrusage(resource.RUSAGE_CHILDREN)
if done.returncode:
    sys.exit(f"failed: {sys.argv[1:]}")
print(f"{u.ru_utime + u.ru_stime:.2f} {time.time() - t:.2f} {u.ru_maxrss / 1024:.0f}")
PY
    done | sort -n | awk -v n="$name" '{l[NR]=$0} END {split(l[int((NR+1)/2)],m," "); printf "%-34s CPU %6.2f s  wall %6.2f s  peak %4d MB\n", n, m[1], m[2], m[3]}'
}

measure "beadwright plan, deposit model" target/release/beadwright plan "$work/bunny.stl" \
    -p crates/beadwright/benches/fdm-0.45x0.2.toml -o "$work/judged"
measure "beadwright plan --no-deposit" target/release/beadwright plan "$work/bunny.stl" \
    -p crates/beadwright/benches/fdm-0.45x0.2.toml --no-deposit -o "$work/out"
if command -v prusa-slicer > /dev/null; then
    measure "prusa-slicer" prusa-slicer --export-gcode "$work/bunny.stl" -o "$work/prusa.gcode" \
        --layer-height 0.2 --first-layer-height 0.2 --nozzle-diameter 0.4 --extrusion-width 0.45 --perimeters 1 \
        --fill-density 100% --fill-pattern rectilinear --skirts 0 --bed-shape 0x0,300x0,300x300,0x300
else
    echo "prusa-slicer is not installed (apt-get install prusa-slicer): its line is left out"
fi
