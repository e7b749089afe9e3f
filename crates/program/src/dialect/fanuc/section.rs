//! The section `[fanuc]`: a FANUC cell (R-30iB, ArcTool), and the limits of its values.

use super::write::FanucTp;
use crate::dialect::writing::needs;
use crate::dialect::writing::orientation::{self, Turn};
use crate::dialect::{DialectError, Extra, Hooks, Job, Section, Table, Templates, Writer};
use crate::program::ProgramSettings;
use bead_plan::limit::{Broken, CONTROLLER, Limit, limit, limits};
use serde::{Deserialize, Serialize};

/// How welding speeds are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub enum FanucSpeed {
    /// `8.0mm/sec`.
    #[serde(rename = "mm/sec")]
    MillimetresPerSecond,
    /// `48.0cm/min`.
    #[serde(rename = "cm/min")]
    CentimetresPerMinute,
    /// `WELD_SPEED`, the speed of the weld schedule, wherever the speed is nominal; elsewhere `mm/sec`.
    #[serde(rename = "weld-speed")]
    WeldSpeed,
}

/// FANUC TP. Templates are instructions with `{{placeholders}}`, without line numbers and `;`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Fanuc {
    /// Number of the user frame (UF) of the part, 0 to 61.
    pub user_frame: u32,
    /// Number of the tool frame (UT) of the torch, 1 to 29.
    pub tool_frame: u32,
    /// Robot configuration of the points, such as `N U T, 0, 0, 0`.
    pub configuration: String,
    /// Axis angles J1 to J6 before and after the program, °.
    pub home: [f64; 6],
    /// Speed of the moves to and from `home`, %.
    pub home_speed: f64,
    /// Orientation of the tool in the user frame: W, P, R, °; `[180, 0, 0]` is straight down.
    pub orientation: [f64; 3],
    /// Continuous motion (CNT) along a pass, 0 to 100; points where the arc is switched are FINE.
    pub continuity: u32,
    /// How welding speeds are written: `mm/sec`, `cm/min` or `weld-speed`.
    pub speed: FanucSpeed,
    /// Maximum number of moves in one program; longer layers continue in another, since pendants accept only 9,999
    /// lines.
    pub max_points: usize,
    /// Instructions at the beginning of the main program.
    pub start: Vec<String>,
    /// Instructions at the beginning of every layer.
    pub layer_start: Vec<String>,
    /// Instructions that strike the arc at the start point of a pass.
    pub arc_on: Vec<String>,
    /// Instructions that end the arc at the end point of a pass.
    pub arc_off: Vec<String>,
    /// Instructions that set the wire feed to `{{wire_feed_ratio}}` times its nominal value, or to `{{wire_feed}}`
    /// m/min; written wherever it changes. Needed for `process.follow = "wire-feed"` and for a
    /// `start_stop.crater_power` below 1; default none.
    #[serde(default)]
    pub wire_feed: Vec<String>,
    /// Instructions that set the wire feed while the torch stands still to fill the crater; default: those of
    /// `wire_feed`. Needed if those take effect only with the next move.
    #[serde(default)]
    pub crater: Vec<String>,
    /// Instructions at the end of the main program.
    pub end: Vec<String>,
    /// Register that holds the pass at which to begin, for `program.restart`; default 90.
    #[serde(default = "ninety")]
    pub restart_register: u32,
    /// Position register that holds the height to be added to a layer, for `program.layer_offsets`; default 90.
    #[serde(default = "ninety")]
    pub offset_register: u32,
    /// Motion group of the table or positioner that turns the part, 2 to 5: the leader of the pair that the controller
    /// coordinates. The user frame is then that of the pair. Needed for `program.positioner`, `program.table_angle` and
    /// `program.table_side`.
    #[serde(default)]
    pub table_group: Option<u32>,
    /// Lines at other places of the program; default none.
    #[serde(default)]
    pub hooks: Hooks,
}

/// How the controller identifies what turns the part.
const TABLE: &str = "It is the motion group of the table or positioner, such as 2: the leader of the coordinated pair, whose frame the \
                     user frame is.";

fn ninety() -> u32 {
    90
}

impl Section for Fanuc {
    fn limits(&self) -> Vec<Limit> {
        let mut limits = limits! {
            "fanuc.user_frame": self.user_frame.into(), 0.0, 61.0, "(user frame)", CONTROLLER;
            "fanuc.tool_frame": self.tool_frame.into(), 1.0, 29.0, "(tool frame)", CONTROLLER;
            "fanuc.home_speed": self.home_speed, 1.0, 100.0, "%", CONTROLLER;
            "fanuc.continuity": self.continuity.into(), 0.0, 100.0, "(CNT)", CONTROLLER;
            "fanuc.restart_register": self.restart_register.into(), 1.0, 1500.0, "(register)", CONTROLLER;
            "fanuc.offset_register": self.offset_register.into(), 1.0, 100.0, "(position register)", CONTROLLER;
            "fanuc.table_group": self.table_group.unwrap_or(2).into(), 2.0, 5.0, "(motion group)", CONTROLLER;
            "fanuc.max_points": self.max_points as f64, 10.0, 3000.0, "moves per program",
                "larger programs do not load into the controller";
        };
        limits.extend(self.home.map(|axis| limit("fanuc.home", axis, (-720.0, 720.0), "°", CONTROLLER)));
        limits
            .extend(self.orientation.map(|angle| limit("fanuc.orientation", angle, (-360.0, 360.0), "°", CONTROLLER)));
        limits
    }

    fn broken(&self, _program: &ProgramSettings) -> Option<Broken> {
        let legal = |b: u8| b.is_ascii_alphanumeric() || b" ,-".contains(&b);
        let fits = !self.configuration.is_empty() && self.configuration.bytes().all(legal);
        let reason = "such as \"N U T, 0, 0, 0\".";
        (!fits).then(|| Broken::text("fanuc.configuration", &self.configuration, reason))
    }

    fn templates(&self) -> Templates<'_> {
        vec![
            ("fanuc.start", &self.start),
            ("fanuc.layer_start", &self.layer_start),
            ("fanuc.arc_on", &self.arc_on),
            ("fanuc.arc_off", &self.arc_off),
            ("fanuc.wire_feed", &self.wire_feed),
            ("fanuc.crater", &self.crater),
            ("fanuc.end", &self.end),
        ]
    }

    fn supports(&self, _extra: Extra) -> bool {
        true
    }

    fn table(&self) -> Option<Table> {
        Some(Table { key: "fanuc.table_group", known: self.table_group.is_some(), what: TABLE })
    }

    fn hooks(&self) -> Option<&Hooks> {
        Some(&self.hooks)
    }

    fn dry_run(&mut self) {
        self.hooks.without_arc();
        // The weld schedule gives no speed while the arc is off.
        if self.speed == FanucSpeed::WeldSpeed {
            self.speed = FanucSpeed::MillimetresPerSecond;
        }
    }

    fn longest_pass(&self, _program: &ProgramSettings) -> Option<usize> {
        Some(self.max_points)
    }

    fn writer(&self, job: &Job<'_>) -> Result<Box<dyn Writer>, DialectError> {
        needs::lines("fanuc", &self.templates(), "AO[1]={{wire_feed_ratio}}", job)?;
        let mut section = self.clone();
        section.orientation = orientation::xyz(section.orientation, Turn::Torch(job.program.torch_angle));
        Ok(Box::new(FanucTp::new(job, section)))
    }
}
