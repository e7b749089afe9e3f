//! Speeds outside the process window.

use super::{Check, Finding, Subject};

pub(super) const CHECK: Check = Check {
    name: "speed-window",
    what: "deposition speeds below check.min_speed or above check.max_speed, or that are not valid speeds",
    why: "too slow burns through and sags, too fast leaves a bead that does not hold",
    example: "layer 1, pass 1: the deposition speed is 31.0 mm/s; the window is 4 to 20 mm/s.",
    remedy: "change process.deposition_speed, or the limits of bead width that make the speed follow",
    find,
};

fn find(subject: &Subject<'_>) -> Vec<Finding> {
    let process = &subject.settings.weld.process;
    let nominal = process.deposition_speed;
    let limits = subject.settings.limits;
    let (low, high) = (limits.min_speed.unwrap_or(0.25 * nominal), limits.max_speed.unwrap_or(4.0 * nominal));
    let mut findings = Vec::new();
    for (layer, i, pass) in subject.beads() {
        let process = process.at_layer(layer.index);
        // A range does not hold NaN.
        let outside = |pace: f64| !(low..=high).contains(&process.speed_at(pace)) || !pace.is_finite();
        if let Some(s) = pass.segments().find(|s| outside(s.pace)) {
            let speed = process.speed_at(s.pace);
            let text = format!("the deposition speed is {speed:.1} mm/s; the window is {low} to {high} mm/s.");
            findings.push(CHECK.of_pass(layer, i, Some(s.from).filter(|p| p.is_finite()), text));
        }
    }
    findings
}
