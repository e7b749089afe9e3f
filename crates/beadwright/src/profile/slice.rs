//! The section `[slice]`.

use crate::limit::{Limit, limits};
use crate::slice::Surface;
use serde::{Deserialize, Serialize};

/// Slicing tolerances.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SliceSection {
    /// Widest gap in an open contour that is bridged, mm; default 0.5.
    pub close_gap: f64,
    /// Contour vertices closer than this to the simplified line are dropped, mm; default 0.01.
    pub simplify: f64,
    /// What a surface that is not closed stands for: `solid`, whose contours are filled, or `wall`, along which one bead is
    /// laid; optional. If it is left out, a part with an opening wider than a bead is not planned.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub surface: Option<Surface>,
}

impl Default for SliceSection {
    fn default() -> Self {
        Self { close_gap: 0.5, simplify: 0.01, surface: None }
    }
}

impl SliceSection {
    /// The limits of the numbers; some depend on the bead width `w`, mm.
    pub(super) fn limits(&self, w: f64) -> Vec<Limit> {
        limits! {
            "slice.close_gap": self.close_gap, 0.0, 1000.0, "mm", "a wider gap is an opening, not a flaw in the file";
            "slice.simplify": self.simplify, 0.0, 0.2 * w, "mm (at most 0.2 bead widths)",
                "more than a fifth of a bead width would change the part";
        }
    }
}
