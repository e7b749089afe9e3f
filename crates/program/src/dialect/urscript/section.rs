//! The section `[urscript]`: a Universal Robots cell, and the limits of its values.

use super::write::UniversalScript;
use crate::dialect::writing::needs;
use crate::dialect::writing::orientation::{self, Turn};
use crate::dialect::writing::volumes::MEGABYTE;
use crate::dialect::{DialectError, Extra, Hooks, Job, Section, Table, Templates, Writer};
use crate::program::{ProgramSettings, Turning};
use bead_plan::limit::{Broken, CONTROLLER, Limit, limit, limits};
use serde::{Deserialize, Serialize};

/// URScript. Templates are statements with `{{placeholders}}`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Urscript {
    /// Tool frame on the flange: x, y, z in mm and rotation vector in rad; leave it out if the installation already has
    /// it.
    pub tool_frame: Option<[f64; 6]>,
    /// Mass of the torch and what is mounted on the flange, kg, written as `set_payload`: without it the arm may stop for no
    /// reason or push where it should yield. Leave it out if the installation already has it.
    pub payload: Option<f64>,
    /// Frame of the part in the robot's base: x, y, z in mm and rotation vector in rad; with a positioner, as its axes hold it
    /// at 0.
    pub part_frame: [f64; 6],
    /// Axis angles before and after the program, °.
    pub home: [f64; 6],
    /// Speed of the moves to and from `home`, °/s.
    pub home_speed: f64,
    /// Orientation of the tool in the part's frame: rotation vector, rad; `[3.141593, 0, 0]` is straight down.
    pub orientation: [f64; 3],
    /// Acceleration of the tool, mm/s².
    pub acceleration: f64,
    /// Blending radius along a pass, mm; reduced where points are closer together than twice the radius; 0 for exact
    /// stops.
    pub blend: f64,
    /// The most that one script may hold, MB; longer programs come in several scripts, run one after another, and a pass that
    /// alone is longer is cut and struck again. Default 2.
    #[serde(default = "two")]
    pub max_megabytes: f64,
    /// Whether the script ends with a call to its program. A script that is sent to the controller's socket or loaded in a
    /// Script node must have nothing after its last `end`; a file that is inserted into a program needs the call. Default
    /// false.
    #[serde(default)]
    pub call: bool,
    /// Statements at the beginning of the program.
    pub start: Vec<String>,
    /// Statements at the beginning of every layer.
    pub layer_start: Vec<String>,
    /// Statements that strike the arc at the start point of a pass.
    pub arc_on: Vec<String>,
    /// Statements that end the arc at the end point of a pass.
    pub arc_off: Vec<String>,
    /// Statements that set the wire feed to `{{wire_feed_ratio}}` times its nominal value, or to `{{wire_feed}}` m/min;
    /// written wherever it changes. Needed for `process.follow = "wire-feed"` and for a `start_stop.crater_power` below
    /// 1; default none.
    #[serde(default)]
    pub wire_feed: Vec<String>,
    /// Statements that set the wire feed while the torch stands still to fill the crater; default: those of
    /// `wire_feed`. Needed if those take effect only with the next move.
    #[serde(default)]
    pub crater: Vec<String>,
    /// Statements at the end of the program.
    pub end: Vec<String>,
    /// Statements that turn a positioner to `{{positioner_1}}` and `{{positioner_2}}` degrees and wait until it stands; the
    /// torch is at home. Needed for `program.positioner`; default none.
    #[serde(default)]
    pub turn: Vec<String>,
    /// Lines of subprograms that the other lines call, at the head of the script; default none.
    #[serde(default)]
    pub routines: Vec<String>,
    /// Lines at other places of the program; default none.
    #[serde(default)]
    pub hooks: Hooks,
}

/// How the controller moves what turns the part.
const TURN: &str = "They are the statements that turn the positioner to {{positioner_1}} and {{positioner_2}} degrees and wait until it \
                    stands, such as a call of your routine.";

fn two() -> f64 {
    2.0
}

impl Section for Urscript {
    fn limits(&self) -> Vec<Limit> {
        let mut limits = limits! {
            "urscript.payload": self.payload.unwrap_or(0.0), 0.0, 60.0, "kg", CONTROLLER;
            "urscript.home_speed": self.home_speed, 0.1, 180.0, "°/s", CONTROLLER;
            "urscript.acceleration": self.acceleration, 1.0, 20_000.0, "mm/s²", CONTROLLER;
            "urscript.max_megabytes": self.max_megabytes, 0.001, 1000.0, "MB", "the controller reads a script as a whole";
            "urscript.blend": self.blend, 0.0, 50.0, "mm", CONTROLLER;
        };
        limits.extend(self.home.map(|axis| limit("urscript.home", axis, (-363.0, 363.0), "°", CONTROLLER)));
        limits.extend(
            self.orientation.map(|angle| limit("urscript.orientation", angle, (-6.284, 6.284), "rad", CONTROLLER)),
        );
        let frames = [("urscript.tool_frame", self.tool_frame), ("urscript.part_frame", Some(self.part_frame))];
        for (key, frame) in frames.iter().filter_map(|(key, frame)| Some((*key, (*frame)?))) {
            limits.extend(frame[..3].iter().map(|&v| limit(key, v, (-1e4, 1e4), "mm", CONTROLLER)));
            limits.extend(frame[3..].iter().map(|&v| limit(key, v, (-6.284, 6.284), "rad", CONTROLLER)));
        }
        limits
    }

    fn broken(&self, program: &ProgramSettings) -> Option<Broken> {
        let value = match program.positioner.as_ref()?.turning {
            Turning::Follow => "follow",
            Turning::Index => "index",
            Turning::IndexAtHome => return None,
        };
        let reason = "URScript does not move the axes with the torch (urscript.turn): set it to \"index-at-home\".";
        (!self.turn.is_empty()).then(|| Broken::text("program.positioner.turning", value, reason))
    }

    fn table(&self) -> Option<Table> {
        Some(Table { key: "urscript.turn", known: !self.turn.is_empty(), what: TURN })
    }

    fn templates(&self) -> Templates<'_> {
        vec![
            ("urscript.start", &self.start),
            ("urscript.layer_start", &self.layer_start),
            ("urscript.arc_on", &self.arc_on),
            ("urscript.arc_off", &self.arc_off),
            ("urscript.wire_feed", &self.wire_feed),
            ("urscript.crater", &self.crater),
            ("urscript.end", &self.end),
            ("urscript.turn", &self.turn),
            ("urscript.routines", &self.routines),
        ]
    }

    fn supports(&self, _extra: Extra) -> bool {
        true
    }

    fn longest_pass(&self, program: &ProgramSettings) -> Option<usize> {
        // The longest line for a move; arcs have two poses.
        let a_move = if program.arcs { 250 } else { 150 };
        Some((self.max_megabytes * MEGABYTE) as usize / a_move)
    }

    fn hooks(&self) -> Option<&Hooks> {
        Some(&self.hooks)
    }

    fn dry_run(&mut self) {
        self.hooks.without_arc();
    }

    fn writer(&self, job: &Job<'_>) -> Result<Box<dyn Writer>, DialectError> {
        let example = "set_standard_analog_out(0, {{wire_feed_ratio}})";
        needs::lines("urscript", &self.templates(), example, job)?;
        let mut section = self.clone();
        section.orientation = orientation::vector(section.orientation, Turn::Torch(job.program.torch_angle));
        Ok(Box::new(UniversalScript::new(job, section)))
    }
}
