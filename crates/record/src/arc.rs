//! When the arc burned, as a log shows it.

use crate::quantity::Quantity;
use crate::source::{Source, What};
use std::ops::Range;

/// A stretch of time, s.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Span {
    /// When it begins.
    pub start: f64,
    /// When it ends.
    pub end: f64,
    /// Whether the beginning was seen; otherwise it is that of the rows.
    pub start_known: bool,
    /// Whether the end was seen.
    pub end_known: bool,
}

impl Span {
    /// A span whose ends are both known.
    pub fn new(start: f64, end: f64) -> Self {
        Self { start, end, start_known: true, end_known: true }
    }

    /// How long it is, s.
    pub fn seconds(&self) -> f64 {
        self.end - self.start
    }

    /// How much of it lies in another one, s.
    pub fn shared(&self, other: &Self) -> f64 {
        (self.end.min(other.end) - self.start.max(other.start)).max(0.0)
    }

    fn is_known(&self) -> bool {
        self.start_known && self.end_known
    }
}

/// What shows that the arc burns, the best first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Signal {
    /// Events of the controller.
    Events,
    /// A measured quantity.
    Measured(Quantity),
}

/// When the arc burned by the clock of the log.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Arcs {
    pub(crate) signal: Signal,
    pub(crate) spans: Vec<Span>,
    /// The rows of each span: the first with the arc on, and the first with it off again.
    pub(crate) rows: Vec<Range<usize>>,
    /// Whether the log has rows only while the arc burns.
    pub(crate) only_burning: bool,
}

/// The arc is on from the first and off below the second value. An arc of less current does not weld, and idle power sources show
/// less than half of it; wire is fed faster than slow inching.
const CURRENT: [f64; 2] = [25.0, 10.0];
const FEED: [f64; 2] = [0.5, 0.2];
const SWITCH: [f64; 2] = [0.5, 0.5];

/// A pyrometer sees the arc where its temperatures are so far apart, K; these fractions of the range then count as on and off.
const HOT: f64 = 300.0;
const PART: [f64; 2] = [0.5, 0.4];

/// Breaks shorter than the first and arcs shorter than the second do not count, s: short circuits, and noise.
const SHORT: [f64; 2] = [0.2, 0.05];

/// Fraction of spans that end where rows are missing, from which on a log is one that has rows only while the arc burns.
const BOUNDED: f64 = 0.5;

impl Arcs {
    /// The arcs that a log shows; `None` if it says nothing of them.
    pub(crate) fn of(source: &Source) -> Option<Self> {
        if let Some((on, off)) = switching(source) {
            return Some(Self::of_events(source, &on, &off));
        }
        let order = [Quantity::Arc, Quantity::Current, Quantity::Feed, Quantity::Temperature];
        let shown = order.into_iter().find_map(|quantity| Some((quantity, source.column(quantity)?)));
        let (quantity, values) = shown?;
        let levels = match quantity {
            Quantity::Arc => SWITCH,
            Quantity::Current => CURRENT,
            Quantity::Feed => FEED,
            _ => hot(values)?,
        };
        Some(Self::of_values(source, quantity, values, levels))
    }

    fn of_values(source: &Source, quantity: Quantity, values: &[f32], [on, off]: [f64; 2]) -> Self {
        let mut arcs =
            Self { signal: Signal::Measured(quantity), spans: Vec::new(), rows: Vec::new(), only_burning: false };
        for run in source.run_rows() {
            let mut since: Option<usize> = None;
            for row in run.clone() {
                let value = f64::from(values[row]);
                match since {
                    None if value >= on => since = Some(row),
                    Some(first) if value < off => {
                        arcs.push(source, first, row, [first > run.start, true]);
                        since = None;
                    }
                    _ => {}
                }
            }
            if let Some(first) = since {
                arcs.push(source, first, run.end - 1, [first > run.start, false]);
            }
        }
        arcs.join();
        arcs.settle();
        if quantity == Quantity::Temperature {
            // Metal cools slowly: only beginnings can be seen.
            arcs.spans.iter_mut().for_each(|span| (span.end, span.end_known) = (span.start, false));
        }
        arcs
    }

