//! The section `[inform]`: a Yaskawa cell (DX200, YRC1000), and the limits of its values.

use super::write::YaskawaInform;
use crate::dialect::writing::needs;
use crate::dialect::writing::orientation::{self, Turn};
use crate::dialect::{DialectError, Extra, Hooks, Job, Section, Table, Templates, Writer};
use crate::program::ProgramSettings;
use bead_plan::limit::{Broken, CONTROLLER, Limit, limit, limits};
use serde::{Deserialize, Serialize};

/// Unit of `V=`, as set in the controller's parameters.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub enum InformSpeed {
    /// Millimetres per second.
    #[serde(rename = "mm/s")]
    MillimetresPerSecond,
    /// Centimetres per minute.
    #[serde(rename = "cm/min")]
    CentimetresPerMinute,
}

/// Yaskawa INFORM. Templates are instructions with `{{placeholders}}`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Inform {
    /// Number of the user frame of the part, 1 to 63; with a station, see `frame_turns`.
    pub user_frame: u32,
    /// Number of the tool that is the torch, 0 to 63.
    pub tool: u32,
    /// Control group of the robot, such as `RB1`.
    pub group: String,
    /// Robot configuration of the points, as in `///RCONF`: `1,0,0,0,0,0,0,0`.
    pub configuration: String,
    /// Axis positions S, L, U, R, B and T before and after the program, pulses.
    pub home: [i64; 6],
    /// Speed (VJ) of the moves to and from `home`, %.
    pub home_speed: f64,
    /// Orientation of the tool in the user frame: Rx, Ry, Rz, °; `[180, 0, 0]` is straight down.
    pub orientation: [f64; 3],
    /// Position level (PL) along a pass, 0 to 8; where the arc is switched it is 0.
    pub position_level: u32,
    /// Unit of `V=`, as set on the controller: `mm/s` or `cm/min`.
    pub speed: InformSpeed,
    /// Date written into the jobs, `yyyy/mm/dd hh:mm`; it is fixed so that the same plan always gives the same bytes.
    pub date: String,
    /// Maximum number of characters in a job name: 32, or 8 on the NX100.
    pub max_name: usize,
    /// Maximum number of moves in one job; longer layers continue in another, since controllers accept only 9,999
    /// instructions.
    pub max_points: usize,
    /// Instructions at the beginning of the main job.
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
    /// Instructions at the end of the main job.
    pub end: Vec<String>,
    /// Number of the D variable that holds the pass at which to begin, for `program.restart`; default 90.
    #[serde(default = "ninety")]
    pub restart_variable: u32,
    /// Number of the P variable that holds the shift of a layer, for `program.layer_offsets`; default 90.
    #[serde(default = "ninety")]
    pub offset_variable: u32,
    /// Control group of the station that turns the part, such as `ST1`, coordinated with the robot. Needed for
    /// `program.positioner`, `program.table_angle` and `program.table_side`.
    #[serde(default)]
    pub station: Option<String>,
    /// Whether the user frame turns with the station, so that positions are on the part; if `false`, it keeps where the
    /// part's frame is with the station at 0, and positions are where the station holds them. Needed with `station`: public
    /// jobs do not agree, so try it with a part that stands beside the axis, without the arc.
    #[serde(default)]
    pub frame_turns: Option<bool>,
    /// Pulses per degree of the station's axes, in the order of `program.positioner.axes`; negative where an axis counts the
    /// other way. With one axis the second value does not matter.
    #[serde(default)]
    pub station_pulses: Option<[f64; 2]>,
    /// Lines at other places of the program; default none.
    #[serde(default)]
    pub hooks: Hooks,
}

/// How the controller identifies what turns the part.
const STATION: &str = "It is the control group of the station, such as \"ST1\"; inform.station_pulses gives the pulses per degree of \
                       its axes.";

/// Fewest and most pulses per degree.
const PULSES: std::ops::RangeInclusive<f64> = 1.0..=1e5;

fn ninety() -> u32 {
    90
}

impl Section for Inform {
    fn limits(&self) -> Vec<Limit> {
        let mut limits = limits! {
            "inform.user_frame": self.user_frame.into(), 1.0, 63.0, "(user frame)", CONTROLLER;
            "inform.tool": self.tool.into(), 0.0, 63.0, "(tool)", CONTROLLER;
            "inform.home_speed": self.home_speed, 0.01, 100.0, "%", CONTROLLER;
            "inform.position_level": self.position_level.into(), 0.0, 8.0, "(PL)", CONTROLLER;
            "inform.max_name": self.max_name as f64, 8.0, 32.0, "characters", CONTROLLER;
            "inform.restart_variable": self.restart_variable.into(), 0.0, 99.0, "(D variable)", CONTROLLER;
            "inform.offset_variable": self.offset_variable.into(), 0.0, 127.0, "(P variable)", CONTROLLER;
            "inform.max_points": self.max_points as f64, 10.0, 2000.0, "moves per job",
                "larger programs do not load into the controller";
        };
        limits.extend(self.home.map(|axis| limit("inform.home", axis as f64, (-1e7, 1e7), "pulses", CONTROLLER)));
        limits
            .extend(self.orientation.map(|angle| limit("inform.orientation", angle, (-360.0, 360.0), "°", CONTROLLER)));
        limits
    }

