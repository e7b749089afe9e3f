#!/usr/bin/env bash
# Makes the gallery: pictures in docs/pictures/gallery and the page docs/book/gallery.md, with commands and figures.
# Takes target/release/beadwright (or BEADWRIGHT=FILE) and builds it where it is missing.
set -euo pipefail
cd "$(dirname "$0")/.."
beadwright=${BEADWRIGHT:-${CARGO_TARGET_DIR:-target}/release/beadwright}
[ -x "$beadwright" ] || cargo build --release --locked -p beadwright-cli
beadwright=$(realpath "$beadwright")
pictures=$PWD/docs/pictures/gallery
page=$PWD/docs/book/gallery.md
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$pictures"
cd "$work"

cat > "$page" <<'END'
# Gallery

Twelve parts as this version plans them. `beadwright example` makes the models, so every picture can be remade with the
command above it; `docs/gallery.sh` makes them all. Contours are blue, lines of infill orange, fills of pockets green, walls
purple; a dot is cyan where the arc starts and red where it ends.

The first picture opens its live report, [`propeller/report.html`](propeller/report.html), which `docs/book/build` puts into the
built book: every layer, and all beads in 3-D.
END

# Runs the plan's command and shows it with its figures: picture NAME TITLE EXAMPLES LAYER ARGUMENTS…
picture() {
    local name=$1 title=$2 examples=$3 layer=$4 example
    shift 4
    { printf '\n## %s\n\n```sh\n' "$title"
      for example in $examples; do
          local file=${example%%=*} ending=${example#*=}
          [ "$ending" != "$example" ] || ending=stl
          echo "beadwright example $file -o $file.$ending"
          "$beadwright" example "$file" -o "$file.$ending" > /dev/null
      done
      echo "beadwright plan $* --picture $layer -o $name"
      printf '```\n\n'
    } >> "$page"
    "$beadwright" plan "$@" --picture "$layer" -o "$name" > said
    local shown="![Layer $layer: $title](../pictures/gallery/$name.svg)"
    # As HTML with a width: mdBook shows a picture in a link in its own size, and these have none.
    [ "$name" != propeller ] \
        || shown="<a href=\"propeller/report.html\"><img width=\"750\" src=\"../pictures/gallery/$name.svg\" alt=\"Layer $layer: $title\"></a>"
    {   echo '```text'
        echo '…'
        sed -n '/^profile /p' said
        echo '…'
        sed -n '/^  passes/p' said
        echo '…'
        sed -n '/^  total time/p' said
        echo '…'
        sed -n '/^  void/,/^  overfill/p' said
        echo '…'
        printf '```\n\n'
        echo "$shown"
    } >> "$page"
    cp "$name/layer-$(printf %03d "$layer").svg" "$pictures/$name.svg"
    echo "$name: $(($(wc -c < "$pictures/$name.svg") / 1024)) KiB"
}

picture propeller 'A propeller in one loop a layer' propeller 5 propeller.stl
picture gear-hybrid 'A gear, its pockets filled along their middle' gear 5 gear.stl -s hybrid
picture star-spiral 'A star in one spiral' star 5 star.stl -s spiral
picture plate-zigzag 'A plate with holes, in lines' plate 3 plate.stl -p plasma-304-cnc -s zigzag
picture cross-compound 'A cross: lines inside, a contour outside' cross 5 cross.stl -p plasma-304-cnc -s compound
picture gear-mat 'A gear from its middle outwards' gear 5 gear.stl -s mat
picture plate-contour 'A plate in rings' plate 3 plate.stl -p cmt-steel-abb -s contour
picture star-hilbert 'A star in a curve of Hilbert' star 5 star.stl -s hilbert
picture vase 'A vase, one loop a layer' vase 10 vase.stl -p cmt-steel-abb
picture pot 'A pot from two lines, square below and round above' pot=igs 20 pot.igs -p cmt-steel-abb
picture tian 'A frame of walls in the fewest paths' tian=igs 5 tian.igs -p cmt-steel-abb --height 26
picture together 'Three parts in one build' 'cross gear star' 5 cross.stl --with gear.stl --with star.stl -s fermat
total=$(du -cb "$pictures"/*.svg | tail -1 | cut -f1)
[ "$total" -lt 1600000 ] || { echo "the pictures are too large: $total bytes, at most 1600000" >&2; exit 1; }
