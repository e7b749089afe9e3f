//! Passes too short to weld.

use super::{Check, Finding, Subject};

pub(super) const CHECK: Check = Check {
    name: "short-pass",
    what: "passes shorter than fill.min_pass_length",
    why: "the arc is not stable before the pass is over; what is left is a blob",
    example: "layer 4, pass 9: it is 1.2 mm long; the shortest that welds is 5 mm.",
    remedy: "raise fill.min_pass_length, so that planning leaves it out and reports it (unless it is the island's \
             only pass), or join it to its neighbour",
    find,
};

fn find(subject: &Subject<'_>) -> Vec<Finding> {
    let shortest = subject.settings.shortest_pass();
    let short = subject.beads().filter(|(_, _, pass)| pass.points.len() > 1 && pass.length() < 0.999 * shortest);
    let text = |length: f64| format!("it is {length:.1} mm long; the shortest that welds is {shortest} mm.");
    short.map(|(layer, i, pass)| CHECK.of_pass(layer, i, pass.start(), text(pass.length()))).collect()
}
