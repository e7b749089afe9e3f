//! How a scanner looks at the robot: targets whose places both know.

use super::CalibrateError;
use super::place::{Calibrated, Known, Place, fitted};
use glam::{DMat3, DQuat, DVec3};

/// A target.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pair {
    /// In the scanner's frame, mm.
    pub scanned: DVec3,
    /// In the robot's base, mm.
    pub known: DVec3,
}

const REMEDY: &str = "give three targets or more that do not lie on one line.";

/// The scanner's frame in the robot's base.
///
/// # Errors
/// [`CalibrateError`] for fewer than three targets, and for targets on one line.
pub fn scanner(pairs: &[Pair]) -> Result<Calibrated, CalibrateError> {
    if pairs.len() < 3 {
        return Err(CalibrateError::TooFew { what: "targets", given: pairs.len(), needed: 3 });
    }
    let guess = three(pairs).ok_or(CalibrateError::Undetermined(REMEDY))?;
    let known = |pair: &Pair| Known { outside: pair.known, inside: pair.scanned.to_array().map(Some) };
    fitted(guess, &pairs.iter().map(known).collect::<Vec<_>>(), REMEDY)
}

/// The frame that brings three targets far from each other together.
fn three(pairs: &[Pair]) -> Option<Place> {
    let first = pairs.first()?;
    let away = |pair: &&Pair| pair.scanned.distance(first.scanned);
    let far = pairs.iter().max_by(|a, b| away(a).total_cmp(&away(b)))?;
    let beside = |pair: &&Pair| (far.scanned - first.scanned).cross(pair.scanned - first.scanned).length();
    let side = pairs.iter().max_by(|a, b| beside(a).total_cmp(&beside(b)))?;
    let frame = |of: fn(&Pair) -> DVec3| {
        let along = (of(far) - of(first)).try_normalize()?;
        let up = along.cross(of(side) - of(first)).try_normalize()?;
        Some(DMat3::from_cols(along, up.cross(along), up))
    };
    let (scanned, known) = (frame(|pair| pair.scanned)?, frame(|pair| pair.known)?);
    let turn = DQuat::from_mat3(&(known * scanned.transpose())).normalize();
    Some(Place { at: first.known - turn * first.scanned, turn })
}
