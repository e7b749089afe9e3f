//! The integer grid underneath booleans and offsets: 0.1 µm, 32 bits.

use crate::{Polygon, Region, Ring};
use glam::DVec2;
use i_overlay::i_float::int::point::IntPoint;

/// Spacing of the integer grid, mm.
pub const GRID_MM: f64 = 1e-4;

/// Largest coordinate that booleans and offsets accept, mm; anything farther out is clamped.
pub const MAX_COORDINATE_MM: f64 = 50_000.0;

pub(crate) type GridPoint = IntPoint<i32>;
pub(crate) type GridShapes = Vec<Vec<Vec<GridPoint>>>;

pub(crate) fn to_grid(p: DVec2) -> GridPoint {
    let scale = |v: f64| {
        let steps = v.clamp(-MAX_COORDINATE_MM, MAX_COORDINATE_MM) / GRID_MM;
        // A cast drops the fraction.
        (steps + 0.5_f64.copysign(steps)) as i32
    };
    IntPoint::new(scale(p.x), scale(p.y))
}

pub(crate) fn from_grid(p: GridPoint) -> DVec2 {
    // A quotient of two exact numbers: 1234567 becomes 123.4567 and not 123.45670000000001.
    DVec2::new(f64::from(p.x) / 1e4, f64::from(p.y) / 1e4)
}

pub(crate) fn ring_to_grid(ring: &Ring) -> Vec<GridPoint> {
    ring.points().iter().map(|&p| to_grid(p)).collect()
}

pub(crate) fn region_to_grid(region: &Region) -> Vec<Vec<GridPoint>> {
    region.rings().map(ring_to_grid).collect()
}

/// Takes shapes as the library returns them: outer ring first and counter-clockwise, then clockwise holes.
pub(crate) fn region_from_grid(shapes: GridShapes) -> Region {
    let ring = |points: Vec<GridPoint>| Ring::new(points.into_iter().map(from_grid).collect());
    let polygons = shapes.into_iter().filter_map(|shape| {
        let mut rings = shape.into_iter().map(ring);
        let outer = rings.next()?;
        Some(Polygon { outer, holes: rings.collect() })
    });
    Region::from_normalised(polygons.collect())
}
