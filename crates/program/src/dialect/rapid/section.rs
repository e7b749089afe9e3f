//! The section `[rapid]`: an ABB cell (IRC5, RobotWare 6), and the limits of its values.

use super::names;
use super::write::AbbRapid;
use crate::dialect::writing::needs;
use crate::dialect::writing::orientation::{self, Turn};
use crate::dialect::{DialectError, Extra, Hooks, Job, Section, Table, Templates, Writer, stands};
use crate::program::ProgramSettings;
use bead_plan::limit::{Broken, CONTROLLER, Limit, limit, limits};
use bead_plan::weld::{WeldSettings, retract_time};
use serde::{Deserialize, Serialize};

/// How the arc is switched.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub enum RapidArc {
    /// By `ArcLStart`, `ArcL` and `ArcLEnd` of RobotWare Arc.
    Instructions,
    /// By the lines `arc_on` and `arc_off` between plain `MoveL` moves.
    Plain,
}

/// How the main program runs the modules of the layers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub enum RapidModules {
    /// Loads each module from `folder`, runs it and unloads it: one layer in memory at a time.
    Load,
    /// All modules are in memory already, as listed in the `.pgf`.
    Call,
}

/// Unit of the wire feed in welddata, as configured in the cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub enum WireFeedUnit {
    /// Metres per minute.
    #[serde(rename = "m/min")]
    MetresPerMinute,
    /// Millimetres per second.
    #[serde(rename = "mm/s")]
    MillimetresPerSecond,
}

/// ABB RAPID. Templates are statements with `{{placeholders}}`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Rapid {
    /// How the arc is switched: `instructions` (RobotWare Arc) or `plain` (`arc_on` and `arc_off`).
    pub arc: RapidArc,
    /// How the modules of the layers are run: `load` (loaded one after another) or `call` (all in memory).
    pub modules: RapidModules,
    /// Folder of the layers' modules on the controller, such as `HOME:/part`; used with `modules = "load"`.
    pub folder: String,
    /// Whether to write a `.pgf` file that lists the modules.
    pub pgf: bool,
    /// Maximum number of moves in one module; longer layers are cut between passes; default 10000.
    #[serde(default = "ten_thousand")]
    pub max_points: usize,
    /// Angles of the six axes before and after the program, °.
    pub home: [f64; 6],
    /// Speed of the moves to and from `home`, mm/s.
    pub home_speed: f64,
    /// Orientation of the tool in the work object: quaternion w, x, y, z; `[0, 1, 0, 0]` is straight down.
    pub orientation: [f64; 4],
    /// Maximum speed of turning the tool, °/s.
    pub orientation_speed: f64,
    /// Radius of the corner paths along a pass, mm; 0 for exact stops.
    pub zone: f64,
    /// Name of the tooldata.
    pub tool: String,
    /// Tool frame on the flange: x, y, z in mm and quaternion w, x, y, z; leave it out if the controller already has
    /// the tooldata.
    pub tool_frame: Option<[f64; 7]>,
    /// Mass of the tool, kg, and its centre of gravity x, y, z, mm.
    pub tool_load: [f64; 4],
    /// Name of the wobjdata.
    pub wobj: String,
    /// Frame of the part: x, y, z in mm and quaternion w, x, y, z; on a turn table, its frame on the table. Leave it out if the
    /// controller already has the wobjdata.
    pub part_frame: Option<[f64; 7]>,
    /// Name of the mechanical unit that is the turn table, such as `STN1`: the work object turns with it, and the program
    /// activates it. Needed for `program.table_angle` and `program.table_side`.
    pub table_unit: Option<String>,
    /// Which external axis of targets the turn table is, 1 to 6 for eax_a to eax_f, as the controller is configured; by
    /// default the first that `program.linear_axis` leaves free.
    pub table_axis: Option<u32>,
    /// Name of the mechanical unit that is the linear axis, where it is not active from the start: the program activates it.
    pub track_unit: Option<String>,
    /// Step of the deposition speeds, mm/s: each is written as the nominal speed plus a whole multiple of this step,
    /// with one welddata per speed.
    pub speed_step: f64,
    /// First component of arcdata: synergic line or job number of the power source.
    pub schedule: u32,
    /// Second component of arcdata: process of the power source (Fronius TPS: 0 standard, 1 pulse, 7 CMT).
    pub mode: u32,
    /// Third component of arcdata: voltage, or arc-length correction of a synergic power source.
    pub voltage: f64,
    /// Fifth component of arcdata: dynamic correction.
    pub control: f64,
    /// Unit of the wire feed in arcdata, as configured in the cell: `m/min` or `mm/s`.
    pub wire_feed_unit: WireFeedUnit,
    /// The rest of the seamdata; gas and ignition times come from `[process]`.
    pub seam: RapidSeam,
    /// Statements at the beginning of the main program.
    pub start: Vec<String>,
    /// Statements at the beginning of every layer.
    pub layer_start: Vec<String>,
    /// Statements that strike the arc at the start point of a pass; for `arc = "plain"`.
    pub arc_on: Vec<String>,
    /// Statements that end the arc at the end point of a pass; for `arc = "plain"`.
    pub arc_off: Vec<String>,
    /// Statements that set the wire feed to `{{wire_feed_ratio}}` times its nominal value, or to `{{wire_feed}}` m/min;
    /// written wherever it changes. With `arc = "instructions"` the welddata contain it instead. Needed for
    /// `process.follow = "wire-feed"` and for a `start_stop.crater_power` below 1; default none.
    #[serde(default)]
    pub wire_feed: Vec<String>,
    /// Statements that set the wire feed while the torch stands still to fill the crater; default: those of
    /// `wire_feed`. Needed if those take effect only with the next move.
    #[serde(default)]
    pub crater: Vec<String>,
    /// Statements at the end of the main program.
    pub end: Vec<String>,
    /// Lines of subprograms that the other lines call, in the main module, after `main`; lines before the first of them
    /// declare data. Default none.
    #[serde(default)]
    pub routines: Vec<String>,
    /// Lines at other places of the program; default none.
    #[serde(default)]
    pub hooks: Hooks,
}

