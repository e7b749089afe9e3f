//! Voids.

use super::{Check, Finding, Subject};

pub(super) const CHECK: Check = Check {
    name: "void",
    what: "layers with more void in the deposit model than check.max_void",
    why: "voids stay in the part as pores and lack of fusion",
    example: "layer 12: 4.10 % of the area stays empty; the limit is 3 %.",
    remedy: "choose a strategy that leaves less, or use a smaller stepover or contour gap",
    find,
};

fn find(subject: &Subject<'_>) -> Vec<Finding> {
    let limit = subject.settings.limits.max_void;
    subject.above(&CHECK, |f| f.void_percent(), limit, "of the area stays empty")
}
