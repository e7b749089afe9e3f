//! What a welding programmer notices in a KRL program without running it: halts and waits in monitoring routines, stops
//! that leave outputs on, sizes and names.

use super::read::{Source, is_head, output};
use crate::dialect::reading::Options;
use crate::dialect::reading::fault::{BAD_NAME, ENDLESS_WAIT, LEFT_ON, STOP_LEAVES_ON, TOO_LARGE};
use crate::dialect::reading::trace::Trace;
use crate::dialect::reading::words::{before_comment, compact, strip_word};
use std::collections::{BTreeSet, HashMap};

/// Longest module name.
const MAX_NAME: usize = 24;

/// Reviews all programs that were read; `lit_with` are the outputs that are on while the arc burns.
pub(super) fn program(
    trace: &mut Trace,
    sources: &[Source],
    interrupts: &HashMap<u32, String>,
    lit_with: &BTreeSet<u32>,
    options: &Options,
) {
    for (i, source) in sources.iter().enumerate() {
        trace.module.clone_from(&source.module);
        for (k, (_, byte, line)) in source.programs.iter().enumerate() {
            // Routines after the main program run while a pass is welded.
            let before = if i == 0 && k > 0 { lit_with.clone() } else { BTreeSet::new() };
            routine(trace, &source.text[*byte..], *line, before, lit_with);
        }
        for (name, ..) in &source.programs {
            if name.len() > MAX_NAME {
                let text = format!("{name} has {} characters; KRL accepts {MAX_NAME}.", name.len());
                trace.faults.add(&BAD_NAME, None, text);
            }
        }
    }
    trace.module = None;
    let stops = |condition: &String| condition.contains("$STOPMESS") || condition.contains("$PRO_ACT");
    // Interrupt 3 is the controller's own, IR_STOPM, which switches no process outputs.
    let covered = interrupts.iter().any(|(number, condition)| *number != 3 && stops(condition));
    if trace.watch.by_outputs && !covered {
        let text = "no interrupt on $STOPMESS ends the arc when something stops the robot.";
        trace.faults.add(&STOP_LEAVES_ON, None, text);
    }
    if let Some(most) = options.max_megabytes.filter(|most| trace.bytes as f64 > most * 1e6) {
        let text = format!(
            "the program has {:.1} MB with its modules; the controller accepts {most:.1} MB.",
            trace.bytes as f64 / 1e6
        );
        trace.faults.add(&TOO_LARGE, None, text);
    }
    let stem = options.file.as_deref().map(|file| file.split('.').next().unwrap_or(file));
    let named = stem.zip(sources.first().and_then(|source| source.programs.first()));
    if let Some((file, (name, ..))) = named.filter(|(file, (name, ..))| !file.eq_ignore_ascii_case(name)) {
        trace.faults.add(&BAD_NAME, None, format!("the file {file}.src holds DEF {name}( ): both must have one name."));
    }
}

/// Follows the outputs through the lines of a program, and checks which of them its halts and waits leave on.
fn routine(trace: &mut Trace, text: &str, first: usize, before: BTreeSet<u32>, lit_with: &BTreeSet<u32>) {
    let mut on = before;
    for (i, raw) in text.lines().enumerate() {
        let line = before_comment(raw, ';').trim();
        if strip_word(line, "END").is_some() || is_head(line).is_some() {
            return;
        }
        let (flat, place) = (compact(line), Some(trace.place(first + i)));
        if let Some((output, state)) = output(&flat) {
            if state {
                on.insert(output)
            } else {
                on.remove(&output)
            };
        }
        let burning =
            on.intersection(lit_with).map(|output| format!("$OUT[{output}]")).collect::<Vec<_>>().join(" and ");
        if burning.is_empty() {
            continue;
        }
        if strip_word(line, "HALT").is_some() {
            trace.faults.add(&LEFT_ON, place, format!("the program halts with {burning} on."));
        } else if flat.starts_with("WAITFOR") && flat.contains("$IN[") && !flat.contains("$TIMER") {
            let text = format!("{line} waits for ever, with {burning} on.");
            trace.faults.add(&ENDLESS_WAIT, place, text);
        }
    }
}
