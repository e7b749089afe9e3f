//! A turn table under the part: the one angle, for the whole program, that gives the robot the greatest margin.
//!
//! The part's frame turns with the table, as a base on external kinematics does, so the positions in the program are
//! unchanged. Angles are judged like positions of the part (`suggest`): by the outermost points of a few layers.

use crate::cell::{Cell, PartPlace};
use crate::suggest::best;
use crate::track::Track;
use serde::Serialize;

/// Angles tried, °: whole multiples of this within the table's limits.
const STEP: f64 = 5.0;

/// A table at one angle.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct TableAngle {
    /// Angle of the table, °: `program.table_angle`.
    pub angle: f64,
    /// Position of the part at that angle.
    pub place: PartPlace,
    /// Least margin of the points examined, °.
    pub margin: f64,
    /// Least margin of these points with the table at 0°, °; `None` if some are out of reach.
    pub unturned: Option<f64>,
}

/// The best angle of the cell's table for a part that is at `place` with the table at 0°; `None` without a table, or if
/// no angle brings all points within reach. The table is turned only if the gain is worthwhile.
pub fn turn_table(cell: &Cell, place: PartPlace, track: &Track) -> Option<TableAngle> {
    let table = cell.table.as_ref()?;
    let [low, high] = table.limits;
    let steps = (180.0 / STEP) as i32;
    let angles = (1 - steps..=steps).map(|k| f64::from(k) * STEP).filter(|angle| (low..=high).contains(angle));
    let turned = |angle: f64| place.turned_about(table, angle);
    let (angle, margin, unturned) = best(cell, track, angles, turned)?;
    Some(TableAngle { angle, place: turned(angle), margin, unturned })
}
