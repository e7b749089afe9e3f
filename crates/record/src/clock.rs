//! Clocks of logs, aligned by the arc: each log sees it begin and end, at times that differ by an offset and a drift.

use crate::arc::{Arcs, Span};
use crate::sequence::{self, Pair, Rules, offset};
use crate::source::Source;
use std::ops::Range;

/// Time of the reference = `rate` × time of the log + offset of the piece.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Clock {
    pub(crate) pieces: Vec<Piece>,
    pub(crate) rate: f64,
    /// Arcs that were found in the reference too.
    pub(crate) matched: usize,
    /// Root mean square by which their ends differ from those of the reference, s.
    pub(crate) within: f64,
    pub(crate) trust: Trust,
}

/// A part of the log during which its clock was not set.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Piece {
    /// Its first row.
    pub(crate) row: usize,
    /// s.
    pub(crate) offset: f64,
}

/// What the alignment of a clock relies on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Trust {
    /// It is the clock by which all others are set.
    Reference,
    /// Arcs that both logs saw.
    Arcs,
    /// The dates of the logs: no arcs were seen in both.
    Dates,
    /// Nothing: the log was put where it begins with the reference.
    Nothing,
}

/// Offsets of arcs that follow one another differ by no more than this, s, and this fraction of the time between them, unless the
/// clock was set.
const STEADY: (f64, f64) = (1.0, 2e-3);

/// Shortest time from which a drift can be computed, s.
const LONG: f64 = 300.0;

/// Ends whose offset differs by more than this, s, from the median of this many on each side are left out of the fit.
const FAR: f64 = 0.3;
const AROUND: usize = 6;

/// Fraction of the arcs of the shorter log that must be found in the other one.
const ENOUGH: f64 = 0.4;

/// Dates are right within about this, s.
const DATED: f64 = 60.0;

impl Clock {
    /// The clock by which the others are set.
    pub(crate) fn reference(arcs: usize) -> Self {
        Self { matched: arcs, ..Self::plain(0.0, Trust::Reference) }
    }

    fn plain(offset: f64, trust: Trust) -> Self {
        Self { pieces: vec![Piece { row: 0, offset }], rate: 1.0, matched: 0, within: 0.0, trust }
    }

    /// Time of a row by the reference, s.
    pub(crate) fn at(&self, source: &Source, row: usize) -> f64 {
        let piece = self.pieces.partition_point(|piece| piece.row <= row).saturating_sub(1);
        self.rate * source.times[row] + self.pieces[piece].offset
    }

    /// The clock of a log, by the arcs of the reference.
    pub(crate) fn aligned(reference: (&Source, &Arcs), source: &Source, arcs: Option<&Arcs>) -> Self {
        let (own, known) = reference;
        let dated = own.dated && source.dated;
        let unknown = || match dated {
            true => Self::plain(0.0, Trust::Dates),
            false => Self::plain(own.times[0] - source.times[0], Trust::Nothing),
        };
        let Some(arcs) = arcs else { return unknown() };
        let rules = Rules {
            length: (0.2, 0.004),
            offset: (0.3, 1e-3),
            missing: 0.25,
            extra: 0.25,
            about: dated.then_some((0.0, DATED)),
        };
        let pairs = sequence::pairs(&known.spans, &arcs.spans, &rules);
        let mut groups = groups(&pairs, &known.spans, &arcs.spans);
        groups.retain(|group| !ends(group, &known.spans, &arcs.spans).is_empty());
        let matched: usize = groups.iter().map(|group| group.len()).sum();
        let shorter = known.spans.len().min(arcs.spans.len());
        if matched < 2 || (matched as f64) < ENOUGH * shorter as f64 {
            return unknown();
        }
        Self::fitted(&groups, &known.spans, source, arcs, matched)
    }

    fn fitted(groups: &[Vec<Pair>], known: &[Span], source: &Source, arcs: &Arcs, matched: usize) -> Self {
        let edges: Vec<Vec<[f64; 2]>> =
            groups.iter().map(|group| steady_ends(&ends(group, known, &arcs.spans))).collect();
        let line = Line::through(&edges);
        let count = edges.iter().map(Vec::len).sum::<usize>().max(1);
        let within = (line.residuals(&edges).map(|apart| apart * apart).sum::<f64>() / count as f64).sqrt();
        let mut pieces = vec![Piece { row: 0, offset: line.offsets[0] }];
        for (pair, offsets) in groups.windows(2).zip(line.offsets.windows(2)) {
            let rows = |group: &[Pair], last: bool| {
                let pair = if last { group.last() } else { group.first() };
                pair.map_or(0..0, |pair| arcs.rows[pair.seen.start].start..arcs.rows[pair.seen.end - 1].end)
            };
            let between = rows(&pair[0], true).end..rows(&pair[1], false).start;
            pieces.push(Piece { row: set_at(source, between, offsets[1] - offsets[0]), offset: offsets[1] });
        }
        Self { pieces, rate: line.rate, matched, within, trust: Trust::Arcs }
    }
}

