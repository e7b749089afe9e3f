//! External axes that do not move during the program: for each the one value that gives the robot the most margin.

use crate::cell::{Cell, PartPlace};
use crate::linear_axis::{Station, station};
use crate::table::{TableAngle, turn_table};
use crate::track::Track;

/// A cell with its external axes set for a program.
#[derive(Debug, Clone, PartialEq)]
pub struct External {
    /// The cell as seen by the robot then.
    pub cell: Cell,
    /// Position of the part relative to the robot's foot.
    pub place: PartPlace,
    /// The position of the linear axis under the robot, if there is one from which the robot reaches the part.
    pub station: Option<Station>,
    /// The angle of the table under the part, if there is one at which the robot reaches the part.
    pub table: Option<TableAngle>,
}

/// The best values of a cell's external axes for a part that is at `place` with the axes at 0: first the linear axis
/// under the robot, then the table.
pub fn external_axes(cell: &Cell, place: PartPlace, track: &Track) -> External {
    let station = station(cell, place, track);
    let (cell, place) =
        station.as_ref().map_or_else(|| (cell.clone(), place), |station| (station.seen(cell), station.place));
    let table = turn_table(&cell, place, track);
    let place = table.map_or(place, |table| table.place);
    External { cell, place, station, table }
}
