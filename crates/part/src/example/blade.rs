//! A turbine blade as a thin wall: an arched mean line that turns with height, with equal thickness on both sides.

use crate::curve::Nurbs;
use crate::model::solid::Solid;
use glam::DVec2;
use planar::{Polygon, Ring};
use std::f64::consts::PI;

/// Thickness of the wall, mm.
pub const WALL: f64 = 3.5;
/// Height, mm.
pub const HEIGHT: f64 = 100.0;
/// Length of the mean line from end to end, mm.
const CHORD: f64 = 90.0;
/// Largest camber of the mean line, and where, as fractions of the chord: the mean line of a NACA profile.
const CAMBER: f64 = 0.14;
const CREST: f64 = 0.4;
/// Turn from the foot to the tip, radians.
const TWIST: f64 = 25.0 * PI / 180.0;
/// Segments of the mean line; its chords stay within 0.003 mm.
const PIECES: u32 = 150;
/// Steps of the twist; its chords stay within 0.01 mm.
const STEPS: u32 = 24;

pub(super) fn build() -> Solid {
    let levels: Vec<f64> = (0..=STEPS).map(|k| HEIGHT * f64::from(k) / f64::from(STEPS)).collect();
    Solid::loft(&foot(), &levels, turned)
}

/// The mean line at height `z` (mm), from the leading edge to the trailing edge.
pub fn mean_line(z: f64) -> Vec<DVec2> {
    (0..=PIECES).map(|k| turned(mean(share(k)).0, z)).collect()
}

/// The mean line at eleven heights.
pub(super) fn curves() -> Vec<Nurbs> {
    let heights = (0..=10).map(|k| HEIGHT * f64::from(k) / 10.0);
    let curve = |z: f64| Nurbs::interpolated(&mean_line(z).iter().map(|p| p.extend(z)).collect::<Vec<_>>(), false).ok();
    heights.filter_map(curve).collect()
}

fn turned(p: DVec2, z: f64) -> DVec2 {
    DVec2::from_angle(TWIST * (z / HEIGHT - 0.5)).rotate(p)
}

fn share(k: u32) -> f64 {
    f64::from(k) / f64::from(PIECES)
}

/// A point of the mean line at the foot, before the twist, at a fraction of the chord, and the unit normal to its left.
fn mean(x: f64) -> (DVec2, DVec2) {
    let span = if x < CREST { CREST } else { 1.0 - CREST };
    let off = (x - CREST) / span;
    let (y, slope) = (CAMBER * (1.0 - off * off), -2.0 * CAMBER * off / span);
    (DVec2::new(x - 0.5, y - 0.6 * CAMBER) * CHORD, DVec2::new(-slope, 1.0).normalize())
}

/// The outline at the foot: along one side and back along the other.
fn foot() -> Polygon {
    let side = |left: f64| {
        move |k: u32| {
            let (at, normal) = mean(share(k));
            turned(at + normal * left * WALL / 2.0, HEIGHT / 2.0)
        }
    };
    Polygon::simple(Ring::new((0..=PIECES).map(side(-1.0)).chain((0..=PIECES).rev().map(side(1.0))).collect()))
}
