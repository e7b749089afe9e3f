#!/usr/bin/env python3
"""CPU seconds and peak memory of whole processes beside PrusaSlicer and CuraEngine, where these are installed.

Solid prints, same layers and line widths for all: perimeters as the case says, 100 % rectilinear inside. The peers run
twice: set to equal work (classic perimeters, no skins, no gap fill, no bridges: nothing that we are not asked for), and
with their other settings as they come. CPU is user and system time together, so other jobs on the machine hardly
matter; each figure is the median of RUNS by CPU. With --welder, weld beads are planned by us with the profile
cmt-al2319-kuka and compound paths, as a welder would: joints, checks and thin places with them.

With --plain, other parts: as large as weld beads need them, planned by us without any flag but the surface's meaning (the
built-in profile, one loop an island, judged, report and KRL program, also where the judgement refuses it), beside peers set to fill the same layers with beads
of the same width.

Debian: apt-get install prusa-slicer cura-engine cura   (cura holds the definitions, else $CURA_DEFINITIONS)
Usage: benches/peers.py [--runs 3] [--cases plate_holes,…] [--turn 0] [--settings equal,default] [--judged] [--welder]
                        [--plain] [--json FILE] [--binary target/release/beadwright]
"""
import argparse, concurrent.futures, gzip, json, math, os, pathlib, shutil, struct, subprocess, tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
MODELS = pathlib.Path(os.environ.get("BEADWRIGHT_MODELS", ROOT / "../shared/models"))
DEFINITIONS = pathlib.Path(os.environ.get("CURA_DEFINITIONS", "/usr/share/cura/resources/definitions"))
PROFILES = {
    (0.45, 0.2): ROOT / "crates/beadwright/benches/fdm-0.45x0.2.toml",
    (5.39, 2.0): ROOT / "crates/beadwright/benches/fdm-5.39x2.toml",
}
# Name, model, scale, (line width, layer height) in mm, perimeters.
CASES = [
    ("plate_holes", "plate_holes.stl", 1, (0.45, 0.2), 2),
    ("openthruster", "openthruster_prop_cw.stl", 1, (0.45, 0.2), 1),
    ("rear_case", "rear_case.stl", 1, (0.45, 0.2), 1),
    ("bunny_70k", "bunny_closed.stl", 1, (0.45, 0.2), 1),
    ("bunny_1.1M", "bunny_1114k.stl.gz", 1, (0.45, 0.2), 1),
    ("bunny_1.1M_5.39", "bunny_1114k.stl.gz", 1, (5.39, 2.0), 1),
    ("propeller_5.39", "bladex_propeller_zup.stl", 1, (5.39, 2.0), 1),
    ("openthruster_x3.66_5.39", "openthruster_prop_cw.stl", 3.66, (5.39, 2.0), 1),
]
# Width and height of the built-in profile's beads.
PLAIN_BEAD = (7.54, 2.0)
PLAIN = "plate_holes openthruster_prop_cw rear_case bunny_closed bunny_1114k.stl.gz bladex_propeller_zup featuretype " \
    "moon_chinese_header star_ascii pulley_t30 propeller_on_hub supportless_sample typhoon_prop_broken branches16 " \
    "spider_ascii iris_quad_duplicates".split()


def plain_cases(wanted):
    """The parts of --plain that are wanted."""
    for name in PLAIN:
        file, name = name if "." in name else f"{name}.stl", name.removesuffix(".stl.gz")
        if wanted and name not in wanted:
            continue
        # In another process, as below.
        with concurrent.futures.ProcessPoolExecutor(1) as other:
            scale = other.submit(plain_scale, file).result()
        yield name, file, scale, PLAIN_BEAD, 1


def plain_scale(file):
    """The scale that makes the middle side of a part 200 mm long."""
    corners = [corner for facet in facets(stl(file)) for corner in facet]
    return 200 / sorted(max(c[axis] for c in corners) - min(c[axis] for c in corners) for axis in range(3))[1]


def stl(name):
    """A model as a binary STL file."""
    data = (MODELS / name).read_bytes()
    data = gzip.decompress(data) if name.endswith(".gz") else data
    if len(data) == 84 + 50 * struct.unpack_from("<I", data, 80)[0]:
        return data
    numbers = [tuple(map(float, line.split()[1:4])) for line in data.decode(errors="replace").splitlines() if line.strip().startswith("vertex")]
    triangles = [struct.pack("<12fH", 0, 0, 0, *sum(numbers[k:k + 3], ()), 0) for k in range(0, len(numbers), 3)]
    return bytes(80) + struct.pack("<I", len(triangles)) + b"".join(triangles)


