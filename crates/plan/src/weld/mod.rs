//! Welding a pass: how it begins and ends, and how long that and the travels between passes take.
//!
//! Totals are counted and programs are written from the same two modules, so that their times agree:
//!
//! | file | what it does |
//! | --- | --- |
//! | `path` | a pass with its overlap, hot start and lead-out: points, and the pace to each |
//! | `room` | the box around all that is welded, around which the torch travels to another body |
//! | `torch` | follows the torch over passes and layers: travels without arc, times, waits |
//!
//! The *pace* of a piece is the speed at which the nominal wire feed lays its metal, mm/s. Depending on
//! `process.follow`, it is the speed of the torch, or it determines the wire feed while the torch keeps its nominal
//! speed.

mod path;
mod room;
mod torch;

pub use path::{lit_ends, path, welded};
pub use torch::retract_time;
pub use torch::{Begun, Pause, Torch, Transfer, Way, Welded};

use crate::motion::Motion;
use crate::process::{Process, StartStop, Travel};
use bead_part::chart::Chart;
use glam::DVec3;

/// What times, travels and moves depend on besides the passes.
#[derive(Debug, Clone, PartialEq)]
pub struct WeldSettings {
    /// Arc, wire and speed.
    pub process: Process,
    /// How passes begin and end, and how long layers wait.
    pub ends: StartStop,
    /// Moves with the arc off.
    pub travel: Travel,
    /// How the machine accelerates, where that is known.
    pub motion: Option<Motion>,
    /// How long the torch stands still at the end of a pass after its crater is filled, s; by default the time for arc end, gas
    /// postflow and drawing the wire back.
    pub arc_end_time: Option<f64>,
    /// Height of what is built next to the part before its first pass, mm; the travel to that pass leads over it.
    pub standing: f64,
    /// How the layers of each body lie in space; at least one.
    pub charts: Vec<Chart>,
    /// The box around an existing part on which this one is welded: lowest and highest corner, mm.
    pub base: Option<[DVec3; 2]>,
}

impl WeldSettings {
    /// Whether all layers are level.
    pub fn is_level(&self) -> bool {
        self.charts.iter().all(Chart::is_level)
    }
}