/// Start and end of a seam, as in seamdata.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RapidSeam {
    /// Time to fill the gas lines before the first seam, s.
    pub purge_time: f64,
    /// Scrape start: 0 none, 1 weaving.
    pub scrape_start: u32,
    /// Speed while heating, mm/s.
    pub heat_speed: f64,
    /// Heating time, s.
    pub heat_time: f64,
    /// Heating distance, mm; unless it is 0, it is used instead of `heat_time`.
    pub heat_distance: f64,
    /// Wire feed while heating, as a multiple of the wire feed of the process.
    pub heat_feed: f64,
    /// Time between heating and welding, s.
    pub cool_time: f64,
    /// Crater filling time, s.
    pub fill_time: f64,
    /// Wire feed while the crater is filled, as a multiple of the wire feed of the process.
    pub fill_feed: f64,
    /// Burnback time of the wire, s.
    pub burnback_time: f64,
    /// Time for which the wire is drawn back, s.
    pub rollback_time: f64,
}

/// How the controller identifies the turn table.
const TABLE: &str =
    "It is the name of the turn table's mechanical unit, such as \"STN1\": the work object must turn with it.";

fn ten_thousand() -> usize {
    10_000
}

impl Section for Rapid {
    fn limits(&self) -> Vec<Limit> {
        const LEAST: f64 = 1e-3;
        let mut limits = limits! {
            "rapid.home_speed": self.home_speed, LEAST, 3000.0, "mm/s", CONTROLLER;
            "rapid.orientation_speed": self.orientation_speed, LEAST, 1000.0, "°/s", CONTROLLER;
            "rapid.zone": self.zone, 0.0, 50.0, "mm", CONTROLLER;
            "rapid.max_points": self.max_points as f64, 10.0, 50_000.0, "moves per module",
                "the pendant cannot show longer modules";
            "rapid.tool_load": self.tool_load[0], LEAST, 500.0, "kg", CONTROLLER;
            "rapid.speed_step": self.speed_step, LEAST, 100.0, "mm/s", CONTROLLER;
            "rapid.table_axis": self.table_axis.unwrap_or(1).into(), 1.0, 6.0, "(external axis)", CONTROLLER;
            "rapid.schedule": self.schedule.into(), 0.0, 9999.0, "(synergic line or job)", CONTROLLER;
            "rapid.mode": self.mode.into(), 0.0, 99.0, "(process of the power source)", CONTROLLER;
            "rapid.voltage": self.voltage, -100.0, 100.0, "(volts, or a correction)", CONTROLLER;
            "rapid.control": self.control, -100.0, 100.0, "(a correction)", CONTROLLER;
        };
        let frames = [("rapid.tool_frame", self.tool_frame), ("rapid.part_frame", self.part_frame)];
        for (key, frame) in frames.iter().filter_map(|(key, frame)| Some((*key, (*frame)?))) {
            limits.extend(frame[..3].iter().map(|&v| limit(key, v, (-1e5, 1e5), "mm", CONTROLLER)));
            limits.push(limit(key, norm(&frame[3..]), (0.999, 1.001), "(length of its quaternion)", CONTROLLER));
        }
        limits.push(limit(
            "rapid.orientation",
            norm(&self.orientation),
            (0.999, 1.001),
            "(length of the quaternion)",
            CONTROLLER,
        ));
        limits.extend(self.home.map(|axis| limit("rapid.home", axis, (-720.0, 720.0), "°", CONTROLLER)));
        limits.extend(self.tool_load[1..].iter().map(|&v| limit("rapid.tool_load", v, (-1e4, 1e4), "mm", CONTROLLER)));
        limits.extend(self.seam.limits());
        limits
    }

