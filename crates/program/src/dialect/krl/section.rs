//! KUKA KRL in profiles: the keys, and the limits of their values.

use super::arctech;
use super::arctech_section::{ArcTech, KrlArc};
use super::write::KukaKrl;
use crate::dialect::writing::needs;
use crate::dialect::writing::orientation::{self, Turn};
use crate::dialect::writing::volumes::MEGABYTE;
use crate::dialect::{DialectError, Extra, Hooks, Job, Section, Table, Templates, Writer, stands};
use crate::program::ProgramSettings;
use bead_plan::limit::{Broken, CONTROLLER, Limit, limit, limits};
use bead_plan::weld::WeldSettings;
use serde::{Deserialize, Serialize};

/// KUKA KRL. Templates are lines of KRL with `{{placeholders}}`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Krl {
    /// Index into TOOL_DATA, 1 to 16.
    pub tool: u32,
    /// Index into BASE_DATA, 1 to 32.
    pub base: u32,
    /// Axis angles before and after the program, °, written as in an E6AXIS: `A1 0.0,A2 -90.0,…`.
    pub home: String,
    /// Orientation of the tool: A, B and C, °.
    pub orientation: [f64; 3],
    /// Index of the turn table in `MACHINE_DEF` of `$config.dat`, 2 to 16: 2 where it is the first machine besides the robot.
    /// The base then turns with it: `$BASE = EK(MACHINE_DEF[2].ROOT,MACHINE_DEF[2].MECH_TYPE,BASE_DATA[1])`, so `BASE_DATA` is
    /// the place of the part on the table. Needed for `program.table_angle` and `program.table_side`.
    pub table_machine: Option<u32>,
    /// Which external axis the turn table is, 1 to 6 for E1 to E6; by default the first that `program.linear_axis` leaves free.
    pub table_axis: Option<u32>,
    /// Speed of point-to-point moves, %.
    pub ptp_speed: f64,
    /// Blending distance (`$APO.CDIS`) along a pass, mm; 0 for no blending.
    pub blend: f64,
    /// Maximum number of moves in one module; longer layers are cut between passes; default 2000.
    #[serde(default = "two_thousand")]
    pub max_points: usize,
    /// The most memory of the controller that one program with its modules may take, MB; larger ones come in volumes, each
    /// with a main program of its own, which are loaded and run one after another. A pass that is larger by itself is cut and
    /// struck again. Default 4.
    #[serde(default = "four")]
    pub max_megabytes: f64,
    /// How the pieces of a pass are run: `lin` (LIN and CIRC, blended by C_DIS) or `slin` (SLIN and SCIRC, blended by C_SPL,
    /// which keep the speed better); default lin.
    #[serde(default)]
    pub motion: KrlMotion,
    /// What switches the arc: `outputs` (the lines `arc_on` and `arc_off`) or `arctech` (the inline forms of ArcTech
    /// Basic); default outputs.
    #[serde(default)]
    pub arc: KrlArc,
    /// Data of ArcTech Basic; needed for `arc = "arctech"`.
    pub arctech: Option<ArcTech>,
    /// Lines at the beginning of the main program.
    pub start: Vec<String>,
    /// Lines at the beginning of every layer.
    pub layer_start: Vec<String>,
    /// Lines that strike the arc at the start point of a pass.
    pub arc_on: Vec<String>,
    /// Lines that end the arc at the end point of a pass.
    pub arc_off: Vec<String>,
    /// Lines that set the wire feed to `{{wire_feed_ratio}}` times its nominal value, or to `{{wire_feed}}` m/min;
    /// written wherever it changes. A plain `$ANOUT[1] = …` stops the robot at the preceding point;
    /// `TRIGGER WHEN DISTANCE=0 DELAY=0 DO $ANOUT[1] = …` does not. Needed for `process.follow = "wire-feed"` and for a
    /// `start_stop.crater_power` below 1; default none.
    #[serde(default)]
    pub wire_feed: Vec<String>,
    /// Lines that set the wire feed while the torch stands still to fill the crater; default: those of `wire_feed`.
    /// Needed if those take effect only with the next move, as a TRIGGER does.
    #[serde(default)]
    pub crater: Vec<String>,
    /// Lines at the end of the main program.
    pub end: Vec<String>,
    /// Lines of subprograms that the other lines call, after the main program; default none.
    #[serde(default)]
    pub routines: Vec<String>,
    /// Lines at other places of the program; default none.
    #[serde(default)]
    pub hooks: Hooks,
}

/// How KRL executes the pieces of a pass.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub enum KrlMotion {
    /// `LIN … C_DIS`
    #[default]
    Lin,
    /// `SLIN … C_SPL`
    Slin,
}

fn four() -> f64 {
    4.0
}

/// How the controller identifies the turn table.
const TABLE: &str = "It is the index of the turn table in MACHINE_DEF of $config.dat, 2 where it is the first machine besides \
                     the robot: the base must turn with it.";

fn two_thousand() -> usize {
    2000
}

