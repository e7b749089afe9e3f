//! A block with a shallow hollow of double curvature in its top, such as a mould's, to be clad.

use super::between::between;
use crate::model::solid::Solid;
use glam::DVec2;
use std::f64::consts::PI;

/// Half its length and width, mm.
const HALF: DVec2 = DVec2::new(80.0, 60.0);
/// Height of its top beside the hollow, and depth of that, mm.
const TOP: f64 = 30.0;
const DEPTH: f64 = 10.0;
/// How much higher one end of the top is than the other, mm.
const RISE: f64 = 8.0;
/// Pieces along each side.
const PIECES: [u32; 2] = [80, 60];

fn top(p: DVec2) -> f64 {
    let angle = PI * p / (2.0 * HALF);
    let hollow = (angle.x.cos() * angle.y.cos()).powi(2);
    TOP - DEPTH * hollow + RISE / 2.0 * angle.x.sin()
}

pub(super) fn build() -> Solid {
    between(HALF, PIECES, |p| [top(p), 0.0])
}
