//! The fast evaluation of a layer: grid squares, row by row, each judged as cheaply as it allows.
//!
//! A square without metal outside the outline is skipped. One inside that parallel beads cross from side to side is
//! known from a line across it ([`Ridges`]). All others, at edges, ends and turns, are computed point by point
//! ([`lay`]). So voids, overfill and metal outside are counted on the same points as in the reference
//! ([`field`](super::field)), and differ only where single precision puts a height on the other side of a limit. Only
//! the mean, deviation and low area of ridges are computed along a line across them, and their least and greatest
//! heights are exact, independent of the grid points.

use super::field::{self, Band, Grid};
use super::lay;
use super::ridges::{MOST, Ridges};
use super::stroke::{Frame, Stroke};
use super::{Mask, Nominal};
use crate::bead::Section;
use rayon::prelude::*;
use std::ops::Range;

/// Grid points along a side of a square.
pub(super) const SIDE: usize = 64;
/// Beads whose directions differ by less than this sine are parallel: over a square they diverge by a millionth of its
/// side.
const PARALLEL: f64 = 1e-6;

/// The layer to be judged.
pub(super) struct Field<'a> {
    pub(super) grid: &'a Grid,
    pub(super) mask: &'a Mask,
    pub(super) nominal: &'a Nominal,
    /// Whether ridges may be judged as such instead of point by point.
    pub(super) ridges: bool,
}

/// A section of a layer that has been evaluated.
pub(super) enum Part<'a> {
    /// Computed point by point.
    Band(&'a Band<'a, f32>),
    /// A whole square of ridges.
    Ridges(&'a Square, &'a Ridges),
}

/// A square of the grid.
#[derive(Debug, Clone)]
pub(super) struct Square {
    pub(super) rows: Range<usize>,
    pub(super) columns: Range<usize>,
    /// Unit vector along its ridges.
    pub(super) along: glam::DVec2,
}

