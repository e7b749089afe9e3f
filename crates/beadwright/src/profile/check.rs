//! Limits of the checks in profiles.

use crate::limit::{Limit, TINY, limits};
use serde::{Deserialize, Serialize};

/// Limits of the checks; every key has a default.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct CheckLimits {
    /// Most void of a layer, % of its area; default 3.
    pub max_void: f64,
    /// Most overfill of a layer, % of its area; default 12.
    pub max_overfill: f64,
    /// Most metal outside the outline of a layer, % of its area; default 3.
    pub max_outside: f64,
    /// How far a layer may reach beyond the one below, in bead widths; default 0.5.
    pub max_overhang: f64,
    /// Lowest deposition speed of the process, mm/s; a quarter of the nominal one when left out.
    pub min_speed: Option<f64>,
    /// Highest deposition speed of the process, mm/s; four times the nominal one when left out.
    pub max_speed: Option<f64>,
    /// Most heat per length of bead, J/mm; not checked when left out.
    pub max_heat_input: Option<f64>,
    /// Least time of a layer, s; not checked when left out.
    pub min_layer_time: Option<f64>,
    /// Layers, one after another, on which arcs may not start at one place; default 12.
    pub stacked_starts: u32,
    /// Most points of a layer; default 20000.
    pub max_points: u32,
    /// Most points of the whole plan, where the controller must hold all of it: a KR C4 has room for about 50,000; no default.
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
            stacked_starts: 12,
            max_points: 20_000,
            max_plan_points: None,
        }
    }
}

impl CheckLimits {
    /// What the numbers can be.
    pub(super) fn limits(&self) -> Vec<Limit> {
        limits! {
            "check.max_void": self.max_void, 0.0, 100.0, "% of the area", "beyond this nothing would ever be found";
            "check.max_overfill": self.max_overfill, 0.0, 100.0, "% of the area",
                "beyond this nothing would ever be found";
            "check.max_outside": self.max_outside, 0.0, 100.0, "% of the area",
                "beyond this nothing would ever be found";
            "check.max_overhang": self.max_overhang, 0.0, 10.0, "bead widths",
                "beyond this nothing would ever be found";
            "check.min_speed": self.min_speed.unwrap_or(1.0), 0.0, 2000.0, "mm/s",
                "beyond this nothing would ever be found";
            "check.max_speed": self.max_speed.unwrap_or(1.0), TINY, 2000.0, "mm/s",
                "beyond this nothing would ever be found";
            "check.max_heat_input": self.max_heat_input.unwrap_or(1.0), TINY, 1e6, "J/mm",
                "beyond this nothing would ever be found";
            "check.min_layer_time": self.min_layer_time.unwrap_or(1.0), 0.0, 1e6, "s",
                "beyond this nothing would ever be found";
            "check.stacked_starts": self.stacked_starts.into(), 2.0, 1e6, "layers",
                "one start over another is no tower yet";
            "check.max_points": self.max_points.into(), 10.0, 1e8, "points", "beyond this nothing would ever be found";
            "check.max_plan_points": self.max_plan_points.unwrap_or(50_000).into(), 10.0, 1e9, "points",
                "beyond this nothing would ever be found";
        }
    }
}
