#!/usr/bin/env bash
# Makes docs/pictures/*.png with the real desktop program on a virtual screen: docs/pictures.sh [NAME…]
# Takes target/release/beadwright-studio (or STUDIO=FILE) and builds it where it is missing. Installs nothing.
set -euo pipefail
cd "$(dirname "$0")/.."

missing=()
command -v Xvfb > /dev/null || missing+=(xvfb)
command -v import > /dev/null && command -v convert > /dev/null || missing+=(imagemagick)
command -v xdotool > /dev/null || missing+=(xdotool)
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
Xvfb -displayfd 3 -screen 0 2800x1800x24 -nolisten tcp -noreset 3> "$work/display" 2> /dev/null &
screen=$!
for _ in $(seq 50); do [ -s "$work/display" ] && break; sleep 0.1; done
[ -s "$work/display" ] || { echo "Xvfb does not start" >&2; exit 1; }
DISPLAY=:$(cat "$work/display")
export DISPLAY

# Time on the processor that the window has taken, in ticks.
ticks() { awk '{ print $14 + $15 }' "/proc/$window/stat" 2> /dev/null || echo gone; }

take() { import -silent -window root -crop "$size+0+0" +repage "$1"; }

# Waits until the window rests: twice in a row it was shown as before, and took no more than a tenth of the time between.
rest() {
    local limit=$((SECONDS + ${LIMIT:-300})) before='' now='' still=0
    while [ $still -lt 2 ]; do
        before=$(ticks) && sleep 2 && now=$(ticks)
        [ "$now" != gone ] || { echo "$1: the program ended: $(cat "$work/said")" >&2; exit 1; }
        [ $SECONDS -lt $limit ] || { echo "$1: does not come to rest" >&2; exit 1; }
        take "$work/now.ppm"
        if [ $((now - before)) -gt 20 ] || cmp -s "$work/now.ppm" "$work/empty.ppm" \
            || ! cmp -s "$work/now.ppm" "$work/last.ppm"; then
            still=0
        else
            still=$((still + 1))
        fi
        mv "$work/now.ppm" "$work/last.ppm"
    done
}

# picture NAME SETTINGS ARGUMENTS…: takes the window when it rests; in CROP a part of it, in PRESS a place that is clicked first.
picture() {
    local name=$1 settings=$2 store=$work/store
    shift 2
    [ ${#wanted[@]} -eq 0 ] || [[ " ${wanted[*]} " == *" $name "* ]] || return 0
    rm -rf "$store" && mkdir "$store" && printf '%s\n' "$settings" > "$store/settings.toml"
    take "$work/empty.ppm"
    "$studio" --store "$store" "$@" 2> "$work/said" &
    window=$!
    rest "$name"
    if [ -n "${PRESS:-}" ]; then
        # Frames are slow here: the button is held for longer than one, but a press of 0.8 s is no click.
        # shellcheck disable=SC2086
        xdotool mousemove $PRESS sleep 1 mousedown 1 sleep 0.4 mouseup 1 sleep 1 mousemove 1400 900
        sleep 2
        rest "$name"
    fi
    kill "$window" && wait "$window" 2> /dev/null || true
    window=''
    convert "$work/last.ppm" ${CROP:+-crop "$CROP" +repage} -strip +dither -colors "${COLOURS:-200}" \
        -define png:compression-level=9 "png8:docs/pictures/$name.png"
    echo "docs/pictures/$name.png, $(($(stat -c %s "docs/pictures/$name.png") / 1024)) KiB"
}

wanted=("$@")
picture start ''
# The first picture of the README: the 3-D view alone.
CROP=634x520+308+128 picture beads '' propeller --set fill.strategy=compound
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
# The button that tries a remedy is pressed.
PRESS='1095 204' picture trial '' star --view layer --heights --layer 1 --panel findings --set fill.strategy=zigzag \
    --set process.deposition_speed=12
picture plots '' vase --panel plots
picture program '' propeller --panel program --layer 4
picture bent '' cross --bent
picture chinese 'language = "zh"' star --panel findings --set fill.strategy=zigzag --set process.deposition_speed=12
picture light 'light = true' cross --set fill.strategy=zigzag
