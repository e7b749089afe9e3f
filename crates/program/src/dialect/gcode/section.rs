//! CNC G-code in profiles: the keys, and the limits of their values.

use super::control::GcodeControl;
use super::positioner::{GcodePositioner, TABLE};
use super::write::CncGcode;
use crate::dialect::writing::{is_extension, needs};
use crate::dialect::{DialectError, Extra, Hooks, Job, Section, Table, Templates, Writer};
use crate::program::ProgramSettings;
use bead_plan::limit::{Broken, CONTROLLER, Limit, limits};
use serde::{Deserialize, Serialize};

/// CNC G-code. These keys and the templates cover the differences between controllers: a dwell of `{{gas_preflow}}` s
/// is `G4 P{{gas_preflow}}` for LinuxCNC, `G4 P{{gas_preflow_ms}}` for Fanuc and `G4 F{{gas_preflow}}` for Siemens.
/// Templates are blocks with `{{placeholders}}`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Gcode {
    /// File name extension without the dot.
    pub extension: String,
    /// Whether blocks have N numbers.
    pub block_numbers: bool,
    /// Number of decimal places of coordinates, 1 to 4.
    pub decimals: usize,
    /// Whether the program begins and ends with a `%` line (LinuxCNC, Fanuc; not Siemens); default true.
    #[serde(default = "yes")]
    pub percent_signs: bool,
    /// O number of the program (Fanuc); default none.
    pub program_number: Option<u32>,
    /// Height to which the torch moves before its first horizontal move, in the part's coordinates, mm: above clamps,
    /// and above the part if a program begins in its middle; default 100.
    #[serde(default = "hundred")]
    pub safe_z: f64,
    /// How comments are written: `parentheses` or `semicolon` (Siemens); default parentheses.
    #[serde(default)]
    pub comments: GcodeComments,
    /// Blocks at the beginning of the program.
    pub header: Vec<String>,
    /// Blocks at the beginning of every layer.
    pub layer_start: Vec<String>,
    /// Blocks that strike the arc at the start point of a pass.
    pub arc_on: Vec<String>,
    /// Blocks that end the arc at the end point of a pass.
    pub arc_off: Vec<String>,
    /// Blocks that wait `{{dwell}}` s or `{{dwell_ms}}` ms; default `G4 P{{dwell}}`, as LinuxCNC expects.
    #[serde(default = "seconds")]
    pub dwell: Vec<String>,
    /// Blocks that set the wire feed to `{{wire_feed_ratio}}` times its nominal value, or to `{{wire_feed}}` m/min;
    /// written wherever it changes. Needed for `process.follow = "wire-feed"` and for a `start_stop.crater_power` below
    /// 1; default none.
    #[serde(default)]
    pub wire_feed: Vec<String>,
    /// Blocks that set the wire feed while the torch stands still to fill the crater; default: those of `wire_feed`.
    /// Needed if those take effect only with the next move, as M67 of LinuxCNC does, unlike M68.
    #[serde(default)]
    pub crater: Vec<String>,
    /// Address of an auxiliary axis that feeds the wire along with the torch, such as `Q1=` (TwinCAT NC I) or `E`: weld
    /// moves give the length of wire that is fed until their end, mm from the beginning of the program. It follows the
    /// wire feed without `wire_feed` lines. Default none: blocks of the templates switch the wire.
    pub wire_axis: Option<String>,
    /// Blocks at the end of the program.
    pub footer: Vec<String>,
    /// The control in whose language branches, heights of layers and file names are written: `linuxcnc`, `fanuc`, `siemens`
    /// or `twincat` (NC I, classic interpreter). Needed for `program.restart` and `program.layer_offsets`; default none.
    pub control: Option<GcodeControl>,
    /// How the axes that turn the part are written; needed for `[program.positioner]`, default none.
    pub positioner: Option<GcodePositioner>,
    /// Lines at other places of the program; default none.
    #[serde(default)]
    pub hooks: Hooks,
}

