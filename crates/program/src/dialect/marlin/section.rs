//! Printers' G-code in profiles: the keys, and the limits of their values.

use super::write::MarlinGcode;
use crate::dialect::writing::is_extension;
use crate::dialect::{DialectError, Job, Section, Templates, Writer};
use crate::program::ProgramSettings;
use bead_plan::layer::Extent;
use bead_plan::limit::{Broken, Limit, limits};
use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};

/// Printers' G-code (Marlin, Klipper). Templates are lines with `{{placeholders}}`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Marlin {
    /// File name extension without the dot.
    pub extension: String,
    /// Whether E restarts for every move (M83), which keeps small moves exact; otherwise it accumulates over a layer
    /// (M82).
    pub relative_extrusion: bool,
    /// Length of filament drawn back before a travel, mm; 0 for none.
    pub retract_length: f64,
    /// Speed at which the filament is drawn back and pushed forward again, mm/s.
    pub retract_speed: f64,
    /// Shortest travel for which the filament is drawn back, mm.
    pub retract_from: f64,
    /// The printer's bed: parts are moved to its middle, and those that do not fit on it are refused. If absent, coordinates
    /// are those of the part.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bed: Option<Bed>,
    /// Lines at the beginning of the program: temperatures, homing.
    pub header: Vec<String>,
    /// Lines at the beginning of every layer: fan, temperatures.
    pub layer_start: Vec<String>,
    /// Lines at the end of the program.
    pub footer: Vec<String>,
}

/// The bed of a printer.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Bed {
    /// Length, width and height that the printer reaches, mm.
    pub size: [f64; 3],
    /// Where x = y = 0 lies.
    pub origin: BedOrigin,
}

/// Where on a bed x = y = 0 lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub enum BedOrigin {
    /// At the front left corner, as on most printers.
    Corner,
    /// In the middle, as on delta printers.
    Centre,
}

impl Bed {
    /// The shift of a part to the middle of the bed, mm.
    ///
    /// # Errors
    /// [`DialectError::OffBed`].
    pub(super) fn offset(&self, part: &Extent) -> Result<DVec2, DialectError> {
        let (size, bed) = (part.size(), DVec3::from_array(self.size));
        if size.cmpgt(bed).any() {
            return Err(DialectError::OffBed { part: size, bed: self.size });
        }
        let middle = match self.origin {
            BedOrigin::Corner => bed.truncate() / 2.0,
            BedOrigin::Centre => DVec2::ZERO,
        };
        // Whole micrometres, so that round numbers in the part stay round.
        Ok(((middle - (part.low + part.high).truncate() / 2.0) * 1e3).round() / 1e3)
    }
}

impl Section for Marlin {
    fn limits(&self) -> Vec<Limit> {
        const PRINTER: &str = "no printer on the market goes beyond this";
        let hot_end = "drawing back more would pull the filament out of the hot end";
        let [x, y, z] = self.bed.map_or([1.0; 3], |bed| bed.size);
        limits! {
            "marlin.bed.size": x, 1.0, 10_000.0, "mm", PRINTER;
            "marlin.bed.size": y, 1.0, 10_000.0, "mm", PRINTER;
            "marlin.bed.size": z, 1.0, 10_000.0, "mm", PRINTER;
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
        // A printer's E sets the feed of every move, but nothing can be fed without a move.
        let cannot = |what, remedy| Err(DialectError::Cannot { dialect: "marlin", what, remedy });
        if job.weld.ends.fills_craters() && !job.dry_run {
            return cannot("a start_stop.crater_fill_time", "Strands have no craters: leave it out.");
        }
        if job.weld.ends.wire_retract > 0.0 && !job.dry_run {
            return cannot("a start_stop.wire_retract", "Use marlin.retract_length instead.");
        }
        Ok(Box::new(MarlinGcode::new(job, self.clone())))
    }
}
