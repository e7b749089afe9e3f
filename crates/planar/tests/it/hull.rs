//! Convex hull and the rectangle of least area.

use crate::shapes;

use planar::{Bounds, DVec2, OrientedRect, Ring, convex_hull, min_area_rect};
use proptest::prelude::*;
use shapes::{config, v};
use std::f64::consts::{FRAC_PI_2, PI};

fn cloud() -> impl Strategy<Value = Vec<DVec2>> {
    prop::collection::vec((-50.0..50.0, -20.0..20.0).prop_map(|(x, y)| v(x, y)), 3..60)
}

/// Integer points: duplicates and collinear ones are common.
fn lattice() -> impl Strategy<Value = Vec<DVec2>> {
    prop::collection::vec((0..6, 0..6).prop_map(|(x, y)| v(f64::from(x), f64::from(y))), 3..40)
}

fn check_hull(points: &[DVec2]) -> Result<(), TestCaseError> {
    let hull = convex_hull(points);
    prop_assert!(hull.iter().all(|p| points.contains(p)));
    for (i, &a) in hull.iter().enumerate() {
        let (b, c) = (hull[(i + 1) % hull.len()], hull[(i + 2) % hull.len()]);
        prop_assert!(hull.len() < 3 || (b - a).perp_dot(c - b) > 0.0, "not strictly convex at {b}");
        prop_assert!(points.iter().all(|&p| (b - a).perp_dot(p - a) >= -1e-9), "a point outside {a}, {b}");
    }
    Ok(())
}

fn box_area(points: &[DVec2], angle: f64) -> f64 {
    let turn = DVec2::from_angle(-angle);
    Bounds::of(points.iter().map(|p| turn.rotate(*p))).map_or(0.0, |b| b.size().x * b.size().y)
}

fn check_covers(rect: &OrientedRect, points: &[DVec2]) -> Result<(), TestCaseError> {
    for &p in points {
        let from_center = v((p - rect.center).dot(rect.axis), rect.axis.perp_dot(p - rect.center));
        prop_assert!((from_center.abs() - rect.size / 2.0).max_element() < 1e-9, "{p} lies outside {rect:?}");
    }
    Ok(())
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn a_hull_is_convex_and_covers(points in cloud(), coarse in lattice()) {
        check_hull(&points)?;
        check_hull(&coarse)?;
    }

    #[test]
    fn no_angle_gives_a_smaller_box(points in cloud()) {
        let rect = min_area_rect(&points).unwrap();
        check_covers(&rect, &points)?;
        let best = (0..3600).map(|i| box_area(&points, f64::from(i) * PI / 7200.0)).fold(f64::INFINITY, f64::min);
        prop_assert!(rect.area() <= box_area(&points, 0.0) + 1e-9 && rect.area() <= best + 1e-9);
        // Half a step of 0.025° away from the best angle the box is at most this much larger.
        let diameter = Bounds::of(points.iter().copied()).unwrap().size().length();
        prop_assert!(best - rect.area() <= diameter * diameter * 2.0 * PI / 14400.0);
    }

    #[test]
    fn a_turned_rectangle_is_found(w in 1.0..100.0, h in 1.0..100.0, angle in 0.0..PI, x in -1e4..1e4, y in -1e4..1e4,
                                   inner in prop::collection::vec((0.0..1.0, 0.0..1.0), 0..20)) {
        let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
        let place = |(s, t): (f64, f64)| v(x, y) + DVec2::from_angle(angle).rotate(v((s - 0.5) * w, (t - 0.5) * h));
        let points: Vec<DVec2> = inner.into_iter().chain(corners).map(place).collect();
        let rect: OrientedRect = min_area_rect(&points).unwrap();
        let size = rect.size;
        prop_assert!(f64::abs(rect.area() - w * h) < 1e-6 && rect.center.distance(v(x, y)) < 1e-6);
        prop_assert!(f64::abs(size.max_element() - f64::max(w, h)) < 1e-6);
        let long = if size.x > size.y { rect.axis } else { rect.axis.perp() };
        let expected = DVec2::from_angle(if w > h { angle } else { angle + FRAC_PI_2 });
        prop_assert!(f64::abs(w - h) < 1e-3 || long.perp_dot(expected).abs() < 1e-6);
    }
}

#[test]
fn degenerate_points() {
    assert!(convex_hull(&[]).is_empty());
    assert_eq!(convex_hull(&[v(1.0, 2.0); 5]), [v(1.0, 2.0)]);
    assert_eq!(min_area_rect(&[v(1.0, 2.0); 5]), None);
    let line: Vec<DVec2> = (0..9).map(|i| f64::from(i) * v(3.0, 4.0)).collect();
    assert_eq!(convex_hull(&line), [line[0], line[8]]);
    let rect = min_area_rect(&line).unwrap();
    assert!((rect.size - v(40.0, 0.0)).length() < 1e-9 && rect.center.distance(v(12.0, 16.0)) < 1e-9);
}

#[test]
fn edge_points_of_a_square_are_left_out() {
    let points: Vec<DVec2> = (0..25).map(|i| v(f64::from(i % 5), f64::from(i / 5))).collect();
    let hull = convex_hull(&points);
    assert_eq!((hull.len(), Ring::new(hull).area()), (4, 16.0));
}
