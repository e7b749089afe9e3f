#!/bin/sh
# Runs our programs with LinuxCNC's own interpreter, rs274, and compares lengths, travel and times with the plan.
# On Debian the interpreter is taken from its package without installing it; elsewhere, or where it is installed, give its
# path: BEADWRIGHT_RS274=/usr/bin/rs274 benches/linuxcnc.sh
set -eu
cd "$(dirname "$0")/.."
if [ -z "${BEADWRIGHT_RS274:-}" ]; then
    folder="${TMPDIR:-/tmp}/beadwright-linuxcnc"
    mkdir -p "$folder"
    if [ ! -x "$folder/root/usr/bin/rs274" ]; then
        python="libpython$(apt-cache depends linuxcnc-uspace | sed -n 's/.*libpython\([0-9.]*\).*/\1/p' | head -n 1)"
        boost="$(apt-cache depends linuxcnc-uspace | sed -n 's/.*\(libboost-python[0-9.]*\).*/\1/p' | head -n 1)"
        (cd "$folder" && apt-get download linuxcnc-uspace "$boost" "$python" "$python-minimal" "$python-stdlib")
        for package in "$folder"/*.deb; do
            dpkg -x "$package" "$folder/root"
        done
    fi
    libraries="$folder/root/usr/lib:$(echo "$folder"/root/usr/lib/*-linux-gnu)"
    printf '#!/bin/sh\nLD_LIBRARY_PATH=%s exec %s "$@"\n' "$libraries" "$folder/root/usr/bin/rs274" > "$folder/rs274"
    chmod +x "$folder/rs274"
    BEADWRIGHT_RS274="$folder/rs274"
    export BEADWRIGHT_RS274
fi
cargo test -p beadwright --test it -- --ignored --nocapture cnc::linuxcnc
# The lines that end the arc run only where LinuxCNC is installed; halrun does not run for root.
BEADWRIGHT_HALRUN="${BEADWRIGHT_HALRUN:-$(command -v halrun || true)}"
if [ -n "$BEADWRIGHT_HALRUN" ]; then
    export BEADWRIGHT_HALRUN
    cargo test -p beadwright --test it -- --ignored --nocapture cnc::hal_ends
else
    echo "halrun is not installed, so examples/cells/linuxcnc-arc.hal was not run."
fi
