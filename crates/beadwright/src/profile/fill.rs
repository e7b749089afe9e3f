//! The section `[fill]`.

use crate::bead::Overlap;
use crate::fill::{ContourOrder, RasterSpacing};
use crate::limit::{Limit, limits};
use serde::{Deserialize, Serialize};

/// How the raster angle changes from layer to layer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum RasterTurn {
    /// The same angle on every layer.
    Fixed,
    /// Turned by 90° on every second layer.
    Alternate,
    /// Turned by `raster_increment` from layer to layer.
    Increment,
    /// The angle with the fewest turns, chosen for every two layers, the second turned by 90° (Han et al. 2018, 3.1).
    Best,
}

/// How layers are filled.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct FillSection {
    /// Strategy: `loop`, `raster`, `zigzag`, `contour`, `compound`, `hybrid` or `wall`.
    pub strategy: String,
    /// Model of the overlap of neighbouring beads, which gives the stepover.
    pub overlap: Overlap,
    /// Stepover, mm; only with `overlap = "free"`.
    pub stepover: Option<f64>,
    /// Distance from the innermost perimeter to the infill, in bead widths (0.591 by Liu et al. 2022).
    pub contour_gap: f64,
    /// Perimeters around the infill of `compound`.
    pub perimeters: u32,
    /// Order of contours: `outside-in` or `inside-out`.
    pub contour_order: ContourOrder,
    /// Extra metal outside the part for machining, mm.
    pub machining_allowance: f64,
    /// Angle of the scan lines on the first layer, ° from x.
    pub raster_angle: f64,
    /// Change of the angle from layer to layer: `fixed`, `alternate`, `increment`, or `best` for the angle with the fewest
    /// turns, chosen for every two layers.
    pub raster_turn: RasterTurn,
    /// Turn per layer for `increment`, °.
    pub raster_increment: f64,
    /// Scan lines spread evenly (`even`) or exactly one stepover apart (`exact`, Liu et al. 2022, eq 11).
    pub raster_spacing: RasterSpacing,
    /// Shorter passes are left out with a warning, mm.
    pub min_pass_length: f64,
    /// Whether `compound` lays the perimeters before the infill; default false.
    #[serde(default)]
    pub perimeters_first: bool,
    /// Part of the infill of `compound` that is filled inside the part, 0 to 1; default 1.
    #[serde(default = "full")]
    pub infill_density: f64,
    /// Layers at every top and bottom that are filled solid when the infill is sparse; default 3.
    #[serde(default = "three")]
    pub solid_layers: u32,
}

fn full() -> f64 {
    1.0
}

fn three() -> u32 {
    3
}

impl FillSection {
    /// What the numbers can be; some depend on the width of a bead, mm.
    pub(super) fn limits(&self, w: f64) -> Vec<Limit> {
        limits! {
            "fill.stepover": self.stepover.unwrap_or(w), 0.2 * w, 2.0 * w, "mm (0.2 to 2 bead widths)",
                "nearer than 0.2 widths beads pile up; farther than two widths they do not touch";
            "fill.contour_gap": self.contour_gap, 0.1, 2.0, "bead widths",
                "beads of different passes must overlap, and not lie on each other";
            "fill.perimeters": self.perimeters.into(), 1.0, 1000.0, "perimeters", "there is at least the outermost one";
            "fill.machining_allowance": self.machining_allowance, 0.0, 50.0, "mm", "more than this is another part";
            "fill.raster_angle": self.raster_angle, -360.0, 360.0, "°", "a whole turn either way says everything";
            "fill.raster_increment": self.raster_increment, -360.0, 360.0, "°",
                "a whole turn either way says everything";
            "fill.infill_density": self.infill_density, 0.01, 1.0, "of full", "from nothing but a hundredth to full";
            "fill.solid_layers": self.solid_layers.into(), 0.0, 32.0, "layers",
                "more layers than are planned at a time cannot be looked through";
            "fill.min_pass_length": self.min_pass_length, 0.0, 1000.0, "mm",
                "shorter passes are all start and end: no steady arc";
        }
    }
}
