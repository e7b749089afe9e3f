//! CNC G-code in profiles.

use serde::{Deserialize, Serialize};

/// CNC G-code. Flavours of controllers differ in these keys and in the templates: a dwell of `{{gas_preflow}}` s is
/// `G4 P{{gas_preflow}}` for LinuxCNC, `G4 P{{gas_preflow_ms}}` for Fanuc and `G4 F{{gas_preflow}}` for Siemens.
/// Templates are blocks with `{{placeholders}}`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Gcode {
    /// File name extension without the dot.
    pub extension: String,
    /// Whether blocks carry N numbers.
    pub block_numbers: bool,
    /// Decimals of coordinates, 1 to 4.
    pub decimals: usize,
    /// Whether a `%` stands before and behind the program (LinuxCNC, Fanuc; not Siemens); default true.
    #[serde(default = "yes")]
    pub percent_signs: bool,
    /// O number of the program (Fanuc); default none.
    pub program_number: Option<u32>,
    /// How comments are written: `parentheses` or `semicolon` (Siemens); default parentheses.
    #[serde(default)]
    pub comments: GcodeComments,
    /// Blocks at the beginning.
    pub header: Vec<String>,
    /// Blocks at the beginning of every layer.
    pub layer_start: Vec<String>,
    /// Blocks that light the arc, at the start point of a pass.
    pub arc_on: Vec<String>,
    /// Blocks that end the arc, at the end point of a pass.
    pub arc_off: Vec<String>,
    /// Blocks that wait `{{dwell}}` s or `{{dwell_ms}}` ms; default `G4 P{{dwell}}`, which is LinuxCNC's.
    #[serde(default = "seconds")]
    pub dwell: Vec<String>,
    /// Blocks that set the wire feed to `{{wire_feed_ratio}}` of the nominal one, or to `{{wire_feed}}` m/min; written
    /// where it changes. Needed for `process.follow = "wire-feed"` and for a `start_stop.crater_power` below 1; default
    /// none.
    #[serde(default)]
    pub wire_feed: Vec<String>,
    /// Blocks that set the wire feed in the crater, where the torch stands; by default those of `wire_feed`. Needed
    /// where those act only with the next move, as LinuxCNC's M67 does: M68 does not.
    #[serde(default)]
    pub crater: Vec<String>,
    /// Blocks at the end.
    pub footer: Vec<String>,
}

/// How comments are written in CNC G-code.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
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

fn yes() -> bool {
    true
}
