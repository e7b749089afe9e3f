//! The section `[fanuc]`: a FANUC cell (R-30iB, ArcTool), and what its values can be.

use super::limits::{Broken, Range, broken_text};
use serde::{Deserialize, Serialize};

/// How speeds of welds are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum FanucSpeed {
    /// `8.0mm/sec`.
    #[serde(rename = "mm/sec")]
    MillimetresPerSecond,
    /// `48.0cm/min`.
    #[serde(rename = "cm/min")]
    CentimetresPerMinute,
    /// `WELD_SPEED`, that of the weld schedule, wherever the speed is the nominal one; else `mm/sec`.
    #[serde(rename = "weld-speed")]
    WeldSpeed,
}

/// FANUC TP. Templates are instructions with `{{placeholders}}`, without line number and `;`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Fanuc {
    /// User frame of the part, UF, 0 to 61.
    pub user_frame: u32,
    /// Tool frame of the torch, UT, 1 to 29.
    pub tool_frame: u32,
    /// Configuration of the points, such as `N U T, 0, 0, 0`.
    pub configuration: String,
    /// Axis position before and after the program, J1 to J6, °.
    pub home: [f64; 6],
    /// Speed to and from it, %.
    pub home_speed: f64,
    /// Orientation of the tool in the user frame: W, P, R, °; `[180, 0, 0]` is straight down.
    pub orientation: [f64; 3],
    /// Continuity along a pass: CNT 0 to 100; where the arc switches it is FINE.
    pub continuity: u32,
    /// How speeds of welds are written: `mm/sec`, `cm/min` or `weld-speed`.
    pub speed: FanucSpeed,
    /// A program of a layer holds at most this many moves and goes on in another: pendants take 9,999 lines.
    pub max_points: usize,
    /// Instructions at the beginning of the main program.
    pub start: Vec<String>,
    /// Instructions at the beginning of every layer.
    pub layer_start: Vec<String>,
    /// Instructions that light the arc, at the start point of a pass.
    pub arc_on: Vec<String>,
    /// Instructions that end the arc, at the end point of a pass.
    pub arc_off: Vec<String>,
    /// Instructions that set the wire feed to `{{wire_feed_ratio}}` of the nominal one, or to `{{wire_feed}}` m/min;
    /// written where it changes. Needed for `process.follow = "wire-feed"` and for a `start_stop.crater_power` below 1;
    /// default none.
    #[serde(default)]
    pub wire_feed: Vec<String>,
    /// Instructions that set the wire feed in the crater, where the torch stands; by default those of `wire_feed`.
    /// Needed where those act only with the next move.
    #[serde(default)]
    pub crater: Vec<String>,
    /// Instructions at the end of the main program.
    pub end: Vec<String>,
}

impl Fanuc {
    /// Ranges of the numbers.
    pub(super) fn ranges(&self) -> Vec<Range> {
        let mut ranges = vec![
            ("fanuc.user_frame", self.user_frame.into(), 0.0, 61.0, "(user frame)"),
            ("fanuc.tool_frame", self.tool_frame.into(), 1.0, 29.0, "(tool frame)"),
            ("fanuc.home_speed", self.home_speed, 1.0, 100.0, "%"),
            ("fanuc.continuity", self.continuity.into(), 0.0, 100.0, "(CNT)"),
            ("fanuc.max_points", self.max_points as f64, 10.0, 3000.0, "moves a program"),
        ];
        ranges.extend(self.home.map(|axis| ("fanuc.home", axis, -720.0, 720.0, "°")));
        ranges.extend(self.orientation.map(|angle| ("fanuc.orientation", angle, -360.0, 360.0, "°")));
        ranges
    }

    /// A configuration that a controller would refuse.
    pub(super) fn broken(&self) -> Option<Broken> {
        let legal = |b: u8| b.is_ascii_alphanumeric() || b" ,-".contains(&b);
        let fits = !self.configuration.is_empty() && self.configuration.bytes().all(legal);
        let reason = "such as \"N U T, 0, 0, 0\".";
        (!fits).then(|| broken_text("fanuc.configuration", &self.configuration, reason))
    }

    /// Keys and lines of the templates.
    pub(super) fn templates(&self) -> [(&'static str, &Vec<String>); 7] {
        [
            ("fanuc.start", &self.start),
            ("fanuc.layer_start", &self.layer_start),
            ("fanuc.arc_on", &self.arc_on),
            ("fanuc.arc_off", &self.arc_off),
            ("fanuc.wire_feed", &self.wire_feed),
            ("fanuc.crater", &self.crater),
            ("fanuc.end", &self.end),
        ]
    }
}