/// The row before which the clock was set by `step`, s, so that time goes on as usual: one where a run begins, if there is one.
fn set_at(source: &Source, between: Range<usize>, step: f64) -> usize {
    let begins = source.runs.iter().copied().filter(|row| *row > between.start && *row <= between.end);
    let odd = |row: &usize| (source.times[*row] - source.times[row - 1] + step).abs();
    begins.min_by(|a, b| odd(a).total_cmp(&odd(b))).unwrap_or(between.end)
}

/// Pairs in groups between which the clock was set. A single pair that fits neither side is a mistake.
fn groups(pairs: &[Pair], known: &[Span], seen: &[Span]) -> Vec<Vec<Pair>> {
    let at = |pair: &Pair| (offset(&known[pair.expected], &seen[pair.seen.clone()]), known[pair.expected].start);
    let steady = |a: &Pair, b: &Pair| {
        let ((first, then), (second, now)) = (at(a), at(b));
        (second - first).abs() <= STEADY.0 + STEADY.1 * (now - then).abs()
    };
    let grouped = |pairs: &mut dyn Iterator<Item = Pair>| {
        let mut groups: Vec<Vec<Pair>> = Vec::new();
        for pair in pairs {
            match groups.last_mut() {
                Some(group) if group.last().is_some_and(|last| steady(last, &pair)) => group.push(pair),
                _ => groups.push(vec![pair]),
            }
        }
        groups
    };
    let first = grouped(&mut pairs.iter().cloned());
    let least = if first.iter().any(|group| group.len() > 2) { 3 } else { 1 };
    grouped(&mut first.into_iter().filter(|group| group.len() >= least).flatten())
}

/// Ends of arcs that both logs saw: time of the log, time of the reference.
fn ends(group: &[Pair], known: &[Span], seen: &[Span]) -> Vec<[f64; 2]> {
    let of = |pair: &Pair| {
        let (own, reference) = (&seen[pair.seen.clone()], &known[pair.expected]);
        let (first, last) = (own.first(), own.last());
        let start =
            first.filter(|span| span.start_known && reference.start_known).map(|span| [span.start, reference.start]);
        let end = last.filter(|span| span.end_known && reference.end_known).map(|span| [span.end, reference.end]);
        start.into_iter().chain(end)
    };
    group.iter().flat_map(of).collect()
}

/// The ends whose offset is about that of those around them.
fn steady_ends(ends: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let apart = |edge: &[f64; 2]| edge[1] - edge[0];
    let middle = |at: usize| {
        let around = &ends[at.saturating_sub(AROUND)..(at + AROUND + 1).min(ends.len())];
        let mut apart: Vec<f64> = around.iter().map(apart).collect();
        *apart.select_nth_unstable_by(around.len() / 2, f64::total_cmp).1
    };
    ends.iter()
        .enumerate()
        .filter(|(at, edge)| (apart(edge) - middle(*at)).abs() <= FAR)
        .map(|(_, edge)| *edge)
        .collect()
}

/// One rate, and an offset for each group.
struct Line {
    rate: f64,
    offsets: Vec<f64>,
}

impl Line {
    /// Least squares; without a group that is long enough, the rate is 1.
    fn through(groups: &[Vec<[f64; 2]>]) -> Self {
        let mean =
            |group: &[[f64; 2]], of: usize| group.iter().map(|edge| edge[of]).sum::<f64>() / group.len().max(1) as f64;
        // The difference of both clocks, so that large times lose no digits.
        let apart = |edge: &[f64; 2]| edge[1] - edge[0];
        let (mut up, mut down, mut longest) = (0.0, 0.0, 0.0_f64);
        for group in groups {
            let middle = mean(group, 0);
            let level = group.iter().map(apart).sum::<f64>() / group.len().max(1) as f64;
            up += group.iter().map(|edge| (edge[0] - middle) * (apart(edge) - level)).sum::<f64>();
            down += group.iter().map(|edge| (edge[0] - middle).powi(2)).sum::<f64>();
            let ends = group.first().zip(group.last());
            longest = longest.max(ends.map_or(0.0, |(first, last)| last[0] - first[0]));
        }
        let drift = if longest >= LONG { up / down } else { 0.0 };
        let offset = |group: &Vec<[f64; 2]>| {
            let level = group.iter().map(apart).sum::<f64>() / group.len().max(1) as f64;
            level - drift * mean(group, 0)
        };
        Self { rate: 1.0 + drift, offsets: groups.iter().map(offset).collect() }
    }

    fn residuals<'a>(&'a self, groups: &'a [Vec<[f64; 2]>]) -> impl Iterator<Item = f64> + 'a {
        let of = move |(group, offset): (&'a Vec<[f64; 2]>, &'a f64)| {
            group.iter().map(move |[own, reference]| self.rate * own + offset - reference)
        };
        groups.iter().zip(&self.offsets).flat_map(of)
    }
}
