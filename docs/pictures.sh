#!/usr/bin/env bash
# Makes docs/pictures/*.png with the real desktop program on a virtual screen: docs/pictures.sh [NAME…]
# Takes target/release/beadwright-studio (or STUDIO=FILE) and builds it where it is missing. Installs nothing.
set -euo pipefail
cd "$(dirname "$0")/.."

missing=()
command -v Xvfb > /dev/null || missing+=(xvfb)
command -v import > /dev/null && command -v convert > /dev/null || missing+=(imagemagick)
[ -n "$(fc-list :lang=zh-cn 2> /dev/null)" ] || missing+=(fonts-wqy-microhei fontconfig)
compgen -G '/usr/share/vulkan/icd.d/*.json' > /dev/null || missing+=(mesa-vulkan-drivers libvulkan1)
libraries='libX11.so.6=libx11-6 libX11-xcb.so.1=libx11-xcb1 libXcursor.so.1=libxcursor1 libXi.so.6=libxi6
    libxkbcommon.so.0=libxkbcommon0 libxkbcommon-x11.so.0=libxkbcommon-x11-0'
known=$(ldconfig -p)
for library in $libraries; do
    [[ $known == *"${library%=*}"* ]] || missing+=("${library#*=}")
done
if [ ${#missing[@]} -gt 0 ]; then
    echo "missing: apt-get install --no-install-recommends ${missing[*]}" >&2
    exit 1
fi

studio=${STUDIO:-${CARGO_TARGET_DIR:-target}/release/beadwright-studio}
[ -x "$studio" ] || cargo build --release --locked -p beadwright-studio

work=$(mktemp -d)
screen='' window=''
finish() {
    for process in $window $screen; do kill "$process" 2> /dev/null || true; done
    rm -rf "$work"
}
trap finish EXIT
mkdir -m 700 "$work/run"
export XDG_RUNTIME_DIR=$work/run WGPU_BACKEND=${WGPU_BACKEND:-vulkan}
unset WAYLAND_DISPLAY

# The pointer begins in the middle of the screen: beyond the window, which lies at the upper left.
size=1280x800
Xvfb -displayfd 3 -screen 0 2800x1800x24 -nolisten tcp 3> "$work/display" 2> /dev/null &
screen=$!
for _ in $(seq 50); do [ -s "$work/display" ] && break; sleep 0.1; done
[ -s "$work/display" ] || { echo "Xvfb does not start" >&2; exit 1; }
DISPLAY=:$(cat "$work/display")
export DISPLAY

# Time on the processor that the window has taken, in ticks.
ticks() { awk '{ print $14 + $15 }' "/proc/$window/stat" 2> /dev/null || echo gone; }

take() { import -silent -window root -crop "$size+0+0" +repage "$1"; }

# picture NAME SETTINGS ARGUMENTS…: waits until the window rests, then takes it.
picture() {
    local name=$1 settings=$2 store=$work/store limit=$((SECONDS + ${LIMIT:-180})) before='' now='' still=0
    shift 2
    [ ${#wanted[@]} -eq 0 ] || [[ " ${wanted[*]} " == *" $name "* ]] || return 0
    rm -rf "$store" && mkdir "$store" && printf '%s\n' "$settings" > "$store/settings.toml"
    take "$work/empty.ppm"
    "$studio" --store "$store" "$@" 2> "$work/said" &
    window=$!
    # It rests when twice in a row it was shown as before, and took no more than a tenth of the time between.
    while [ $still -lt 2 ]; do
        before=$(ticks) && sleep 2 && now=$(ticks)
        [ "$now" != gone ] || { echo "$name: the program ended: $(cat "$work/said")" >&2; exit 1; }
        [ $SECONDS -lt $limit ] || { echo "$name: does not come to rest" >&2; exit 1; }
        take "$work/now.ppm"
        if [ $((now - before)) -gt 20 ] || cmp -s "$work/now.ppm" "$work/empty.ppm" \
            || ! cmp -s "$work/now.ppm" "$work/last.ppm"; then
            still=0
        else
            still=$((still + 1))
        fi
        mv "$work/now.ppm" "$work/last.ppm"
    done
    kill "$window" && wait "$window" 2> /dev/null || true
    window=''
    convert "$work/last.ppm" -strip +dither -colors "${COLOURS:-200}" -define png:compression-level=9 \
        "png8:docs/pictures/$name.png"
    echo "docs/pictures/$name.png, $(($(stat -c %s "docs/pictures/$name.png") / 1024)) KiB"
}

wanted=("$@")
picture start ''
picture main '' propeller --set fill.strategy=hybrid
picture layer '' propeller --view layer --heights --layer 4 --set fill.strategy=contour
picture compare '' propeller --view compare --set fill.strategy=contour --compare-with hybrid --heights --layer 4
picture compare-solid '' gear --view compare --solid --set fill.strategy=zigzag --compare-with contour
picture steps '' propeller --view compare --steps --compare-with hybrid --layer 4
picture place '' gear --place --set fill.strategy=hybrid
picture section '' gear --section y --set fill.strategy=hybrid
picture robot '' propeller --robot
# A scan made up: the cross's upper face sags at one end and is too high at the other.
awk 'BEGIN { for (x = -49; x <= 49; x += 0.5) for (y = -49; y <= 49; y += 0.5) if ((x < 0 ? -x : x) < 17 || (y < 0 ? -y : y) < 17)
    print x "," y "," 20 + 0.6 * sin(x / 30) + 0.2 * cos(y / 4) }' > "$work/scan.csv"
picture scan '' cross --scan "$work/scan.csv"
picture findings '' star --view layer --heights --layer 1 --panel findings --set fill.strategy=zigzag \
    --set process.deposition_speed=12
picture plots '' vase --panel plots
picture chinese 'language = "zh"' gear --set fill.strategy=hybrid
picture light 'light = true' cross --set fill.strategy=zigzag
