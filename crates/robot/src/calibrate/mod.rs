//! Calibration of a cell from measured points: where the wire's tip lies on the flange, where the part lies, about which
//! line an axis of a positioner turns, and how a scanner looks at the robot.
//!
//! Each is a least-squares estimate. What the points leave uncertain is given with it, as half the width of the interval
//! that holds the true value in 95 of 100 calibrations, from the residuals (Student's t).
//!
//! | file | what is measured |
//! | --- | --- |
//! | `tool` | one fixed point, touched from several sides |
//! | `base` | points on the sides of the plate or the part |
//! | `axis` | one point of the plate at several angles of an axis |
//! | `scanner` | targets known to both scanner and robot |
//! | `place` | a place and an orientation that bring points to where they belong |
//! | `least_squares` | the normal equations, and what they leave uncertain |

mod axis;
mod base;
mod least_squares;
mod place;
mod scanner;
mod tool;

pub use axis::{AtAngle, TurningAxis, axis};
pub use base::{Touch, base};
pub use place::{Calibrated, Place};
pub use scanner::{Pair, scanner};
pub use tool::{Flange, Tool, tool};

/// Distances that a calibration leaves between measured points and where it says that they lie.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Residuals {
    /// Root of the mean square of the distances, mm.
    pub rms: f64,
    /// The largest, mm.
    pub worst: f64,
    /// Index of the point that has it.
    pub at: usize,
    /// Measured values beyond those that the unknowns need; with none, nothing is known of the errors.
    pub spare: usize,
}

impl Residuals {
    fn of(distances: impl IntoIterator<Item = f64>, spare: usize) -> Self {
        let distances: Vec<f64> = distances.into_iter().collect();
        let (at, worst) = distances.iter().copied().enumerate().max_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((0, 0.0));
        let squares: f64 = distances.iter().map(|d| d * d).sum();
        Self { rms: (squares / distances.len().max(1) as f64).sqrt(), worst, at, spare }
    }
}

/// Why points do not suffice for a calibration.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum CalibrateError {
    /// Too few points.
    #[error("{given} {what} are too few: give at least {needed}, better twice as many, so that errors can be seen.")]
    TooFew {
        /// What is counted.
        what: &'static str,
        /// How many there are.
        given: usize,
        /// How many are needed.
        needed: usize,
    },
    /// Points that leave something undetermined.
    #[error("the points leave something open: {0}")]
    Undetermined(&'static str),
}
