//! Curves: against closed forms, and against the Cox–de Boor recursion written out from its definition.

use crate::definition;

use beadwright::curve::{CurveError, Nurbs};
use definition::{cubic, from_definition};
use glam::{DAffine3, DMat3, DVec3, dvec3};
use proptest::prelude::*;
use std::f64::consts::{FRAC_PI_2, PI, SQRT_2, TAU};

fn circle(radius: f64) -> Nurbs {
    Nurbs::circle(dvec3(3.0, -2.0, 7.0), DVec3::X * radius, DVec3::Y * radius).unwrap()
}

/// Parameters spread over the domain, both ends included.
fn spread(curve: &Nurbs, pieces: usize) -> impl Iterator<Item = f64> {
    let (start, end) = curve.domain();
    (0..=pieces).map(move |i| start + (end - start) * i as f64 / pieces as f64)
}

fn assert_near(found: f64, expect: f64, tolerance: f64) {
    assert!((found - expect).abs() <= tolerance, "{found} is not {expect} within {tolerance}");
}

#[test]
fn a_circle_is_round_everywhere() {
    let curve = circle(50.0);
    for u in spread(&curve, 1000) {
        let [point, velocity, _] = curve.derivatives(u);
        assert_near(point.distance(dvec3(3.0, -2.0, 7.0)), 50.0, 1e-12 * 50.0);
        assert_near(velocity.normalize().dot((point - dvec3(3.0, -2.0, 7.0)).normalize()), 0.0, 1e-12);
    }
    assert_near(curve.length(), TAU * 50.0, 1e-10 * TAU * 50.0);
    assert!(curve.is_closed() && curve.is_rational());
}

#[test]
fn arcs_of_any_sweep_have_their_radius_ends_and_length() {
    for (start, sweep) in [(0.0, 0.3), (1.0, FRAC_PI_2), (2.0, -PI), (-1.0, 4.5), (0.5, -TAU), (0.0, 1e-4)] {
        let arc = Nurbs::arc(DVec3::ZERO, DVec3::X * 8.0, DVec3::Y * 8.0, start, sweep).unwrap();
        let at = |angle: f64| dvec3(angle.cos(), angle.sin(), 0.0) * 8.0;
        assert!(arc.point(0.0).distance(at(start)) < 1e-13 * 8.0);
        assert!(arc.point(arc.domain().1).distance(at(start + sweep)) < 1e-13 * 8.0);
        assert!(arc.arc_length().point(4.0 * sweep.abs()).distance(at(start + sweep / 2.0)) < 1e-9);
        assert_near(arc.length(), 8.0 * sweep.abs(), 1e-10 * 8.0 * sweep.abs());
        assert!(spread(&arc, 97).all(|u| (arc.point(u).length() - 8.0).abs() < 1e-12));
    }
}

#[test]
fn an_ellipse_keeps_its_equation_and_its_length() {
    let curve = Nurbs::circle(DVec3::ZERO, DVec3::X * 2.0, DVec3::Y).unwrap();
    assert!(
        spread(&curve, 500).all(|u| (curve.point(u).x.powi(2) / 4.0 + curve.point(u).y.powi(2) - 1.0).abs() < 1e-13)
    );
    // 8 E(√3/2), the complete elliptic integral of the second kind.
    assert_near(curve.length(), 9.688_448_220_547_675, 1e-9);
}

#[test]
fn a_line_is_straight_and_even() {
    let (a, b) = (dvec3(1.0, 2.0, 3.0), dvec3(4.0, 6.0, 15.0));
    let line = Nurbs::line(a, b).unwrap();
    assert_eq!(line.point(0.25), a.lerp(b, 0.25));
    assert_eq!(line.derivatives(0.3)[1..], [b - a, DVec3::ZERO]);
    assert_eq!(line.length(), 13.0);
    assert_eq!(line.parameters_by_chord(0.1), [0.0, 1.0]);
    assert_eq!(line.points_by_length(5.0).len(), 4);
    assert_eq!(line.closest(dvec3(1.0, 2.0, 3.0) - (b - a)).point, a);
}

