#!/usr/bin/env python3
"""How CPU time and memory grow when one thing about a part doubles: triangles, layers, islands a layer, vertices of an
outline, holes. Prints seconds (user and system) and peak MB for each size and, over the upper half of the sizes, the
exponent of the growth in time (1 is proportional). Parts are made here; nothing is downloaded.

Usage: benches/doubling.py [--only islands,holes] [--scale 1.0] [--huge] [--json FILE] [--binary FILE]
--huge plans a part of 20 million triangles (1 GB of STL) and one of 100,000 layers.
"""
import argparse, array, json, math, os, pathlib, subprocess, tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
PROFILE = ROOT / "crates/beadwright/benches/fdm-5.39x2.toml"
FINE = ROOT / "crates/beadwright/benches/fdm-0.45x0.2.toml"


def triangles_of_prism(ring, height, cap):
    """A prism over a ring; `cap` lists triangles (indices) of its floor, counter-clockwise."""
    for i, a in enumerate(ring):
        b = ring[(i + 1) % len(ring)]
        yield (*a, 0), (*b, 0), (*b, height)
        yield (*a, 0), (*b, height), (*a, height)
    for i, j, k in cap:
        yield (*ring[i], height), (*ring[j], height), (*ring[k], height)
        yield (*ring[i], 0), (*ring[k], 0), (*ring[j], 0)


def circle(x, y, radius, count, waves=0):
    def at(k):
        angle = 2 * math.pi * k / count
        r = radius * (1 + 0.1 * math.cos(waves * angle))
        return x + r * math.cos(angle), y + r * math.sin(angle)
    return [at(k) for k in range(count)]


def fan(count):
    return [(0, k, k + 1) for k in range(1, count - 1)]


def disc(count, height=6.0):
    """One round island whose outline has many vertices, waved so that none of them lies on a line."""
    ring = circle(0, 0, 150, count, waves=8)
    return triangles_of_prism(ring, height, fan(count))


def tower(layers):
    return triangles_of_prism(circle(0, 0, 25, 32), 2.0 * layers, fan(32))


def thread(layers):
    """As high as coordinates reach: 20 m are 100,000 layers of 0.2 mm."""
    return triangles_of_prism(circle(0, 0, 2, 16), 0.2 * layers, fan(16))


