//! B-splines from their definition, slow and plain: the judge of the library's evaluation.
#![allow(dead_code, unreachable_pub)]

use beadwright::curve::Nurbs;
use glam::{DVec3, dvec3};

/// `N_{i,p}(u)` by the Cox–de Boor recursion; 0/0 counts as 0. The last span that is not empty includes its end.
pub fn basis(i: usize, p: usize, u: f64, knots: &[f64], end: f64) -> f64 {
    if p == 0 {
        let inside = knots[i] <= u && u < knots[i + 1];
        let at_end = u == end && knots[i] < end && knots[i + 1] == end;
        return f64::from(u8::from(inside || at_end));
    }
    let part = |numerator: f64, denominator: f64, i: usize| {
        if denominator == 0.0 { 0.0 } else { numerator / denominator * basis(i, p - 1, u, knots, end) }
    };
    part(u - knots[i], knots[i + p] - knots[i], i) + part(knots[i + p + 1] - u, knots[i + p + 1] - knots[i + 1], i + 1)
}

/// The point of a curve from the sum over all control points.
pub fn from_definition(curve: &Nurbs, u: f64) -> DVec3 {
    let (mut point, mut sum) = (DVec3::ZERO, 0.0);
    for (i, (p, w)) in curve.control_points().iter().zip(curve.weights()).enumerate() {
        let share = w * basis(i, curve.degree(), u, curve.knots(), curve.domain().1);
        point += *p * share;
        sum += share;
    }
    point / sum
}

/// A cubic in space with uneven knots.
pub fn cubic() -> Nurbs {
    let points =
        [[0.0, 0.0, 0.0], [10.0, 20.0, 1.0], [25.0, -15.0, 3.0], [30.0, 10.0, 2.0], [45.0, 5.0, 6.0], [50.0, 0.0, 0.0]];
    let knots = vec![0.0, 0.0, 0.0, 0.0, 0.3, 0.7, 1.0, 1.0, 1.0, 1.0];
    Nurbs::new(3, knots, vec![1.0; 6], points.map(|[x, y, z]| dvec3(x, y, z)).to_vec()).unwrap()
}
