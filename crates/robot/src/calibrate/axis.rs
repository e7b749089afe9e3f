//! The line about which an axis of a positioner turns: one point of the plate, measured at several angles of the axis.
//!
//! `point = centre + across · cos(angle) + beside · sin(angle)` is linear in the three vectors; the direction is square
//! to the last two.

use super::least_squares::Equations;
use super::{CalibrateError, Residuals};
use glam::DVec3;

/// A point at an angle of the axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AtAngle {
    /// As the controller shows it, °.
    pub angle: f64,
    /// Where the point is, mm.
    pub at: DVec3,
}

/// The line about which an axis turns.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TurningAxis {
    /// Unit vector: a growing angle turns counter-clockwise seen against it.
    pub direction: DVec3,
    /// Half the widths of the intervals that hold its components with 95 % probability.
    pub direction_within: DVec3,
    /// The middle of the circle on which the point moves, mm.
    pub centre: DVec3,
    /// The same for its coordinates, mm.
    pub centre_within: DVec3,
    /// Radius of the circle, mm.
    pub radius: f64,
    /// How far each point lies from where its angle puts it.
    pub residuals: Residuals,
}

const REMEDY: &str = "measure at three angles or more, spread over 90° or more, a point that is not on the axis.";
/// The arc must be this wide for a circle, mm.
const LEAST: f64 = 1e-6;

/// The line about which a point turns.
///
/// # Errors
/// [`CalibrateError`] for fewer than three angles, and for points that do not move on an arc.
pub fn axis(points: &[AtAngle]) -> Result<TurningAxis, CalibrateError> {
    if points.len() < 3 {
        return Err(CalibrateError::TooFew { what: "angles", given: points.len(), needed: 3 });
    }
    let middle = points.iter().map(|point| point.at).sum::<DVec3>() / points.len() as f64;
    let mut equations = Equations::new(9);
    for point in points {
        let (sin, cos) = point.angle.to_radians().sin_cos();
        for k in 0..3 {
            let mut row = [0.0; 9];
            (row[k], row[3 + k], row[6 + k]) = (1.0, cos, sin);
            equations.add(&row, point.at[k] - middle[k]);
        }
    }
    let solution = equations.solve(REMEDY)?;
    let three = |from: usize, of: &[f64]| DVec3::new(of[from], of[from + 1], of[from + 2]);
    let [centre, across, beside] = [0, 3, 6].map(|from| three(from, &solution.values));
    let square = across.cross(beside);
    let direction = square.try_normalize().filter(|_| square.length() > LEAST);
    let direction = direction.ok_or(CalibrateError::Undetermined(REMEDY))?;
    // The derivative of a unit vector loses what lies along it.
    let unit = |change: DVec3| change.reject_from_normalized(direction) / square.length();
    let axes = [DVec3::X, DVec3::Y, DVec3::Z];
    let mut derivatives = [[0.0; 9]; 3];
    for (k, e) in axes.into_iter().enumerate() {
        let (by_across, by_beside) = (unit(e.cross(beside)), unit(across.cross(e)));
        for (row, derivative) in derivatives.iter_mut().enumerate() {
            (derivative[3 + k], derivative[6 + k]) = (by_across[row], by_beside[row]);
        }
    }
    let direction_within = DVec3::from_array(derivatives.map(|row| solution.within_of(&row)));
    let placed = |point: &AtAngle| {
        let (sin, cos) = point.angle.to_radians().sin_cos();
        (middle + centre + across * cos + beside * sin).distance(point.at)
    };
    Ok(TurningAxis {
        direction,
        direction_within,
        centre: middle + centre,
        centre_within: three(0, &solution.within),
        radius: (across.length() + beside.length()) / 2.0,
        residuals: Residuals::of(points.iter().map(placed), solution.spare),
    })
}
