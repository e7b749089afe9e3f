//! The colours of everything that is drawn: pages, drawings, scenes and the studio take them from here, so that a kind of pass, a
//! void or a temperature looks the same wherever it is seen. People without red, green or blue cones can tell them apart, too
//! (`tests/it/palette.rs`).

use crate::pass::PassKind;

/// Red, green, blue, 0 to 255, as on the screen (sRGB).
pub type Rgb = [u8; 3];

/// The kinds of passes, in the order of their colours; dots look like walls.
pub const KINDS: [PassKind; 4] = [PassKind::Contour, PassKind::Infill, PassKind::Skeleton, PassKind::Wall];

/// Where passes start.
pub const START: Rgb = [40, 190, 200];
/// Where passes end.
pub const END: Rgb = [222, 62, 54];
/// A place that stays empty, or lies in the air.
pub const VOID: Rgb = [232, 0, 150];
/// What is chosen.
pub const CHOSEN: Rgb = [255, 51, 143];
/// Time that passes while the torch waits.
pub const WAIT: Rgb = [217, 119, 6];
/// What a step of a strategy found, over the beads of it.
pub const STEP: Rgb = [224, 60, 156];
/// Where a step joined two rings, over [`STEP`].
pub const FLIP: Rgb = [242, 208, 44];

/// The slice below what is drawn on it, on white.
pub const SLICE: Rgb = [238, 240, 243];

/// The axes x, y and z, and what moves or turns the part along them.
pub const AXES: [Rgb; 3] = [[224, 82, 76], [92, 178, 92], [84, 140, 232]];

/// The curves of a plot, and all else that has numbers for names (most are Okabe and Ito's, 2008).
pub const CURVES: [Rgb; 6] = [[0, 75, 135], [213, 94, 0], [0, 158, 115], [216, 143, 192], [138, 28, 74], [0, 0, 0]];

/// The bodies that a part is welded as, in their order: colours of faces, none so dark or so bright that their shading is lost.
pub const BODIES: [Rgb; 8] = [
    [120, 100, 220],
    [240, 160, 40],
    [40, 140, 100],
    [220, 160, 240],
    [160, 60, 140],
    [160, 200, 120],
    [120, 100, 20],
    [20, 240, 200],
];

/// Values from little to much, of rising lightness (after matplotlib's "viridis", less its ends, which would vanish on dark and
/// on bright ground).
pub const RISING: [Rgb; 5] = [[71, 45, 123], [49, 104, 142], [32, 146, 140], [94, 201, 98], [223, 227, 24]];
/// Temperatures from cold to hot, of rising lightness (after matplotlib's "inferno", less its ends).
pub const WARMTH: [Rgb; 5] = [[78, 16, 112], [137, 32, 106], [195, 60, 78], [238, 107, 36], [251, 182, 28]];
/// Heights of metal, in nominal bead heights: blue where some is missing, red on humps.
pub const HEIGHTS: [(f64, Rgb); 7] = [
    (0.0, [30, 70, 170]),
    (0.35, [60, 125, 210]),
    (0.75, [150, 196, 226]),
    (1.0, [238, 240, 234]),
    (1.3, [250, 176, 84]),
    (1.6, [224, 92, 44]),
    (2.0, [160, 16, 36]),
];

/// How far faces lean from the vertical: up to this many °, and their colour.
pub const LEANS: [(f64, Rgb); 4] =
    [(30.0, [201, 212, 223]), (45.0, [242, 208, 107]), (60.0, [238, 154, 77]), (90.0, [207, 74, 63])];
/// What lies on the plate.
pub const LYING: Rgb = [125, 136, 148];

/// The colour of a kind of pass.
pub const fn kind(kind: PassKind) -> Rgb {
    match kind {
        PassKind::Contour => [52, 100, 230],
        PassKind::Infill => [252, 168, 48],
        PassKind::Skeleton => [14, 194, 140],
        PassKind::Wall | PassKind::Spot => [170, 133, 204],
    }
}

/// The colour of a body of a part, by its index; they come again after eight.
pub fn body(index: usize) -> Rgb {
    BODIES[index % BODIES.len()]
}

/// What has no value.
pub fn missing(dark: bool) -> Rgb {
    if dark { [112, 116, 122] } else { [168, 172, 178] }
}

/// Text and marks of what went well.
pub fn good(dark: bool) -> Rgb {
    if dark { [90, 210, 150] } else { [10, 118, 88] }
}

/// Text and marks of what breaks a limit.
pub fn bad(dark: bool) -> Rgb {
    if dark { [255, 110, 100] } else { [180, 20, 20] }
}

/// The mark at the place of a finding.
pub fn mark(dark: bool) -> Rgb {
    if dark { [255, 176, 87] } else { [194, 65, 12] }
}

/// The colour at a fraction (0 to 1) of [`RISING`].
pub fn rising(part: f64) -> Rgb {
    even(&RISING, part)
}

/// The colour at a fraction (0 to 1) of [`WARMTH`].
pub fn warmth(part: f64) -> Rgb {
    even(&WARMTH, part)
}

/// The colour of a height, in nominal bead heights.
pub fn height(height: f64) -> Rgb {
    let above = HEIGHTS.iter().position(|(at, _)| *at >= height).unwrap_or(HEIGHTS.len() - 1).max(1);
    let ((low, a), (high, b)) = (HEIGHTS[above - 1], HEIGHTS[above]);
    mixed(a, b, (height - low) / (high - low))
}

/// As CSS and SVG write it.
pub fn hex([r, g, b]: Rgb) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// As shares of light, 0 to 1, in which glTF counts.
pub fn linear(rgb: Rgb) -> [f64; 3] {
    rgb.map(|c| f64::from(c) / 255.0).map(|c| if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) })
}

/// A map through colours at equal distances.
fn even(stops: &[Rgb; 5], part: f64) -> Rgb {
    let place = part.clamp(0.0, 1.0) * (stops.len() - 1) as f64;
    let low = (place as usize).min(stops.len() - 2);
    mixed(stops[low], stops[low + 1], place - low as f64)
}

fn mixed(a: Rgb, b: Rgb, part: f64) -> Rgb {
    let part = part.clamp(0.0, 1.0);
    [0, 1, 2].map(|c| (f64::from(a[c]) + (f64::from(b[c]) - f64::from(a[c])) * part).round() as u8)
}
