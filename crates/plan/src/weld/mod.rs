//! Welding a pass: how it begins and ends, and the time for it and for the travels between passes.
//!
//! Totals are computed and programs written with the same modules, so that their times agree:
//!
//! | file | what it does |
//! | --- | --- |
//! | `path` | a pass with its overlap, hot start and lead-out: points, and the pace to each |
//! | `room` | the box around all that is welded, which the torch avoids on its way to another body |
//! | `torch` | follows the torch over passes and layers: travels, times, waits |
//!
//! The *pace* of a piece is the speed at which the nominal wire feed lays its metal, mm/s. Depending on
//! `process.follow`, it is the speed of the torch, or it determines the wire feed while the torch keeps its nominal
//! speed.

mod path;
mod room;
mod torch;

pub use path::{ends_of, path, welded};
pub use torch::retract_time;
pub use torch::{Begun, Pause, Torch, Transfer, Way, Welded};

use crate::motion::Motion;
use crate::process::{Process, StartStop, Travel};
use bead_part::chart::Chart;
use glam::DVec3;

/// What times and moves depend on besides the passes.
#[derive(Debug, Clone, PartialEq)]
pub struct WeldSettings {
    /// Arc, wire and speed.
    pub process: Process,
    /// How passes begin and end, and how long layers wait.
    pub ends: StartStop,
    /// Moves with the arc off.
    pub travel: Travel,
    /// How the machine accelerates, if known.
    pub motion: Option<Motion>,
    /// Time the torch stands still at the end of a pass after its crater is filled, s; by default the time for arc end,
    /// gas postflow and retracting the wire.
    pub arc_end_time: Option<f64>,
    /// Height of what is already built next to the part before its first pass, mm; the travel to that pass leads over
    /// it.
    pub standing: f64,
    /// The chart of each body's layers; at least one.
    pub charts: Vec<Chart>,
    /// The box around an existing part onto which this one is welded: lowest and highest corner, mm.
    pub base: Option<[DVec3; 2]>,
}

impl WeldSettings {
    /// Whether all layers are level.
    pub fn is_level(&self) -> bool {
        self.charts.iter().all(Chart::is_level)
    }
}
