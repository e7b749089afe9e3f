//! All splines of one degree over given knots, open or closed, and the one nearest to given points.

use super::banded::Banded;
use super::{CurveError, Nurbs};
use glam::DVec3;

/// The highest degree of a fitted curve.
const CUBIC: usize = 3;

/// Splines up to cubics over the knots; an open space is clamped, a closed one is smooth across the seam.
pub(super) struct SplineSpace {
    degree: usize,
    knots: Vec<f64>,
    /// Number of free control points; a closed curve repeats the first of them at its end.
    unknowns: usize,
    is_closed: bool,
}

/// The basis functions that are not zero at a parameter: number of the first, and their values.
type Row = (usize, [f64; CUBIC + 1]);

impl SplineSpace {
    /// Clamped at both ends of `breaks`, which must increase.
    pub(super) fn open(degree: usize, breaks: &[f64]) -> Self {
        let (first, last) = (breaks[0], breaks[breaks.len() - 1]);
        let end = |value| std::iter::repeat_n(value, degree);
        let knots: Vec<f64> = end(first).chain(breaks.iter().copied()).chain(end(last)).collect();
        Self { degree, unknowns: knots.len() - degree - 1, knots, is_closed: false }
    }

    /// Periodic cubics over `breaks`, which must increase; at least three spans.
    pub(super) fn closed(breaks: &[f64]) -> Self {
        let (spans, degree) = (breaks.len() - 1, CUBIC);
        let period = breaks[spans] - breaks[0];
        let before = (0..degree).map(|i| breaks[spans - degree + i] - period);
        let behind = (0..degree).map(|i| breaks[1 + i] + period);
        let knots = before.chain(breaks.iter().copied()).chain(behind).collect();
        Self { degree, knots, unknowns: spans, is_closed: true }
    }

    /// Values of the basis at `u` (Piegl & Tiller, A2.2).
    fn row(&self, u: f64) -> Row {
        let (p, knots) = (self.degree, &self.knots);
        let inner = &knots[p..knots.len() - p];
        let below = inner.partition_point(|&t| t <= u).min(inner.partition_point(|&t| t < inner[inner.len() - 1]));
        let span = p + below.max(1) - 1;
        let mut values = [1.0, 0.0, 0.0, 0.0];
        for round in 1..=p {
            let mut carried = 0.0;
            for (r, value) in values.iter_mut().enumerate().take(round) {
                let (right, left) = (knots[span + r + 1] - u, u - knots[span + 1 + r - round]);
                let share = *value / (right + left);
                *value = carried + right * share;
                carried = left * share;
            }
            values[round] = carried;
        }
        (span - p, values)
    }

    /// The spline nearest to `points` at `parameters` by least squares; an open one keeps the first and the last point.
    /// `None` when the points do not determine it.
    pub(super) fn nearest(&self, parameters: &[f64], points: &[DVec3]) -> Option<Result<Nurbs, CurveError>> {
        let rows: Vec<Row> = parameters.iter().map(|&u| self.row(u)).collect();
        let mut control = vec![DVec3::ZERO; self.unknowns];
        if !self.is_closed {
            control[0] = points[0];
            control[self.unknowns - 1] = points[points.len() - 1];
        }
        let free = self.unknowns - 2 * self.fixed();
        if free > 0 {
            let factored = self.normal_equations(&rows, free).factored()?;
            // The second round removes the rounding error of the normal equations.
            for _ in 0..2 {
                let change = factored.solve(&self.right_side(&rows, points, &control, free));
                control[self.fixed()..].iter_mut().zip(change).for_each(|(c, d)| *c += d);
            }
        }
        Some(self.curve(control))
    }

    /// Number of fixed control points at each end.
    fn fixed(&self) -> usize {
        usize::from(!self.is_closed)
    }

    fn normal_equations(&self, rows: &[Row], free: usize) -> Banded {
        let border = if !self.is_closed { 0 } else { self.degree.min(free) };
        // With so few unknowns the band would wrap onto itself.
        let border = if self.is_closed && free <= 2 * self.degree { free } else { border };
        let mut system = Banded::new(free, self.degree, border);
        for row in rows {
            for a in 0..=self.degree {
                for b in 0..=a {
                    if let (Some(i), Some(j)) = (self.column(row, a), self.column(row, b)) {
                        // Two that meet again over the seam of a very short closed curve count twice.
                        let times = if i == j && a != b { 2.0 } else { 1.0 };
                        system.add(i, j, times * row.1[a] * row.1[b]);
                    }
                }
            }
        }
        system
    }

    /// The differences between the points and the curve over `control`, projected onto the basis.
    fn right_side(&self, rows: &[Row], points: &[DVec3], control: &[DVec3], free: usize) -> Vec<DVec3> {
        let mut right = vec![DVec3::ZERO; free];
        for (row, &point) in rows.iter().zip(points) {
            let rest = point - self.value(row, control);
            for a in 0..=self.degree {
                if let Some(i) = self.column(row, a) {
                    right[i] += rest * row.1[a];
                }
            }
        }
        right
    }

    fn value(&self, row: &Row, control: &[DVec3]) -> DVec3 {
        (0..=self.degree).map(|a| control[(row.0 + a) % self.unknowns] * row.1[a]).sum()
    }

    /// Index of the unknown for basis function `a` of a row; `None` for a fixed end.
    fn column(&self, row: &Row, a: usize) -> Option<usize> {
        let index = (row.0 + a) % self.unknowns;
        let free = self.unknowns - 2 * self.fixed();
        index.checked_sub(self.fixed()).filter(|&i| i < free)
    }

    fn curve(&self, mut control: Vec<DVec3>) -> Result<Nurbs, CurveError> {
        if self.is_closed {
            control.extend_from_within(..self.degree);
        }
        Nurbs::new(self.degree, self.knots.clone(), vec![1.0; control.len()], control)
    }
}
