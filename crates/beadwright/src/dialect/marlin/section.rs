//! Printers' G-code in profiles: the keys, and what their values can be.

use super::write::MarlinGcode;
use crate::dialect::{DialectError, Job, Section, Templates, Writer};
use crate::dialect::writing::is_extension;
use crate::program::ProgramSettings;
use crate::limit::{Broken, Limit, limits};
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

impl Section for Marlin {
    fn limits(&self) -> Vec<Limit> {
        const PRINTER: &str = "no printer of the trade goes beyond";
        let hot_end = "more filament than this leaves the hot end";
        limits! {
            "marlin.retract_length": self.retract_length, 0.0, 50.0, "mm of filament", hot_end;
            "marlin.retract_speed": self.retract_speed, 0.1, 500.0, "mm/s", PRINTER;
            "marlin.retract_from": self.retract_from, 0.0, 1000.0, "mm", PRINTER;
        }
    }

    fn broken(&self, _program: &ProgramSettings) -> Option<Broken> {
        (!is_extension(&self.extension))
            .then(|| Broken::text("marlin.extension", &self.extension, "letters and digits only."))
    }

    fn templates(&self) -> Templates<'_> {
        vec![
            ("marlin.header", &self.header),
            ("marlin.layer_start", &self.layer_start),
            ("marlin.footer", &self.footer),
        ]
    }

    fn writer(&self, job: &Job<'_>) -> Result<Box<dyn Writer>, DialectError> {
        // A printer's E tells the feed of every move, but nothing melts without one.
        let cannot = |what, remedy| Err(DialectError::Cannot { dialect: "marlin", what, remedy });
        if job.weld.ends.crater_fill_time > 0.0 && !job.dry_run {
            return cannot("a start_stop.crater_fill_time", "Strands have no craters: leave it out.");
        }
        if job.weld.ends.wire_retract > 0.0 && !job.dry_run {
            return cannot("a start_stop.wire_retract", "Take marlin.retract_length instead.");
        }
        Ok(Box::new(MarlinGcode::new(job, self.clone())))
    }
}
