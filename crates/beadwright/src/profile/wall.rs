//! The section `[wall]`.

use crate::fill::wall::WallSettings;
use crate::limit::{TINY, section};

section! {
    /// How the strategy `wall` lays (Li et al.); every key has a default.
    WallSection "wall" {
        /// Ends and crossings of centre-lines nearer than this are one junction, in bead widths; default 0.5.
        junction_tolerance: f64 = 0.5, 0.01, 2.0, "bead widths", "what lies two widths apart is not one junction";
        /// How far the path may leave the middle of the wall where it is smooth, mm; default 0.02.
        chord_error: f64 = 0.02, TINY, 1.0, "mm", "finer than this no controller runs, coarser than 1 mm is seen";
        /// Radius of the path's corners, in bead widths; default 0.5.
        corner_radius: f64 = 0.5, 0.05, 10.0, "bead widths", "a sharp corner stops the torch; a wide one leaves the part";
        /// How far paths that touch at a junction and turn away keep from its middle, in bead widths; default 0.4.
        junction_gap: f64 = 0.4, 0.0, 1.0, "bead widths", "a bead's end reaches no farther than the bead is wide";
        /// How far the end of a path at a junction stays away from the paths that pass there, in bead widths; default 0.4.
        end_gap: f64 = 0.4, 0.0, 1.0, "bead widths", "a bead's end reaches no farther than the bead is wide";
        /// The narrowest bead of the process, in bead widths: thinner walls are welded with it; default 0.7.
        min_width: f64 = 0.7, 0.2, 1.0, "bead widths", "narrower beads have no steady arc";
        /// The widest bead of the process, in bead widths; default 1.4.
        max_width: f64 = 1.4, 1.0, 3.0, "bead widths", "a bead wider than three times the nominal does not stand";
    }
}

impl WallSection {
    /// In mm, for beads of that width.
    pub(super) fn settings(&self, w: f64) -> WallSettings {
        WallSettings {
            tolerance: self.junction_tolerance * w,
            chord_error: self.chord_error,
            corner_radius: self.corner_radius,
            junction_gap: self.junction_gap,
            end_gap: self.end_gap,
            width_limits: (self.min_width * w, self.max_width * w),
        }
    }
}
