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
const MOST_CELLS: usize = 40_000_000;

/// A way to some expected and some seen arcs: what it costs, and its last pair.
#[derive(Debug, Clone, Copy)]
struct Way {
    cost: f64,
    last: Option<Last>,
}

#[derive(Debug, Clone, Copy)]
struct Last {
    offset: f64,
    expected: usize,
}

/// The cheapest ways to some expected and some seen arcs. That which ends with a pair is kept beside a cheaper one that does not:
/// its offset may be that of all pairs to come.
#[derive(Debug, Clone, Copy)]
struct Cell {
    any: Way,
    paired: Way,
}

/// How a cell was reached.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Step {
    Begin,
    Missing,
    Extra,
    Paired,
}

/// The last step of both ways to a cell; that of the paired one is a number of arcs, after a way that ended with a pair or any.
#[derive(Debug, Clone, Copy)]
struct Trail {
    any: Step,
    count: u8,
    after_pair: bool,
}

const NO_WAY: Way = Way { cost: f64::INFINITY, last: None };
const NOWHERE: Cell = Cell { any: NO_WAY, paired: NO_WAY };

/// The pairs of two sequences, in order.
pub(crate) fn pairs(expected: &[Span], seen: &[Span], rules: &Rules) -> Vec<Pair> {
    let (rows, columns) = (expected.len() + 1, seen.len() + 1);
    let band = Band { rows, columns, half: (MOST_CELLS / rows / 2).max(MOST + 1) };
    let mut trails: Vec<Vec<Trail>> = Vec::with_capacity(rows);
    let mut above: Vec<Cell> = Vec::new();
    for row in 0..rows {
        let (range, before) = (band.range(row), band.range(row.saturating_sub(1)));
        let mut own: Vec<Cell> = Vec::with_capacity(range.len());
        let mut steps = Vec::with_capacity(range.len());
        for column in range {
            let up = |back: usize| {
                let at = column.checked_sub(back).filter(|at| row > 0 && before.contains(at));
                at.map_or(NOWHERE, |at| above[at - before.start])
            };
            let (paired, count, after_pair) = rules.best_pair(expected, seen, (row, column), &up);
            let begin = if (row, column) == (0, 0) { Way { cost: 0.0, last: None } } else { NO_WAY };
            let (missing, extra) = (up(0).any, own.last().map_or(NO_WAY, |left| left.any));
            let ways = [
                (begin, Step::Begin),
                (paired, Step::Paired),
                (Way { cost: missing.cost + rules.missing, ..missing }, Step::Missing),
                (Way { cost: extra.cost + rules.extra, ..extra }, Step::Extra),
            ];
            let first = ways[0];
            let (any, step) =
                ways.into_iter().fold(first, |best, way| if way.0.cost < best.0.cost { way } else { best });
            own.push(Cell { any, paired });
            steps.push(Trail { any: step, count, after_pair });
        }
        above = own;
        trails.push(steps);
    }
    walk(&band, &trails)
}

/// The way back from the last cell.
fn walk(band: &Band, trails: &[Vec<Trail>]) -> Vec<Pair> {
    let (mut row, mut column, mut found, mut pair) = (band.rows - 1, band.columns - 1, Vec::new(), false);
    while row > 0 || column > 0 {
        let trail = trails[row][column - band.range(row).start];
        match if pair { Step::Paired } else { trail.any } {
            Step::Missing => row -= 1,
            Step::Extra => column -= 1,
            Step::Paired => {
                let first = column - usize::from(trail.count);
                row -= 1;
                found.push(Pair { expected: row, seen: first..column });
                (column, pair) = (first, trail.after_pair);
            }
            Step::Begin => break,
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
    /// The cheapest way to a cell that ends with a pair, its number of seen arcs, and whether a pair comes before.
    fn best_pair(
        &self,
        expected: &[Span],
        seen: &[Span],
        (row, column): (usize, usize),
        up: &dyn Fn(usize) -> Cell,
    ) -> (Way, u8, bool) {
        let mut best = (NO_WAY, 1, false);
        for count in 1..=MOST.min(column) {
            let from = up(count);
            for (way, after_pair) in [(from.paired, true), (from.any, false)] {
                if way.cost < best.0.cost {
                    let paired = self.paired(expected, row - 1, &seen[column - count..column], way);
                    if paired.cost < best.0.cost {
                        best = (paired, count as u8, after_pair);
                    }
                }
            }
        }
        best
    }

    /// The way after an expected arc for which these were seen.
    fn paired(&self, expected: &[Span], index: usize, seen: &[Span], from: Way) -> Way {
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
        Way { cost: from.cost + wrong + again, last: Some(Last { offset, expected: index }) }
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