def facets(data):
    """The corners of the triangles of a binary STL file."""
    for facet in struct.iter_unpack("<12x9f2x", data[84:]):
        yield facet[:3], facet[3:6], facet[6:]


def model(name, scale, turn, work):
    """The model as a plain STL file of the wanted size, turned about z by that many degrees."""
    data = bytearray(stl(name))
    if scale != 1 or turn:
        c, s = scale * math.cos(math.radians(turn)), scale * math.sin(math.radians(turn))
        for at in range(84, len(data) - 49, 50):
            corners = struct.iter_unpack("<3f", data[at + 12:at + 48])
            turned = [v for x, y, z in corners for v in (c * x - s * y, s * x + c * y, scale * z)]
            struct.pack_into("<9f", data, at + 12, *turned)
    path = work / "model.stl"
    path.write_bytes(data)
    return path


def ours(binary, part, bead, perimeters, work, given):
    if given.plain:
        return [binary, "plan", part, "--units", "mm", "--surface", "solid", "--allow-findings", "-o", work / "ours"]
    if given.welder and bead[0] > 1:
        how = ["-p", "cmt-al2319-kuka", "-s", "compound", "--surface", "solid"]
    else:
        profile = PROFILES[bead].read_text().replace("perimeters = 1", f"perimeters = {perimeters}")
        (work / "profile.toml").write_text(profile)
        how = ["-p", work / "profile.toml"]
    judging = [] if given.judged else ["--no-deposit"]
    return [binary, "plan", part, *how, *judging, "--allow-findings", "-o", work / "ours"]


def prusa(part, bead, perimeters, work, equal):
    width, height = bead
    keys = "extrusion-width first-layer-extrusion-width perimeter-extrusion-width external-perimeter-extrusion-width " \
        "infill-extrusion-width solid-infill-extrusion-width top-infill-extrusion-width nozzle-diameter"
    widths = [arg for key in keys.split() for arg in (f"--{key}", str(width))]
    lean = ["--perimeter-generator", "classic", "--top-solid-layers", "0", "--bottom-solid-layers", "0",
            "--solid-infill-below-area", "0", "--no-thin-walls", "--no-gap-fill-enabled", "--resolution", "0"]
    first = height if equal else 2 * height
    return ["prusa-slicer", "--export-gcode", part, "-o", work / "prusa.gcode", "--layer-height", str(height),
            "--first-layer-height", str(first), *widths, "--filament-diameter", "1.75", "--perimeters", str(perimeters),
            "--fill-density", "100%", "--fill-pattern", "rectilinear", "--skirts", "0", *(lean if equal else []),
            "--bed-shape", "0x0,600x0,600x600,0x600", "--max-print-height", "600"]


def cura(part, bead, perimeters, work, equal):
    width, height = bead
    values = {key: width for key in "line_width wall_line_width wall_line_width_0 wall_line_width_x skin_line_width "
              "infill_line_width machine_nozzle_size".split()}
    values |= dict(machine_width=600, machine_depth=600, machine_height=600, center_object="true", mesh_position_x=0,
                   mesh_position_y=0, mesh_position_z=0, machine_center_is_zero="true", material_diameter=1.75,
                   layer_height=height, layer_height_0=height, initial_layer_line_width_factor=100,
                   wall_line_count=perimeters, wall_thickness=perimeters * width, adhesion_type="none",
                   skirt_line_count=0, roofing_layer_count=0, cool_min_layer_time=0, prime_blob_enable="false")
    if equal:
        values |= dict(bottom_layers=0, initial_bottom_layers=0, top_layers=0, infill_sparse_density=100,
                       infill_sparse_thickness=height, infill_line_distance=width, infill_pattern="lines",
                       zig_zaggify_infill="false", infill_overlap=0, infill_overlap_mm=0, infill_wipe_dist=0,
                       wall_0_wipe_dist=0, wall_0_inset=0, skin_edge_support_layers=0, fill_perimeter_gaps="nowhere",
                       fill_outline_gaps="false", brim_line_count=0, support_enable="false", retraction_combing="off",
                       slicing_tolerance="middle")
    else:
        values |= dict(bottom_layers=99999, initial_bottom_layers=99999, top_layers=0, top_bottom_pattern="zigzag",
                       top_bottom_pattern_0="zigzag", skin_outline_count=0, infill_line_distance=0)
    settings = [arg for key, value in values.items() for arg in ("-s", f"{key}={value}")]
    return ["CuraEngine", "slice", "-j", DEFINITIONS / "fdmprinter.def.json", *settings, "-e0", "-s",
            "material_diameter=1.75", "-l", part, "-o", work / "cura.gcode"]


