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
    /// Lines that set the wire feed to `{{wire_feed_ratio}}` of the nominal one, or to `{{wire_feed}}` m/min; written
    /// where it changes. `$ANOUT[1] = …` stops at the point before; `TRIGGER WHEN DISTANCE=0 DELAY=0 DO $ANOUT[1] = …`
    /// does not. Needed for `process.follow = "wire-feed"` and for a `start_stop.crater_power` below 1; default none.
    #[serde(default)]
    pub wire_feed: Vec<String>,
    /// Lines that set the wire feed in the crater, where the torch stands; by default those of `wire_feed`. Needed
    /// where those act only with the next move, as a TRIGGER does.
    #[serde(default)]
    pub crater: Vec<String>,
    /// Lines at the end of the main program.
    pub end: Vec<String>,
}