#[test]
fn a_parabola_has_its_closed_form() {
    // y = x² for x from −1 to 2.
    let curve = Nurbs::conic(dvec3(-1.0, 1.0, 0.0), dvec3(0.5, -2.0, 0.0), dvec3(2.0, 4.0, 0.0), 1.0).unwrap();
    for u in spread(&curve, 50) {
        let [p, d, dd] = curve.derivatives(u);
        assert_near(p.y, p.x * p.x, 1e-14 * 4.0);
        assert_near(p.x, 3.0 * u - 1.0, 1e-14);
        assert!(d.distance(dvec3(3.0, 6.0 * p.x, 0.0)) < 1e-13 && dd.distance(dvec3(0.0, 18.0, 0.0)) < 1e-12);
    }
    let primitive = |x: f64| (2.0 * x * (1.0 + 4.0 * x * x).sqrt() + (2.0 * x).asinh()) / 4.0;
    assert_near(curve.length(), primitive(2.0) - primitive(-1.0), 1e-10);
}

#[test]
fn a_cusp_does_not_spoil_the_length() {
    // (t², t³) for t from −1 to 1 stands still at t = 0.
    let points = [[1.0, -1.0], [-1.0 / 3.0, 1.0], [-1.0 / 3.0, -1.0], [1.0, 1.0]].map(|[x, y]| dvec3(x, y, 0.0));
    let curve = Nurbs::new(3, [[0.0; 4], [1.0; 4]].concat(), vec![1.0; 4], points.to_vec()).unwrap();
    let half = (13.0_f64.powf(1.5) - 8.0) / 27.0;
    assert_near(curve.length(), 2.0 * half, 1e-9);
    assert_near(curve.arc_length().at(0.5), half, 1e-9);
    assert!(curve.arc_length().parameter(half).is_finite() && curve.tangent(0.5).is_finite());
}

#[test]
fn tiny_curves_far_out_take_no_time() {
    for far in [1e3, 1e6, 1e9] {
        let curve = Nurbs::circle(DVec3::splat(far), DVec3::X * 1e-3, DVec3::Y * 1e-3).unwrap();
        // Coordinates are rounded to 1e-16 of their size, and a length can be no better.
        assert_near(curve.length(), TAU * 1e-3, 1e-14 * far + 1e-12);
        assert!(curve.arc_length().parameter(3e-3).is_finite());
        assert!(curve.parameters_by_chord(0.0).len() < 200_000);
        assert!(curve.closest(DVec3::ZERO).distance > 0.0);
    }
}

#[test]
fn length_and_its_inverse_agree() {
    for curve in [cubic(), circle(20.0), circle(1e-3), circle(1e4)] {
        let table = curve.arc_length();
        for i in 0..=40 {
            let wanted = table.total() * f64::from(i) / 40.0;
            assert_near(table.at(table.parameter(wanted)), wanted, 1e-11 * table.total());
        }
        let pieces = table.equal_parameters(17);
        let each = pieces.windows(2).map(|w| table.at(w[1]) - table.at(w[0]));
        each.for_each(|length| assert_near(length, table.total() / 17.0, 1e-10 * table.total()));
    }
    // Against 100,000 chords.
    let curve = cubic();
    let points: Vec<DVec3> = spread(&curve, 100_000).map(|u| curve.point(u)).collect();
    let chords: f64 = points.windows(2).map(|w| w[0].distance(w[1])).sum();
    assert_near(curve.length(), chords, 1e-8 * chords);
}

#[test]
fn chords_stay_within_the_error() {
    for curve in [cubic(), circle(50.0)] {
        for error in [1.0, 0.1, 0.01, 1e-4] {
            let parameters = curve.parameters_by_chord(error);
            let worst = parameters.windows(2).flat_map(|w| {
                let chord = Nurbs::line(curve.point(w[0]), curve.point(w[1])).unwrap();
                let at = |i: usize| curve.point(w[0] + (w[1] - w[0]) * i as f64 / 40.0);
                (1..40).map(|i| chord.closest(at(i)).distance).collect::<Vec<_>>()
            });
            let worst = worst.fold(0.0, f64::max);
            assert!(worst <= error, "{worst} > {error}");
            assert!(worst > error / 8.0 || parameters.len() <= 20, "{} points give {worst}", parameters.len());
        }
    }
    // A circle of 50 mm at 0.01 mm needs 158 chords; halving takes up to twice as many.
    assert!((158..=316).contains(&circle(50.0).points_by_chord(0.01).len()));
}

#[test]
fn the_closest_point_of_a_circle_lies_on_the_ray() {
    let (curve, centre) = (circle(50.0), dvec3(3.0, -2.0, 7.0));
    for i in 0..60 {
        let angle = f64::from(i) * 0.11;
        let direction = dvec3(angle.cos(), angle.sin(), 0.0);
        for distance in [1.0, 49.0, 50.0, 51.0, 500.0] {
            let found = curve.closest(centre + direction * distance);
            assert!(found.point.distance(centre + direction * 50.0) < 1e-6, "{distance} {angle}");
            assert_near(found.distance, (distance - 50.0).abs(), 1e-9);
        }
    }
}