    fn broken(&self, program: &ProgramSettings) -> Option<Broken> {
        let broken = |key: &str, value: String, reason: &str| {
            Some(Broken { key: key.to_owned(), value, reason: reason.to_owned() })
        };
        if let Some(axis) = self.table_axis.filter(|axis| *axis == 1 && program.linear_axis.is_some()) {
            return broken(
                "rapid.table_axis",
                axis.to_string(),
                "the linear axis (program.linear_axis) is eax_a, the first.",
            );
        }
        for (key, unit) in [("rapid.table_unit", &self.table_unit), ("rapid.track_unit", &self.track_unit)] {
            if let Some(unit) = unit.as_ref().filter(|unit| !names::is_identifier(unit)) {
                let reason =
                    "at most 32 letters, digits and _, a letter first: the name of the unit on the controller.";
                return broken(key, format!("\"{unit}\""), reason);
            }
        }
        for (key, name) in [("rapid.tool", &self.tool), ("rapid.wobj", &self.wobj)] {
            let taken = names::OWN.iter().any(|own| own.eq_ignore_ascii_case(name));
            if taken || !names::is_identifier(name) {
                let reason = "at most 32 letters, digits and _, a letter first; no reserved word and no system data.";
                return broken(key, format!("\"{name}\""), reason);
            }
        }
        if self.tool.eq_ignore_ascii_case(&self.wobj) {
            return broken("rapid.wobj", format!("\"{}\"", self.wobj), "the tool has this name.");
        }
        if self.tool_load[1..] == [0.0; 3] {
            return broken(
                "rapid.tool_load",
                format!("{:?}", self.tool_load),
                "the centre of gravity must not be 0, 0, 0.",
            );
        }
        let fits = self.folder.len() <= names::MAX_FOLDER && !self.folder.ends_with(['/', '\\']);
        if !fits || self.folder.is_empty() || !self.folder.bytes().all(|b| b.is_ascii_graphic() && b != b'"') {
            let reason = "at most 40 printable ASCII characters without blanks and quotes, not ending with a slash.";
            return broken("rapid.folder", format!("\"{}\"", self.folder), reason);
        }
        None
    }

