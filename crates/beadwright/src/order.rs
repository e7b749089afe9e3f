//! Order: in which sequence the passes of a layer are laid, and where each begins.
//!
//! Nearest next: from where the torch stands to the nearest start among the passes that may come now. Islands are
//! finished one after another, the stages of an island in their order. An open pass may begin at either end, a
//! closed one at any of its vertices.

use crate::fill::{Fill, Pass};
use glam::DVec2;

/// Puts the passes of a layer in order. `torch` is where the torch stands before and after.
pub fn order(mut islands: Vec<Fill>, torch: &mut Option<DVec2>) -> Vec<Pass> {
    let mut ordered = Vec::with_capacity(islands.iter().flat_map(|f| &f.stages).map(Vec::len).sum());
    islands.retain_mut(|fill| {
        fill.stages.retain(|stage| !stage.is_empty());
        !fill.stages.is_empty()
    });
    while !islands.is_empty() {
        let from = torch.unwrap_or_default();
        let reach = |fill: &Fill| fill.stages[0].iter().map(|p| entry(p, from).1).fold(f64::INFINITY, f64::min);
        let nearest = nearest_index(islands.iter().map(reach));
        let fill = islands.swap_remove(nearest);
        for stage in fill.stages {
            lay_stage(stage, fill.fixed_order, torch, &mut ordered);
        }
    }
    ordered
}

fn lay_stage(mut stage: Vec<Pass>, fixed_order: bool, torch: &mut Option<DVec2>, ordered: &mut Vec<Pass>) {
    if fixed_order {
        *torch = stage.last().and_then(last_point).or(*torch);
        ordered.append(&mut stage);
        return;
    }
    while !stage.is_empty() {
        let from = torch.unwrap_or_default();
        let nearest = nearest_index(stage.iter().map(|p| entry(p, from).1));
        let mut pass = stage.swap_remove(nearest);
        let start = entry(&pass, from).0;
        begin_at(&mut pass, start);
        *torch = last_point(&pass).or(*torch);
        ordered.push(pass);
    }
}

fn nearest_index(distances: impl Iterator<Item = f64>) -> usize {
    distances.enumerate().min_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |(i, _)| i)
}

/// Index of the point at which a pass is best entered, and its squared distance.
fn entry(pass: &Pass, from: DVec2) -> (usize, f64) {
    let last = pass.points.len().saturating_sub(1);
    let candidates = match (pass.closed, pass.reversible) {
        (true, _) => (0..=last).step_by(1),
        (false, true) => (0..=last).step_by(last.max(1)),
        (false, false) => (0..=0).step_by(1),
    };
    let scored = candidates.filter_map(|i| Some((i, pass.points.get(i)?.distance_squared(from))));
    scored.min_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((0, f64::INFINITY))
}

/// Turns a pass so that it begins at the point of that index.
fn begin_at(pass: &mut Pass, index: usize) {
    if pass.closed {
        pass.points.rotate_left(index);
        pass.width.rotate_left(index);
    } else if index > 0 {
        pass.points.reverse();
        pass.width.reverse();
    }
}

/// Where the torch stands after a pass.
fn last_point(pass: &Pass) -> Option<DVec2> {
    if pass.closed { pass.points.first().copied() } else { pass.points.last().copied() }
}
