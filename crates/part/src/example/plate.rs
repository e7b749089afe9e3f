//! A plate with rounded corners and holes of different sizes.

use super::outline;
use crate::model::solid::Solid;
use glam::DVec2;
use planar::{Polygon, Ring};
use std::f64::consts::FRAC_PI_2;

const SIZE: DVec2 = DVec2::new(120.0, 80.0);
const HEIGHT: f64 = 12.0;
const CORNER_RADIUS: f64 = 12.0;
/// Centre x, centre y and diameter of each hole.
const HOLES: [[f64; 3]; 5] =
    [[0.0, 0.0, 30.0], [-38.0, 17.0, 22.0], [-39.0, -20.0, 16.0], [40.0, 19.0, 12.0], [41.0, -18.0, 10.0]];

pub(super) fn build() -> Solid {
    let hole = |[x, y, diameter]: [f64; 3]| outline::circle(DVec2::new(x, y), diameter / 2.0).reversed();
    Solid::extrude(&Polygon { outer: rim(), holes: HOLES.map(hole).to_vec() }, 0.0, HEIGHT)
}

/// A rectangle with rounded corners.
fn rim() -> Ring {
    let center = SIZE / 2.0 - CORNER_RADIUS;
    let corners = [DVec2::new(1.0, 1.0), DVec2::new(-1.0, 1.0), DVec2::new(-1.0, -1.0), DVec2::new(1.0, -1.0)];
    let corner = |(k, side): (usize, DVec2)| {
        let from = FRAC_PI_2 * k as f64;
        outline::arc(center * side, CORNER_RADIUS, from, from + FRAC_PI_2)
    };
    Ring::new(corners.into_iter().enumerate().flat_map(corner).collect())
}
