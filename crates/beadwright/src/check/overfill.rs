//! Overfill.

use super::{Check, Finding, Subject};

pub(super) const CHECK: Check = Check {
    name: "overfill",
    what: "layers with more overfill in the deposit model than check.max_overfill",
    why: "humps grow from layer to layer until the torch hits them",
    example: "layer 2: 14.00 % of the area is laid too high; the limit is 12 %.",
    remedy: "use a larger stepover or contour gap, or another strategy",
    find,
};

fn find(subject: &Subject<'_>) -> Vec<Finding> {
    let limit = subject.settings.limits.max_overfill;
    subject.above(&CHECK, |f| f.overfill_percent(), limit, "of the area is laid too high")
}
