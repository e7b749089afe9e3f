//! A linear axis under the robot (track, carriage): the one position, for the whole program, that gives the robot the
//! greatest margin.
//!
//! The controller includes the axis in its kinematics, so the positions in the program stay as they are.

use crate::cell::{Cell, LinearAxis, PartPlace};
use crate::suggest::best;
use crate::track::Track;
use glam::DVec3;
use serde::Serialize;

/// Most positions tried …
const MOST: f64 = 200.0;

/// … at least this far apart, mm.
const STEP: f64 = 50.0;

/// A robot at one position of its linear axis.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Station {
    /// Position of the axis, mm: `program.linear_axis`.
    pub position: f64,
    /// Position of the part relative to the robot's foot there.
    pub place: PartPlace,
    /// Least margin of the points examined, °.
    pub margin: f64,
    /// Least margin of these points with the axis at 0, °; `None` if some are out of reach.
    pub at_zero: Option<f64>,
}

impl Station {
    /// The cell as seen by the robot from there: part and table are elsewhere.
    pub(crate) fn seen(&self, cell: &Cell) -> Cell {
        let mut cell = cell.clone();
        let Some(axis) = &cell.linear_axis else { return cell };
        cell.part = axis.seen(cell.part, self.position);
        if let Some(table) = &mut cell.table {
            let [x, y, _] = axis.way(self.position).to_array();
            table.axis = [table.axis[0] - x, table.axis[1] - y];
        }
        cell
    }
}

impl LinearAxis {
    /// Displacement of the robot's foot at this `position` of the axis, mm.
    fn way(&self, position: f64) -> DVec3 {
        position * DVec3::from(self.direction).normalize_or_zero()
    }

    /// A part's position as seen by the robot from a position of the axis.
    fn seen(&self, place: PartPlace, position: f64) -> PartPlace {
        PartPlace { position: (DVec3::from(place.position) - self.way(position)).to_array(), ..place }
    }
}

/// The best position of the robot on its linear axis for a part that is at `place` with the axis at 0; `None` without
/// such an axis, or if no position has all points within reach.
pub(crate) fn station(cell: &Cell, place: PartPlace, track: &Track) -> Option<Station> {
    let axis = cell.linear_axis.as_ref()?;
    let [low, high] = axis.limits;
    let step = ((high - low) / MOST).max(STEP);
    let (first, last) = ((low / step).ceil() as i64, (high / step).floor() as i64);
    let positions = (first..=last).map(|k| k as f64 * step);
    let (position, margin, at_zero) = best(cell, track, positions, |position| axis.seen(place, position))?;
    Some(Station { position, place: axis.seen(place, position), margin, at_zero })
}
