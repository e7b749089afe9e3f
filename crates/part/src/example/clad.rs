//! Cladding of a saddle, in layers that follow it.

use super::between::between;
use super::surface_body;
use crate::model::solid::Solid;
use glam::DVec2;

/// Half its length and width, mm.
const HALF: DVec2 = DVec2::new(70.0, 45.0);
/// Thickness of the cladding, mm.
const THICKNESS: f64 = 5.6;
/// Pieces along each side.
const PIECES: [u32; 2] = [70, 46];

/// Height of the saddle, mm; its lowest places lie at 0.
fn saddle(p: DVec2) -> f64 {
    let part = p / HALF;
    4.0 + 6.0 * part.x * part.x - 4.0 * part.y * part.y
}

pub(super) fn bodies() -> String {
    surface_body("clad", 10.0, 8, 6, saddle)
}

pub(super) fn build() -> Solid {
    between(HALF, PIECES, |p| [saddle(p) + THICKNESS, saddle(p)])
}
