#!/usr/bin/env python3
"""Time and peak memory of `beadwright record` on long logs: by default ten hours at 100 Hz from four sources, 3.6 million rows each. The
part is a block planned here; its build is logged by a controller, two power sources' logs and a pyrometer, whose clocks have
offsets and drifts, with faults at known passes that must be found. Nothing is downloaded.

Usage: benches/record.py [--hours 10] [--hertz 100] [--binary target/release/beadwright] [--keep FOLDER]
Needs numpy.
"""
import argparse, csv, json, os, pathlib, struct, subprocess, tempfile, time

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent


def box(path, x, y, z):
    """A box as binary STL."""
    v = [(a, b, c) for c in (0, z) for b in (0, y) for a in (0, x)]
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    faces = [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
    with open(path, "wb") as file:
        file.write(bytes(80) + struct.pack("<I", len(faces)))
        for face in faces:
            file.write(struct.pack("<12fH", 0, 0, 0, *(w for k in face for w in v[k]), 0))


def passes_of(table):
    """Start and end of each pass, s, and its feed, from an exported table."""
    passes = {}
    with open(table, newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            start, seconds = float(row["start (s)"]), float(row["time (s)"])
            key = (int(row["layer"]), int(row["pass"]))
            begin = passes.get(key, (start,))[0]
            passes[key] = (begin, start + seconds, float(row["wire feed (ratio)"]))
    return passes


def write(path, header, columns, formats):
    with open(path, "w", encoding="utf-8") as file:
        file.write(header + "\n")
        for begin in range(0, len(columns[0]), 200_000):
            np.savetxt(file, np.column_stack([c[begin:begin + 200_000] for c in columns]), fmt=formats, delimiter=",")


def main():
    ask = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    ask.add_argument("--hours", type=float, default=10.0)
    ask.add_argument("--hertz", type=float, default=100.0)
    ask.add_argument("--binary", default=ROOT / "target/release/beadwright")
    ask.add_argument("--keep", help="folder to work in, and to leave there")
    wanted = ask.parse_args()
    folder = pathlib.Path(wanted.keep or tempfile.mkdtemp())
    folder.mkdir(parents=True, exist_ok=True)
    os.chdir(folder)
    box("block.stl", 150, 100, 4)

    def run(*arguments):
        subprocess.run([wanted.binary, *map(str, arguments)], check=True, stdout=subprocess.DEVNULL)

    def plan(height):
        box("block.stl", 150, 100, height)
        run("plan", "block.stl", "-s", "raster", "--no-deposit", "-o", "plan", "--quiet", "--allow-findings",
            "--set", "process.current=180", "--set", "process.voltage=20")
        run("export", "plan/plan.json", "-o", "beads.csv")
        return passes_of("beads.csv")

    passes = plan(20)
    end = max(p[1] for p in passes.values())
    passes = plan(round(20 * wanted.hours * 3600 / end))
    times = np.array([p[:2] for p in passes.values()])
    feed = json.loads(pathlib.Path("plan/plan.json").read_text())["profile"]["process"]["wire_feed_speed"]
    dice = np.random.default_rng(1)
    count = int(wanted.hours * 3600 * wanted.hertz)
    clock = np.arange(count) / wanted.hertz
    inside = np.searchsorted(times[:, 1], clock, side="right").clip(max=len(times) - 1)
    burns = (clock >= times[inside, 0]) & (clock < times[inside, 1])
    # Faults: the feed falls for three seconds in the middle of twenty passes.
    long = np.flatnonzero(times[:, 1] - times[:, 0] > 12)
    low = np.sort(dice.choice(long[5:-5], 20, replace=False))
    middle = times[low].mean(axis=1)
    fed = np.where(burns, feed, 0.0)
    for at in middle:
        fed[(clock >= at - 1.5) & (clock < at + 1.5)] *= 0.6
    noise = lambda part: 1 + part * (dice.random(count) - 0.5)
    write("power.csv", "time_s,current_a,voltage_v", [clock * (1 + 2e-4) + 700, np.where(burns, 180 * noise(0.08), 0.5), np.where(burns, 20 * noise(0.06), 62)], ["%.3f", "%.1f", "%.2f"])
    write("feeder.csv", "time_s,wire_feed_speed_m_min", [clock * (1 - 3e-4) - 50, fed * noise(0.03)], ["%.3f", "%.3f"])
    write("pyrometer.csv", "time_s,temperature_c,arc", [clock + 9000, np.where(burns, 1400 * noise(0.02), 150), burns], ["%.3f", "%.1f", "%d"])
    write("robot.csv", "time_s,speed_mm_s,arc", [clock, np.where(burns, 8 * noise(0.02), 40), burns], ["%.3f", "%.2f", "%d"])
    logs = ["power.csv", "feeder.csv", "pyrometer.csv", "robot.csv"]
    size = sum(os.path.getsize(name) for name in logs)
    sources = [word for name in logs for word in ("--source", name)]
    begin = time.perf_counter()
    with open("said.json", "w", encoding="utf-8") as out:
        record = subprocess.Popen([wanted.binary, "record", "plan/plan.json", *sources, "--json"], stdout=out)
        _, status, used = os.wait4(record.pid, 0)
    seconds = time.perf_counter() - begin
    assert status == 0, "record failed"
    found = json.loads(pathlib.Path("said.json").read_text())
    marked = {f["pass"] for f in found["findings"] if f["kind"] == {"out_of_window": "feed"}}
    print(f"{len(times)} passes, 4 logs of {count} rows, {size / 1e6:.0f} MB: {seconds:.1f} s, {used.ru_maxrss / 1024:.0f} MB at most")
    print(f"{len(marked & set(low.tolist()))} of {len(low)} faults found at their pass, {len(marked - set(low.tolist()))} marked elsewhere")
    for log in found["logs"]:
        print(f"  {log['name']:<14} drift {log['drift']:+.1f} millionths, {log['matched']} of {log['arcs']} arcs within {log['within']:.3f} s")


main()
