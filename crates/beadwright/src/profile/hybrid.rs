//! Thresholds of the hybrid in profiles.

use crate::fill::hybrid::{HybridOrder, ScanAlong};
use serde::{Deserialize, Serialize};

/// Thresholds of the strategy `hybrid` (Zhao et al. 2023); every key has a default.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Hybrid {
    /// Follow the paper to the letter; default false.
    pub literal: bool,
    /// How far a contour is moved in to find its pockets, in stepovers; default 1.5.
    pub pocket_depth: f64,
    /// What the backtracked contour is larger so that numerical slivers are no pockets (u), in stepovers; default 0.01.
    pub tolerance: f64,
    /// Smaller pockets are not kept, in squared bead widths; default 0.05.
    pub min_pocket_area: f64,
    /// Shorter corner pockets are not kept, in bead widths; default 3.
    pub min_pocket_length: f64,
    /// Distance between skeleton fill and contours (d2), in stepovers (d1); default 0.928: 5 mm to 5.39 mm.
    pub skeleton_gap: f64,
    /// Least distance between contours and beads along a medial axis, in stepovers; default 0.64.
    pub least_gap: f64,
    /// Skeleton regions narrower than this, in stepovers, are filled along their medial axis; default 12.
    pub region_width: f64,
    /// Scan lines of wide skeleton regions run along the `short` or the `long` side of their smallest rectangle, or
    /// `auto`: with fewer arc starts, then fewer turns; default auto.
    pub scan_along: ScanAlong,
    /// What is laid first: `skeleton-first` or `contours-first`; default skeleton-first.
    pub order: HybridOrder,
    /// How far free ends of cut contours reach into the fill, in bead widths; default 0.5.
    pub end_overlap: f64,
    /// How far sharp corners of contours are drawn out into the void before them, 0 to 1; default 0.4.
    pub tip_reach: f64,
    /// The narrowest bead of the process, in bead widths; default 0.7.
    pub min_width: f64,
    /// The widest bead of the process, in bead widths; default 1.4.
    pub max_width: f64,
}

impl Default for Hybrid {
    fn default() -> Self {
        Self {
            literal: false,
            pocket_depth: 1.5,
            tolerance: 0.01,
            min_pocket_area: 0.05,
            min_pocket_length: 3.0,
            skeleton_gap: 0.928,
            least_gap: 0.64,
            region_width: 12.0,
            scan_along: ScanAlong::Auto,
            order: HybridOrder::SkeletonFirst,
            end_overlap: 0.5,
            tip_reach: 0.4,
            min_width: 0.7,
            max_width: 1.4,
        }
    }
}
