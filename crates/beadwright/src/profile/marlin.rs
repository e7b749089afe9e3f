//! Printers' G-code in profiles.

use serde::{Deserialize, Serialize};

/// Printers' G-code (Marlin, Klipper). Templates are lines with `{{placeholders}}`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Marlin {
    /// File name extension without the dot.
    pub extension: String,
    /// Whether E counts from move to move (M83), which keeps small moves exact; else from layer to layer (M82).
    pub relative_extrusion: bool,
    /// Filament drawn back before a travel, mm; 0 for none.
    pub retract_length: f64,
    /// Speed at which it is drawn back and pushed forward again, mm/s.
    pub retract_speed: f64,
    /// Shorter travels are made without drawing it back, mm.
    pub retract_from: f64,
    /// Lines at the beginning: temperatures, homing.
    pub header: Vec<String>,
    /// Lines at the beginning of every layer: fan, temperatures.
    pub layer_start: Vec<String>,
    /// Lines at the end.
    pub footer: Vec<String>,
}
