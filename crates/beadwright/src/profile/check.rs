//! Limits of the checks in profiles.

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