    /// Whether it shows when the arc burned, not only that it was struck.
    pub(crate) fn is_exact(&self) -> bool {
        self.signal != Signal::Measured(Quantity::Temperature)
    }

    fn of_events(source: &Source, on: &What, off: &What) -> Self {
        let mut arcs = Self { signal: Signal::Events, spans: Vec::new(), rows: Vec::new(), only_burning: false };
        let mut since: Option<usize> = None;
        let switches = source.events.iter().filter(|(_, event)| event.what == *on || event.what == *off);
        for (&row, event) in switches {
            let begins = event.what == *on;
            match since {
                // A message that was sent twice.
                Some(first) if begins && source.times[row] - source.times[first] < SHORT[0] => {}
                Some(first) => {
                    arcs.push(source, first, row, [true, !begins]);
                    since = begins.then_some(row);
                }
                None => since = begins.then_some(row),
            }
        }
        if let Some(first) = since {
            arcs.push(source, first, source.times.len() - 1, [true, false]);
        }
        arcs
    }

    fn push(&mut self, source: &Source, first: usize, last: usize, [start_known, end_known]: [bool; 2]) {
        let (start, end) = (source.times[first], source.times[last]);
        // The clock was set in between.
        if end >= start {
            self.spans.push(Span { start, end, start_known, end_known });
            self.rows.push(first..last);
        }
    }

    /// Joins arcs with hardly a break between them, and drops the shortest.
    fn join(&mut self) {
        let (spans, rows) = (std::mem::take(&mut self.spans), std::mem::take(&mut self.rows));
        for (span, rows) in spans.into_iter().zip(rows) {
            match (self.spans.last_mut(), self.rows.last_mut()) {
                (Some(last), Some(own))
                    if last.end_known && span.start_known && (0.0..SHORT[0]).contains(&(span.start - last.end)) =>
                {
                    (last.end, last.end_known) = (span.end, span.end_known);
                    own.end = rows.end;
                }
                _ => {
                    self.spans.push(span);
                    self.rows.push(rows);
                }
            }
        }
        let mut long = self.spans.iter().map(|span| span.seconds() >= SHORT[1]).collect::<Vec<_>>().into_iter();
        let mut again = long.clone();
        self.spans.retain(|_| long.next() == Some(true));
        self.rows.retain(|_| again.next() == Some(true));
    }

    /// Where most arcs end with the rows, the log has rows only while the arc burns, and the ends of its rows are those of the arcs.
    fn settle(&mut self) {
        let bounded = self.spans.iter().filter(|span| !span.start_known && !span.end_known).count();
        self.only_burning = bounded > 1 && bounded as f64 >= BOUNDED * self.spans.len() as f64;
        if self.only_burning {
            self.spans.iter_mut().for_each(|span| (span.start_known, span.end_known) = (true, true));
        }
    }

    /// Number of spans of which both ends were seen.
    pub(crate) fn known(&self) -> usize {
        self.spans.iter().filter(|span| span.is_known()).count()
    }
}

/// The events that switch the arc, or else those around passes; `None` if the log has neither.
fn switching(source: &Source) -> Option<(What, What)> {
    let pairs = [(What::ArcOn, What::ArcOff), (What::PassStart, What::PassEnd)];
    pairs.into_iter().find(|(on, _)| source.events.values().any(|event| event.what == *on))
}

/// The levels of a pyrometer that sees the arc; `None` where it does not.
fn hot(values: &[f32]) -> Option<[f64; 2]> {
    let every = (values.len() / 10_000).max(1);
    let mut some: Vec<f32> = values.iter().step_by(every).copied().filter(|value| value.is_finite()).collect();
    some.sort_by(f32::total_cmp);
    let [low, high] = [0.1, 0.99].map(|part| some.get((part * some.len() as f64) as usize).copied().map(f64::from));
    let (low, high) = (low?, high?);
    (high - low > HOT).then(|| PART.map(|part| low + part * (high - low)))
}
