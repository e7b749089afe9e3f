//! Passes over a bead of their own layer.

use super::{Check, Finding, Subject};
use crate::fill::sound;
use crate::layer::Layer;
use crate::pass::Pass;
use glam::DVec2;

pub(super) const CHECK: Check = Check {
    name: "crossing",
    what: "passes that cross a bead laid earlier in the same layer",
    why: "metal is laid twice there; the hump grows from layer to layer until the torch hits it",
    example: "layer 1, pass 3, x 12.0 y 8.0 z 2.00 mm: it crosses pass 1.",
    remedy: "end the pass before the bead, or use a strategy whose passes do not cross",
    find,
};

fn find(subject: &Subject<'_>) -> Vec<Finding> {
    subject.layers.iter().copied().flat_map(in_layer).collect()
}

fn in_layer(layer: &Layer) -> Vec<Finding> {
    let lines: Vec<Vec<DVec2>> = layer.passes.iter().map(Pass::line).collect();
    let mut last = None;
    // One finding per pass.
    let fresh = |found: &(usize, usize, DVec2)| last.replace(found.0) != Some(found.0);
    let finding = |(i, other, place): (usize, usize, DVec2)| {
        let text = format!("it crosses pass {}.", other + 1);
        CHECK.of_pass(layer, i, Some(place.extend(layer.z)), text)
    };
    sound::crossings(&lines).filter(fresh).map(finding).collect()
}
