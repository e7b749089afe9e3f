//! The wire's tip on the flange: the tip touches one fixed point while the flange stands at several angles.
//!
//! For each pose, `turn · tip + at = point` with the tip and the point unknown: linear in both.

use super::least_squares::Equations;
use super::{CalibrateError, Residuals};
use glam::{DQuat, DVec3};

/// How the flange stands in the robot's base.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Flange {
    /// Its position, mm.
    pub at: DVec3,
    /// Rotation from its directions to those of the base.
    pub turn: DQuat,
}

/// The tip of the wire.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tool {
    /// In the flange's frame, mm.
    pub tip: DVec3,
    /// Half the widths of the intervals that hold its coordinates with 95 % probability, mm.
    pub within: DVec3,
    /// The point that was touched, in the base, mm.
    pub touched: DVec3,
    /// How far each pose misses that point.
    pub residuals: Residuals,
}

const REMEDY: &str = "turn the flange about two different directions, by 30° or more, between the touches.";

/// The tip that touches one point in all these poses.
///
/// ```
/// use bead_robot::calibrate::{Flange, tool};
/// use glam::{DQuat, DVec3};
///
/// let (tip, point) = (DVec3::new(12.0, -3.0, 340.0), DVec3::new(900.0, 50.0, 420.0));
/// let turns = [(0.0, 0.0), (0.5, 0.0), (0.0, 0.6), (-0.4, 0.3), (0.2, -0.5)];
/// let poses = turns.map(|(a, b)| {
///     let turn = DQuat::from_rotation_x(3.0 + a) * DQuat::from_rotation_y(b);
///     Flange { at: point - turn * tip, turn }
/// });
/// let found = tool(&poses)?;
/// assert!(found.tip.distance(tip) < 1e-6 && found.residuals.rms < 1e-6);
/// # Ok::<(), bead_robot::calibrate::CalibrateError>(())
/// ```
///
/// # Errors
/// [`CalibrateError`] for fewer than four poses, and for poses that turn about one direction only.
pub fn tool(poses: &[Flange]) -> Result<Tool, CalibrateError> {
    if poses.len() < 4 {
        return Err(CalibrateError::TooFew { what: "touches", given: poses.len(), needed: 4 });
    }
    // About the middle, so that large numbers do not cancel.
    let middle = poses.iter().map(|pose| pose.at).sum::<DVec3>() / poses.len() as f64;
    let mut equations = Equations::new(6);
    for pose in poses {
        let columns = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| pose.turn * axis);
        for k in 0..3 {
            let mut row = [columns[0][k], columns[1][k], columns[2][k], 0.0, 0.0, 0.0];
            row[3 + k] = -1.0;
            equations.add(&row, middle[k] - pose.at[k]);
        }
    }
    let solution = equations.solve(REMEDY)?;
    let three = |from: usize, of: &[f64]| DVec3::new(of[from], of[from + 1], of[from + 2]);
    let (tip, touched) = (three(0, &solution.values), middle + three(3, &solution.values));
    let missed = poses.iter().map(|pose| (pose.turn * tip + pose.at).distance(touched));
    let residuals = Residuals::of(missed, solution.spare);
    Ok(Tool { tip, within: three(0, &solution.within), touched, residuals })
}
