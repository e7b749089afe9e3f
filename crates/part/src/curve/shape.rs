//! Exact curves of simple shapes.

use super::{CurveError, Nurbs};
use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, TAU};

impl Nurbs {
    /// The straight line from `a` to `b`, mm, over the parameters 0 to 1.
    ///
    /// # Errors
    /// [`CurveError::NotFinite`].
    pub fn line(a: DVec3, b: DVec3) -> Result<Self, CurveError> {
        Self::new(1, vec![0.0, 0.0, 1.0, 1.0], vec![1.0; 2], vec![a, b])
    }

    /// Straight lines through `points`, mm; the parameter is the point's number, from 0.
    ///
    /// # Errors
    /// [`CurveError::TooFewPoints`] for fewer than two, [`CurveError::NotFinite`].
    pub fn polyline(points: Vec<DVec3>) -> Result<Self, CurveError> {
        let last = points.len().saturating_sub(1) as f64;
        let inner = (0..points.len()).map(|i| i as f64);
        let knots = std::iter::once(0.0).chain(inner).chain([last]).collect();
        Self::new(1, knots, vec![1.0; points.len()], points)
    }

    /// The arc `centre + u cos θ + v sin θ` for θ from `start` over `sweep` (rad, at most one turn; negative runs
    /// backwards), as a rational quadratic. With `u` and `v` of equal length and at right angles it is circular,
    /// otherwise elliptical. The domain is 0 to |sweep|; where its pieces join, the parameter is the angle from the
    /// start.
    ///
    /// # Errors
    /// [`CurveError`] when a value is not finite or `sweep` is 0.
    pub fn arc(centre: DVec3, u: DVec3, v: DVec3, start: f64, sweep: f64) -> Result<Self, CurveError> {
        let sweep = sweep.clamp(-TAU, TAU);
        let pieces = (sweep.abs() / FRAC_PI_2 - 1e-9).ceil().max(1.0) as usize;
        let half = sweep / pieces as f64 / 2.0;
        let at = |i: usize| {
            let angle = start + half * i as f64;
            (u * angle.cos() + v * angle.sin()) / if i % 2 == 1 { half.cos() } else { 1.0 }
        };
        let mut points: Vec<DVec3> = (0..=2 * pieces).map(|i| centre + at(i)).collect();
        if sweep.abs() == TAU {
            // The sine of a whole turn is not quite 0; the ends are the same point.
            points[2 * pieces] = points[0];
        }
        let weights = (0..=2 * pieces).map(|i| if i % 2 == 1 { half.cos() } else { 1.0 }).collect();
        let joint = |i: usize| sweep.abs() * i as f64 / pieces as f64;
        let inner = (0..=pieces).flat_map(|i| [joint(i); 2]);
        let knots = std::iter::once(0.0).chain(inner).chain([sweep.abs()]).collect();
        Self::new(2, knots, weights, points)
    }

    /// The circle about `centre` with half axes `u` and `v`, mm.
    ///
    /// ```
    /// use bead_part::curve::Nurbs;
    /// use glam::DVec3;
    /// use std::f64::consts::TAU;
    ///
    /// let circle = Nurbs::circle(DVec3::ZERO, DVec3::X * 10.0, DVec3::Y * 10.0)?;
    /// assert!(circle.is_closed());
    /// assert!((circle.length() - TAU * 10.0).abs() < 1e-6);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`CurveError::NotFinite`].
    pub fn circle(centre: DVec3, u: DVec3, v: DVec3) -> Result<Self, CurveError> {
        Self::arc(centre, u, v, 0.0, TAU)
    }

    /// The conic from `a` to `b` whose tangents meet in `corner`: an ellipse's arc for a `weight` below 1, a
    /// parabola's at 1, a hyperbola's above. Points in mm.
    ///
    /// # Errors
    /// [`CurveError`] when a value is not finite or the weight is not above 0.
    pub fn conic(a: DVec3, corner: DVec3, b: DVec3, weight: f64) -> Result<Self, CurveError> {
        Self::new(2, vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0], vec![1.0, weight, 1.0], vec![a, corner, b])
    }
}
