//! Arcs that always start where another has ended.

use super::{Check, Finding, Subject};
use crate::layer::Layer;
use glam::DVec2;

pub(super) const CHECK: Check = Check {
    name: "alternating-ends",
    what: "places where starts and ends of passes meet on twice check.stacked_starts consecutive layers",
    why: "every arc is struck on a crater: pores and cracks gather in one line up the part",
    example: "layer 25, pass 1, x 0.0 y 3.0 z 50.00 mm: starts and ends of passes meet at this place on 24 consecutive layers.",
    remedy: "move the ends from layer to layer by more than a bead width, or lay closed passes",
    find,
};

/// Ends closer than this lie on one spot, in bead widths.
const NEAR: f64 = 0.5;

/// A high start and a low end level each other, so it takes more of them than of starts alone.
const LONGER: usize = 2;

/// An end of an open pass: its place, whether the pass starts there, and on how many consecutive layers, down from this
/// one, starts and ends have met there.
struct End {
    at: DVec2,
    starts: bool,
    met: usize,
}

fn find(subject: &Subject<'_>) -> Vec<Finding> {
    let (near, most) = (NEAR * subject.settings.bead_width, LONGER * subject.settings.limits.stacked_starts as usize);
    let (mut below, mut findings): (Vec<End>, Vec<Finding>) = (Vec::new(), Vec::new());
    for layer in &subject.layers {
        let mut here = Vec::new();
        for (pass, at, starts) in ends(layer) {
            let on = |end: &&End| end.at.distance(at) < near;
            let meets = |end: &&End| on(end) && end.starts != starts;
            let under = below.iter().filter(on).map(|end| end.met).max().unwrap_or(0);
            // Within a layer only a start can lie on a crater: that of an end laid before it.
            let met = below.iter().any(|end| meets(&end)) || (starts && here.iter().any(|end| meets(&end)));
            let met = if met { under + 1 } else { 0 };
            if met == most {
                let text = format!("starts and ends of passes meet at this place on {met} consecutive layers.");
                findings.push(CHECK.of_pass(layer, pass, Some(at.extend(layer.z)), text));
            }
            here.push(End { at, starts, met });
        }
        below = here;
    }
    findings
}

/// Ends of the open passes, in order: the pass, the place, and whether the pass starts there.
fn ends(layer: &Layer) -> impl Iterator<Item = (usize, DVec2, bool)> + '_ {
    let open = layer.passes.iter().enumerate().filter(|(_, pass)| !pass.closed && !layer.lit.is_turn());
    let both = open.flat_map(|(i, pass)| [(i, pass.start(), true), (i, pass.end(), false)]);
    both.filter_map(|(i, at, starts)| Some((i, at.filter(|p| p.is_finite())?.truncate(), starts)))
}
