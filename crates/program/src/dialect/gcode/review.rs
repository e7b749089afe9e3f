//! What a welding programmer sees in a CNC program without running it: stops that leave outputs on, and names.

use super::block::{Block, Line};
use super::branches::without_number;
use super::control::GcodeControl;
use crate::dialect::reading::Options;
use crate::dialect::reading::fault::{BAD_NAME, LEFT_ON};
use crate::dialect::reading::trace::Trace;
use std::collections::BTreeSet;

/// Whether a program is for LinuxCNC: O words, or waits for an input (M66).
pub(super) fn is_linuxcnc(text: &str) -> bool {
    text.lines().any(|line| {
        let line = without_number(line.trim().as_bytes());
        let mut block = Block::new();
        let waits = matches!(block.read(line), Line::Words) && block.m.has(660) && block.has(b'L');
        waits || line.first() == Some(&b'O') && line.contains(&b'[')
    })
}

/// Follows digital outputs (M62 to M65) and the spindle through all lines, also those of branches.
pub(super) fn program(trace: &mut Trace, text: &str, options: &Options) {
    let (mut on, mut block) = (BTreeSet::new(), Block::new());
    for (i, line) in text.lines().enumerate() {
        if !matches!(block.read(line.trim().as_bytes()), Line::Words) {
            continue;
        }
        let output = block.get(b'P').map(|p| format!("output {p}"));
        for code in block.m.iter() {
            match (code, &output) {
                (620 | 640, Some(output)) => drop(on.insert(output.clone())),
                (630 | 650, Some(output)) => drop(on.remove(output)),
                (30 | 40, _) => drop(on.insert("the spindle".to_owned())),
                (50, _) => drop(on.remove("the spindle")),
                (0 | 10 | 20 | 300, _) if !on.is_empty() => {
                    let names = on.iter().cloned().collect::<Vec<_>>().join(" and ");
                    let place = Some(trace.place(i + 1));
                    trace.faults.add(&LEFT_ON, place, format!("M{} stops the program with {names} on.", code / 10));
                }
                _ => {}
            }
        }
    }
    let siemens = options
        .file
        .as_deref()
        .and_then(|file| file.rsplit_once('.'))
        .filter(|(_, end)| ["mpf", "spf"].iter().any(|own| end.eq_ignore_ascii_case(own)));
    if let Some((name, end)) = siemens.filter(|(name, _)| !GcodeControl::Siemens.takes(name)) {
        let text = format!("\"{name}.{end}\": names begin with two letters, then letters, digits and _, 24 at most.");
        trace.faults.add(&BAD_NAME, None, text);
    }
}
