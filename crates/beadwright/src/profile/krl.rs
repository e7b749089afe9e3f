//! KUKA KRL in profiles.

use super::arctech::{ArcTech, KrlArc};
use super::limits::{Broken, Range};
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
    /// Moves in one module; longer layers are cut between passes; default 2000.
    #[serde(default = "two_thousand")]
    pub max_points: usize,
    /// What switches the arc: `outputs`, the lines `arc_on` and `arc_off`, or `arctech`, the forms of ArcTech Basic; default
    /// outputs.
    #[serde(default)]
    pub arc: KrlArc,
    /// Data of ArcTech Basic; needed for `arc = "arctech"`.
    pub arctech: Option<ArcTech>,
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

fn two_thousand() -> usize {
    2000
}

impl Krl {
    /// Ranges of the numbers.
    pub(super) fn ranges(&self) -> Vec<Range> {
        let mut ranges = vec![
            ("krl.tool", self.tool.into(), 1.0, 16.0, "(index into TOOL_DATA)"),
            ("krl.base", self.base.into(), 1.0, 32.0, "(index into BASE_DATA)"),
            ("krl.ptp_speed", self.ptp_speed, 1.0, 100.0, "%"),
            ("krl.blend", self.blend, 0.0, 50.0, "mm"),
            ("krl.max_points", self.max_points as f64, 10.0, 50_000.0, "moves a module"),
        ];
        ranges.extend(self.orientation.map(|angle| ("krl.orientation", angle, -360.0, 360.0, "°")));
        ranges.extend(self.arctech.iter().flat_map(|arctech| arctech.ranges()));
        ranges
    }

    /// The first text that a controller would refuse.
    pub(super) fn broken(&self) -> Option<Broken> {
        if self.arc == KrlArc::Arctech && self.arctech.is_none() {
            let reason = "a table [krl.arctech] with the data of the package is needed.".to_owned();
            return Some(Broken { key: "krl.arc".to_owned(), value: "\"arctech\"".to_owned(), reason });
        }
        self.arctech.as_ref().and_then(ArcTech::broken)
    }
}
