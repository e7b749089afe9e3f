//! KUKA KRL in profiles.

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
    /// Axis position before and after the program, as in an E6AXIS: `A1 0.0,A2 -90.0,…`, °.
    pub home: String,
    /// Orientation of the tool, A, B and C, °.
    pub orientation: [f64; 3],
    /// Speed of point-to-point moves, %.
    pub ptp_speed: f64,
    /// Blending distance along a pass, `$APO.CDIS`, mm; 0 for none.
    pub blend: f64,
    /// Lines at the beginning of the main program.
    pub start: Vec<String>,
    /// Lines at the beginning of every layer.
    pub layer_start: Vec<String>,
    /// Lines that light the arc, at the start point of a pass.
    pub arc_on: Vec<String>,
    /// Lines that end the arc, at the end point of a pass.
    pub arc_off: Vec<String>,
    /// Lines at the end of the main program.
    pub end: Vec<String>,
}
