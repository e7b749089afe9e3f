//! Two sequences of arcs brought together: one expected, one seen, with arcs missing, added and broken in either.
//!
//! The cheapest alignment (Needleman and Wunsch 1970), in which a pair also costs what its offset in time differs from that of the
//! pair before. So a lost arc is recognised in a part whose passes are all equally long: after it, times agree as before.

use crate::arc::Span;
use std::ops::Range;

/// What differences cost. A pair whose lengths agree and whose offset is that of the pair before costs nothing.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Rules {
    /// Lengths of arcs agree within this, s, plus this fraction of them.
    pub(crate) length: (f64, f64),
    /// Offsets agree within this, s, plus this fraction of the time since the pair before.
    pub(crate) offset: (f64, f64),
    /// An expected arc that was not seen.
    pub(crate) missing: f64,
    /// A seen arc that was not expected.
    pub(crate) extra: f64,
    /// The offset that is to be expected, s, and how well it is known, s.
    pub(crate) about: Option<(f64, f64)>,
}

/// An expected arc, and those that were seen for it: several where it was struck again.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Pair {
    pub(crate) expected: usize,
    pub(crate) seen: Range<usize>,
}

/// Most arcs for an expected one.
const MOST: usize = 4;
/// Another arc for the same expected one.
const AGAIN: f64 = 0.3;
/// A length or an offset that does not agree at all.
const WRONG: [f64; 2] = [0.6, 1.0];
/// Most pairs that are looked at; beyond, those far from the diagonal are left out.
const MOST_CELLS: usize = 60_000_000;

/// The cheapest way to some expected and some seen arcs, and the offset of its last pair, s.
#[derive(Debug, Clone, Copy)]
struct Cell {
    cost: f64,
    last: Option<Last>,
}

#[derive(Debug, Clone, Copy)]
struct Last {
    offset: f64,
    expected: usize,
}

/// How a cell was reached.
const MISSING: u8 = 0;
const EXTRA: u8 = 1;
/// This, less one, and the number of arcs seen for the expected one.
const PAIRED: u8 = 1;

const NOWHERE: Cell = Cell { cost: f64::INFINITY, last: None };

/// The pairs of two sequences, in order.
pub(crate) fn pairs(expected: &[Span], seen: &[Span], rules: &Rules) -> Vec<Pair> {
    let (rows, columns) = (expected.len() + 1, seen.len() + 1);
    let band = Band { rows, columns, half: (MOST_CELLS / rows / 2).max(MOST + 1) };
    let mut way: Vec<Vec<u8>> = Vec::with_capacity(rows);
    let mut before: Vec<Cell> = Vec::new();
    for row in 0..rows {
        let (range, above) = (band.range(row), band.range(row.saturating_sub(1)));
        let mut own: Vec<Cell> = Vec::with_capacity(range.len());
        let mut steps = Vec::with_capacity(range.len());
        for column in range.clone() {
            let up = |back: usize| {
                let at = column.checked_sub(back).filter(|at| row > 0 && above.contains(at));
                at.map_or(NOWHERE, |at| before[at - above.start])
            };
            let mut best = (NOWHERE, MISSING);
            let mut offer = |cell: Cell, step: u8| {
                if cell.cost < best.0.cost {
                    best = (cell, step);
                }
            };
            if (row, column) == (0, 0) {
                offer(Cell { cost: 0.0, last: None }, MISSING);
            }
            offer(Cell { cost: up(0).cost + rules.missing, ..up(0) }, MISSING);
            if let Some(left) = own.last() {
                offer(Cell { cost: left.cost + rules.extra, ..*left }, EXTRA);
            }
            for count in 1..=MOST.min(column) {
                let from = up(count);
                if row > 0 && from.cost < f64::INFINITY {
                    let cell = rules.paired(expected, row - 1, &seen[column - count..column], from);
                    offer(cell, PAIRED + count as u8);
                }
            }
            own.push(best.0);
            steps.push(best.1);
        }
        before = own;
        way.push(steps);
    }
    walk(&band, &way)
}

/// The way back from the last cell.
fn walk(band: &Band, way: &[Vec<u8>]) -> Vec<Pair> {
    let (mut row, mut column, mut found) = (band.rows - 1, band.columns - 1, Vec::new());
    while row > 0 || column > 0 {
        match way[row][column - band.range(row).start] {
            EXTRA => column -= 1,
            MISSING if row > 0 => row -= 1,
            step if step > PAIRED && row > 0 => {
                let first = column - usize::from(step - PAIRED);
                row -= 1;
                found.push(Pair { expected: row, seen: first..column });
                column = first;
            }
            _ => break,
        }
    }
    found.reverse();
    found
}

/// The cells that are looked at: all, or those around the diagonal.
struct Band {
    rows: usize,
    columns: usize,
    half: usize,
}

impl Band {
    fn range(&self, row: usize) -> Range<usize> {
        let middle = (row as f64 / (self.rows - 1).max(1) as f64 * (self.columns - 1) as f64) as usize;
        // Neighbouring rows of a steep band must touch.
        let half = self.half.max(self.columns / self.rows + 1);
        middle.saturating_sub(half)..(middle + half + 1).min(self.columns)
    }
}

impl Rules {
    /// The cell after an expected arc for which these were seen.
    fn paired(&self, expected: &[Span], index: usize, seen: &[Span], from: Cell) -> Cell {
        let (own, length) = (&expected[index], self.length_part(&expected[index], seen));
        let mut offset = offset(own, seen);
        let apart = match from.last {
            Some(last) => {
                // An arc that was struck late, or went out early, is judged by its other end.
                let by_end = seen[seen.len() - 1].end - own.end;
                if length > 1.0 && (by_end - last.offset).abs() < (offset - last.offset).abs() {
                    offset = by_end;
                }
                let time = (own.start - expected[last.expected].end).max(0.0);
                (offset - last.offset) / (self.offset.0 + self.offset.1 * time)
            }
            None => self.about.map_or(0.0, |(about, within)| (offset - about) / within),
        };
        let again = AGAIN * (seen.len() - 1) as f64;
        let wrong = WRONG[0] * length * length / (1.0 + length * length) + WRONG[1] * apart.abs() / (1.0 + apart.abs());
        Cell { cost: from.cost + wrong + again, last: Some(Last { offset, expected: index }) }
    }

    /// By how much lengths differ, in units of what is allowed.
    fn length_part(&self, own: &Span, seen: &[Span]) -> f64 {
        let (first, last) = (&seen[0], &seen[seen.len() - 1]);
        let whole = last.end - first.start;
        // The torch waits for the arc, or goes on without it.
        let burning: f64 = seen.iter().map(Span::seconds).sum();
        let open = !(first.start_known && last.end_known && own.start_known && own.end_known);
        let apart = |length: f64| {
            let difference = length - own.seconds();
            if open { difference.max(0.0) } else { difference.abs() }
        };
        apart(whole).min(apart(burning)) / (self.length.0 + self.length.1 * own.seconds())
    }
}

/// By how much the seen arcs come later than the expected one, s, judged by the ends that were seen.
pub(crate) fn offset(expected: &Span, seen: &[Span]) -> f64 {
    let (Some(first), Some(last)) = (seen.first(), seen.last()) else { return 0.0 };
    let (start, end) = (first.start - expected.start, last.end - expected.end);
    match (first.start_known && expected.start_known, last.end_known && expected.end_known) {
        (false, true) => end,
        _ => start,
    }
}
