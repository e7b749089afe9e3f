//! What the time of a program is spent on.

use crate::view3d::{LayerBeads, PassSpan, Scene};
use beadwright::metrics::Metrics;
use beadwright::pass::PassKind;

/// Parts of the time of a program, s.
#[derive(Debug, Clone, PartialEq)]
pub struct Shares {
    /// The torch moves with the arc on, by kind of pass, the longest first.
    pub arc: Vec<(PassKind, f64)>,
    /// Gas, striking and ending the arc, craters.
    pub starts: f64,
    /// The torch moves with the arc off.
    pub travel: f64,
    /// Waits between layers and passes.
    pub wait: f64,
    /// All of it.
    pub total: f64,
}

impl Shares {
    /// Of a whole program.
    pub fn of(scene: &Scene, metrics: &Metrics) -> Self {
        let mut arc: Vec<(PassKind, f64)> = Vec::new();
        for layer in scene.layers().iter().flatten() {
            for pass in layer.passes() {
                let seconds = moving(layer, pass);
                match arc.iter_mut().find(|(kind, _)| *kind == pass.kind) {
                    Some((_, sum)) => *sum += seconds,
                    None => arc.push((pass.kind, seconds)),
                }
            }
        }
        arc.sort_by(|a, b| b.1.total_cmp(&a.1));
        let Metrics { start_stop_time_s: starts, dwell_time_s: wait, total_time_s: total, .. } = *metrics;
        let moving: f64 = arc.iter().map(|(_, seconds)| seconds).sum();
        Self { arc, starts, travel: (total - moving - starts - wait).max(0.0), wait, total }
    }
}

/// How long the torch moves with the arc on in a pass, s.
fn moving(layer: &LayerBeads, pass: &PassSpan) -> f64 {
    let last = pass.segments.clone().last().and_then(|segment| layer.times(segment));
    last.map_or(0.0, |(_, end)| end - pass.arc_start)
}
