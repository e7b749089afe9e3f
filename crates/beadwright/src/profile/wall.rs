//! The section `[wall]`.

use crate::fill::wall::WallSettings;
use crate::limit::{TINY, section};
use crate::model::wall_curves::CurvesAre;

section! {
    /// How the strategy `wall` lays beads (Li et al.); every key has a default.
    WallSection "wall" {
        /// Ends and crossings of centre-lines closer together than this become one junction, in bead widths; default
        /// 0.5.
        junction_tolerance: f64 = 0.5, 0.01, 2.0, "bead widths", "places two bead widths apart are not one junction";
        /// How far the path may deviate from the middle of the wall where the wall is smooth, mm; default 0.02.
        chord_error: f64 = 0.02, TINY, 1.0, "mm", "no controller follows a finer path, and more than 1 mm is visible";
        /// Radius of the path's corners, in bead widths; default 0.5.
        corner_radius: f64 = 0.5, 0.05, 10.0, "bead widths", "a sharp corner stops the torch; a wide one leaves the part";
        /// Distance from the middle of a junction that is kept by paths that touch there and turn away, in bead widths;
        /// default 0.4.
        junction_gap: f64 = 0.4, 0.0, 1.0, "bead widths", "a bead's end reaches no farther than the bead is wide";
        /// Gap between the end of a path at a junction and the paths that run through the junction, in bead widths;
        /// default 0.4.
        end_gap: f64 = 0.4, 0.0, 1.0, "bead widths", "a bead's end reaches no farther than the bead is wide";
        /// Narrowest bead of the process, in bead widths; thinner walls are welded with this bead, which extends beyond
        /// them; default 0.7.
        min_width: f64 = 0.7, 0.2, 1.0, "bead widths", "narrower beads have no steady arc";
        /// Walls of a solid that are thinner than this get no bead, in bead widths; default 0.5. The strategy `wall` welds
        /// all of them.
        thinnest: f64 = 0.5, 0.2, 1.0, "bead widths", "the narrowest bead would lie next to a thinner wall rather than in it";
        /// What curves less than two beads apart, side by side, stand for: the `sides` of a wall, which gets one bead
        /// midway between them, or the `centre` lines of walls; without it, such curves are not planned.
        #[serde(skip_serializing_if = "Option::is_none")]
        curves: Option<CurvesAre> = None;
        /// Whether closed walls become the turns of one helix, from the bottom to the top with one arc start; default false.
        /// Each layer must be one closed wall.
        helix: bool = false;
        /// Widest bead of the process, in bead widths; default 1.4.
        max_width: f64 = 1.4, 1.0, 3.0, "bead widths",
            "a bead more than three times its nominal width does not hold its shape";
    }
}

impl WallSection {
    /// In mm, for beads of width `w`.
    pub(super) fn settings(&self, w: f64) -> WallSettings {
        WallSettings {
            tolerance: self.junction_tolerance * w,
            chord_error: self.chord_error,
            corner_radius: self.corner_radius,
            junction_gap: self.junction_gap,
            end_gap: self.end_gap,
            width_limits: (self.min_width * w, self.max_width * w),
            thinnest: self.thinnest.min(self.min_width) * w,
        }
    }
}
