//! Shapes, generators and oracles that the tests share; nothing here uses the code under test beyond its types.
#![allow(dead_code)]

use planar::{DVec2, FillRule, Polygon, Region, Ring};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed};
use std::f64::consts::TAU;

/// The same cases on every run; `PROPTEST_RNG_SEED` and `PROPTEST_CASES` try others.
pub(crate) fn config() -> Config {
    let default = Config { failure_persistence: None, ..Config::default() };
    let cases = default.cases.min(128);
    match default.rng_seed {
        RngSeed::Random => Config { cases, rng_seed: RngSeed::Fixed(1), ..default },
        RngSeed::Fixed(_) => default,
    }
}

pub(crate) fn v(x: f64, y: f64) -> DVec2 {
    DVec2::new(x, y)
}

pub(crate) fn box_ring(min: DVec2, max: DVec2) -> Ring {
    Ring::new(vec![min, v(max.x, min.y), max, v(min.x, max.y)])
}

/// A `w` by `h` plate at the origin with box-shaped holes, each (lower left, upper right).
pub(crate) fn plate(w: f64, h: f64, holes: &[(DVec2, DVec2)]) -> Region {
    let holes = holes.iter().map(|&(min, max)| box_ring(min, max).reversed()).collect();
    Polygon { outer: box_ring(DVec2::ZERO, v(w, h)), holes }.into()
}

/// A plate of 60 by 40 mm with three holes, two of them at the same height.
pub(crate) fn three_holes() -> Region {
    plate(60.0, 40.0, &[(v(5.0, 5.0), v(15.0, 12.0)), (v(25.0, 5.0), v(40.0, 20.0)), (v(12.0, 25.0), v(30.0, 33.0))])
}

/// A bridge of 2 mm width and 0.5 mm length between two squares of 10 mm.
pub(crate) fn dumbbell() -> Region {
    let squares = [(v(0.0, 0.0), v(10.0, 10.0)), (v(10.5, 0.0), v(20.5, 10.0)), (v(9.0, 4.0), v(12.0, 6.0))];
    Region::from_rings(&squares.map(|(min, max)| box_ring(min, max)), FillRule::NonZero)
}

/// Points about `center` with radii `radii`, evenly spread and then jittered by less than half a step.
fn star_ring(center: DVec2, phase: f64, spokes: &[(f64, f64)]) -> Ring {
    let step = TAU / spokes.len() as f64;
    let spoke = |(i, &(radius, jitter)): (usize, &(f64, f64))| {
        center + radius * DVec2::from_angle(phase + (i as f64 + jitter) * step)
    };
    Ring::new(spokes.iter().enumerate().map(spoke).collect())
}

/// A star-shaped polygon within 20 mm of a point near the origin, with up to three holes.
///
/// Its edges keep 5·cos 48° = 3.3 mm away from the middle; the holes reach out to 2.75 mm and not to each other.
pub(crate) fn star() -> impl Strategy<Value = Region> {
    let spokes = prop::collection::vec((5.0..20.0, -0.3..0.3), 6..20);
    let hole = prop::collection::vec((0.4..1.0, -0.3..0.3), 3..8);
    let holes = prop::collection::vec(hole, 0..4);
    (-8.0..8.0, -8.0..8.0, 0.0..TAU, spokes, holes).prop_map(|(x, y, phase, spokes, holes)| {
        let center = v(x, y);
        let hole = |(i, spokes): (usize, &Vec<(f64, f64)>)| {
            let middle = center + 1.75 * DVec2::from_angle(phase + i as f64 * TAU / 3.0);
            star_ring(middle, phase, spokes).reversed()
        };
        let holes = holes.iter().enumerate().map(hole).collect();
        Polygon { outer: star_ring(center, phase, &spokes), holes }.into()
    })
}

/// A convex polygon of 4 to 12 corners, inscribed in an ellipse; edges of at least 6 mm, corners of at least 28°.
pub(crate) fn convex() -> impl Strategy<Value = Region> {
    let spokes = prop::collection::vec((Just(1.0), -0.2..0.2), 4..=12);
    (20.0..40.0, 1.0..2.0, 0.0..TAU, spokes).prop_map(|(radius, stretch, phase, spokes)| {
        let circle = Region::from(Polygon::simple(star_ring(DVec2::ZERO, phase, &spokes)));
        map_points(&circle, |p| v(p.x * stretch, p.y) * radius)
    })
}

/// The region with every point moved; the rings keep their order, so `f` must not mirror.
pub(crate) fn map_points(region: &Region, f: impl Fn(DVec2) -> DVec2) -> Region {
    map_rings(region, |r| Ring::new(r.points().iter().map(|&p| f(p)).collect()))
}

fn map_rings(region: &Region, f: impl Fn(&Ring) -> Ring) -> Region {
    let polygon = |p: &Polygon| Polygon { outer: f(&p.outer), holes: p.holes.iter().map(&f).collect() };
    Region::from_normalised(region.polygons().iter().map(polygon).collect())
}

/// The same region rotated by 90°, mirrored, described from other start vertices, and with its holes in another order.
pub(crate) fn same_shapes(region: &Region) -> [Region; 4] {
    let mirror = |r: &Ring| Ring::new(r.points().iter().rev().map(|&p| v(-p.x, p.y)).collect());
    let restart = |r: &Ring| {
        let mut points = r.points().to_vec();
        points.rotate_left(2);
        Ring::new(points)
    };
    let mut reordered = region.clone().into_polygons();
    reordered.reverse();
    reordered.iter_mut().for_each(|p| p.holes.reverse());
    [
        map_points(region, |p| p.perp()),
        map_rings(region, mirror),
        map_rings(region, restart),
        Region::from_normalised(reordered),
    ]
}

/// Distance from `p` to the boundary, edge by edge.
pub(crate) fn distance_to_boundary(region: &Region, p: DVec2) -> f64 {
    let to_edge = |(a, b): (DVec2, DVec2)| {
        let t = (p - a).dot(b - a) / (b - a).length_squared();
        p.distance(a.lerp(b, t.clamp(0.0, 1.0)))
    };
    region.rings().flat_map(Ring::edges).map(to_edge).fold(f64::INFINITY, f64::min)
}

/// Area of what lies in one region and not in the other.
pub(crate) fn symmetric_difference(a: &Region, b: &Region) -> f64 {
    a.difference(b).area() + b.difference(a).area()
}

/// The area that rounding to the 0.1 µm grid can change: each point of the boundary moves by less than one step,
/// once on the way in and once where edges are cut.
pub(crate) fn grid_error(perimeter: f64) -> f64 {
    2.0 * planar::GRID_MM * perimeter
}

pub(crate) fn to_clipper(region: &Region) -> clipper2_rust::Paths64 {
    let point = |p: &DVec2| clipper2_rust::Point64::new((p.x * 1e4).round() as i64, (p.y * 1e4).round() as i64);
    region.rings().map(|r| r.points().iter().map(point).collect()).collect()
}

pub(crate) fn clipper_area(paths: &clipper2_rust::Paths64) -> f64 {
    paths.iter().map(clipper2_rust::area).sum::<f64>() * 1e-8
}
