//! A cross with four square-ended arms.

use crate::model::solid::Solid;
use glam::DVec2;
use planar::{Polygon, Ring};

const LENGTH: f64 = 100.0;
const ARM_WIDTH: f64 = 36.0;
const HEIGHT: f64 = 20.0;

pub(super) fn build() -> Solid {
    let (end, side) = (LENGTH / 2.0, ARM_WIDTH / 2.0);
    let arm = [DVec2::new(end, -side), DVec2::new(end, side), DVec2::new(side, side)];
    let turns = [DVec2::X, DVec2::Y, DVec2::NEG_X, DVec2::NEG_Y];
    let points = turns.iter().flat_map(|turn| arm.map(|p| turn.rotate(p)));
    Solid::extrude(&Polygon::simple(Ring::new(points.collect())), 0.0, HEIGHT)
}
