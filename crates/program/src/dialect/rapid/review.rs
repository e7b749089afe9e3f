//! What a welding programmer notices in a RAPID program without running it: stops and waits in monitoring routines, and
//! stops that leave outputs on.

use super::module::Module;
use super::read::output;
use crate::dialect::reading::fault::{ENDLESS_WAIT, LEFT_ON, STOP_LEAVES_ON};
use crate::dialect::reading::trace::Trace;
use crate::dialect::reading::words::{compact, name, strip_word};
use std::collections::BTreeSet;

/// Reviews the main module; `lit_with` are the outputs that are on while the arc burns.
pub(super) fn program(trace: &mut Trace, main: &Module, stops: bool, lit_with: &BTreeSet<String>) {
    if !trace.watch.by_outputs {
        return;
    }
    // Routines run while a pass is welded; `main` begins with all outputs off.
    let mut on = BTreeSet::new();
    for (i, line) in main.text.lines().map(str::trim).enumerate() {
        let (word, rest) = name(line);
        let is = |name: &str| word.eq_ignore_ascii_case(name);
        if is("PROC") || is("TRAP") {
            on = if name(rest).0.eq_ignore_ascii_case("main") { BTreeSet::new() } else { lit_with.clone() };
        } else if let Some((output, state)) = output(word, rest.trim_end_matches(';')) {
            if state {
                on.insert(output)
            } else {
                on.remove(&output)
            };
        }
        let burning = on.intersection(lit_with).cloned().collect::<Vec<_>>().join(" and ");
        if burning.is_empty() {
            continue;
        }
        let (flat, place) = (compact(line), Some(trace.place(i + 1)));
        if is("Stop") || is("EXIT") || strip_word(line, "UIMsgBox").is_some() {
            trace.faults.add(&LEFT_ON, place, format!("the program stops with {burning} on."));
        } else if (is("WaitDI") || is("WaitUntil")) && !flat.contains("\\MAXTIME") {
            trace.faults.add(
                &ENDLESS_WAIT,
                place,
                format!("{} waits for ever, with {burning} on.", line.trim_end_matches(';')),
            );
        }
    }
    if !stops {
        let text = "no TriggStopProc ends the arc when the program is stopped.";
        trace.faults.add(&STOP_LEAVES_ON, None, text);
    }
}
