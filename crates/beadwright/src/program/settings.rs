//! The section `[program]` of a profile.

use crate::limit::{Broken, Limit, limits};
use serde::{Deserialize, Serialize};

/// How paths become moves of a program; every key has a default.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ProgramSettings {
    /// How far the moves may leave the planned path so that they are fewer, mm, 0.015 or more; default 0: every point
    /// is kept.
    pub chord_tolerance: f64,
    /// Whether arcs are fitted, and not straight moves only; default false.
    pub arcs: bool,
    /// Speeds along a pass that differ by no more than this part become one, with the same time along it: fewer changes,
    /// longer moves; default 0.
    pub speed_tolerance: f64,
    /// Least time between two points of a pass, s: nearer ones are merged where that keeps the chord tolerance, since
    /// controllers read ahead only so fast (KRC4 interpolates every 0.012 s); default 0: none are.
    pub min_point_time: f64,
    /// Turn of the torch about its own axis, on top of the orientation in the robot's section, °: counter-clockwise seen from
    /// behind the torch. Robots only; `beadwright reach` tells the best one. Default 0.
    pub torch_angle: f64,
    /// Angle of the turn table under the part, the same for the whole program, °; `beadwright reach` tells the best one. The
    /// part's frame must turn with the table. KRL writes it as E1, RAPID as the first external axis; other posts refuse it.
    /// Left out where there is no table.
    pub table_angle: Option<f64>,
}

impl ProgramSettings {
    /// What the numbers can be; some depend on the width of a bead, mm.
    pub(crate) fn limits(&self, w: f64) -> Vec<Limit> {
        limits! {
            "program.chord_tolerance": self.chord_tolerance, 0.0, 0.5 * w, "mm (at most half a bead width)",
                "rounding takes 0.015 mm; more than half a bead would change the part";
            "program.speed_tolerance": self.speed_tolerance, 0.0, 0.3, "of the speed",
                "the bead's width follows the speed: 30 % is the width of a process window";
            "program.min_point_time": self.min_point_time, 0.0, 1.0, "s", "beyond this the value has no meaning";
            "program.torch_angle": self.torch_angle, -360.0, 360.0, "°", "beyond this the value has no meaning";
            "program.table_angle": self.table_angle.unwrap_or(0.0), -7200.0, 7200.0, "°",
                "beyond this the value has no meaning";
        }
    }

    /// What does not fit together.
    pub(crate) fn broken(&self) -> Option<Broken> {
        let reason = if self.chord_tolerance > 0.0 && self.chord_tolerance < 0.015 {
            "0 keeps every point; else it must be 0.015 mm or more, over the 0.01 mm of the least move."
        } else if self.arcs && self.chord_tolerance == 0.0 {
            "arcs = true needs a tolerance, such as 0.05 mm."
        } else if self.min_point_time > 0.0 && self.chord_tolerance == 0.0 {
            "min_point_time needs a tolerance within which points are merged, such as 0.05 mm."
        } else {
            return None;
        };
        Some(self.broken_tolerance(reason))
    }

    /// The tolerance as a value that cannot be.
    pub(crate) fn broken_tolerance(&self, reason: &str) -> Broken {
        let (key, value) = ("program.chord_tolerance".to_owned(), format!("{}", self.chord_tolerance));
        Broken { key, value, reason: reason.to_owned() }
    }
}
