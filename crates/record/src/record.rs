//! The record: what was planned and what was measured, pass by pass, and how the logs were aligned.

use crate::aligned::Aligned;
use crate::clock::Trust;
use crate::figures::Measured;
use crate::finding::Finding;
use crate::quantity::Quantity;
use crate::source::{Tally, What, longest_step};

/// The record of a part.
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    /// A row for each planned pass, in order.
    pub passes: Vec<PassRow>,
    /// What is doubtful, the gravest first.
    pub findings: Vec<Finding>,
    /// The logs, in the order in which they were given.
    pub logs: Vec<Log>,
}

/// A pass: planned and measured. Times are those of the reference, s.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct PassRow {
    /// Layer, from 1.
    pub layer: usize,
    /// Pass in its layer, from 1.
    pub pass: usize,
    /// Length, mm.
    pub length: f64,
    /// Where its arc was first struck, and last went out; `None` if it was not welded.
    pub time: Option<[f64; 2]>,
    /// Time from arc on to arc off, s: planned, measured.
    pub seconds: [Option<f64>; 2],
    /// Time since the arc of the pass before went out, s: planned, measured.
    pub wait: [Option<f64>; 2],
    /// Time for which the arc burned, s.
    pub burned: f64,
    /// Number of arcs.
    pub arcs: usize,
    /// Earlier beginnings of the pass, given up.
    pub tries: usize,
    /// Quantities: their planned mean, and what was measured.
    pub quantities: Vec<(Quantity, Option<f64>, Option<Measured>)>,
    /// Heat input, J/mm: planned, measured.
    pub heat: [Option<f64>; 2],
    /// Temperature of the metal before the pass, °C: planned, measured.
    pub before: [Option<f64>; 2],
    /// Greatest temperature during the pass, °C.
    pub peak: Option<f64>,
    /// Mean height of its top where a scan shows it, mm: planned, measured.
    pub height: [Option<f64>; 2],
    /// Measured minus planned height along it, mm.
    pub off: Option<Measured>,
    /// Fraction of its length, 0 to 1, that a scan shows; `None` if none was taken of its layer.
    pub scanned: Option<f64>,
    /// What the operator noted.
    pub notes: Vec<String>,
    /// Number of findings.
    pub findings: usize,
}

impl PassRow {
    /// What was measured of a quantity.
    pub fn measured(&self, quantity: Quantity) -> Option<&Measured> {
        self.quantities.iter().find(|(own, ..)| *own == quantity)?.2.as_ref()
    }

    /// What was planned of it.
    pub fn planned(&self, quantity: Quantity) -> Option<f64> {
        self.quantities.iter().find(|(own, ..)| *own == quantity)?.1
    }
}

/// A log, and how its clock was aligned.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Log {
    /// Its name.
    pub name: String,
    /// Its rows.
    pub tally: Tally,
    /// What it measures.
    pub quantities: Vec<Quantity>,
    /// When it begins and ends, s by the reference.
    pub time: [f64; 2],
    /// Arcs that it saw.
    pub arcs: usize,
    /// Those that the reference saw too.
    pub matched: usize,
    /// What the alignment relies on.
    pub trust: Trust,
    /// By how much the reference is ahead of its clock where it begins, s.
    pub offset: f64,
    /// By how much its clock runs slow, in millionths.
    pub drift: f64,
    /// Root mean square by which its arcs begin and end apart from those of the reference, s.
    pub within: f64,
    /// When its clock was set, s by the reference, and by how much, s.
    pub set: Vec<[f64; 2]>,
    /// Stretches without rows, s by the reference.
    pub gaps: Vec<[f64; 2]>,
    /// When it lost the connection to what it logs, s by the reference, and why.
    pub interruptions: Vec<(f64, String)>,
}

impl Log {
    pub(crate) fn of(log: &Aligned<'_>) -> Self {
        let (source, clock) = (log.source, &log.clock);
        let last = source.times.len() - 1;
        let set = clock.pieces.windows(2).map(|pair| [log.time(pair[1].row), pair[0].offset - pair[1].offset]);
        let gap = |pair: (usize, usize)| [log.time(pair.0), log.time(pair.1)];
        let silent = log.arcs.as_ref().is_some_and(|arcs| arcs.only_burning);
        let gaps = source.runs.iter().skip(1).map(|row| gap((row - 1, *row)));
        let longest = longest_step(source);
        let lost = source.events.iter().filter(|(_, event)| event.what == What::Interrupted);
        Self {
            name: source.name.clone(),
            tally: source.tally,
            quantities: source.columns.iter().map(|(quantity, _)| *quantity).collect(),
            time: [log.time(0), log.time(last)],
            arcs: log.arcs.as_ref().map_or(0, |arcs| arcs.spans.len()),
            matched: clock.matched,
            trust: clock.trust,
            offset: log.time(0) - source.times[0],
            drift: (clock.rate - 1.0) * 1e6,
            within: clock.within,
            set: set.collect(),
            gaps: if silent { Vec::new() } else { gaps.filter(|gap| gap[1] - gap[0] > longest).collect() },
            interruptions: lost.map(|(row, event)| (log.time(*row), event.note.clone())).collect(),
        }
    }
}
