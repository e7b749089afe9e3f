#!/bin/sh
# Runs our programs with LinuxCNC's own interpreter, rs274, and compares lengths, travel and times with the plan; and programs for
# tilting tables with its own kinematics too: where its joints bring the torch's tip on the part.
# On Debian both are taken from its package without installing it; elsewhere, or where it is installed, give the paths of the
# interpreter and of the folder with its modules:
# BEADWRIGHT_RS274=/usr/bin/rs274 BEADWRIGHT_LINUXCNC_MODULES=/usr/lib/linuxcnc/modules benches/linuxcnc.sh
set -eu
cd "$(dirname "$0")/.."
folder="${TMPDIR:-/tmp}/beadwright-linuxcnc"
mkdir -p "$folder"
if [ -z "${BEADWRIGHT_RS274:-}" ]; then
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
    BEADWRIGHT_LINUXCNC_MODULES="$folder/root/usr/lib/linuxcnc/modules"
fi
cargo test -p beadwright --test it -- --ignored --nocapture cnc::linuxcnc
if [ -n "${BEADWRIGHT_LINUXCNC_MODULES:-}" ]; then
    cc -O1 -rdynamic -o "$folder/kinematics" benches/linuxcnc-kinematics.c -ldl -lm
    export BEADWRIGHT_LINUXCNC_KINEMATICS="$folder/kinematics:$BEADWRIGHT_LINUXCNC_MODULES"
    cargo test -p beadwright --test it -- --ignored --nocapture the_joints_of_linuxcnc
fi
# The lines that end the arc run only where LinuxCNC is installed; halrun does not run for root.
BEADWRIGHT_HALRUN="${BEADWRIGHT_HALRUN:-$(command -v halrun || true)}"
if [ -n "$BEADWRIGHT_HALRUN" ]; then
    export BEADWRIGHT_HALRUN
    cargo test -p beadwright --test it -- --ignored --nocapture cnc::hal_ends
else
    echo "halrun is not installed, so examples/cells/linuxcnc-arc.hal was not run."
fi
