//! The section `[program]` of a profile.

use super::Positioner;
use bead_plan::limit::{Broken, Limit, limits};
use serde::{Deserialize, Serialize};

/// How paths become moves of a program; every key has a default.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ProgramSettings {
    /// How far moves may deviate from the planned path so that fewer are needed, mm, 0.015 or more; default 0: every
    /// point is kept.
    pub chord_tolerance: f64,
    /// Whether circular arcs are fitted as well as straight moves; default false.
    pub arcs: bool,
    /// Neighbouring speeds along a pass that differ by no more than this fraction become one speed that takes the same
    /// time, which gives fewer changes and longer moves; default 0.
    pub speed_tolerance: f64,
    /// Minimum time between two points of a pass, s: points that follow faster are merged where `chord_tolerance`
    /// allows it, since controllers read ahead only so fast (KRC4 interpolates every 0.012 s); default 0: no points are
    /// merged.
    pub min_point_time: f64,
    /// Rotation of the torch about its own axis, in addition to the orientation in the robot's section, °;
    /// counter-clockwise as seen from behind the torch. Robots only; `beadwright reach` finds the best angle. Default
    /// 0.
    pub torch_angle: f64,
    /// Position of the robot on its linear axis (track), the same for the whole program, mm; `beadwright reach` finds the best
    /// position. The controller must include the axis in its kinematics, so that the part's frame stays where it is. KRL writes
    /// it as E1, RAPID as the first external axis, and a turn table then as the second; other posts refuse it. Leave it out if
    /// there is no such axis.
    pub linear_axis: Option<f64>,
    /// Angle of the turn table under the part, the same for the whole program, °; `beadwright reach` finds the best
    /// angle. The part's frame turns with the table (`krl.table_machine`, `rapid.table_unit`). KRL and RAPID write it; other
    /// posts refuse it. Leave it out if there is no turn table.
    pub table_angle: Option<f64>,
    /// Direction from the turn table's axis in which the arc stays, °: the table, whose axis is at x = 0, y = 0 of the
    /// part and whose angle grows counter-clockwise as seen from above, turns with the torch, and the controller moves both
    /// together. KRL and RAPID write it, as `table_angle`, which it replaces. Leave it out if the table does not turn.
    pub table_side: Option<f64>,
    /// The angles between which a table that turns with the torch (`table_side`) may turn, least and greatest, °: passes begin
    /// where it can follow them to their end, and at the end of its range it stops while the torch continues around it. Leave it
    /// out if the table turns endlessly.
    pub table_range: Option<[f64; 2]>,
    /// One or two axes that turn the part so that layers lie level under the torch, and when they turn. KRL, RAPID, FANUC and
    /// G-code write them (`krl.table_machine`, `rapid.table_unit`, `fanuc.table_group`, `gcode.positioner`). It replaces
    /// `table_angle`. Leave it out if nothing turns the part.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub positioner: Option<Positioner>,
    /// Which fraction of a wall's lean the torch adopts (work angle), 0 to 1; 0, the default, leaves it as in the robot's
    /// section. Robots only.
    pub follow_wall: f64,
    /// The greatest work angle, °; default 30.
    pub max_work_angle: f64,
    /// Lean of the torch along its path, °: above 0 the wire points forward (push), below 0 back (drag). Robots only. Default
    /// 0.
    pub travel_angle: f64,
    /// How far the normal of a layer that is not level may lean from upright, °, where no positioner turns the part; default 15.
    pub max_off_level: f64,
    /// Whether a stopped build can continue inside the program, without a new one: a variable, which each program names at its
    /// head, holds the layer times 10000 plus the pass at which to begin, and 0 to begin at the beginning. For robots and
    /// LinuxCNC; for others use `plan --from-layer --from-pass`. Default false.
    pub restart: bool,
    /// Whether every layer has a height of its own to be added, 0 mm at first, that can be set in the program between
    /// layers: an array in KRL, RAPID and URScript, a line in each layer's program for FANUC; other posts refuse it. Default
    /// false.
    pub layer_offsets: bool,
    /// Interval, in layers, at which the lines of `hooks.measure` are written; default 10.
    pub measure_every: usize,
}

impl Default for ProgramSettings {
    fn default() -> Self {
        Self {
            chord_tolerance: 0.0,
            arcs: false,
            speed_tolerance: 0.0,
            min_point_time: 0.0,
            torch_angle: 0.0,
            linear_axis: None,
            table_angle: None,
            table_side: None,
            table_range: None,
            positioner: None,
            follow_wall: 0.0,
            max_work_angle: 30.0,
            travel_angle: 0.0,
            max_off_level: 15.0,
            restart: false,
            layer_offsets: false,
            measure_every: 10,
        }
    }
}

impl ProgramSettings {
    /// Whether there are axes other than the robot's.
    pub fn external_axes(&self) -> bool {
        self.linear_axis.is_some() || self.has_table()
    }

