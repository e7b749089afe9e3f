//! The section `[bead]`.

use crate::bead::{BeadByHeat, Law, Section};
use crate::limit::{Limit, limits};
use serde::{Deserialize, Serialize};

/// Shape of a single bead.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct BeadSection {
    /// Width at the foot, mm.
    pub width: f64,
    /// Height at the crown, mm.
    pub height: f64,
    /// Cross-section: `parabola`, `ellipse`, or `stadium` for the flat beads of printers; default parabola.
    #[serde(default)]
    pub section: Section,
    /// How a bead's height changes with its width at a constant wire feed: `constant-height`, `constant-ratio`, or
    /// measured beads as `{ library = [[width, height], …] }` in mm; default constant-height.
    #[serde(default)]
    pub law: Law,
    /// Path of a library of measured beads, as `beadwright bead fit` writes it, relative to the profile's folder. The
    /// beads that it gives for this process at other speeds replace `law`; optional.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub library: Option<String>,
    /// How the bead changes with the heat of the metal below; optional, default not at all.
    pub by_heat: Option<BeadByHeat>,
}

impl BeadSection {
    /// The limits of the numbers.
    pub(super) fn limits(&self) -> Vec<Limit> {
        let general = limits! {
            "bead.width": self.width, 0.05, 100.0, "mm",
                "this covers everything from a printer's line to the widest weave";
            "bead.height": self.height, 0.01, 50.0, "mm", "a bead that is higher than it is wide falls over";
        };
        let by_heat = self.by_heat.iter().flat_map(BeadByHeat::limits);
        general.into_iter().chain(by_heat).collect()
    }
}
