//! Knot insertion (W. Boehm, "Inserting new knots into B-spline curves", CAD 12, 1980) and pieces of curves.

use super::{CurveError, Nurbs};
use glam::DVec4;

/// Ends nearer to a knot than this fraction of the domain are moved onto the knot.
const SAME: f64 = 1e-12;

impl Nurbs {
    /// The same curve with one more knot at `u`, inside the domain.
    fn with_knot(&self, u: f64) -> Self {
        let (u, span) = self.place(u);
        let degree = self.degree;
        let point = |i: usize| -> DVec4 {
            if i + degree <= span {
                self.homogeneous_point(i)
            } else if i > span {
                self.homogeneous_point(i - 1)
            } else {
                let share = (u - self.knots[i]) / (self.knots[i + degree] - self.knots[i]);
                self.homogeneous_point(i - 1).lerp(self.homogeneous_point(i), share)
            }
        };
        let all: Vec<DVec4> = (0..=self.points.len()).map(point).collect();
        let mut knots = self.knots.clone();
        knots.insert(span + 1, u);
        let points = all.iter().map(|p| p.truncate() / p.w).collect();
        Self { degree, knots, weights: all.iter().map(|p| p.w).collect(), points }
    }

    /// The part of the curve between two parameters, clamped at both; exact.
    ///
    /// # Errors
    /// [`CurveError::EmptyDomain`] when nothing of the domain lies between them.
    pub fn piece(&self, from: f64, to: f64) -> Result<Self, CurveError> {
        let (from, to) = (self.near_knot(from), self.near_knot(to));
        if from.partial_cmp(&to) != Some(std::cmp::Ordering::Less) {
            return Err(CurveError::EmptyDomain { start: from });
        }
        let curve = self.with_multiple_knot(from).with_multiple_knot(to);
        let (degree, knots) = (self.degree, &curve.knots);
        // From the last knot at the start to the first at the end: the piece lies between them.
        let first = knots.partition_point(|&t| t <= from) - 1;
        let last = knots.partition_point(|&t| t < to);
        let (low, high) = (first - degree, last);
        let end = |value| std::iter::repeat_n(value, degree + 1);
        Self::new(
            degree,
            end(from).chain(knots[first + 1..last].iter().copied()).chain(end(to)).collect(),
            curve.weights[low..high].to_vec(),
            curve.points[low..high].to_vec(),
        )
    }

    /// Inserts `u` until it occurs as often as the degree: the curve then passes through a control point.
    fn with_multiple_knot(&self, u: f64) -> Self {
        let mut curve = self.clone();
        let there = self.knots.iter().filter(|&&t| t == u).count();
        for _ in there..self.degree {
            curve = curve.with_knot(u);
        }
        curve
    }

    /// `u` clamped to the domain and moved onto an almost equal knot.
    fn near_knot(&self, u: f64) -> f64 {
        let (start, end) = self.domain();
        let u = u.clamp(start, end);
        let near = self.breaks().into_iter().find(|t| (t - u).abs() <= SAME * (end - start));
        near.unwrap_or(u)
    }
}
