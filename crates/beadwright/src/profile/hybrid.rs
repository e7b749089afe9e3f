//! Thresholds of the hybrid in profiles.

use crate::fill::hybrid::{HybridOrder, HybridSettings, ScanAlong};
use crate::limit::section;

section! {
    /// Thresholds of the strategy `hybrid` (Zhao et al. 2023); every key has a default.
    HybridSection "hybrid" {
        /// Follow the paper to the letter; default false.
        literal: bool = false;
        /// How far a contour is moved in to find its pockets, in stepovers; default 1.5.
        pocket_depth: f64 = 1.5, 0.5, 3.0, "stepovers", "pockets lie within reach of the bead beside them";
        /// What the backtracked contour is larger so that numerical slivers are no pockets (u), in stepovers; default 0.01.
        tolerance: f64 = 0.01, 0.001, 0.2, "stepovers", "slivers below it are rounding, pockets above it are real";
        /// Smaller pockets are not kept, in squared bead widths; default 0.05.
        min_pocket_area: f64 = 0.05, 0.0, 100.0, "squared bead widths",
            "sizes are told in beads, and parts have few across";
        /// Shorter corner pockets are not kept, in bead widths; default 3.
        min_pocket_length: f64 = 3.0, 0.0, 100.0, "bead widths", "sizes are told in beads, and parts have few across";
        /// Distance between skeleton fill and contours (d2), in stepovers (d1); default 0.928: 5 mm to 5.39 mm.
        skeleton_gap: f64 = 0.928, 0.3, 1.5, "stepovers", "beads must overlap, and not lie on each other";
        /// Least distance between contours and beads along a medial axis, in stepovers; default 0.64.
        least_gap: f64 = 0.64, 0.3, 1.5, "stepovers", "beads must overlap, and not lie on each other";
        /// Skeleton regions narrower than this, in stepovers, are filled along their medial axis; default 12.
        region_width: f64 = 12.0, 0.0, 20.0, "stepovers", "sizes are told in beads, and parts have few across";
        /// Scan lines of wide skeleton regions run along the `short` or the `long` side of their smallest rectangle, or
        /// `auto`: with fewer arc starts, then fewer turns; default auto.
        scan_along: ScanAlong = ScanAlong::Auto;
        /// What is laid first: `skeleton-first` or `contours-first`; default skeleton-first.
        order: HybridOrder = HybridOrder::SkeletonFirst;
        /// How far free ends of cut contours reach into the fill, in bead widths; default 0.5.
        end_overlap: f64 = 0.5, 0.0, 1.0, "bead widths", "a bead's end reaches no farther than the bead is wide";
        /// How far sharp corners of contours are drawn out into the void before them, 0 to 1; default 0.4.
        tip_reach: f64 = 0.4, 0.0, 1.0, "of the way", "from not at all to all the way";
        /// The narrowest bead of the process, in bead widths; default 0.7.
        min_width: f64 = 0.7, 0.2, 1.0, "bead widths", "narrower beads have no steady arc";
        /// The widest bead of the process, in bead widths; default 1.4.
        max_width: f64 = 1.4, 1.0, 3.0, "bead widths", "a bead wider than three times the nominal does not stand";
    }
}

impl HybridSection {
    /// In mm, for beads of width `w` that lie `d` apart.
    pub(super) fn settings(&self, w: f64, d: f64) -> HybridSettings {
        HybridSettings {
            literal: self.literal,
            pocket_depth: self.pocket_depth * d,
            tolerance: self.tolerance * d,
            min_pocket_area: self.min_pocket_area * w * w,
            min_pocket_length: self.min_pocket_length * w,
            skeleton_gap: self.skeleton_gap * d,
            least_gap: self.least_gap * d,
            region_width: self.region_width * d,
            scan_along: self.scan_along,
            order: self.order,
            end_overlap: self.end_overlap * w,
            tip_reach: self.tip_reach,
            width_limits: (self.min_width * w, self.max_width * w),
        }
    }
}