#[test]
fn the_closest_point_is_never_farther_than_a_sample() {
    let curve = cubic();
    for i in 0..200 {
        let target = dvec3(f64::from(i % 20) * 3.0 - 10.0, f64::from(i / 20) * 4.0 - 20.0, f64::from(i % 7));
        let found = curve.closest(target);
        let sampled = spread(&curve, 5000).map(|u| curve.point(u).distance(target)).fold(f64::INFINITY, f64::min);
        assert!(found.distance <= sampled + 1e-12, "{target}: {} > {sampled}", found.distance);
        assert!(curve.point(found.parameter).distance(found.point) < 1e-12);
    }
}

#[test]
fn an_interpolating_cubic_meets_its_points() {
    let points: Vec<DVec3> =
        (0..40).map(|i| f64::from(i) * 0.3).map(|t| dvec3(20.0 * t.cos(), 15.0 * t.sin(), t * t)).collect();
    for count in [2, 3, 4, 5, 40] {
        let curve = Nurbs::interpolated(&points[..count], false).unwrap();
        for point in &points[..count] {
            assert!(curve.closest(*point).distance < 1e-10, "{count} points");
        }
        assert_eq!(curve.degree(), (count - 1).min(3));
    }
}

#[test]
fn a_closed_cubic_is_smooth_over_its_seam() {
    for count in [3, 4, 5, 6, 7, 8, 36] {
        let angle = |i: u32| f64::from(i) / f64::from(count) * TAU;
        let points: Vec<DVec3> = (0..count).map(|i| dvec3(30.0 * angle(i).cos(), 30.0 * angle(i).sin(), 5.0)).collect();
        let curve = Nurbs::interpolated(&points, true).unwrap();
        assert!(points.iter().all(|p| curve.closest(*p).distance < 1e-10), "{count} points");
        let (start, end) = curve.domain();
        let ends = [curve.derivatives(start), curve.derivatives(end)];
        assert!(
            curve.is_closed() && (0..3).all(|k| ends[0][k].distance(ends[1][k]) < 1e-9),
            "{count} points: {ends:?}"
        );
        if count == 36 {
            assert_near(curve.length(), TAU * 30.0, 2e-3);
            assert!(spread(&curve, 500).all(|u| ((curve.point(u) - DVec3::Z * 5.0).length() - 30.0).abs() < 1e-3));
        }
    }
}

#[test]
fn a_fit_keeps_the_error_with_few_knots() {
    let wave = |t: f64| dvec3(100.0 * t, 20.0 * (4.0 * t).sin(), 10.0 * t * t);
    let points: Vec<DVec3> = (0..=400).map(|i| wave(f64::from(i) / 400.0)).collect();
    for (error, most) in [(1.0, 10), (0.1, 15), (0.01, 25), (1e-3, 40)] {
        let fit = Nurbs::fitted(&points, false, error).unwrap();
        let farthest = points.iter().map(|p| fit.curve.closest(*p).distance).fold(0.0, f64::max);
        assert!(fit.error <= error && farthest <= fit.error + 1e-12);
        let control = fit.curve.control_points();
        assert!(control.len() <= most, "{} control points for {error}", control.len());
        assert_eq!((control[0], control[control.len() - 1]), (points[0], points[400]));
        // Between the points, too, it stays near the true shape.
        assert!((0..4000).all(|i| fit.curve.closest(wave(f64::from(i) / 4000.0)).distance < 1.5 * error));
    }
}

#[test]
fn a_closed_fit_is_smooth_and_within_the_error() {
    let blob = |t: f64| (50.0 + 6.0 * (3.0 * t).cos()) * dvec3(t.cos(), t.sin(), 0.1);
    let mut points: Vec<DVec3> = (0..300).map(|i| blob(f64::from(i) / 300.0 * TAU)).collect();
    let fit = Nurbs::fitted(&points, true, 0.01).unwrap();
    assert!(fit.error <= 0.01 && fit.curve.control_points().len() < 45, "{}", fit.curve.control_points().len());
    let (start, end) = fit.curve.domain();
    for (a, b) in fit.curve.derivatives(start).into_iter().zip(fit.curve.derivatives(end)) {
        assert!(a.distance(b) < 1e-9);
    }
    points.push(points[0]);
    assert_eq!(Nurbs::fitted(&points, true, 0.01).unwrap(), fit, "a repeated first point changes nothing");
}