impl Section for Krl {
    fn limits(&self) -> Vec<Limit> {
        let mut limits = limits! {
            "krl.tool": self.tool.into(), 1.0, 16.0, "(index into TOOL_DATA)", CONTROLLER;
            "krl.base": self.base.into(), 1.0, 32.0, "(index into BASE_DATA)", CONTROLLER;
            "krl.table_machine": self.table_machine.unwrap_or(2).into(), 2.0, 16.0, "(index into MACHINE_DEF)", CONTROLLER;
            "krl.table_axis": self.table_axis.unwrap_or(1).into(), 1.0, 6.0, "(external axis)", CONTROLLER;
            "krl.ptp_speed": self.ptp_speed, 1.0, 100.0, "%", CONTROLLER;
            "krl.blend": self.blend, 0.0, 50.0, "mm", CONTROLLER;
            "krl.max_megabytes": self.max_megabytes, 0.001, 1000.0, "MB", "a controller has a few megabytes for programs";
            "krl.max_points": self.max_points as f64, 10.0, 50_000.0, "moves per module",
                "the pendant cannot show longer modules";
        };
        limits.extend(self.orientation.map(|angle| limit("krl.orientation", angle, (-360.0, 360.0), "°", CONTROLLER)));
        limits.extend(self.arctech.iter().flat_map(|arctech| arctech.limits()));
        limits
    }

    fn broken(&self, program: &ProgramSettings) -> Option<Broken> {
        if let Some(axis) = self.table_axis.filter(|axis| *axis == 1 && program.linear_axis.is_some()) {
            let reason = "the linear axis (program.linear_axis) is E1.".to_owned();
            return Some(Broken { key: "krl.table_axis".to_owned(), value: axis.to_string(), reason });
        }
        let home = &self.home;
        if !home.starts_with("A1 ") || !home.bytes().all(|b| b.is_ascii_graphic() || b == b' ') || home.contains('}') {
            return Some(Broken::text("krl.home", home, "an axis position such as \"A1 0.0,A2 -90.0,…\"."));
        }
        if self.arc == KrlArc::Arctech && self.arctech.is_none() {
            let reason = "a table [krl.arctech] with the data of the package is needed.".to_owned();
            return Some(Broken { key: "krl.arc".to_owned(), value: "\"arctech\"".to_owned(), reason });
        }
        self.arctech.as_ref().and_then(ArcTech::broken)
    }

    fn templates(&self) -> Templates<'_> {
        vec![
            ("krl.start", &self.start),
            ("krl.layer_start", &self.layer_start),
            ("krl.arc_on", &self.arc_on),
            ("krl.arc_off", &self.arc_off),
            ("krl.wire_feed", &self.wire_feed),
            ("krl.crater", &self.crater),
            ("krl.end", &self.end),
            ("krl.routines", &self.routines),
        ]
    }

    fn supports(&self, _extra: Extra) -> bool {
        true
    }

    fn longest_pass(&self, program: &ProgramSettings) -> Option<usize> {
        // The longest lines for a move and its speed; arcs have two poses.
        let axes = usize::from(program.linear_axis.is_some()) + program.turning_axes();
        let a_move = if program.arcs { 180 + 44 * axes } else { 102 + 22 * axes };
        Some((self.max_megabytes * MEGABYTE) as usize / a_move)
    }

    fn hooks(&self) -> Option<&Hooks> {
        Some(&self.hooks)
    }

    fn stands_at_start(&self) -> bool {
        self.arc == KrlArc::Arctech || stands(&self.arc_on)
    }

    fn arc_end_time(&self, weld: &WeldSettings) -> Option<f64> {
        let crater = &self.arctech.as_ref().filter(|_| self.arc == KrlArc::Arctech)?.crater;
        // The filling of `[start_stop]` is counted elsewhere, and replaces the section's.
        let filling = if weld.ends.fills_craters() { 0.0 } else { crater.time };
        Some(filling + crater.burnback_time + weld.process.gas_postflow)
    }

    fn dry_run(&mut self) {
        self.hooks.without_arc();
        self.arc = KrlArc::Outputs;
    }

    fn table(&self) -> Option<Table> {
        Some(Table { key: "krl.table_machine", known: self.table_machine.is_some(), what: TABLE })
    }

    fn writer(&self, job: &Job<'_>) -> Result<Box<dyn Writer>, DialectError> {
        match self.arc {
            KrlArc::Arctech => self.arctech.iter().try_for_each(|data| arctech::check(self, data, job))?,
            KrlArc::Outputs => {
                needs::lines("krl", &self.templates(), "$ANOUT[1] = {{wire_feed_ratio}}", job)?;
            }
        }
        let mut section = self.clone();
        if self.arc == KrlArc::Arctech {
            section.hooks.without_arc();
        }
        section.orientation = orientation::zyx(section.orientation, Turn::Torch(job.program.torch_angle));
        Ok(Box::new(KukaKrl::new(job, section)))
    }
}
