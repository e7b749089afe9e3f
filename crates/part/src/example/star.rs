//! A five-pointed star, one point along +y.

use crate::model::solid::Solid;
use glam::DVec2;
use planar::{Polygon, Ring};
use std::f64::consts::{FRAC_PI_2, PI};

const POINTS: u32 = 5;
const OUTER_RADIUS: f64 = 80.0;
const INNER_RADIUS: f64 = 34.0;
const HEIGHT: f64 = 20.0;

pub(super) fn build() -> Solid {
    let corner = |k: u32| {
        let radius = if k.is_multiple_of(2) { OUTER_RADIUS } else { INNER_RADIUS };
        DVec2::from_angle(FRAC_PI_2 + PI * f64::from(k) / f64::from(POINTS)) * radius
    };
    let outline = Ring::new((0..2 * POINTS).map(corner).collect());
    Solid::extrude(&Polygon::simple(outline), 0.0, HEIGHT)
}
