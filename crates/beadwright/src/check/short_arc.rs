//! Passes that are over before their arc is steady.

use super::{Check, Finding, Subject};
use crate::pass::Pass;

pub(super) const CHECK: Check = Check {
    name: "short-arc",
    what: "passes that take less time than process.arc_start_delay, in programs that do not wait for the arc",
    why: "the torch has left before the arc is steady; what is left is a blob without fusion",
    example: "layer 4, pass 9: it is over in 0.80 s; its arc takes 1.2 s to start.",
    remedy: "use a strategy with longer passes (loop), or raise fill.min_pass_length, so that planning leaves it out and \
             reports it",
    find,
};

fn find(subject: &Subject<'_>) -> Vec<Finding> {
    let soonest = subject.settings.soonest_arc_end;
    let process = &subject.settings.weld.process;
    let time = |pass: &Pass| pass.seconds(process);
    let short = subject.beads().filter(|(_, _, pass)| pass.points.len() > 1 && time(pass) < 0.999 * soonest);
    let text = |time: f64| format!("it is over in {time:.2} s; its arc takes {soonest} s to start.");
    short.map(|(layer, i, pass)| CHECK.of_pass(layer, i, pass.start(), text(time(pass)))).collect()
}
