//! A frame with a cross inside, like the character 田: outer walls and two inner ones that cross.

use crate::curve::Nurbs;
use crate::model::solid::Solid;
use glam::{DVec2, DVec3};
use planar::{Polygon, Ring};

const SIZE: f64 = 100.0;
const WALL: f64 = 4.5;
const HEIGHT: f64 = 26.0;

pub(super) fn build() -> Solid {
    let opening = (SIZE - 3.0 * WALL) / 2.0;
    let off = (opening + WALL) / 2.0;
    let centers = [DVec2::new(-off, -off), DVec2::new(off, -off), DVec2::new(off, off), DVec2::new(-off, off)];
    let holes = centers.iter().map(|&c| square(c, opening).reversed()).collect();
    Solid::extrude(&Polygon { outer: square(DVec2::ZERO, SIZE), holes }, 0.0, HEIGHT)
}

/// The middle of the walls: four around and two that cross.
pub(super) fn curves() -> Vec<Nurbs> {
    let half = (SIZE - WALL) / 2.0;
    let line =
        |[x0, y0, x1, y1]: [f64; 4]| Nurbs::line(DVec3::new(x0, y0, 0.0) * half, DVec3::new(x1, y1, 0.0) * half).ok();
    let around = [[-1.0, -1.0, 1.0, -1.0], [1.0, -1.0, 1.0, 1.0], [1.0, 1.0, -1.0, 1.0], [-1.0, 1.0, -1.0, -1.0]];
    let inside = [[-1.0, 0.0, 1.0, 0.0], [0.0, -1.0, 0.0, 1.0]];
    around.into_iter().chain(inside).filter_map(line).collect()
}

fn square(center: DVec2, side: f64) -> Ring {
    let corners = [DVec2::new(-1.0, -1.0), DVec2::new(1.0, -1.0), DVec2::ONE, DVec2::new(-1.0, 1.0)];
    Ring::new(corners.map(|corner| center + corner * side / 2.0).to_vec())
}
