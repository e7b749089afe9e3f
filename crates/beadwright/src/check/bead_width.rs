//! Beads narrower or wider than the process lays them.

use super::{Check, Finding, Subject};

pub(super) const CHECK: Check = Check {
    name: "bead-width",
    what: "bead widths far from bead.width",
    why: "a bead follows its speed only within a window; beyond it the arc wanders or the pool runs off",
    example: "layer 5, pass 2: the bead is 12.0 mm wide; 3.8 to 11.3 mm are possible.",
    remedy: "keep widths between hybrid.min_width and max_width, or use another bead",
    find,
};

/// Least and greatest possible width of a bead, in nominal widths.
const WINDOW: (f64, f64) = (0.5, 1.5);

fn find(subject: &Subject<'_>) -> Vec<Finding> {
    let width = subject.settings.bead_width;
    let (low, high) = (WINDOW.0 * width, WINDOW.1 * width);
    let mut findings = Vec::new();
    for (layer, i, pass) in subject.passes() {
        if let Some(s) = pass.segments().find(|s| !(s.width >= low && s.width <= high)) {
            let text = format!("the bead is {:.1} mm wide; {low:.1} to {high:.1} mm are possible.", s.width);
            findings.push(CHECK.of_pass(layer, i, Some(s.from).filter(|p| p.is_finite()), text));
        }
    }
    findings
}
