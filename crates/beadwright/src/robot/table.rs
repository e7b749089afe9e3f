//! A turn table under the part: the one angle, for the whole program, that gives the robot the most margin.
//!
//! The part's frame turns with the table, as a base on external kinematics does, so the positions in the program stay
//! as they are. Angles are judged like places of the part (`suggest`): by the outermost points of a few layers.

use super::cell::{Cell, PartPlace};
use super::suggest::{WORTH_MOVING, outermost, rate};
use super::track::Track;
use rayon::prelude::*;
use serde::Serialize;

/// Angles that are tried, °: whole multiples of this within the table's limits.
const STEP: f64 = 5.0;

/// A table at one angle.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct TableAngle {
    /// Angle that the table shows, °: `program.table_angle`.
    pub angle: f64,
    /// Where the part lies at that angle.
    pub place: PartPlace,
    /// Least margin of the points examined, °.
    pub margin: f64,
    /// Least margin of these points with the table at 0°; none where some are out of reach.
    pub unturned: Option<f64>,
}

/// The best angle of the cell's table for a part that lies at `place` while the table stands at 0°; `None` without a
/// table, or where no angle brings all points within reach. Turning the table must gain enough to be worth it.
pub fn turn_table(cell: &Cell, place: PartPlace, track: &Track) -> Option<TableAngle> {
    let table = cell.table.as_ref()?;
    let points = outermost(track);
    let (arm, tool_from_flange) = (cell.arm(), cell.flange_from_tool().inverse());
    let margin = |angle: f64| {
        let turned = place.turned_about(table, angle);
        rate(&arm, &tool_from_flange, turned, &points, super::turn::ANGLES).map(|found| (angle, found.margin))
    };
    let [low, high] = table.limits;
    let steps = (180.0 / STEP) as i32;
    // The smallest turn wins among equals.
    let mut angles: Vec<f64> = (1 - steps..=steps).map(|k| f64::from(k) * STEP).collect();
    angles.sort_by(|a, b| a.abs().total_cmp(&b.abs()).then(b.total_cmp(a)));
    angles.retain(|angle| (low..=high).contains(angle));
    let judged: Vec<Option<(f64, f64)>> = angles.into_par_iter().map(margin).collect();
    let unturned = judged.iter().flatten().find(|(angle, _)| *angle == 0.0).map(|(_, margin)| *margin);
    let best = judged.into_iter().flatten().rev().max_by(|a, b| a.1.total_cmp(&b.1))?;
    let (angle, margin) = match unturned {
        Some(now) if best.1 - now < WORTH_MOVING => (0.0, now),
        _ => best,
    };
    Some(TableAngle { angle, place: place.turned_about(table, angle), margin, unturned })
}