    fn broken(&self, program: &ProgramSettings) -> Option<Broken> {
        let digits = |text: &str, marks: &[u8]| text.bytes().all(|b| b.is_ascii_digit() || marks.contains(&b));
        let is_group = |text: &str| !text.is_empty() && text.bytes().all(|b| b.is_ascii_alphanumeric() || b == b',');
        let group = is_group(&self.group);
        let station = self.station.as_deref().is_none_or(is_group);
        let date = self.date.len() == 16 && digits(&self.date, b"/ :");
        let configuration = !self.configuration.is_empty() && digits(&self.configuration, b",");
        [
            (group, "inform.group", self.group.as_str(), "such as \"RB1\"."),
            (station, "inform.station", self.station.as_deref().unwrap_or_default(), "such as \"ST1\"."),
            (configuration, "inform.configuration", &self.configuration, "such as \"1,0,0,0,0,0,0,0\"."),
            (date, "inform.date", &self.date, "yyyy/mm/dd hh:mm."),
        ]
        .into_iter()
        .find(|(fits, ..)| !fits)
        .map(|(_, key, value, reason)| Broken::text(key, value, reason))
        .or_else(|| self.broken_station(program))
    }

    fn templates(&self) -> Templates<'_> {
        vec![
            ("inform.start", &self.start),
            ("inform.layer_start", &self.layer_start),
            ("inform.arc_on", &self.arc_on),
            ("inform.arc_off", &self.arc_off),
            ("inform.wire_feed", &self.wire_feed),
            ("inform.crater", &self.crater),
            ("inform.end", &self.end),
        ]
    }

    fn supports(&self, _extra: Extra) -> bool {
        true
    }

    fn table(&self) -> Option<Table> {
        Some(Table { key: "inform.station", known: self.station.is_some(), what: STATION })
    }

    fn hooks(&self) -> Option<&Hooks> {
        Some(&self.hooks)
    }

    fn longest_pass(&self, _program: &ProgramSettings) -> Option<usize> {
        Some(self.max_points)
    }

    fn dry_run(&mut self) {
        self.hooks.without_arc();
    }

    fn writer(&self, job: &Job<'_>) -> Result<Box<dyn Writer>, DialectError> {
        if job.weave().is_some_and(|weave| weave.shares_files()) {
            let (what, remedy) = (
                "[[weave.layers]] with the same weaving file",
                "Give each of them a file of its own: the controller keeps the values there.",
            );
            return Err(DialectError::Cannot { dialect: "inform", what, remedy });
        }
        needs::lines("inform", &self.templates(), "AOUT AO#(1) {{wire_feed_ratio}}", job)?;
        let mut section = self.clone();
        section.orientation = orientation::xyz(section.orientation, Turn::Torch(job.program.torch_angle));
        Ok(Box::new(YaskawaInform::new(job, section)))
    }
}

impl Inform {
    /// The first contradiction about a station that turns the part.
    fn broken_station(&self, program: &ProgramSettings) -> Option<Broken> {
        let (axes, pulses) = (program.turning_axes(), self.station_pulses);
        if self.station.is_none() || axes == 0 {
            return None;
        }
        let broken = |key: &str, value: String, reason: String| Some(Broken { key: key.to_owned(), value, reason });
        let wrong = |pulses: [f64; 2]| pulses.iter().take(axes).any(|pulses| !PULSES.contains(&pulses.abs()));
        if pulses.is_none_or(wrong) {
            let reason = format!(
                "it needs the pulses per degree of each of the {axes} axes that turn the part, from {} to {}, with a minus sign \
                 where an axis counts the other way.",
                PULSES.start(),
                PULSES.end()
            );
            let value = pulses.map_or("missing".to_owned(), |pulses| format!("{pulses:?}"));
            return broken("inform.station_pulses", value, reason);
        }
        if self.frame_turns.is_none() {
            let reason = "say whether the user frame turns with the station: true if positions are on the part, false if it stays \
                          where it is with the station at 0."
                .to_owned();
            return broken("inform.frame_turns", "missing".to_owned(), reason);
        }
        let reason = "how a Yaskawa controller runs an arc while the station turns is unconfirmed: set it to false.";
        program.arcs.then(|| broken("program.arcs", "true".to_owned(), reason.to_owned())).flatten()
    }
}