#[test]
fn a_corner_is_met_in_the_end() {
    let points: Vec<DVec3> = (0..=40).map(|i| dvec3(f64::from(i.min(20)), f64::from((i - 20).max(0)), 0.0)).collect();
    let fit = Nurbs::fitted(&points, false, 1e-3).unwrap();
    assert!(fit.error <= 1e-3 && points.iter().all(|p| fit.curve.closest(*p).distance <= 1e-3));
    // With some tolerance the knots gather at the corner.
    assert!(Nurbs::fitted(&points, false, 0.1).unwrap().curve.control_points().len() <= 20);
}

#[test]
fn unclamped_knots_are_evaluated_as_defined() {
    let curve = Nurbs::new(
        2,
        (0..8).map(f64::from).collect(),
        vec![1.0, 2.0, 0.5, 1.0, 3.0],
        cubic().control_points()[..5].to_vec(),
    );
    let curve = curve.unwrap();
    assert_eq!(curve.domain(), (2.0, 5.0));
    for u in spread(&curve, 100) {
        assert!(curve.point(u).distance(from_definition(&curve, u)) < 1e-12);
    }
    let piece = curve.piece(2.0, 5.0).unwrap();
    assert!(spread(&curve, 100).all(|u| piece.point(u).distance(curve.point(u)) < 1e-12));
    assert_eq!(piece.knots(), [2.0, 2.0, 2.0, 3.0, 4.0, 5.0, 5.0, 5.0]);
}

#[test]
fn reversing_and_moving_change_nothing_else() {
    let place = DAffine3::from_mat3_translation(
        DMat3::from_rotation_x(0.4) * DMat3::from_rotation_z(1.3) * 2.0,
        dvec3(5.0, -3.0, 100.0),
    );
    for curve in [cubic(), circle(20.0)] {
        let (back, moved) = (curve.reversed(), curve.transformed(&place));
        let (start, end) = curve.domain();
        for u in spread(&curve, 60) {
            assert!(back.point(start + end - u).distance(curve.point(u)) < 1e-12);
            assert!(moved.point(u).distance(place.transform_point3(curve.point(u))) < 1e-11);
        }
        assert_near(back.length(), curve.length(), 1e-10 * curve.length());
        assert_near(moved.length(), 2.0 * curve.length(), 1e-10 * curve.length());
        assert!(back.reversed().point(start + 0.3).distance(curve.point(start + 0.3)) < 1e-12);
        let target = dvec3(11.0, -4.0, 2.0);
        assert_near(moved.closest(place.transform_point3(target)).distance, 2.0 * curve.closest(target).distance, 1e-9);
    }
}

#[test]
fn what_is_no_curve_is_refused() {
    let points = || vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    let check = |degree, knots: &[f64], weights: &[f64], points, words: &str| {
        let error = Nurbs::new(degree, knots.to_vec(), weights.to_vec(), points).unwrap_err().to_string();
        assert!(error.contains(words), "{error}");
    };
    let good = [0.0, 0.0, 0.0, 0.5, 1.0, 1.0, 1.0];
    check(0, &good, &[1.0; 4], points(), "degree 0; degrees from 1 to 25");
    check(4, &good, &[1.0; 4], points(), "4 control points; degree 4 takes at least 5");
    check(2, &good[1..], &[1.0; 4], points(), "6 knots where its degree and control points require 7");
    check(2, &good, &[1.0; 3], points(), "3 weights where its degree and control points require 4");
    check(2, &good, &[1.0, 1.0, 0.0, 1.0], points(), "weight 3 of the curve is 0");
    check(2, &[0.0, 0.0, 0.0, f64::NAN, 1.0, 1.0, 1.0], &[1.0; 4], points(), "knot 4 of the curve is not");
    check(2, &[0.0, 0.0, 0.5, 0.4, 1.0, 1.0, 1.0], &[1.0; 4], points(), "knot 4 of the curve (0.4) is smaller");
    check(2, &[1.0; 7], &[1.0; 4], points(), "begins and ends at the same parameter");
    check(1, &[0.0, 0.0, 0.5, 0.5, 1.0, 1.0], &[1.0; 4], points(), "knot 0.5 of the curve occurs 2 times");
    assert!(matches!(Nurbs::fitted(&points(), false, 0.0), Err(CurveError::Tolerance { .. })));
    assert!(matches!(Nurbs::interpolated(&[DVec3::X; 9], false), Err(CurveError::TooFewToFit { points: 1, .. })));
    assert!(matches!(Nurbs::polyline(vec![]), Err(CurveError::TooFewPoints { .. })));
    assert!(matches!(cubic().piece(0.7, 0.7), Err(CurveError::EmptyDomain { .. })));
}

