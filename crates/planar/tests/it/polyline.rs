//! Simplification: what is dropped was near what stays, and a ring has no start.

use crate::shapes;

use planar::polyline::{distance_squared_to_segment, length, point_at, simplify, simplify_ring, without_end};
use planar::{DVec2, Ring};
use proptest::prelude::*;
use shapes::{config, star, v};

/// A wiggly line: steps of up to 1 mm.
fn wiggle() -> impl Strategy<Value = Vec<DVec2>> {
    prop::collection::vec((-1.0..1.0, -1.0..1.0), 0..60).prop_map(|steps| {
        let next = |at: &mut DVec2, (x, y)| {
            *at += v(x, y);
            Some(*at)
        };
        steps.into_iter().scan(DVec2::ZERO, next).collect()
    })
}

fn distance_to_line(p: DVec2, line: &[DVec2]) -> f64 {
    line.windows(2).map(|w| distance_squared_to_segment(p, w[0], w[1]).sqrt()).fold(f64::INFINITY, f64::min)
}

fn assert_start_does_not_matter(ring: &Ring, tolerance: f64) -> Result<(), TestCaseError> {
    let expected = simplify_ring(ring.clone(), tolerance);
    for start in 0..ring.points().len() {
        let mut points = ring.points().to_vec();
        points.rotate_left(start);
        prop_assert_eq!(simplify_ring(Ring::new(points), tolerance), expected.clone());
    }
    Ok(())
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn dropped_points_are_near(line in wiggle(), tolerance in 0.01..2.0) {
        let result = simplify(&line, tolerance);
        prop_assert_eq!((result.first(), result.last()), (line.first(), line.last()));
        prop_assert!(result.iter().all(|p| line.contains(p)) && length(&result) <= length(&line) + 1e-9);
        for &p in line.iter().filter(|_| line.len() > 1) {
            prop_assert!(distance_to_line(p, &result) <= tolerance + 1e-12);
        }
    }

    #[test]
    fn points_dropped_from_a_ring_are_near(region in star(), tolerance in 0.01..2.0) {
        let ring = &region.polygons()[0].outer;
        let Some(result) = simplify_ring(ring.clone(), tolerance) else { return Ok(()) };
        let mut closed = result.into_points();
        closed.push(closed[0]);
        for &p in ring.points() {
            prop_assert!(distance_to_line(p, &closed) <= tolerance + 1e-12);
        }
    }

    #[test]
    fn a_ring_has_no_start(region in star(), tolerance in 0.01..5.0) {
        assert_start_does_not_matter(&region.polygons()[0].outer, tolerance)?;
    }
}

#[test]
fn a_symmetric_ring_has_no_start() {
    let corner = |i: i32| (10.0 * DVec2::from_angle(f64::from(i) * std::f64::consts::TAU / 24.0)).round();
    let ring = Ring::new((0..24).map(corner).collect());
    for tolerance in [0.0, 0.1, 1.0, 3.0] {
        assert_start_does_not_matter(&ring, tolerance).unwrap();
    }
}

#[test]
fn collinear_points_go_and_corners_stay() {
    let line = [v(0.0, 0.0), v(1.0, 0.0), v(2.0, 0.0), v(2.0, 1.0), v(2.0, 5.0)];
    assert_eq!(simplify(&line, 0.0), [line[0], line[2], line[4]]);
    let square = Ring::new(vec![v(5.0, 0.0), v(10.0, 0.0), v(10.0, 10.0), v(0.0, 10.0), v(0.0, 0.0)]);
    let simple = simplify_ring(square, 0.0).unwrap();
    assert_eq!((simple.points().len(), simple.area()), (4, 100.0));
}

#[test]
fn a_ring_thinner_than_the_tolerance_vanishes() {
    let sliver = Ring::new(vec![v(0.0, 0.0), v(5.0, -0.001), v(10.0, 0.0), v(5.0, 0.001)]);
    assert_eq!(simplify_ring(sliver, 0.003), None);
    assert!(simplify(&[], 1.0).is_empty());
}

#[test]
fn a_spike_that_turns_back_is_kept() {
    // All on one straight line: a distance to the infinite line would lose the tip.
    assert_eq!(simplify(&[v(0.0, 0.0), v(9.0, 0.0), v(1.0, 0.0)], 0.5).len(), 3);
}

#[test]
fn points_along_a_line_and_lines_without_their_end() {
    let line = vec![DVec2::ZERO, DVec2::new(3.0, 4.0), DVec2::new(3.0, 10.0)];
    assert_eq!(point_at(&line, 2.5), Some(DVec2::new(1.5, 2.0)));
    assert_eq!(point_at(&line, 8.0), Some(DVec2::new(3.0, 7.0)));
    assert_eq!(point_at(&line, 99.0), Some(DVec2::new(3.0, 10.0)));
    assert_eq!(point_at(&[], 1.0), None);
    for by in [0.5, 6.0, 7.5, 10.9] {
        let rest = without_end(line.clone(), by);
        assert!((length(&rest) - (11.0 - by)).abs() < 1e-9, "{by}");
        assert_eq!(rest[0], line[0]);
    }
}
