//! Cubics through points, and cubics near points with as few knots as a tolerance allows.
//!
//! Parameters are chord lengths, so one unit of parameter is about 1 mm of a fitted curve. Interpolation takes the
//! knots of C. de Boor (averages of parameters; Piegl & Tiller 9.2.1), or the parameters themselves on a closed curve.
//! Approximation begins with few knots and halves, by number of points, every span that misses the tolerance.

use super::spline_space::SplineSpace;
use super::{CurveError, Nurbs};
use glam::DVec3;

/// Points nearer than this fraction of their extent are one.
const SAME: f64 = 1e-12;

/// Number of spans in the first attempt on a closed curve, and the fewest points for which it is tried.
const CLOSED_START: usize = 4;
const CLOSED_POINTS: usize = 8;

/// A curve near points.
#[derive(Debug, Clone, PartialEq)]
pub struct Fit {
    /// The curve.
    pub curve: Nurbs,
    /// The largest distance between a point and the curve at that point's parameter, mm; no point is farther from the
    /// curve.
    pub error: f64,
}

impl Nurbs {
    /// The smooth cubic through `points`, mm; with `closed`, it continues from the last to the first without a kink (do
    /// not repeat the first). Three points give a parabola, two a line. Points that repeat the one before count once.
    ///
    /// # Errors
    /// [`CurveError::TooFewToFit`] for fewer than two different points (three for a closed curve),
    /// [`CurveError::NotFinite`].
    pub fn interpolated(points: &[DVec3], closed: bool) -> Result<Self, CurveError> {
        Data::new(points, closed)?.interpolated()
    }

    /// A smooth cubic with few knots that passes within `error` (mm) of all `points`; with `closed`, it continues from
    /// the last to the first without a kink. An open curve begins at the first point and ends at the last. Between
    /// points the curve is unconstrained: give points as densely as the shape must be kept.
    ///
    /// ```
    /// use bead_part::curve::Nurbs;
    /// use glam::{DVec2, DVec3};
    /// use std::f64::consts::FRAC_PI_2;
    ///
    /// // A quarter of a circle.
    /// let angle = |k: i32| FRAC_PI_2 * f64::from(k) / 100.0;
    /// let points: Vec<DVec3> = (0..=100).map(|k| (DVec2::from_angle(angle(k)) * 10.0).extend(0.0)).collect();
    /// let fit = Nurbs::fitted(&points, false, 0.01)?;
    /// assert!(fit.error <= 0.01 && fit.curve.control_points().len() < 20);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`CurveError::Tolerance`] for an `error` not above 0, and those of [`Nurbs::interpolated`].
    pub fn fitted(points: &[DVec3], closed: bool, error: f64) -> Result<Fit, CurveError> {
        if error.is_nan() || error <= 0.0 {
            return Err(CurveError::Tolerance { error });
        }
        Data::new(points, closed)?.fitted(error)
    }
}

/// Points with the parameters at which the curve should meet them.
struct Data {
    /// Different points; the first of a closed curve is not repeated.
    points: Vec<DVec3>,
    /// Chord lengths; a closed curve has one more, for its end.
    parameters: Vec<f64>,
    is_closed: bool,
}

impl Data {
    fn new(given: &[DVec3], is_closed: bool) -> Result<Self, CurveError> {
        if let Some(i) = given.iter().position(|p| !p.is_finite()) {
            return Err(CurveError::NotFinite { what: "point", index: i + 1 });
        }
        let first = given.first().copied().unwrap_or_default();
        let same = SAME * given.iter().map(|p| p.distance(first)).fold(0.0, f64::max);
        let mut points: Vec<DVec3> = Vec::with_capacity(given.len());
        for &point in given {
            if points.last().is_none_or(|last| last.distance(point) > same) {
                points.push(point);
            }
        }
        while is_closed && points.len() > 1 && points[points.len() - 1].distance(first) <= same {
            points.pop();
        }
        let needed = if is_closed { 3 } else { 2 };
        if points.len() < needed {
            return Err(CurveError::TooFewToFit { points: points.len(), needed });
        }
        let ring = points.iter().chain(is_closed.then_some(&points[0]));
        let parameters = ring.scan((points[0], 0.0), |(last, sum), &p| {
            *sum += p.distance(*last);
            *last = p;
            Some(*sum)
        });
        Ok(Self { parameters: parameters.collect(), points, is_closed })
    }

