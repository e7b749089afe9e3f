//! Passes laid over themselves.

use super::{Check, Finding, Subject};
use crate::pass::Pass;
use glam::DVec3;
use std::collections::HashMap;

pub(super) const CHECK: Check = Check {
    name: "retraced",
    what: "passes that run over themselves: out and back along the same line, less than a quarter of a bead apart",
    why: "metal is laid twice there; the ridge grows from layer to layer until the torch hits it",
    example: "layer 3, pass 2, x 10.0 y 4.0 z 6.00 mm: it runs over itself for 21.5 mm.",
    remedy: "end the pass at the tip, or bring it back a full bead away from its way out",
    find,
};

/// Samples along a pass, per bead width.
const SAMPLES: f64 = 4.0;
/// Places closer than this fraction of the narrower bead lie on each other. In sharp corners the beads of good fills
/// come as close as half a width, over up to two widths, but nowhere closer than a quarter.
const NEAR: f64 = 0.25;
/// Places on a pass are compared if this many bead widths of it lie between them: beads at a corner always touch.
const APART: f64 = 1.0;
/// Shortest run that is reported, in bead widths; crossings are found by another check.
const LENGTH: f64 = 1.0;

/// A place on a pass, and the width of the bead there.
type Sample = (DVec3, f64);

fn find(subject: &Subject<'_>) -> Vec<Finding> {
    let width = subject.settings.bead_width;
    // The last turn of a helix ends on itself, where it has risen.
    let found = subject.passes().filter(|(layer, ..)| !layer.lit.is_turn()).filter_map(|(layer, i, pass)| {
        let (place, length) = retraced(&samples(pass, width / SAMPLES), width, pass.closed)?;
        let text = format!("it runs over itself for {length:.1} mm.");
        Some(CHECK.of_pass(layer, i, Some(place), text))
    });
    found.collect()
}

/// The place where a pass first runs over itself, and the length of the longest such run, mm.
fn retraced(samples: &[Sample], width: f64, closed: bool) -> Option<(DVec3, f64)> {
    let apart = (APART * SAMPLES) as usize;
    let cell = |p: DVec3| (p.truncate() / width).floor().as_i64vec2().to_array();
    let mut laid: HashMap<[i64; 2], Vec<usize>> = HashMap::new();
    // Start and length of the current run and of the longest one, in samples.
    let (mut run, mut longest) = ((0, 0), (0, 0));
    for (k, &(place, own)) in samples.iter().enumerate() {
        let [x, y] = cell(place);
        let around = (-1..=1).flat_map(|i| (-1..=1).map(move |j| [x + i, y + j]));
        let over = |&j: &usize| {
            let far = k - j > apart && (!closed || samples.len() - (k - j) > apart);
            far && place.distance(samples[j].0) < NEAR * own.min(samples[j].1)
        };
        let over = around.filter_map(|cell| laid.get(&cell)).flatten().any(over);
        run = match over {
            true if run.1 > 0 => (run.0, run.1 + 1),
            true => (k, 1),
            false => (0, 0),
        };
        longest = if run.1 > longest.1 { run } else { longest };
        laid.entry([x, y]).or_default().push(k);
    }
    let length = longest.1 as f64 * width / SAMPLES;
    (length >= LENGTH * width).then(|| (samples[longest.0].0, length))
}

/// Places at even distances along a pass.
fn samples(pass: &Pass, step: f64) -> Vec<Sample> {
    let (mut samples, mut rest) = (Vec::new(), 0.0);
    for s in pass.segments().filter(|s| s.from.is_finite() && s.to.is_finite()) {
        let (length, mut way) = (s.length(), rest);
        while way < length {
            samples.push((s.from.lerp(s.to, way / length), s.width));
            way += step;
        }
        rest = way - length;
    }
    samples
}