def measured(command, runs):
    """CPU s and peak MB: the median of some runs by CPU."""
    figures = []
    for _ in range(runs):
        process = subprocess.Popen([str(c) for c in command], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        _, status, used = os.wait4(process.pid, 0)
        if status:
            return None
        figures.append((used.ru_utime + used.ru_stime, used.ru_maxrss / 1024))
    cpu, peak = sorted(figures)[len(figures) // 2]
    return {"cpu_s": round(cpu, 3), "peak_mb": round(peak, 1)}


def version(command):
    """What a program calls itself."""
    done = subprocess.run(command, capture_output=True, text=True)
    return next((line for line in (done.stdout + done.stderr).splitlines() if any(c.isdigit() for c in line)), "")


def mean_ratio(rows, peer, key):
    """Geometric mean of a peer's figure over ours."""
    ratios = [row[peer][key] / row["beadwright"][key] for row in rows if row.get(peer) and row.get("beadwright")]
    return math.exp(sum(map(math.log, ratios)) / len(ratios)) if ratios else None


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--runs", type=int, default=3)
    arguments.add_argument("--cases", default="")
    arguments.add_argument("--turn", type=float, default=0, help="turns the parts about z, degrees")
    arguments.add_argument("--json", type=pathlib.Path)
    arguments.add_argument("--binary", type=pathlib.Path)
    arguments.add_argument("--settings", default="equal,default", help="of the peers")
    arguments.add_argument("--welder", action="store_true", help="weld beads planned as a welder would")
    arguments.add_argument("--plain", action="store_true", help="our plans without flags, of parts of a welder's size")
    arguments.add_argument("--judged", action="store_true", help="our plans with the deposit model on, as by default")
    arguments.add_argument("--alone", action="store_true", help="leave the peers out")
    given = arguments.parse_args()
    if given.plain and (given.welder or given.judged):
        arguments.error("--plain plans without flags: leave --welder and --judged out")
    if not given.binary:
        subprocess.run(["cargo", "build", "--release", "--quiet", "-p", "beadwright-cli"], cwd=ROOT, check=True)
    target = pathlib.Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
    binary = given.binary or target / "release/beadwright"
    peers = {}
    for setting in ([] if given.alone else given.settings.split(",")):
        for name, of, command in (("PrusaSlicer", prusa, "prusa-slicer"), ("CuraEngine", cura, "CuraEngine")):
            if shutil.which(command):
                peers[f"{name}, {setting}"] = lambda *case, of=of, equal=setting == "equal": of(*case, equal)
    rows = []
    print(f"{'case':<26}" + "".join(f"{name:>22}" for name in [*peers, "beadwright"]) + "   (CPU s, peak MB)")
    wanted = given.cases.split(",") if given.cases else []
    cases = plain_cases(wanted) if given.plain else [case for case in CASES if not wanted or case[0] in wanted]
    for name, file, scale, bead, perimeters in cases:
        with tempfile.TemporaryDirectory() as folder, concurrent.futures.ProcessPoolExecutor(1) as other:
            work = pathlib.Path(folder)
            # In another process: the memory of this one counts as that of what it starts.
            part = other.submit(model, file, scale, given.turn, work).result()
            row = {"case": name} | {peer: measured(of(part, bead, perimeters, work), given.runs) for peer, of in peers.items()}
            row["beadwright"] = measured(ours(binary, part, bead, perimeters, work, given), given.runs)
        rows.append(row)
        cells = [row[who] for who in [*peers, "beadwright"]]
        print(f"{name:<26}" + "".join(f"{c['cpu_s']:>14.2f}{c['peak_mb']:>8.0f}" if c else f"{'refused':>22}" for c in cells), flush=True)
    means = {peer: {key: mean_ratio(rows, peer, key) for key in ("cpu_s", "peak_mb")} for peer in peers}
    for peer, mean in means.items():
        if mean["cpu_s"]:
            print(f"{peer}: {mean['cpu_s']:.2f} × our CPU, {mean['peak_mb']:.2f} × our memory (geometric mean)")
    if given.json:
        table = {"runs": given.runs, "beadwright": version([str(binary), "--version"]), "rows": rows, "means": means}
        given.json.write_text(json.dumps(table, indent=1) + "\n")


if __name__ == "__main__":
    main()
