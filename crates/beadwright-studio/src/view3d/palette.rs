//! What beads look like: the library's palette, and which of its maps shows what.

use super::style::Colour;
pub use beadwright::palette::body;
pub use beadwright::palette::{CHOSEN, END, KINDS, Rgb, START, kind, missing};
use beadwright::palette::{height, rising, warmth};

/// Number of colours in a map.
pub(super) const STEPS: usize = 256;

/// The colour at a fraction (0 to 1) of a map's range.
pub fn at(colour: Colour, part: f64) -> Rgb {
    match colour {
        Colour::Kind => kind(KINDS[((part * STEPS as f64) as usize).min(KINDS.len() - 1)]),
        Colour::Body => body((part * STEPS as f64) as usize),
        // What is as high as planned has the middle of the range.
        Colour::HeightError => height(2.0 * part),
        Colour::Temperature => warmth(part),
        Colour::Order | Colour::Speed | Colour::Width | Colour::Time | Colour::OffLevel | Colour::Movement => {
            rising(part)
        }
    }
}

/// All colours of a map; for kinds, those in the order of [`KINDS`], with the last one repeated; for bodies, those of each.
pub fn map(colour: Colour) -> Vec<Rgb> {
    let part = |i: usize| match colour {
        Colour::Kind | Colour::Body => i as f64 / STEPS as f64,
        _ => i as f64 / (STEPS - 1) as f64,
    };
    (0..STEPS).map(|i| at(colour, part(i))).collect()
}
