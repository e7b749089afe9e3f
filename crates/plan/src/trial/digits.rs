//! Numbers as strokes, so that trials are numbered in weld metal: nobody mixes them up after the saw.

use glam::DVec2;

/// Height and width of a digit, and the distance to the next one, in bead widths: as small as can be read.
const HEIGHT: f64 = 4.0;
const WIDTH: f64 = 2.0;
const ADVANCE: f64 = 4.0;

/// The strokes of each digit in a box one wide and two high.
const STROKES: [&[&[(f64, f64)]]; 10] = [
    &[&[(0.0, 0.0), (0.0, 2.0), (1.0, 2.0), (1.0, 0.0), (0.0, 0.0)]],
    &[&[(0.5, 0.0), (0.5, 2.0)]],
    &[&[(0.0, 2.0), (1.0, 2.0), (1.0, 1.0), (0.0, 1.0), (0.0, 0.0), (1.0, 0.0)]],
    &[&[(0.0, 2.0), (1.0, 2.0), (1.0, 0.0), (0.0, 0.0)], &[(0.2, 1.0), (1.0, 1.0)]],
    &[&[(0.0, 2.0), (0.0, 1.0), (1.0, 1.0)], &[(1.0, 2.0), (1.0, 0.0)]],
    &[&[(1.0, 2.0), (0.0, 2.0), (0.0, 1.0), (1.0, 1.0), (1.0, 0.0), (0.0, 0.0)]],
    &[&[(1.0, 2.0), (0.0, 2.0), (0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]],
    &[&[(0.0, 2.0), (1.0, 2.0), (0.3, 0.0)]],
    &[&[(0.0, 0.0), (0.0, 2.0), (1.0, 2.0), (1.0, 0.0), (0.0, 0.0)], &[(0.0, 1.0), (1.0, 1.0)]],
    &[&[(1.0, 1.0), (0.0, 1.0), (0.0, 2.0), (1.0, 2.0), (1.0, 0.0), (0.0, 0.0)]],
];

/// The strokes of a number with this lower left corner, of beads of this width, mm.
pub(super) fn strokes(number: usize, at: DVec2, bead: f64) -> Vec<Vec<DVec2>> {
    let scale = bead * DVec2::new(WIDTH, HEIGHT / 2.0);
    let digits = number.to_string().into_bytes();
    let digit = |(place, letter): (usize, u8)| {
        let corner = at + DVec2::new(place as f64 * ADVANCE * bead, 0.0);
        let strokes = STROKES.get(usize::from(letter - b'0')).copied().unwrap_or_default();
        strokes.iter().map(move |stroke| stroke.iter().map(|&(x, y)| corner + scale * DVec2::new(x, y)).collect())
    };
    digits.into_iter().enumerate().flat_map(digit).collect()
}

/// Width and height of a number without the width of its beads, mm.
pub(super) fn size(number: usize, bead: f64) -> DVec2 {
    let digits = number.to_string().len();
    bead * DVec2::new((digits - 1) as f64 * ADVANCE + WIDTH, HEIGHT)
}
