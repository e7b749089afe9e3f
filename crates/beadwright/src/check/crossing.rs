//! Passes over a bead of their own layer.

use super::{Check, Finding, Subject};
use crate::fill::sound;
use crate::layer::Layer;
use crate::pass::Pass;
use glam::DVec2;
use std::borrow::Cow;

pub(super) const CHECK: Check = Check {
    name: "crossing",
    what: "passes that cross a bead laid earlier in the same layer",
    why: "metal is laid twice there; the hump grows from layer to layer until the torch hits it",
    example: "layer 1, pass 3, x 12.0 y 8.0 z 2.00 mm: it crosses pass 1.",
    remedy: "end the pass before the bead, or use a strategy whose passes do not cross",
    find,
};

fn find(subject: &Subject<'_>) -> Vec<Finding> {
    subject.layers.iter().flat_map(|layer| in_layer(layer, subject)).collect()
}

fn in_layer(layer: &Layer, subject: &Subject<'_>) -> Vec<Finding> {
    // Turns of one pass lie side by side.
    let cut = subject.settings.unrolling.bands(layer).map(|bands| bands.cut(&layer.passes));
    let (passes, of) = cut.map_or((Cow::Borrowed(&layer.passes), None), |(passes, of)| (Cow::Owned(passes), Some(of)));
    let lines: Vec<Vec<DVec2>> = passes.iter().map(Pass::line).collect();
    let pass = |line: usize| of.as_ref().map_or(line, |of| of[line]);
    let mut last = None;
    // One finding per pass.
    let fresh = |found: &(usize, usize, DVec2)| last.replace(found.0) != Some(found.0);
    let finding = |(i, other, place): (usize, usize, DVec2)| {
        let text = format!("it crosses pass {}.", pass(other) + 1);
        CHECK.of_pass(layer, pass(i), Some(place.extend(layer.z)), text)
    };
    sound::crossings(&lines).filter(fresh).map(finding).collect()
}
