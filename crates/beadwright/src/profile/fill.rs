//! The section `[fill]`.

use crate::bead::Overlap;
use crate::fill::around::Around;
use crate::fill::{ContourOrder, LineEnds, RasterSpacing, StrategyName};
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
    /// The angle that takes the least time, among those with few turns and `raster_angle`, chosen for each pair of
    /// layers, the second of which is turned by 90° (Han et al. 2018, 3.1).
    Best,
}

/// How layers are filled.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct FillSection {
    /// Strategy: `loop`, `raster`, `zigzag`, `contour`, `compound`, `hybrid`, `spiral`, `fermat`, `hilbert`, `partition`,
    /// `mat` or `wall`.
    pub strategy: StrategyName,
    /// Model for the overlap of neighbouring beads, which determines the stepover.
    pub overlap: Overlap,
    /// Distance between neighbouring centre-lines (stepover), mm; only with `overlap = "free"`.
    pub stepover: Option<f64>,
    /// Distance from the innermost perimeter to the infill, in bead widths (0.591 in Liu et al. 2022).
    pub contour_gap: f64,
    /// Number of perimeters around the infill of `compound`, `hilbert` and `partition`.
    pub perimeters: u32,
    /// Order of contours: `outside-in` or `inside-out`.
    pub contour_order: ContourOrder,
    /// Extra metal outside the part for machining, mm.
    pub machining_allowance: f64,
    /// Angle of the scan lines on the first layer, ° from the x axis.
    pub raster_angle: f64,
    /// How the raster angle changes from layer to layer: `fixed`, `alternate`, `increment`, or `best` for the angle
    /// that takes the least time, chosen for each pair of layers, the second of which is turned by 90°.
    pub raster_turn: RasterTurn,
    /// Change of the raster angle per layer for `raster_turn = "increment"`, °.
    pub raster_increment: f64,
    /// Spacing of the scan lines: spread evenly (`even`), exactly one stepover apart (`exact`, Liu et al. 2022, eq 11),
    /// or spread evenly between the long edges parallel to them (`fitted`).
    pub raster_spacing: RasterSpacing,
    /// How scan lines end where they are not linked: straight (`plain`, Liu et al. 2022; the default) or with a hook along
    /// a boundary that they meet at a slant (`hooked`), which leaves fewer voids there.
    #[serde(default)]
    pub line_ends: LineEnds,
    /// How islands that go all around an axis (`layers.chart = "cylinder:…"`) are filled: cut open and filled by the strategy
    /// (`open`, the default), or with one helix where both edges are rings (`helix`).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub around: Option<Around>,
    /// Minimum length of a pass, mm; shorter passes are left out with a warning, except an island's only pass.
    pub min_pass_length: f64,
    /// Whether `compound`, `hilbert` and `partition` lay the perimeters before the infill; default false.
    #[serde(default)]
    pub perimeters_first: bool,
    /// Density of the infill of `compound` inside the part, as a fraction from 0 to 1; default 1.
    #[serde(default = "full")]
    pub infill_density: f64,
    /// Number of layers at every top and bottom that are filled solid when the infill is sparse; default 3.
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
    /// Angle of the scan lines on a layer, radians from x.
    pub(crate) fn angle(&self, layer: usize) -> f64 {
        let turned = match self.raster_turn {
            // The plan chooses the best angle, which depends on the layer.
            RasterTurn::Fixed | RasterTurn::Best => 0.0,
            RasterTurn::Alternate => 90.0 * (layer % 2) as f64,
            RasterTurn::Increment => self.raster_increment * layer as f64,
        };
        ((self.raster_angle + turned) % 180.0).to_radians()
    }

    /// The limits of the numbers; some depend on the bead width `w`, mm.
    pub(super) fn limits(&self, w: f64) -> Vec<Limit> {
        limits! {
            "fill.stepover": self.stepover.unwrap_or(w), 0.2 * w, 2.0 * w, "mm (0.2 to 2 bead widths)",
                "beads closer than 0.2 widths pile up; beads more than two widths apart do not touch";
            "fill.contour_gap": self.contour_gap, 0.1, 2.0, "bead widths",
                "beads of different passes must overlap but not lie on top of each other";
            "fill.perimeters": self.perimeters.into(), 1.0, 1000.0, "perimeters",
                "there is always at least the outermost one";
            "fill.machining_allowance": self.machining_allowance, 0.0, 50.0, "mm",
                "more than this would be a different part";
            "fill.raster_angle": self.raster_angle, -360.0, 360.0, "°", "one full turn either way covers every angle";
            "fill.raster_increment": self.raster_increment, -360.0, 360.0, "°",
                "one full turn either way covers every angle";
            "fill.infill_density": self.infill_density, 0.01, 1.0, "(fraction)",
                "below a hundredth there is practically no infill, and 1 is solid";
            "fill.solid_layers": self.solid_layers.into(), 0.0, 32.0, "layers",
                "only this many layers are planned at a time";
            "fill.min_pass_length": self.min_pass_length, 0.0, 1000.0, "mm",
                "shorter passes are all start and end, with no steady arc";
        }
    }
}