    /// Whether there is a turn table or a positioner under the part.
    pub fn has_table(&self) -> bool {
        self.turning_axes() > 0
    }

    /// Number of the axes that turn the part.
    pub fn turning_axes(&self) -> usize {
        let table = usize::from(self.table_angle.is_some() || self.table_side.is_some());
        self.positioner.as_ref().map_or(table, Positioner::count)
    }

    /// The initial angles of the axes that turn the part, °; `None` if there are none.
    pub fn first_angles(&self) -> Option<[f64; 2]> {
        self.has_table().then(|| [self.table_angle.unwrap_or(0.0), 0.0])
    }

    /// Whether the torch leans away from the orientation in the robot's section.
    pub fn tilts(&self) -> bool {
        self.follow_wall != 0.0 || self.travel_angle != 0.0
    }

    /// The limits of the numbers; some depend on the bead width `w`, mm.
    pub fn limits(&self, w: f64) -> Vec<Limit> {
        let mut limits = limits! {
            "program.chord_tolerance": self.chord_tolerance, 0.0, 0.5 * w, "mm (at most half a bead width)",
                "rounding alone takes 0.015 mm; more than half a bead width would change the part";
            "program.speed_tolerance": self.speed_tolerance, 0.0, 0.3, "(fraction of the speed)",
                "the bead's width follows the speed: 30 % is the width of a process window";
            "program.min_point_time": self.min_point_time, 0.0, 1.0, "s", "values outside this range make no sense";
            "program.measure_every": self.measure_every as f64, 1.0, 1e6, "layers", "values outside this range make no sense";
            "program.torch_angle": self.torch_angle, -360.0, 360.0, "°", "values outside this range make no sense";
            "program.linear_axis": self.linear_axis.unwrap_or(0.0), -1e5, 1e5, "mm", "no track is longer";
            "program.table_angle": self.table_angle.unwrap_or(0.0), -7200.0, 7200.0, "°",
                "values outside this range make no sense";
            "program.table_side": self.table_side.unwrap_or(0.0), -360.0, 360.0, "°", "values outside this range make no sense";
            "program.follow_wall": self.follow_wall, 0.0, 1.0, "(fraction of the wall's lean)", "a torch leans no more than the wall";
            "program.max_work_angle": self.max_work_angle, 0.0, 45.0, "°", "the gas does not cover the metal at a greater lean";
            "program.max_off_level": self.max_off_level, 0.0, 180.0, "°", "180° is overhead";
            "program.travel_angle": self.travel_angle, -30.0, 30.0, "°", "the gas does not cover the metal at a greater lean";
        };
        limits.extend(self.positioner.iter().flat_map(Positioner::limits));
        limits
    }

    /// The first contradiction between values.
    pub fn broken(&self) -> Option<Broken> {
        if let (Some(_), Some(side)) = (self.table_angle, self.table_side) {
            let reason =
                "a table keeps one angle (table_angle) or turns with the torch (table_side): remove one of them.";
            return Some(Broken {
                key: "program.table_side".to_owned(),
                value: format!("{side}"),
                reason: reason.to_owned(),
            });
        }
        if let Some(positioner) = &self.positioner {
            if self.table_angle.is_some() || self.table_side.is_some() {
                let reason =
                    "a table (table_angle, table_side) is an axis of the positioner: remove the key of the table.";
                let (key, value) = ("program.positioner".to_owned(), format!("{} axes", positioner.count()));
                return Some(Broken { key, value, reason: reason.to_owned() });
            }
            if let Some(broken) = positioner.broken() {
                return Some(broken);
            }
        }
        if let Some([low, high]) = self.table_range.filter(|[low, high]| !(low + 360.0 <= *high && high - low < 1e5)) {
            let reason = "the least angle comes first, and the table must turn by at least 360°.".to_owned();
            return Some(Broken { key: "program.table_range".to_owned(), value: format!("[{low}, {high}]"), reason });
        }
        let reason = if self.chord_tolerance > 0.0 && self.chord_tolerance < 0.015 {
            "0 keeps every point; otherwise it must be 0.015 mm or more, more than the 0.01 mm of the shortest move."
        } else if self.arcs && self.chord_tolerance == 0.0 {
            "arcs = true needs a tolerance, such as 0.05 mm."
        } else if self.min_point_time > 0.0 && self.chord_tolerance == 0.0 {
            "min_point_time needs a tolerance within which points are merged, such as 0.05 mm."
        } else {
            return None;
        };
        Some(self.broken_tolerance(reason))
    }

    /// The chord tolerance reported as an impossible value.
    pub fn broken_tolerance(&self, reason: &str) -> Broken {
        let (key, value) = ("program.chord_tolerance".to_owned(), format!("{}", self.chord_tolerance));
        Broken { key, value, reason: reason.to_owned() }
    }
}