    fn templates(&self) -> Templates<'_> {
        vec![
            ("rapid.start", &self.start),
            ("rapid.layer_start", &self.layer_start),
            ("rapid.arc_on", &self.arc_on),
            ("rapid.arc_off", &self.arc_off),
            ("rapid.wire_feed", &self.wire_feed),
            ("rapid.crater", &self.crater),
            ("rapid.end", &self.end),
            ("rapid.routines", &self.routines),
        ]
    }

    fn supports(&self, _extra: Extra) -> bool {
        true
    }

    fn table(&self) -> Option<Table> {
        Some(Table { key: "rapid.table_unit", known: self.table_unit.is_some(), what: TABLE })
    }

    fn hooks(&self) -> Option<&Hooks> {
        Some(&self.hooks)
    }

    fn stands_at_start(&self) -> bool {
        self.arc == RapidArc::Instructions || stands(&self.arc_on)
    }

    fn arc_end_time(&self, weld: &WeldSettings) -> Option<f64> {
        let (seam, ends, process) = (&self.seam, &weld.ends, &weld.process);
        let filling = if ends.fills_craters() { 0.0 } else { seam.fill_time };
        let back = if ends.wire_retract > 0.0 { retract_time(ends, process) } else { seam.rollback_time };
        let time = filling + seam.burnback_time + back + process.gas_postflow + process.arc_end_delay;
        (self.arc == RapidArc::Instructions).then_some(time)
    }

    fn dry_run(&mut self) {
        self.hooks.without_arc();
        self.arc = RapidArc::Plain;
    }

    fn writer(&self, job: &Job<'_>) -> Result<Box<dyn Writer>, DialectError> {
        if self.arc == RapidArc::Plain {
            needs::lines("rapid", &self.templates(), "SetAO aoWire,{{wire_feed_ratio}};", job)?;
        }
        if job.program.table_side.is_some() && self.part_frame.is_some_and(|[x, y, ..]| x != 0.0 || y != 0.0) {
            return Err(DialectError::Cannot {
                dialect: "rapid",
                what: "a part off the axis of a table that turns with the torch (program.table_side)",
                remedy: "The table turns about x = 0, y = 0 of the part: set the first two numbers of rapid.part_frame to 0.",
            });
        }
        let mut section = self.clone();
        if self.arc == RapidArc::Instructions {
            section.hooks.without_arc();
        }
        section.orientation = orientation::quaternion(section.orientation, Turn::Torch(job.program.torch_angle));
        Ok(Box::new(AbbRapid::new(job, section)))
    }
}

impl RapidSeam {
    fn limits(&self) -> Vec<Limit> {
        limits! {
            "rapid.seam.purge_time": self.purge_time, 0.0, 60.0, "s", CONTROLLER;
            "rapid.seam.scrape_start": self.scrape_start.into(), 0.0, 3.0, "(kind)", CONTROLLER;
            "rapid.seam.heat_speed": self.heat_speed, 0.0, 1000.0, "mm/s", CONTROLLER;
            "rapid.seam.heat_time": self.heat_time, 0.0, 60.0, "s", CONTROLLER;
            "rapid.seam.heat_distance": self.heat_distance, 0.0, 100.0, "mm", CONTROLLER;
            "rapid.seam.heat_feed": self.heat_feed, 0.0, 5.0, "(multiple of the wire feed)", CONTROLLER;
            "rapid.seam.cool_time": self.cool_time, 0.0, 60.0, "s", CONTROLLER;
            "rapid.seam.fill_time": self.fill_time, 0.0, 60.0, "s", CONTROLLER;
            "rapid.seam.fill_feed": self.fill_feed, 0.0, 5.0, "(multiple of the wire feed)", CONTROLLER;
            "rapid.seam.burnback_time": self.burnback_time, 0.0, 10.0, "s", CONTROLLER;
            "rapid.seam.rollback_time": self.rollback_time, 0.0, 10.0, "s", CONTROLLER;
        }
    }
}

fn norm(quaternion: &[f64]) -> f64 {
    quaternion.iter().map(|q| q * q).sum::<f64>().sqrt()
}
