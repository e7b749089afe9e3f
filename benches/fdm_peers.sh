#!/usr/bin/env bash
# Travel, time and volume of solid prints beside PrusaSlicer (Debian: prusa-slicer) and CuraEngine (Debian:
# cura-engine, with the definitions of the package cura in $CURA_DEFINITIONS): 0.2 mm layers, 0.4 mm lines, one
# perimeter, 100 % rectilinear (zigzag for CuraEngine, its shortest). All three programs are read back and timed by
# `beadwright simulate` with the acceleration of the profile fdm-abs-0.4; travel counts every move without extrusion.
# Usage: benches/fdm_peers.sh [MODEL…]   (files of $BEADWRIGHT_MODELS)
set -euo pipefail
cd "$(dirname "$0")/.."
models=${BEADWRIGHT_MODELS:-../shared/models}
definitions=${CURA_DEFINITIONS:-/usr/share/cura/resources/definitions}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cargo build --release --quiet
bw=target/release/beadwright
[ $# -gt 0 ] || set -- plate_holes.stl openthruster_prop_cw.stl rear_case.stl body_structure_top.stl pulley_t30.stl

# Layers, travel m, time min, volume cm³ of a program.
row() {
    $bw simulate "$2" --profile fdm-abs-0.4 --json -o "$work/page.html" > "$work/row.json"
    python3 - "$1" "$work/row.json" <<'PY'
import json, sys
t = json.load(open(sys.argv[2]))["totals"]
print(f"  {sys.argv[1]:<14} starts {t['arc_starts']:7d}  travel {t['travel_length_mm']/1e3:9.2f} m  time {t['total_time_s']/60:8.1f} min  volume {t['metal_volume_mm3']/1e3:9.3f} cm³")
PY
}

for model in "$@"; do
    echo "$model"
    $bw plan "$models/$model" --profile fdm-abs-0.4 --set marlin.bed.size=[600,600,600] --no-deposit --json -o "$work/ours" > "$work/plan.json"
    python3 -c "import json; print(f\"  part           {json.load(open('$work/plan.json'))['part_volume_mm3']/1e3:62.3f} cm³\")"
    row beadwright "$work/ours/${model%.stl}.gcode"
    prusa-slicer --export-gcode "$models/$model" -o "$work/prusa.gcode" --layer-height 0.2 --first-layer-height 0.2 \
        --nozzle-diameter 0.4 --filament-diameter 1.75 --extrusion-width 0.4 --first-layer-extrusion-width 0.4 \
        --perimeter-extrusion-width 0.4 --external-perimeter-extrusion-width 0.4 --infill-extrusion-width 0.4 \
        --solid-infill-extrusion-width 0.4 --top-infill-extrusion-width 0.4 --perimeters 1 --fill-density 100% \
        --fill-pattern rectilinear --skirts 0 --perimeter-speed 120 --external-perimeter-speed 120 \
        --small-perimeter-speed 120 --infill-speed 120 --solid-infill-speed 120 --top-solid-infill-speed 120 \
        --first-layer-speed 120 --travel-speed 160 --gap-fill-speed 120 --bridge-speed 120 \
        --bed-shape 0x0,500x0,500x500,0x500 > /dev/null 2>&1 && row PrusaSlicer "$work/prusa.gcode" || echo "  PrusaSlicer    refused"
    widths=""
    for key in line_width wall_line_width wall_line_width_0 wall_line_width_x skin_line_width infill_line_width initial_layer_line_width_factor; do
        [ $key = initial_layer_line_width_factor ] && value=100 || value=0.4
        widths="$widths -s $key=$value"
    done
    speeds=""
    for key in speed_print speed_wall speed_wall_0 speed_wall_x speed_infill speed_topbottom speed_layer_0 speed_print_layer_0 speed_roofing; do
        speeds="$speeds -s $key=120"
    done
    CuraEngine slice -j "$definitions/fdmprinter.def.json" -s machine_width=600 -s machine_depth=600 -s machine_height=600 \
        -s center_object=true -s mesh_position_x=0 -s mesh_position_y=0 -s mesh_position_z=0 -s machine_center_is_zero=true \
        -s material_diameter=1.75 -s machine_nozzle_size=0.4 -s layer_height=0.2 -s layer_height_0=0.2 $widths $speeds \
        -s speed_travel=160 -s speed_travel_layer_0=160 -s wall_line_count=1 -s wall_thickness=0.4 -s bottom_layers=99999 -s initial_bottom_layers=99999 -s top_layers=0 \
        -s top_bottom_pattern=zigzag -s top_bottom_pattern_0=zigzag -s skin_outline_count=0 -s infill_line_distance=0 \
        -s adhesion_type=none -s skirt_line_count=0 -s roofing_layer_count=0 -s cool_min_layer_time=0 -s cool_min_speed=120 -s prime_blob_enable=false -e0 -s material_diameter=1.75 \
        -l "$models/$model" -o "$work/cura.gcode" > "$work/cura.log" 2>&1 && row CuraEngine "$work/cura.gcode" || echo "  CuraEngine     refused"
done
