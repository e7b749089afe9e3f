//! The arc on where there is no part.

use super::{Check, Finding, Subject};
use crate::pass::Segment;
use planar::{Join, Region};

pub(super) const CHECK: Check = Check {
    name: "air",
    what: "the arc on where the layer has no metal to lay",
    why: "a bead is welded across an opening or next to the part, as if a travel were made with the arc on",
    example: "layer 2, pass 5, x 10.0 y 4.0 z 4.00 mm: the arc is on outside the part, on pieces 12.3 mm long in all.",
    remedy: "split the pass there, so that the torch travels with the arc off",
    find,
};

fn find(subject: &Subject<'_>) -> Vec<Finding> {
    let width = subject.settings.bead_width;
    let room = subject.settings.unrolling.allowance + width / 2.0;
    let mut findings = Vec::new();
    for layer in subject.layers.iter().filter(|l| !l.islands.is_empty()) {
        let near = Region::from_normalised(layer.islands.clone()).offset(room, Join::ROUND);
        let bands = subject.settings.unrolling.bands(layer);
        for (i, pass) in layer.passes.iter().enumerate() {
            let once = |s: Segment| bands.as_ref().map_or(s, |bands| bands.piece(s));
            let outside = |s: &Segment| s.from.is_finite() && outside(&near, s, width);
            let pieces: Vec<Segment> = pass.segments().map(once).filter(outside).collect();
            if let Some(first) = pieces.first() {
                let length: f64 = pieces.iter().map(Segment::length).sum();
                let text = format!("the arc is on outside the part, on pieces {length:.1} mm long in all.");
                findings.push(CHECK.of_pass(layer, i, Some(first.from), text));
            }
        }
    }
    findings
}

/// Whether a piece leaves the region, judged at points a bead width apart.
fn outside(near: &Region, s: &Segment, width: f64) -> bool {
    let steps = (s.length() / width).ceil().max(1.0) as usize;
    let place = |k: usize| s.from.lerp(s.to, (k as f64 + 0.5) / steps as f64).truncate();
    (0..steps).any(|k| !near.contains(place(k)))
}