def islands(count):
    side = math.ceil(math.sqrt(count))
    for k in range(count):
        yield from triangles_of_prism(circle(30 * (k % side), 30 * (k // side), 12, 24), 6.0, fan(24))


def holes(count):
    """Tiles of a plate, each with a square hole; neighbours share their outer corners."""
    side, pitch, half, height = math.ceil(math.sqrt(count)), 40.0, 8.0, 6.0
    for k in range(side * side):
        x, y = pitch * (k % side), pitch * (k // side)
        outer = [(x, y), (x + pitch, y), (x + pitch, y + pitch), (x, y + pitch)]
        middle = (x + pitch / 2, y + pitch / 2)
        inner = [(middle[0] + dx * half, middle[1] + dy * half) for dx, dy in [(-1, -1), (1, -1), (1, 1), (-1, 1)]]
        if k >= count:
            inner = None
        for i in range(4):
            j = (i + 1) % 4
            a, b = outer[i], outer[j]
            if inner:
                c, d = inner[j], inner[i]
                for p, q, r in [(a, b, c), (a, c, d)]:
                    yield (*p, height), (*q, height), (*r, height)
                    yield (*p, 0), (*r, 0), (*q, 0)
                yield (*c, 0), (*d, 0), (*d, height)
                yield (*c, 0), (*d, height), (*c, height)
            else:
                yield (*a, height), (*b, height), (*middle, height)
                yield (*a, 0), (*middle, 0), (*b, 0)
            edge = [k // side == 0, k % side == side - 1, k // side == side - 1, k % side == 0][i]
            if edge:
                yield (*a, 0), (*b, 0), (*b, height)
                yield (*a, 0), (*b, height), (*a, height)


def ball(count, radius=40.0):
    """A ball of about `count` triangles on a grid of latitudes and longitudes."""
    rows = max(4, round(math.sqrt(count / 4)))
    columns = 2 * rows

    def ring(i):
        polar = math.pi * i / rows
        z, r = radius - radius * math.cos(polar), radius * math.sin(polar)
        return [(r * math.cos(2 * math.pi * j / columns), r * math.sin(2 * math.pi * j / columns), z) for j in range(columns)]
    below = ring(0)
    for i in range(rows):
        above = ring(i + 1) if i + 1 < rows else [(0.0, 0.0, 2 * radius)] * columns
        below = [(0.0, 0.0, 0.0)] * columns if i == 0 else below
        for j in range(columns):
            k = (j + 1) % columns
            if i > 0:
                yield below[j], below[k], above[k]
            if i + 1 < rows:
                yield below[j], above[k], above[j]
        below = above


def write(triangles, path):
    """A binary STL file, in pieces: the largest parts would not fit otherwise."""
    with open(path, "wb") as file:
        file.write(bytes(84))
        count, part = 0, bytearray()
        for a, b, c in triangles:
            part += bytes(12) + array.array("f", (*a, *b, *c)).tobytes() + b"\0\0"
            count += 1
            if len(part) > 1 << 24:
                file.write(part)
                part.clear()
        file.write(part)
        file.seek(80)
        file.write(count.to_bytes(4, "little"))
    return count


SERIES = {
    "triangles": (ball, [25_000, 50_000, 100_000, 200_000, 400_000, 800_000]),
    "layers": (tower, [500, 1_000, 2_000, 4_000, 8_000]),
    "islands": (islands, [125, 250, 500, 1_000, 2_000]),
    "vertices": (disc, [3_200, 6_400, 12_800, 25_600, 51_200, 102_400]),
    "holes": (holes, [125, 250, 500, 1_000, 2_000]),
}
HUGE = {"20 million triangles": (ball, [20_000_000]), "100 thousand layers": (thread, [99_900])}


def measured(binary, part, profile, work):
    command = [binary, "plan", part, "-p", profile, "--no-deposit", "--allow-findings", "-o", work / "out"]
    process = subprocess.Popen([str(c) for c in command], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, used = os.wait4(process.pid, 0)
    return None if status else (used.ru_utime + used.ru_stime, used.ru_maxrss / 1024)


def exponent(sizes, values):
    """Slope of the least squares line through the logarithms of the upper half."""
    points = [(math.log(s), math.log(v)) for s, v in zip(sizes, values)][len(sizes) // 2 - 1:]
    mx, my = (sum(p[i] for p in points) / len(points) for i in (0, 1))
    return sum((x - mx) * (y - my) for x, y in points) / sum((x - mx) ** 2 for x, _ in points)


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--only", default="")
    arguments.add_argument("--scale", type=float, default=1.0, help="all sizes times this")
    arguments.add_argument("--huge", action="store_true")
    arguments.add_argument("--json", type=pathlib.Path)
    target = pathlib.Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
    arguments.add_argument("--binary", type=pathlib.Path, default=target / "release/beadwright")
    given = arguments.parse_args()
    table = {}
    for name, (make, sizes) in (HUGE if given.huge else SERIES).items():
        if given.only and name not in given.only.split(","):
            continue
        rows = []
        for size in (max(4, round(given.scale * s)) for s in sizes):
            with tempfile.TemporaryDirectory() as folder:
                part = pathlib.Path(folder) / "part.stl"
                write(make(size), part)
                found = measured(given.binary, part, FINE if make is thread else PROFILE, pathlib.Path(folder))
            figures = f"{found[0]:9.2f} s {found[1]:7.0f} MB" if found else "  refused"
            print(f"{name:<22}{size:>12,}{figures}", flush=True)
            rows += [(size, *found)] if found else []
        table[name] = {"rows": [dict(zip(("size", "cpu_s", "peak_mb"), row)) for row in rows]}
        if len(rows) > 2:
            table[name]["exponent"] = round(exponent([r[0] for r in rows], [r[1] for r in rows]), 3)
            print(f"{name:<22}time grows with the power {table[name]['exponent']:.2f}", flush=True)
    if given.json:
        given.json.write_text(json.dumps(table, indent=1) + "\n")


if __name__ == "__main__":
    main()
