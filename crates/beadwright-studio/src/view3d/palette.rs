//! The colours of beads: distinct hues for kinds, perceptually even maps for values.

use super::style::Colour;
use beadwright::pass::PassKind;

/// Red, green, blue, 0 to 255, as on the screen.
pub type Rgb = [u8; 3];

/// Number of colours in a map.
pub(super) const STEPS: usize = 256;

/// The colour of what is chosen.
pub const ACCENT: Rgb = [255, 51, 143];

/// The colours of starts and ends of passes.
pub const START: Rgb = [40, 190, 200];
/// See [`START`].
pub const END: Rgb = [222, 62, 54];

/// The kinds of passes, in the order of their colours; dots look like walls.
pub const KINDS: [PassKind; 4] = [PassKind::Contour, PassKind::Infill, PassKind::Skeleton, PassKind::Wall];

/// The colour of a kind of pass. People without red, green or blue cones can tell them apart, too (`tests/it/colours.rs`).
pub fn kind(kind: PassKind) -> Rgb {
    match kind {
        PassKind::Contour => [52, 100, 230],
        PassKind::Infill => [252, 168, 48],
        PassKind::Skeleton => [14, 194, 140],
        PassKind::Wall | PassKind::Spot => [170, 133, 204],
    }
}

/// The colour of beads without a value.
pub fn missing(dark: bool) -> Rgb {
    if dark { [112, 116, 122] } else { [168, 172, 178] }
}

/// The colour at a fraction (0 to 1) of a map's range.
pub fn at(colour: Colour, part: f64, dark: bool) -> Rgb {
    match colour {
        Colour::Kind => kind(KINDS[((part * STEPS as f64) as usize).min(KINDS.len() - 1)]),
        Colour::HeightError => diverging(part),
        Colour::Temperature => ember(if dark { 0.15 + 0.85 * part } else { part }),
        // The dark end would vanish on a dark background, the bright end on a bright one.
        Colour::Order | Colour::Speed | Colour::Width | Colour::Time | Colour::OffLevel | Colour::Movement => {
            viridis(if dark { 0.12 + 0.88 * part } else { 0.95 * part })
        }
    }
}

/// All colours of a map; for kinds, those in the order of [`KINDS`], with the last one repeated.
pub fn map(colour: Colour, dark: bool) -> Vec<Rgb> {
    let part = |i: usize| match colour {
        Colour::Kind => i as f64 / STEPS as f64,
        _ => i as f64 / (STEPS - 1) as f64,
    };
    (0..STEPS).map(|i| at(colour, part(i), dark)).collect()
}

/// The map viridis, as a polynomial (Matt Zucker's fit, within 1 % of it).
fn viridis(part: f64) -> Rgb {
    const COEFFICIENTS: [[f64; 3]; 7] = [
        [0.277_727, 0.005_407, 0.334_100],
        [0.105_093, 1.404_614, 1.384_590],
        [-0.330_862, 0.214_848, 0.095_095],
        [-4.634_230, -5.799_101, -19.332_441],
        [6.228_270, 14.179_933, 56.690_553],
        [4.776_385, -13.745_145, -65.353_033],
        [-5.435_456, 4.645_853, 26.312_435],
    ];
    let t = part.clamp(0.0, 1.0);
    [0, 1, 2].map(|c| byte(COEFFICIENTS.iter().rev().fold(0.0, |sum, k| sum * t + k[c])))
}

/// Dark violet to yellow, as in the report (after matplotlib's "inferno").
fn ember(part: f64) -> Rgb {
    stepped([[0.16, 0.04, 0.33], [0.47, 0.11, 0.43], [0.74, 0.22, 0.33], [0.93, 0.41, 0.15], [0.98, 0.71, 0.10]], part)
}

/// Blue below, near white in the middle, red above.
fn diverging(part: f64) -> Rgb {
    stepped([[0.10, 0.30, 0.75], [0.45, 0.68, 0.92], [0.93, 0.93, 0.93], [0.96, 0.60, 0.47], [0.76, 0.10, 0.16]], part)
}

/// A map through five colours at equal distances.
fn stepped(stops: [[f64; 3]; 5], part: f64) -> Rgb {
    let place = part.clamp(0.0, 1.0) * (stops.len() - 1) as f64;
    let low = (place as usize).min(stops.len() - 2);
    let t = place - low as f64;
    [0, 1, 2].map(|c| byte(stops[low][c] * (1.0 - t) + stops[low + 1][c] * t))
}

fn byte(value: f64) -> u8 {
    (value.clamp(0.0, 1.0) * 255.0).round() as u8
}
