//! A torch that is not lifted.

use super::{Check, Finding, Subject};

pub(super) const CHECK: Check = Check {
    name: "clearance",
    what: "a torch (process.ctwd above 0) with a travel.clearance of 0",
    why: "the wire is dragged over the beads that were just laid",
    example: "travel.clearance = 0: the wire would be dragged over fresh beads.",
    remedy: "set travel.clearance to a few millimetres more than the height of a bead",
    find,
};

fn find(subject: &Subject<'_>) -> Vec<Finding> {
    subject.settings.forbidden.iter().map(|reason| CHECK.of_plan(reason.clone())).collect()
}
