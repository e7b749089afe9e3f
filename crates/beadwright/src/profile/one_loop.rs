//! The section `[loop]`.

use crate::fill::one_loop::LoopOptions;
use crate::limit::section;

section! {
    /// How the strategy `loop` lays beads; every key has a default.
    LoopSection "loop" {
        /// Narrowest bead where two or more lie side by side, in bead widths; default 0.8.
        min_width: f64 = 0.8, 0.3, 1.0, "bead widths", "narrower beads have no steady arc";
        /// Widest bead where two or more lie side by side, in bead widths; default 1.3.
        max_width: f64 = 1.3, 1.0, 3.0, "bead widths",
            "a bead more than three times its nominal width does not hold its shape";
        /// Shortest length over which the bead width changes, in bead widths; default 0.7.
        smoothing_length: f64 = 0.7, 0.0, 10.0, "bead widths",
            "the melt pool responds to the speed over about its own length";
        /// Approximate size of the steps in which the bead width changes, in bead widths; default 0.1.
        width_step: f64 = 0.1, 0.001, 1.0, "bead widths",
            "a tenth of a bead width is invisible; finer steps only make programs longer";
        /// Number of rounds of relaxation, which evens out the rings; 0 leaves them as they are; default 30.
        relaxation: u32 = 30, 0.0, 500.0, "rounds", "little changes after about twenty rounds";
        /// Length of the stretch where two rings are joined, as a multiple of the distance between them; default 0.85.
        flip_length: f64 = 0.85, 0.4, 2.0, "ring distances", "shorter stretches pile up metal, longer ones leave voids";
        /// Whether nested rings become a spiral; default true.
        spirals: bool = true;
    }
}

impl LoopSection {
    /// In mm, for beads of width `w`.
    pub(super) fn settings(&self, w: f64) -> LoopOptions {
        LoopOptions {
            width_limits: (self.min_width * w, self.max_width * w),
            smoothing_length: self.smoothing_length * w,
            width_step: self.width_step * w,
            rounds: self.relaxation,
            flip_length: self.flip_length,
            spirals: self.spirals,
        }
    }
}