impl Field<'_> {
    /// Evaluates a whole layer. Each row of squares has its own `R`, which takes in its sections from left to right;
    /// they are returned from the lowest to the highest, whatever the number of threads.
    pub(super) fn look<R: Send>(
        &self,
        strokes: &[Stroke],
        begin: impl Fn(Range<usize>) -> R + Sync,
        take: impl Fn(&mut R, Part<'_>) + Sync,
    ) -> Vec<R> {
        let frames: Vec<Frame> = strokes.iter().filter_map(Stroke::frame).collect();
        let reaching = field::reaching(&frames, self.grid, SIDE);
        let row = |(k, reaching): (usize, &Vec<&Frame>)| {
            let rows = k * SIDE..(k * SIDE + SIDE).min(self.grid.rows);
            let mut seen = begin(rows.clone());
            self.row_of_squares(rows, reaching, |part| take(&mut seen, part));
            seen
        };
        reaching.par_iter().enumerate().map(row).collect()
    }

    fn row_of_squares(&self, rows: Range<usize>, reaching: &[&Frame], mut take: impl FnMut(Part<'_>)) {
        let pieces: Vec<(&Frame, Range<usize>)> =
            reaching.iter().map(|frame| (*frame, self.squares_under(frame, &rows))).collect();
        let mut cells = self.cells(&rows);
        for (frame, under) in &pieces {
            for at in under.clone() {
                self.note(&mut cells[at], frame, at, &rows);
            }
        }
        let ridges: Vec<Option<Ridges>> = cells.iter_mut().map(|cell| self.ridges(cell)).collect();
        let computed = |at: usize| ridges[at].is_none() && !cells[at].is_empty();
        let mut at = 0;
        while at < cells.len() {
            let start = at;
            while at < cells.len() && at - start < lay::MOST_COLUMNS / SIDE && computed(at) {
                at += 1;
            }
            if start < at {
                let columns = start * SIDE..(at * SIDE).min(self.grid.columns);
                let mut band = Band::bare(self.grid, rows.clone(), columns);
                let near = pieces.iter().filter(|(_, under)| under.start < at && under.end > start);
                near.for_each(|(frame, _)| lay::add(frame, &mut band));
                take(Part::Band(&band));
                continue;
            }
            if let (Some(ridges), Some(frame)) = (&ridges[at], cells[at].first) {
                let columns = at * SIDE..(at * SIDE + SIDE).min(self.grid.columns);
                take(Part::Ridges(&Square { rows: rows.clone(), columns, along: frame.along }, ridges));
            }
            at += 1;
        }
    }

    /// The squares of a row that a piece may reach.
    fn squares_under(&self, frame: &Frame, rows: &Range<usize>) -> Range<usize> {
        let grid = self.grid;
        let (low, high) = (grid.place(0, rows.start).y - frame.a, grid.place(0, rows.end).y + frame.a);
        let (from, way) = (frame.from, frame.along * frame.length);
        let at = |y: f64| from.x + ((y - from.y) / way.y).clamp(0.0, 1.0) * way.x;
        let (p, q) = if way.y.abs() > 1e-9 { (at(low), at(high)) } else { (from.x, from.x + way.x) };
        let columns = grid.columns_between(p.min(q) - frame.a, p.max(q) + frame.a);
        columns.start / SIDE..columns.end.div_ceil(SIDE)
    }

    /// The squares of a row, classified by the outline.
    fn cells<'f>(&self, rows: &Range<usize>) -> Vec<Cell<'f>> {
        let mut cells = vec![Cell::default(); self.grid.columns.div_ceil(SIDE)];
        // How many more rows are wholly inside from each square on.
        let mut more = vec![0_isize; cells.len() + 1];
        for columns in rows.clone().flat_map(|row| self.mask.core(row)) {
            let (start, end) = (columns.start, columns.end);
            for edge in [start, end].into_iter().filter(|edge| edge % SIDE != 0) {
                cells[edge / SIDE].edge = true;
            }
            if start.div_ceil(SIDE) < end / SIDE {
                more[start.div_ceil(SIDE)] += 1;
                more[end / SIDE] -= 1;
            }
        }
        let mut inside = 0;
        for (cell, more) in cells.iter_mut().zip(more) {
            inside += more;
            cell.inside = !cell.edge && inside == rows.len() as isize;
            cell.edge |= inside > 0 && !cell.inside;
        }
        cells
    }

    /// Records the effect of a piece on a square.
    fn note<'f>(&self, cell: &mut Cell<'f>, frame: &'f Frame, at: usize, rows: &Range<usize>) {
        // The square is treated as complete even at the edge of the grid.
        let middle = self.grid.place(at * SIDE, rows.start) + self.half() - self.grid.step / 2.0;
        let reach = self.half() * (frame.along.x.abs() + frame.along.y.abs());
        let d = middle - frame.from;
        let (t, y) = (d.dot(frame.along), frame.along.perp_dot(d));
        let past = frame.a + reach;
        if y.abs() >= past || t <= -past || t >= frame.length + past {
            return;
        }
        let first = *cell.first.get_or_insert(frame);
        let alike = frame.a == first.a && frame.height == first.height && frame.section == first.section;
        let parallel = frame.along.perp_dot(first.along).abs() < PARALLEL;
        let whole = t >= past && t <= frame.length - past;
        if !(self.ridges && cell.inside && alike && parallel && whole) || cell.count == MOST {
            cell.edge = true;
            return;
        }
        cell.offsets[cell.count] = -y * frame.along.dot(first.along).signum();
        cell.count += 1;
    }

    /// Distance from the middle of a square to its sides, half a step beyond its outer points, mm.
    fn half(&self) -> f64 {
        0.5 * SIDE as f64 * self.grid.step
    }

    fn ridges(&self, cell: &mut Cell<'_>) -> Option<Ridges> {
        let frame = cell.first.filter(|frame| !cell.edge && cell.inside && frame.section == Section::Parabola)?;
        Ridges::of(frame, &mut cell.offsets[..cell.count], self.half(), self.nominal.bead.height)
    }
}

/// What is known about a square before its points are computed.
#[derive(Debug, Clone, Copy, Default)]
struct Cell<'f> {
    /// The first piece that reaches it.
    first: Option<&'f Frame>,
    /// An outline, an end or a turn lies in it.
    edge: bool,
    /// All its points are inside the outline less its rim.
    inside: bool,
    offsets: [f64; MOST],
    count: usize,
}

impl Cell<'_> {
    /// Whether it has neither metal nor an area where metal is required.
    fn is_empty(&self) -> bool {
        self.first.is_none() && !self.edge && !self.inside
    }
}
