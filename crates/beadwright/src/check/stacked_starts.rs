//! Arc starts on top of each other.

use super::{Check, Finding, Subject};
use crate::layer::Layer;
use crate::pass::{Pass, PassKind};
use crate::plan::charted::Across;

pub(super) const CHECK: Check = Check {
    name: "stacked-starts",
    what: "arc starts that lie above each other on check.stacked_starts consecutive layers",
    why: "every start is a little high and every end a little low: stacked, they become a tower and a hole",
    example: "layer 12, pass 1, x 0.0 y 3.0 z 24.00 mm: arcs start at this place on 12 consecutive layers.",
    remedy: "move the seam from layer to layer, or alternate the direction",
    find,
};

/// Starts closer than this count as lying on top of each other, in bead widths.
const NEAR: f64 = 0.5;

fn find(subject: &Subject<'_>) -> Vec<Finding> {
    let (width, most) = (subject.settings.bead_width, subject.settings.limits.stacked_starts as usize);
    // The starts of the layer below, each with the number of consecutive layers, down from there, that start at that
    // place.
    let mut below: Vec<(glam::DVec2, usize)> = Vec::new();
    let mut findings = Vec::new();
    let mut lower: Option<&Layer> = None;
    for &layer in &subject.layers {
        if let Some(across) = lower.and_then(|lower| Across::layers(&subject.settings.layers.chart, lower, layer)) {
            below = below.iter().flat_map(|(p, count)| across.places(*p).map(move |p| (p, *count))).collect();
        }
        let mut here = Vec::with_capacity(layer.passes.len());
        for (i, start) in starts(layer) {
            let under = below.iter().filter(|(at, _)| at.distance(start.truncate()) < NEAR * width);
            let count = 1 + under.map(|(_, count)| *count).max().unwrap_or(0);
            if count == most {
                let text = format!("arcs start at this place on {count} consecutive layers.");
                findings.push(CHECK.of_pass(layer, i, Some(start), text));
            }
            here.push((start.truncate(), count));
        }
        below = here;
        lower = Some(layer);
    }
    findings
}

fn starts(layer: &Layer) -> impl Iterator<Item = (usize, glam::DVec3)> + '_ {
    let start = |(i, pass): (usize, &Pass)| Some((i, pass.start().filter(|p| p.is_finite())?));
    let lit_anew = layer.passes.iter().enumerate().filter(|_| !layer.lit.before);
    // A column of dots cannot start anywhere else.
    let lit_anew = lit_anew.filter(|(_, pass)| pass.kind != PassKind::Spot);
    lit_anew.filter_map(start)
}
