//! Rows in order: doubled ones dropped, late ones put where they belong, and runs found between which the clock was set or rows are
//! missing.

use super::{Event, Source};
use std::collections::BTreeMap;
use std::ops::Range;

/// What was found wrong with the rows of a log.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize)]
pub struct Tally {
    /// All rows.
    pub rows: usize,
    /// Rows that cannot be read.
    pub broken: usize,
    /// Rows that the log holds twice.
    pub doubled: usize,
    /// Rows that came after later ones.
    pub late: usize,
    /// Times that the clock was set back.
    pub set_back: usize,
}

/// Rows that come so much later than they should, s, are late; otherwise the clock may have been set.
const LATE: f64 = 2.0;

/// Rows are missing where the time between two of them is this many times the usual one, and at least so long, s.
const GAP: (f64, f64) = (10.0, 1.0);

/// Fraction of the rows of a run that must be known already for the run to be a copy.
const COPY: f64 = 0.9;

/// Brings the rows of a log in order, and finds its runs.
pub(super) fn clean(source: &mut Source) {
    if source.times.is_sorted_by(|a, b| a < b) {
        source.runs = vec![0];
    } else {
        let pieces = Pieces::of(source);
        pieces.apply(source);
    }
    gaps(source);
}

/// Rows in their new order.
struct Pieces {
    order: Vec<u32>,
    /// Where the clock was set back: indices of `order`.
    begins: Vec<usize>,
    /// Latest time since then, s.
    known: f64,
    /// Longest time between two rows between which none is missing, s.
    longest: f64,
    doubled: usize,
    late: usize,
}

impl Pieces {
    fn of(source: &Source) -> Self {
        let times = &source.times;
        let steps: Vec<usize> = (1..times.len()).filter(|&row| times[row] < times[row - 1]).collect();
        let longest = longest_step(source);
        let mut pieces = Self {
            order: Vec::with_capacity(times.len()),
            begins: vec![0],
            known: f64::NEG_INFINITY,
            longest,
            doubled: 0,
            late: 0,
        };
        let mut begin = 0;
        for end in steps.iter().copied().chain([times.len()]) {
            let next = times.get(end).copied();
            pieces.take(source, begin..end, next);
            begin = end;
        }
        pieces.end_segment(source);
        pieces
    }

    /// Takes rows whose times do not decrease; `next` is the time of the row after them.
    fn take(&mut self, source: &Source, rows: Range<usize>, next: Option<f64>) {
        let times = &source.times;
        let segment = self.begins.last().copied().unwrap_or_default();
        if times[rows.start] < self.known {
            let behind = rows.start + times[rows.clone()].partition_point(|time| *time <= self.known);
            if self.is_late(times, &rows, behind, next) || self.is_copy(source, segment, rows.start..behind) {
                self.late += behind - rows.start;
            } else {
                self.end_segment(source);
                self.begins.push(self.order.len());
                self.known = f64::NEG_INFINITY;
            }
        }
        self.known = self.known.max(times[rows.end - 1]);
        self.order.extend(rows.map(|row| row as u32));
    }

    /// Whether rows, those before `behind` of which have times that are past, came late; otherwise the clock may have been set back. After
    /// a late block the log goes on from where it was, and after the clock was set back, from there.
    fn is_late(&self, times: &[f64], rows: &Range<usize>, behind: usize, next: Option<f64>) -> bool {
        let goes_on = match behind < rows.end {
            true => times[behind] - times[behind - 1] > self.longest,
            false => next.is_some_and(|next| next >= self.known),
        };
        goes_on || self.known - times[rows.start] <= LATE
    }

    /// Whether most of these rows are in the segment already.
    fn is_copy(&self, source: &Source, segment: usize, rows: Range<usize>) -> bool {
        let mut known: Vec<u32> = self.order[segment..].to_vec();
        let times = &source.times;
        known.sort_by(|a, b| times[*a as usize].total_cmp(&times[*b as usize]));
        let twin = |row: usize| {
            let first = known.partition_point(|&own| times[own as usize] < times[row]);
            known[first..]
                .iter()
                .take_while(|&&own| times[own as usize] == times[row])
                .any(|&own| same(source, own as usize, row))
        };
        let (count, twins) = (rows.len(), rows.filter(|&row| twin(row)).count());
        twins as f64 >= COPY * count as f64
    }

    /// Sorts the rows since the clock was last set, and drops the doubled ones.
    fn end_segment(&mut self, source: &Source) {
        let segment = self.begins.last().copied().unwrap_or_default();
        let mut rows = self.order.split_off(segment);
        rows.sort_by(|a, b| source.times[*a as usize].total_cmp(&source.times[*b as usize]));
        let before = rows.len();
        // Rows of one time follow one another, in the order of the file.
        let mut kept: Vec<u32> = Vec::with_capacity(rows.len());
        for row in rows {
            let twin = |own: &u32| same(source, *own as usize, row as usize);
            let time = source.times[row as usize];
            let at_once = kept.iter().rev().take_while(|own| source.times[**own as usize] == time);
            if !at_once.into_iter().any(twin) {
                kept.push(row);
            }
        }
        let dropped = before - kept.len();
        self.doubled += dropped;
        self.late = self.late.saturating_sub(dropped);
        self.order.extend(kept);
    }

    fn apply(self, source: &mut Source) {
        source.times = self.order.iter().map(|&row| source.times[row as usize]).collect();
        for (_, column) in &mut source.columns {
            *column = self.order.iter().map(|&row| column[row as usize]).collect();
        }
        if !source.events.is_empty() {
            let events = std::mem::take(&mut source.events);
            let moved = self.order.iter().enumerate();
            let moved = moved.filter_map(|(to, from)| Some((to, events.get(&(*from as usize))?.clone())));
            source.events = moved.collect::<BTreeMap<usize, Event>>();
        }
        source.tally.doubled = self.doubled;
        source.tally.late = self.late;
        source.tally.set_back = self.begins.len() - 1;
        source.runs = self.begins;
    }
}

/// Whether two rows hold the same.
fn same(source: &Source, a: usize, b: usize) -> bool {
    let equal = |x: f32, y: f32| x == y || x.is_nan() && y.is_nan();
    source.columns.iter().all(|(_, column)| equal(column[a], column[b]))
        && source.events.get(&a) == source.events.get(&b)
}

/// Begins runs where rows are missing. A log of events has no rhythm, so nothing is missing from it.
fn gaps(source: &mut Source) {
    if source.columns.is_empty() || source.times.len() < 3 {
        return;
    }
    let longest = longest_step(source);
    let missing =
        source.times.windows(2).enumerate().filter(|(_, pair)| pair[1] - pair[0] > longest).map(|(row, _)| row + 1);
    source.runs.extend(missing.collect::<Vec<_>>());
    source.runs.sort_unstable();
    source.runs.dedup();
}

/// Longest time between two rows of a log between which none is missing, s.
pub(crate) fn longest_step(source: &Source) -> f64 {
    GAP.1.max(GAP.0 * usual_step(&source.times))
}

/// Median time between rows, s, of some thousand of them.
fn usual_step(times: &[f64]) -> f64 {
    let every = (times.len() / 5000).max(1);
    let mut steps: Vec<f64> =
        times.windows(2).step_by(every).map(|pair| pair[1] - pair[0]).filter(|step| *step > 0.0).collect();
    let middle = steps.len() / 2;
    if steps.is_empty() { 0.0 } else { *steps.select_nth_unstable_by(middle, f64::total_cmp).1 }
}
