//! Speeds outside the process window.

use super::{Check, Finding, Subject};

pub(super) const CHECK: Check = Check {
    name: "speed-window",
    what: "deposition speeds below check.min_speed or above check.max_speed, or that are no speeds",
    why: "too slow burns through and sags, too fast leaves a bead that does not hold",
    example: "layer 1, pass 1: the deposition speed is 31.0 mm/s; the window is 4 to 20 mm/s.",
    remedy: "change process.deposition_speed, or the limits of bead width that make the speed follow",
    find,
};

fn find(subject: &Subject<'_>) -> Vec<Finding> {
    let nominal = subject.profile.process.deposition_speed;
    let limits = &subject.profile.check;
    let (low, high) = (limits.min_speed.unwrap_or(0.25 * nominal), limits.max_speed.unwrap_or(4.0 * nominal));
    let mut findings = Vec::new();
    for (layer, i, pass) in subject.passes() {
        // Written so that NaN is outside.
        if let Some(s) = pass.segments().find(|s| !(s.speed >= low && s.speed <= high)) {
            let text = format!("the deposition speed is {:.1} mm/s; the window is {low} to {high} mm/s.", s.speed);
            findings.push(Finding::of_pass(&CHECK, layer, i, Some(s.from).filter(|p| p.is_finite()), text));
        }
    }
    findings
}
