//! All layers that follow a scan, if nothing else is measured until the end.

use super::area::core;
use super::correct::{Feedback, Rules, next};
use super::levels::Levels;
use super::see::Seen;
use super::surface::Spread;
use crate::layer::Layer;

/// The layers that follow.
#[derive(Debug, Clone)]
pub struct Followed {
    /// The layers, from the one after the scan.
    pub layers: Vec<Layer>,
    /// Number of layers that the plan had left.
    pub planned: usize,
    /// Number of pieces in their passes.
    pub pieces: usize,
    /// Number of pieces that need more or less metal than the window allows.
    pub clipped: usize,
    /// Least and greatest metal of the first of them, as multiples of the planned metal.
    pub metal: (f64, f64),
    /// Expected height of the last one relative to the end of the plan, mm; that of the scan where no layer follows.
    pub end: Spread,
}

/// Plans the layers after the scanned one, which has this `number`, counted from 1.
pub fn follow(planned: &[Layer], number: usize, seen: &Seen, width: f64, rules: &Rules) -> Followed {
    let mut surface = seen.surface.clone();
    let (left, mut core_points) = (planned.len().saturating_sub(number), seen.core.clone());
    let mut followed = Followed {
        layers: Vec::new(),
        planned: left,
        pieces: 0,
        clipped: 0,
        metal: (1.0, 1.0),
        end: Spread::default(),
    };
    let Some(levels) = Levels::of(planned) else { return followed };
    // Each layer brings the build one layer closer to the end, except for what the window holds back.
    for index in number..2 * planned.len() {
        surface.settle(surface.spread(&core_points).mean);
        let Some(next) = next(planned, &levels, &surface, index, Feedback::Place, rules) else { break };
        if followed.layers.is_empty() {
            followed.metal = next.metal;
        }
        surface.lay(&next.promised, &next.layer);
        core_points = core(surface.grid(), &next.layer.islands, width);
        followed.pieces += next.pieces;
        followed.clipped += next.clipped;
        followed.layers.push(next.layer);
    }
    followed.end = surface.spread(&core_points).moved(surface.level() - levels.end());
    followed
}