/// How comments are written in CNC G-code.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub enum GcodeComments {
    /// `(LAYER 1)`
    #[default]
    Parentheses,
    /// `; LAYER 1`
    Semicolon,
}

fn seconds() -> Vec<String> {
    vec!["G4 P{{dwell}}".to_owned()]
}

fn hundred() -> f64 {
    100.0
}

/// Whether a text is the address of an axis: a letter, or a letter with a number and `=`.
pub(super) fn is_axis(text: &str) -> bool {
    let Some((letter, rest)) = text.split_at_checked(1) else { return false };
    let index = rest.strip_suffix('=').unwrap_or("x");
    "ABCDEHLOPQRSTUVW".contains(letter) && (rest.is_empty() || index.parse::<u8>().is_ok())
}

fn yes() -> bool {
    true
}

impl Section for Gcode {
    fn limits(&self) -> Vec<Limit> {
        let number = self.program_number.unwrap_or(1);
        limits! {
            "gcode.decimals": self.decimals as f64, 1.0, 4.0, "decimals", CONTROLLER;
            "gcode.safe_z": self.safe_z, 0.0, 1e4, "mm", "below 0 it would go into the table";
            "gcode.program_number": number.into(), 1.0, 9999.0, "(O number)", CONTROLLER;
        }
    }

    fn broken(&self, program: &ProgramSettings) -> Option<Broken> {
        if !is_extension(&self.extension) {
            return Some(Broken::text("gcode.extension", &self.extension, "letters and digits only."));
        }
        if let Some(axis) = self.wire_axis.as_ref().filter(|axis| !is_axis(axis)) {
            let reason = "it must be one letter that no other word uses, or a letter, a number and =, such as \"Q1=\".";
            return Some(Broken::text("gcode.wire_axis", axis, reason));
        }
        if let Some(broken) = self.positioner.as_ref().and_then(|own| own.broken(program)) {
            return Some(broken);
        }
        let coarse = program.arcs && self.decimals < 3;
        coarse.then(|| program.broken_tolerance("arcs = true needs 3 gcode.decimals or more: the radius must be kept."))
    }

    fn templates(&self) -> Templates<'_> {
        let mut templates = vec![
            ("gcode.header", &self.header),
            ("gcode.layer_start", &self.layer_start),
            ("gcode.arc_on", &self.arc_on),
            ("gcode.arc_off", &self.arc_off),
            ("gcode.dwell", &self.dwell),
            ("gcode.wire_feed", &self.wire_feed),
            ("gcode.crater", &self.crater),
            ("gcode.footer", &self.footer),
        ];
        templates.extend(self.positioner.iter().flat_map(GcodePositioner::templates));
        templates
    }

    fn supports(&self, extra: Extra) -> bool {
        match extra {
            // The wire axis would feed at once the wire of the skipped passes.
            Extra::Restart => self.control.is_some() && self.wire_axis.is_none(),
            Extra::LayerOffsets => self.control.is_some(),
            Extra::Weave => true,
            // The part turns, and the torch points straight down.
            Extra::Chart => self.positioner.is_some(),
            Extra::Tilt => false,
        }
    }

    fn table(&self) -> Option<Table> {
        Some(Table { key: "gcode.positioner", known: self.positioner.is_some(), what: TABLE })
    }

    fn hooks(&self) -> Option<&Hooks> {
        Some(&self.hooks)
    }

    fn dry_run(&mut self) {
        self.hooks.without_arc();
        self.wire_axis = None;
    }

    fn writer(&self, job: &Job<'_>) -> Result<Box<dyn Writer>, DialectError> {
        // A wire axis follows the wire feed by itself.
        if self.wire_axis.is_none() || job.weld.ends.wire_retract > 0.0 {
            needs::lines("gcode", &self.templates(), "M67 E0 Q{{wire_feed_ratio}}", job)?;
        }
        Ok(Box::new(CncGcode::new(job, self.clone())))
    }
}
