//! Programs too large for a controller.

use super::{Check, Finding, Subject};

pub(super) const CHECK: Check = Check {
    name: "program-size",
    what: "layers with more points than check.max_points",
    why: "the module of the layer does not load, or the pendant cannot show it",
    example: "layer 3: it has 61000 points; 20000 are the most for one module.",
    remedy: "raise slice.simplify, or let arcs be fitted",
    find,
};

fn find(subject: &Subject<'_>) -> Vec<Finding> {
    let most = subject.profile.check.max_points as usize;
    let points = |layer: &crate::plan::Layer| layer.passes.iter().map(|p| p.points.len()).sum::<usize>();
    let large = subject.layers.iter().filter(|layer| points(layer) > most);
    let text = |count: usize| format!("it has {count} points; {most} are the most for one module.");
    large.map(|layer| Finding::of_layer(&CHECK, layer, text(points(layer)))).collect()
}
