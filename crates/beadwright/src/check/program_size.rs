//! Programs too large for a controller.

use super::{Check, Finding, Subject};
use crate::layer::Layer;

pub(super) const CHECK: Check = Check {
    name: "program-size",
    what: "layers with more points than check.max_points, plans with more than check.max_plan_points",
    why: "the module of the layer does not load, or the controller's memory is full before the part is done",
    example: "layer 3: it has 61000 points; the limit for one layer is 20000.",
    remedy: "raise slice.simplify, fit arcs, or load layer by layer",
    find,
};

fn find(subject: &Subject<'_>) -> Vec<Finding> {
    let (limits, sizes) = (subject.settings.limits, subject.layers.iter().map(|layer| (*layer, points(layer))));
    let most = limits.max_points as usize;
    let large = sizes.clone().filter(|(_, size)| *size > most);
    let text = |count: usize| format!("it has {count} points; the limit for one layer is {most}.");
    let layers = large.map(|(layer, count)| CHECK.of_layer(layer, None, text(count)));
    let all: usize = sizes.map(|(_, size)| size).sum();
    let plan = limits.max_plan_points.filter(|most| all > *most as usize);
    let plan = plan.map(|most| CHECK.of_plan(format!("The plan has {all} points; the limit is {most}.")));
    layers.chain(plan).collect()
}

fn points(layer: &Layer) -> usize {
    layer.passes.iter().map(|pass| pass.points.len()).sum()
}
