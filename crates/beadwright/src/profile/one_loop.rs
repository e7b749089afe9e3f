//! The strategy `loop` in profiles.

use crate::fill::one_loop::LoopOptions;
use crate::limit::section;

section! {
    /// How the strategy `loop` lays; every key has a default.
    LoopSection "loop" {
        /// The narrowest bead where two or more lie side by side, in bead widths; default 0.8.
        min_width: f64 = 0.8, 0.3, 1.0, "bead widths", "narrower beads have no steady arc";
        /// The widest bead there, in bead widths; default 1.3.
        max_width: f64 = 1.3, 1.0, 3.0, "bead widths", "a bead wider than three times the nominal does not stand";
        /// Widths change no faster than over this, in bead widths; default 0.7.
        smoothing_length: f64 = 0.7, 0.0, 10.0, "bead widths", "the pool follows the speed over about its own length";
        /// Widths change in steps of about this, in bead widths; default 0.1.
        width_step: f64 = 0.1, 0.001, 1.0, "bead widths",
            "a tenth of a width is seen by no eye; finer steps only make longer programs";
        /// Rounds of relaxation; 0 leaves rings as they are; default 30.
        relaxation: u32 = 30, 0.0, 500.0, "rounds", "after some twenty rounds little changes";
        /// Length of the stretches where two rings are joined, in distances of the rings; default 0.85.
        flip_length: f64 = 0.85, 0.4, 2.0, "distances of the rings", "shorter ones pile metal up, longer ones leave voids";
        /// Whether rings that lie in one another become a spiral; default true.
        spirals: bool = true;
    }
}

impl LoopSection {
    /// In mm, for beads of that width.
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
