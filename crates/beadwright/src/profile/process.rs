//! The section `[process]`: arc, wire feed, speed and gas.

use serde::{Deserialize, Serialize};

/// Arc, wire feed, speed and gas.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Process {
    /// Wire feed speed, m/min.
    pub wire_feed_speed: f64,
    /// Speed of the torch while the arc burns, mm/s.
    pub deposition_speed: f64,
    /// What changes where a bead is wider or narrower than nominal, or hotter: `speed` of the torch, or `wire-feed`;
    /// default speed.
    #[serde(default)]
    pub follow: Follow,
    /// Part of the wire that ends in the bead, 0 to 1.
    pub efficiency: f64,
    /// Arc current, A; optional, for the heat input.
    pub current: Option<f64>,
    /// Arc voltage, V; optional, for the heat input.
    pub voltage: Option<f64>,
    /// Wait after the arc is on before the torch moves, s.
    pub arc_start_delay: f64,
    /// Wait after the arc is off before the torch leaves, s.
    pub arc_end_delay: f64,
    /// Shielding gas, for the report.
    pub gas: String,
    /// Gas flow, L/min.
    pub gas_flow: f64,
    /// Gas before the arc, s.
    pub gas_preflow: f64,
    /// Gas after the arc, s.
    pub gas_postflow: f64,
    /// Contact tip to work distance, mm.
    pub ctwd: f64,
}

/// What keeps the metal of a bead in balance where it is not the nominal one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Follow {
    /// The torch goes slower or faster; the wire comes at its nominal speed.
    #[default]
    Speed,
    /// The wire comes faster or slower; the torch goes at its nominal speed.
    WireFeed,
}
