//! A straight wall, one bead thick.

use crate::curve::Nurbs;
use crate::model::solid::Solid;
use glam::{DVec2, DVec3};
use planar::{Polygon, Ring};

const LENGTH: f64 = 120.0;
const WALL: f64 = 4.5;
const HEIGHT: f64 = 72.0;

pub(super) fn build() -> Solid {
    let half = DVec2::new(LENGTH, WALL) / 2.0;
    let corners = [DVec2::new(-1.0, -1.0), DVec2::new(1.0, -1.0), DVec2::ONE, DVec2::new(-1.0, 1.0)];
    Solid::extrude(&Polygon::simple(Ring::new(corners.map(|corner| corner * half).to_vec())), 0.0, HEIGHT)
}

/// The middle of the wall.
pub(super) fn curves() -> Vec<Nurbs> {
    let end = DVec3::X * LENGTH / 2.0;
    Nurbs::line(-end, end).into_iter().collect()
}