/// Curves of degree 1 to 5 with random knots (some repeated), weights and points.
fn any_curve() -> impl Strategy<Value = Nurbs> {
    (1_usize..=5, 0_usize..6).prop_flat_map(|(degree, more)| {
        let count = degree + 1 + more;
        let steps = prop::collection::vec(prop_oneof![3 => 0.05..2.0, 1 => Just(0.0)], more);
        let points = prop::collection::vec((-50.0..50.0, -50.0..50.0, -50.0..50.0), count);
        let weights = prop::collection::vec(0.2..5.0, count);
        (Just(degree), steps, weights, points).prop_map(|(degree, steps, weights, points)| {
            let mut knots = vec![0.0; degree + 1];
            let mut knot = 0.05;
            for step in steps {
                knots.push(knot);
                // A knot is never repeated more than the degree allows.
                let run = knots.iter().filter(|&&t| t == knot).count();
                knot += if run >= degree { 0.1 } else { step };
            }
            knots.extend(vec![knot + 0.5; degree + 1]);
            let points = points.into_iter().map(DVec3::from).collect();
            Nurbs::new(degree, knots, weights, points).unwrap()
        })
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn evaluation_is_that_of_the_definition(curve in any_curve(), share in 0.0..1.0) {
        let u = curve.domain().1 * share;
        prop_assert!(curve.point(u).distance(from_definition(&curve, u)) < 1e-11);
    }

    #[test]
    fn derivatives_are_those_of_differences(curve in any_curve(), share in 0.0..1.0) {
        let breaks = curve.breaks();
        for span in breaks.windows(2) {
            let width = span[1] - span[0];
            let (u, h) = (span[0] + width * (0.1 + 0.8 * share), 1e-5 * width);
            let [_, d, dd] = curve.derivatives(u);
            let difference = (curve.point(u + h) - curve.point(u - h)) / (2.0 * h);
            let second = (curve.derivative(u + h) - curve.derivative(u - h)) / (2.0 * h);
            prop_assert!(d.distance(difference) <= 1e-6 * (d.length() + dd.length() * width + 100.0 / width));
            prop_assert!(dd.distance(second) <= 1e-6 * (dd.length() + d.length() / width + 100.0 / width / width));
        }
    }

    #[test]
    fn a_piece_is_the_same_curve(curve in any_curve(), a in 0.0..1.0, b in 0.0..1.0) {
        let end = curve.domain().1;
        let (from, to) = (end * f64::min(a, b), end * f64::max(a, b));
        prop_assume!(to - from > 1e-3);
        let piece = curve.piece(from, to).unwrap();
        prop_assert_eq!(piece.domain(), (from, to));
        for u in spread(&piece, 20) {
            prop_assert!(piece.point(u).distance(curve.point(u)) < 1e-9);
        }
        let lengths = curve.arc_length();
        prop_assert!((piece.length() - (lengths.at(to) - lengths.at(from))).abs() < 1e-8 * lengths.total());
    }

    #[test]
    fn fits_meet_their_points(
        points in prop::collection::vec((-50.0..50.0, -50.0..50.0, -5.0..5.0), 3..30),
        closed in any::<bool>(),
        error in 0.01..10.0,
    ) {
        let points: Vec<DVec3> = points.into_iter().map(DVec3::from).collect();
        let fit = Nurbs::fitted(&points, closed, error).unwrap();
        prop_assert!(fit.error <= error);
        prop_assert!(points.iter().all(|p| fit.curve.closest(*p).distance <= error + 1e-9));
    }
}

#[test]
fn a_quarter_circle_has_the_textbook_weights() {
    let arc = Nurbs::arc(DVec3::ZERO, DVec3::X, DVec3::Y, 0.0, FRAC_PI_2).unwrap();
    assert_near(arc.weights()[1], SQRT_2 / 2.0, 1e-15);
    assert!(arc.control_points()[1].distance(dvec3(1.0, 1.0, 0.0)) < 1e-15);
}
