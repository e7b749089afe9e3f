//! The section `[hybrid]`.

use crate::fill::hybrid::{HybridOrder, HybridSettings, ScanAlong};
use crate::limit::section;

section! {
    /// Thresholds of the strategy `hybrid` (Zhao et al. 2023); every key has a default.
    HybridSection "hybrid" {
        /// Whether to follow the paper to the letter; default false. Corner pockets of half a bead width or more are then
        /// kept, and `scan_along = "auto"` means the short side.
        literal: bool = false;
        /// How far a contour is moved inwards to find its pockets, in stepovers. If left out, it is chosen for each island
        /// (1 or 1.5); 1.5 with `literal`.
        pocket_depth: Option<f64> = None, 0.5, 3.0, "stepovers", "pockets lie within reach of the bead next to them";
        /// How much larger the backtracked contour is made (u), so that numerical slivers do not count as pockets, in
        /// stepovers; default 0.01.
        tolerance: f64 = 0.01, 0.001, 0.2, "stepovers", "smaller slivers are rounding errors, larger pockets are real";
        /// Area of the smallest pocket that is kept, in squared bead widths; default 0.05.
        min_pocket_area: f64 = 0.05, 0.0, 100.0, "squared bead widths",
            "sizes are measured in beads, and parts are only a few beads across";
        /// Length of the shortest corner pocket that is kept, in bead widths; default 3.
        min_pocket_length: f64 = 3.0, 0.0, 100.0, "bead widths",
            "sizes are measured in beads, and parts are only a few beads across";
        /// Distance between skeleton fill and contours (d2), in stepovers (d1); default 0.928, the ratio of 5 mm to
        /// 5.39 mm.
        skeleton_gap: f64 = 0.928, 0.3, 1.5, "stepovers", "beads must overlap but not lie on top of each other";
        /// Minimum distance between contours and beads along a medial axis, in stepovers; default 0.64.
        least_gap: f64 = 0.64, 0.3, 1.5, "stepovers", "beads must overlap but not lie on top of each other";
        /// Skeleton regions narrower than this, in stepovers, are filled along their medial axis; default 12.
        region_width: f64 = 12.0, 0.0, 20.0, "stepovers",
            "sizes are measured in beads, and parts are only a few beads across";
        /// Direction of the scan lines in wide skeleton regions: along the `short` or the `long` side of their smallest
        /// enclosing rectangle, or `auto` for the one with fewer arc starts, then fewer turns; default auto.
        scan_along: ScanAlong = ScanAlong::Auto;
        /// What is laid first: `skeleton-first` or `contours-first`; default contours-first.
        order: HybridOrder = HybridOrder::ContoursFirst;
        /// How far free ends of cut contours reach into the fill, in bead widths; default 0.5.
        end_overlap: f64 = 0.5, 0.0, 1.0, "bead widths", "a bead's end reaches no farther than the bead is wide";
        /// How far sharp corners of contours are drawn out into the void beyond them, as a fraction from 0 (not at all)
        /// to 1 (all the way). If left out, it is chosen for each island (0.4 to 1).
        tip_reach: Option<f64> = None, 0.0, 1.0, "(fraction)", "0 leaves corners as they are, 1 draws them out all the way";
        /// Narrowest bead of the process, in bead widths; default 0.7.
        min_width: f64 = 0.7, 0.2, 1.0, "bead widths", "narrower beads have no steady arc";
        /// Widest bead of the process, in bead widths; default 1.4.
        max_width: f64 = 1.4, 1.0, 3.0, "bead widths",
            "a bead more than three times its nominal width does not hold its shape";
    }
}

/// Corner pockets longer than this are never dropped by the paper's filter, in bead widths: its propeller takes 12 arc
/// starts with this, and 32 with three.
const LITERAL_POCKET: f64 = 0.5;

/// Depth at which the paper finds pockets, in stepovers.
const PAPER_DEPTH: f64 = 1.5;

impl HybridSection {
    /// In mm, for beads of width `w` that lie `d` apart.
    pub(super) fn settings(&self, w: f64, d: f64) -> HybridSettings {
        let pocket = if self.literal { self.min_pocket_length.min(LITERAL_POCKET) } else { self.min_pocket_length };
        HybridSettings {
            literal: self.literal,
            pocket_depth: self.pocket_depth.unwrap_or(PAPER_DEPTH) * d,
            tries_depths: self.pocket_depth.is_none(),
            tolerance: self.tolerance * d,
            min_pocket_area: self.min_pocket_area * w * w,
            min_pocket_length: pocket * w,
            skeleton_gap: self.skeleton_gap * d,
            least_gap: self.least_gap * d,
            region_width: self.region_width * d,
            scan_along: self.scan_along,
            order: self.order,
            end_overlap: self.end_overlap * w,
            tip_reach: self.tip_reach.unwrap_or_default(),
            tries_reaches: self.tip_reach.is_none(),
            width_limits: (self.min_width * w, self.max_width * w),
        }
    }
}
