//! External axes that stand still during the program: for each the one value that gives the robot the most margin.

use super::cell::{Cell, PartPlace};
use super::linear_axis::{Station, station};
use super::suggest::{WORTH_MOVING, outermost, rate};
use super::table::{TableAngle, turn_table};
use super::track::Track;
use super::turn::ANGLES;
use rayon::prelude::*;

/// A cell with its external axes where they stand for a program.
#[derive(Debug, Clone, PartialEq)]
pub struct External {
    /// The cell as the robot sees it from there.
    pub cell: Cell,
    /// Where the part lies, seen from the robot's foot.
    pub place: PartPlace,
    /// The linear axis under the robot, if there is one from which it reaches the part.
    pub station: Option<Station>,
    /// The table under the part, likewise.
    pub table: Option<TableAngle>,
}

/// Where the external axes of a cell stand best for a part that lies at `place` while they show 0: first the linear axis
/// under the robot, then the table.
pub fn external_axes(cell: &Cell, place: PartPlace, track: &Track) -> External {
    let station = station(cell, place, track);
    let (cell, place) =
        station.as_ref().map_or_else(|| (cell.clone(), place), |station| (station.seen(cell), station.place));
    let table = turn_table(&cell, place, track);
    let place = table.map_or(place, |table| table.place);
    External { cell, place, station, table }
}

/// The best of some values for an axis that brings the part to a place, its margin (°), and that of the value 0, `None` where
/// some points are out of reach there. They are judged by the outermost points of a few layers. 0 is kept unless another
/// value gains enough, and the smallest wins among equals. `None` where no value brings all points within reach.
pub(super) fn best(
    cell: &Cell,
    track: &Track,
    values: impl Iterator<Item = f64>,
    place_at: impl Fn(f64) -> PartPlace + Sync,
) -> Option<(f64, f64, Option<f64>)> {
    let points = outermost(track);
    let (arm, tool_from_flange) = (cell.arm(), cell.flange_from_tool().inverse());
    let margin =
        |value: f64| rate(&arm, &tool_from_flange, place_at(value), &points, ANGLES).map(|found| (value, found.margin));
    let mut values: Vec<f64> = values.collect();
    values.sort_by(|a, b| a.abs().total_cmp(&b.abs()).then(b.total_cmp(a)));
    let judged: Vec<Option<(f64, f64)>> = values.into_par_iter().map(margin).collect();
    let at_zero = judged.iter().flatten().find(|(value, _)| *value == 0.0).map(|(_, margin)| *margin);
    let (value, margin) = judged.into_iter().flatten().rev().max_by(|a, b| a.1.total_cmp(&b.1))?;
    match at_zero {
        Some(now) if margin - now < WORTH_MOVING => Some((0.0, now, at_zero)),
        _ => Some((value, margin, at_zero)),
    }
}
