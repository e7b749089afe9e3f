//! The strategy `loop` in profiles.

use super::limits::Range;
use crate::fill::one_loop::LoopOptions;
use serde::{Deserialize, Serialize};

/// How the strategy `loop` lays; every key has a default.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Loop {
    /// The narrowest bead where two or more lie side by side, in bead widths; default 0.8.
    pub min_width: f64,
    /// The widest bead there, in bead widths; default 1.3.
    pub max_width: f64,
    /// Widths change no faster than over this, in bead widths; default 0.7.
    pub smoothing_length: f64,
    /// Widths change in steps of about this, in bead widths; default 0.1.
    pub width_step: f64,
    /// Rounds of relaxation; 0 leaves rings as they are; default 30.
    pub relaxation: u32,
    /// Length of the stretches where two rings are joined, in distances of the rings; default 0.85.
    pub flip_length: f64,
    /// Whether rings that lie in one another become a spiral; default true.
    pub spirals: bool,
}

impl Default for Loop {
    fn default() -> Self {
        Self {
            min_width: 0.8,
            max_width: 1.3,
            smoothing_length: 0.7,
            width_step: 0.1,
            relaxation: 30,
            flip_length: 0.85,
            spirals: true,
        }
    }
}

impl Loop {
    /// In mm, for beads of that width.
    pub(super) fn options(&self, w: f64) -> LoopOptions {
        LoopOptions {
            width_limits: (self.min_width * w, self.max_width * w),
            smoothing_length: self.smoothing_length * w,
            width_step: self.width_step * w,
            rounds: self.relaxation,
            flip_length: self.flip_length,
            spirals: self.spirals,
        }
    }

    pub(super) fn ranges(&self) -> Vec<Range> {
        vec![
            ("loop.min_width", self.min_width, 0.3, 1.0, "bead widths"),
            ("loop.max_width", self.max_width, 1.0, 3.0, "bead widths"),
            ("loop.smoothing_length", self.smoothing_length, 0.0, 10.0, "bead widths"),
            ("loop.width_step", self.width_step, 0.001, 1.0, "bead widths"),
            ("loop.relaxation", self.relaxation.into(), 0.0, 500.0, "rounds"),
            ("loop.flip_length", self.flip_length, 0.4, 2.0, "distances of the rings"),
        ]
    }
}
