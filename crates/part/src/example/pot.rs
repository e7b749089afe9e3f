//! A pot without a bottom, square at the foot and round at the rim. The wall thickness is measured square to the wall,
//! as a bead makes it: where the wall leans, most at the corners, a layer shows it thicker.

use super::outline;
use crate::curve::Nurbs;
use crate::model::solid::Solid;
use glam::{DVec2, DVec3};
use planar::{Polygon, Ring};
use std::f64::consts::FRAC_PI_2;

const HEIGHT: f64 = 80.0;
const WALL: f64 = 4.0;
/// Outer half width at the foot and at the rim.
const HALF_WIDTH: (f64, f64) = (50.0, 30.0);
/// Outer corner radius at the foot; at the rim it is the half width, a circle.
const FOOT_RADIUS: f64 = 12.0;
/// Corners have as many chords as an arc of this many times the rim's radius: 0.03 mm there is 0.0075 mm on the rim.
const FINE: f64 = 4.0;

pub(super) fn build() -> Solid {
    let foot = Polygon { outer: ring(0.0), holes: vec![ring(1.0).reversed()] };
    // Every point moves straight upwards and inwards, so two levels are exact.
    Solid::loft(&foot, &[0.0, HEIGHT], raised).welded()
}

/// The middle of the wall at the foot and at the rim; between them it is lofted.
pub(super) fn curves() -> Vec<Nurbs> {
    let middle = ring(0.5);
    let curve = |z: f64| {
        let mut points: Vec<DVec3> = middle.points().iter().map(|&p| raised(p, z).extend(z)).collect();
        points.extend(points.first().copied());
        Nurbs::polyline(points).ok()
    };
    [0.0, HEIGHT].into_iter().filter_map(curve).collect()
}

/// The outline at the foot, moved inwards by a fraction of the wall: straight sides and round corners.
fn ring(part: f64) -> Ring {
    let corners = [DVec2::ONE, DVec2::new(-1.0, 1.0), DVec2::NEG_ONE, DVec2::new(1.0, -1.0)];
    let points = corners.iter().enumerate().flat_map(|(k, side)| {
        let from = FRAC_PI_2 * k as f64;
        let unit = outline::arc(DVec2::ZERO, FINE * HALF_WIDTH.1, from, from + FRAC_PI_2);
        unit.into_iter().map(move |p| {
            *side * (HALF_WIDTH.0 - FOOT_RADIUS) + p.normalize() * (FOOT_RADIUS - part * level_wall(p.normalize()))
        })
    });
    Ring::new(points.collect())
}

/// Position of a point of the foot's outline at height `z`, mm.
fn raised(p: DVec2, z: f64) -> DVec2 {
    let side = p.signum();
    let arm = p - side * (HALF_WIDTH.0 - FOOT_RADIUS);
    let share = z / HEIGHT;
    let half_width = HALF_WIDTH.0 + share * (HALF_WIDTH.1 - HALF_WIDTH.0);
    let radius = FOOT_RADIUS + share * (HALF_WIDTH.1 - FOOT_RADIUS);
    side * (half_width - radius) + arm.normalize_or_zero() * (arm.length() + radius - FOOT_RADIUS)
}

/// Thickness of the wall in a level cut where the outline faces `out`, mm.
fn level_wall(out: DVec2) -> f64 {
    let grown = (HALF_WIDTH.1 - FOOT_RADIUS) / HEIGHT;
    let shifted = (HALF_WIDTH.1 - HALF_WIDTH.0) / HEIGHT - grown;
    WALL * (shifted * out.abs().element_sum() + grown).hypot(1.0)
}