    fn interpolated(&self) -> Result<Nurbs, CurveError> {
        let space = if self.is_closed {
            SplineSpace::closed(&self.parameters)
        } else {
            let degree = (self.points.len() - 1).min(3);
            SplineSpace::open(degree, &self.averaged(degree))
        };
        let parameters = &self.parameters[..self.points.len()];
        // A cubic through the points always exists; only rounding, at wildly uneven spacing, can make it fail.
        space.nearest(parameters, &self.points).unwrap_or_else(|| Nurbs::polyline(self.ring()))
    }

    fn ring(&self) -> Vec<DVec3> {
        self.points.iter().copied().chain(self.is_closed.then_some(self.points[0])).collect()
    }

    /// First parameter, averages of `degree` neighbouring inner parameters, last parameter.
    fn averaged(&self, degree: usize) -> Vec<f64> {
        let (u, last) = (&self.parameters, self.points.len() - 1);
        let inner = u[1..last].windows(degree).map(|w| w.iter().sum::<f64>() / degree as f64);
        std::iter::once(u[0]).chain(inner).chain([u[last]]).collect()
    }

    fn fitted(&self, error: f64) -> Result<Fit, CurveError> {
        let count = self.points.len();
        if count < if self.is_closed { CLOSED_POINTS } else { 4 } {
            return self.exact();
        }
        let mut breaks = if self.is_closed {
            (0..=CLOSED_START).map(|k| self.parameters[k * count / CLOSED_START]).collect()
        } else {
            vec![self.parameters[0], self.parameters[count - 1]]
        };
        while let Some(curve) = self.space(&breaks).nearest(&self.parameters[..count], &self.points) {
            let curve = curve?;
            let misses = self.misses(&curve);
            let worst = misses.iter().copied().fold(0.0, f64::max);
            if worst <= error {
                return Ok(Fit { curve, error: worst });
            }
            if !self.split(&mut breaks, &misses, error) {
                break;
            }
        }
        self.exact()
    }

    fn space(&self, breaks: &[f64]) -> SplineSpace {
        if self.is_closed { SplineSpace::closed(breaks) } else { SplineSpace::open(3, breaks) }
    }

    fn exact(&self) -> Result<Fit, CurveError> {
        let curve = self.interpolated()?;
        let error = self.misses(&curve).into_iter().fold(0.0, f64::max);
        Ok(Fit { curve, error })
    }

    /// Distance of each point from the curve at its parameter, mm.
    fn misses(&self, curve: &Nurbs) -> Vec<f64> {
        // A polyline, the last resort of interpolation, has parameters of its own but passes through the points.
        if curve.degree() == 1 {
            return vec![0.0; self.points.len()];
        }
        self.points.iter().zip(&self.parameters).map(|(p, &u)| p.distance(curve.point(u))).collect()
    }

    /// Halves the spans that miss the tolerance and hold enough points; returns whether any was halved.
    fn split(&self, breaks: &mut Vec<f64>, misses: &[f64], error: f64) -> bool {
        let before = breaks.len();
        let mut added = Vec::new();
        for span in breaks.windows(2) {
            let within = |u: f64| self.parameters[..self.points.len()].partition_point(|&t| t < u);
            let (low, high) = (within(span[0]), within(span[1]));
            let middle = (low + high) / 2;
            if high >= low + 2 && misses[low..high].iter().any(|&miss| miss > error) {
                added.push((self.parameters[middle - 1] + self.parameters[middle]) / 2.0);
            }
        }
        breaks.extend(added);
        breaks.sort_by(f64::total_cmp);
        breaks.len() > before
    }
}
