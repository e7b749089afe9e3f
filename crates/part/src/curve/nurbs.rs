//! The rational B-spline curve.

use super::CurveError;
use glam::{DAffine3, DVec3};
use serde::{Deserialize, Serialize};

/// The highest degree supported; drawing programs write at most 25.
pub const MAX_DEGREE: usize = 25;

/// Ends nearer than this fraction of the curve's extent are one point.
const CLOSED: f64 = 1e-9;

/// A rational B-spline curve: `C(u) = Σ N_i(u) w_i P_i / Σ N_i(u) w_i` (Li et al., eq 1).
///
/// The knots may be any non-decreasing ones, clamped or not; the curve runs over [`Nurbs::domain`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Nurbs {
    pub(super) degree: usize,
    pub(super) knots: Vec<f64>,
    pub(super) weights: Vec<f64>,
    pub(super) points: Vec<DVec3>,
}

impl Nurbs {
    /// A curve from its degree p, n + p + 1 knots, n weights and n control points (mm).
    ///
    /// # Errors
    /// [`CurveError`] when the lengths of the lists do not match, a value is not finite, knots decrease, a weight is
    /// not above 0, or an inner knot is repeated more than p times (the curve would break there).
    pub fn new(degree: usize, knots: Vec<f64>, weights: Vec<f64>, points: Vec<DVec3>) -> Result<Self, CurveError> {
        let curve = Self { degree, knots, weights, points };
        curve.check_counts()?;
        curve.check_values()?;
        curve.check_knots()?;
        Ok(curve)
    }

    fn check_counts(&self) -> Result<(), CurveError> {
        let (degree, points) = (self.degree, self.points.len());
        if !(1..=MAX_DEGREE).contains(&degree) {
            return Err(CurveError::Degree { degree });
        }
        if points <= degree {
            return Err(CurveError::TooFewPoints { points, degree });
        }
        let lists = [("knots", self.knots.len(), points + degree + 1), ("weights", self.weights.len(), points)];
        match lists.into_iter().find(|(_, found, expected)| found != expected) {
            Some((what, found, expected)) => Err(CurveError::Count { what, found, expected }),
            None => Ok(()),
        }
    }

    fn check_values(&self) -> Result<(), CurveError> {
        let not_finite = |what, index: usize| CurveError::NotFinite { what, index: index + 1 };
        if let Some(i) = self.knots.iter().position(|v| !v.is_finite()) {
            return Err(not_finite("knot", i));
        }
        if let Some(i) = self.weights.iter().position(|v| !v.is_finite()) {
            return Err(not_finite("weight", i));
        }
        if let Some(i) = self.points.iter().position(|p| !p.is_finite()) {
            return Err(not_finite("control point", i));
        }
        match self.weights.iter().position(|&w| w <= 0.0) {
            Some(i) => Err(CurveError::Weight { index: i + 1, weight: self.weights[i] }),
            None => Ok(()),
        }
    }

    fn check_knots(&self) -> Result<(), CurveError> {
        if let Some(i) = self.knots.windows(2).position(|w| w[1] < w[0]) {
            return Err(CurveError::KnotOrder { index: i + 2, knot: self.knots[i + 1] });
        }
        let (start, end) = self.domain();
        if start >= end {
            return Err(CurveError::EmptyDomain { start });
        }
        let mut runs = self.knots.chunk_by(|a, b| a == b);
        match runs.find(|run| run.len() > self.degree && run[0] > start && run[0] < end) {
            Some(run) => Err(CurveError::KnotRepeated { knot: run[0], times: run.len(), degree: self.degree }),
            None => Ok(()),
        }
    }

    /// Polynomial degree of the pieces.
    pub fn degree(&self) -> usize {
        self.degree
    }

    /// The knots, non-decreasing.
    pub fn knots(&self) -> &[f64] {
        &self.knots
    }

    /// A weight for each control point, above 0.
    pub fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// The control points, mm.
    pub fn control_points(&self) -> &[DVec3] {
        &self.points
    }

    /// First and last parameter.
    pub fn domain(&self) -> (f64, f64) {
        (self.knots[self.degree], self.knots[self.points.len()])
    }

    /// The different knots of the domain, both ends included: between two of them the curve is smooth.
    pub fn breaks(&self) -> Vec<f64> {
        let mut breaks = self.knots[self.degree..=self.points.len()].to_vec();
        breaks.dedup();
        breaks
    }

    /// Whether the weights differ.
    pub fn is_rational(&self) -> bool {
        self.weights.iter().any(|&w| w != self.weights[0])
    }

    /// Whether the curve ends where it begins (within 1e-9 of its extent).
    pub fn is_closed(&self) -> bool {
        let (start, end) = self.domain();
        self.point(start).distance(self.point(end)) <= CLOSED * self.extent()
    }

    /// Diagonal of the box around the control points, mm; the curve lies inside that box.
    pub fn extent(&self) -> f64 {
        let (low, high) = self.bounds();
        low.distance(high)
    }

    /// Lowest and highest coordinates of the control points, mm; the curve lies between them.
    pub fn bounds(&self) -> (DVec3, DVec3) {
        self.points.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), &p| (low.min(p), high.max(p)))
    }

    /// Largest absolute coordinate of the control points, mm.
    pub(super) fn reach(&self) -> f64 {
        let (low, high) = self.bounds();
        low.abs().max(high.abs()).max_element()
    }

    /// The same curve run backwards, over the same domain when its knots are clamped.
    pub fn reversed(&self) -> Self {
        let sum = self.knots[0] + self.knots[self.knots.len() - 1];
        Self {
            degree: self.degree,
            knots: self.knots.iter().rev().map(|t| sum - t).collect(),
            weights: self.weights.iter().rev().copied().collect(),
            points: self.points.iter().rev().copied().collect(),
        }
    }

    /// The curve moved, turned or scaled; exact, as affine maps keep a NURBS.
    pub fn transformed(&self, place: &DAffine3) -> Self {
        let points = self.points.iter().map(|&p| place.transform_point3(p)).collect();
        Self { points, ..self.clone() }
    }
}
