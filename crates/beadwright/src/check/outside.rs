//! Metal outside the part.

use super::{Check, Finding, Subject};

pub(super) const CHECK: Check = Check {
    name: "outside",
    what: "layers with more metal outside the outline in the deposit model than check.max_outside",
    why: "the part is too large there, and a wall next to it is not upright",
    example: "layer 6: 5.00 % of the area is laid outside the outline; the limit is 3 %.",
    remedy: "keep passes half a bead inside the outline, or allow for it with fill.machining_allowance",
    find,
};

fn find(subject: &Subject<'_>) -> Vec<Finding> {
    let limit = subject.settings.limits.max_outside;
    subject.above(&CHECK, |f| f.outside_percent(), limit, "of the area is laid outside the outline")
}
