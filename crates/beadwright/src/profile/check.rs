//! The section `[check]`.

use crate::limit::{Limit, TINY, limits};
use serde::{Deserialize, Serialize};

/// Limits of the checks; every key has a default.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct CheckLimits {
    /// Maximum void in a layer, % of its area; default 3.
    pub max_void: f64,
    /// Maximum overfill in a layer, % of its area; default 12.
    pub max_overfill: f64,
    /// Maximum metal outside the outline of a layer, % of its area; default 3.
    pub max_outside: f64,
    /// How far a layer may reach beyond the one below, in bead widths; default 0.5.
    pub max_overhang: f64,
    /// Lowest deposition speed of the process, mm/s; a quarter of the nominal speed if left out.
    pub min_speed: Option<f64>,
    /// Highest deposition speed of the process, mm/s; four times the nominal speed if left out.
    pub max_speed: Option<f64>,
    /// Maximum heat per length of bead, J/mm; not checked if left out.
    pub max_heat_input: Option<f64>,
    /// Minimum time of a layer, s; not checked if left out.
    pub min_layer_time: Option<f64>,
    /// Layers that take less time than this, s, are reported if the program has no wait to cool them; 0 for no report;
    /// default 15.
    pub cooling_time: f64,
    /// Number of consecutive layers on which arcs must not all start in the same place; default 12.
    pub stacked_starts: u32,
    /// Maximum number of points in a layer; default 20000.
    pub max_points: u32,
    /// Maximum number of points in the whole plan, if the controller must hold all of it (a KR C4 has room for about
    /// 50,000); not checked if left out.
    pub max_plan_points: Option<u32>,
}

impl Default for CheckLimits {
    fn default() -> Self {
        Self {
            max_void: 3.0,
            max_overfill: 12.0,
            max_outside: 3.0,
            max_overhang: 0.5,
            min_speed: None,
            max_speed: None,
            max_heat_input: None,
            min_layer_time: None,
            cooling_time: 15.0,
            stacked_starts: 12,
            max_points: 20_000,
            max_plan_points: None,
        }
    }
}

impl CheckLimits {
    /// The limits of the numbers.
    pub(super) fn limits(&self) -> Vec<Limit> {
        limits! {
            "check.max_void": self.max_void, 0.0, 100.0, "% of the area",
                "outside this range the check would never find anything";
            "check.max_overfill": self.max_overfill, 0.0, 100.0, "% of the area",
                "outside this range the check would never find anything";
            "check.max_outside": self.max_outside, 0.0, 100.0, "% of the area",
                "outside this range the check would never find anything";
            "check.max_overhang": self.max_overhang, 0.0, 10.0, "bead widths",
                "outside this range the check would never find anything";
            "check.min_speed": self.min_speed.unwrap_or(1.0), 0.0, 2000.0, "mm/s",
                "outside this range the check would never find anything";
            "check.max_speed": self.max_speed.unwrap_or(1.0), TINY, 2000.0, "mm/s",
                "outside this range the check would never find anything";
            "check.max_heat_input": self.max_heat_input.unwrap_or(1.0), TINY, 1e6, "J/mm",
                "outside this range the check would never find anything";
            "check.min_layer_time": self.min_layer_time.unwrap_or(1.0), 0.0, 1e6, "s",
                "outside this range the check would never find anything";
            "check.cooling_time": self.cooling_time, 0.0, 36_000.0, "s",
                "ten hours cool any part";
            "check.stacked_starts": self.stacked_starts.into(), 2.0, 1e6, "layers",
                "one start over another is not yet a tower";
            "check.max_points": self.max_points.into(), 10.0, 1e8, "points",
                "outside this range the check would never find anything";
            "check.max_plan_points": self.max_plan_points.unwrap_or(50_000).into(), 10.0, 1e9, "points",
                "outside this range the check would never find anything";
        }
    }
}
