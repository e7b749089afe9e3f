//! The height field of a layer on a grid, every point in double precision, computed in bands of rows. Each band
//! considers only the pieces of bead that reach it; bands run in parallel, and none is kept unless asked for.
//!
//! This is the reference: a [`Judge`](super::Judge) computes the same figures faster (`tiles`).

use super::stroke::{Domed, Even, Footprint, Frame, Rimmed, Stroke};
use crate::bead::Section;
use glam::{DVec2, I64Vec2};
use planar::Bounds;
use rayon::prelude::*;
use std::ops::{Add, Mul, Range};

/// Approximate number of points in a band, so that it stays in the cache.
const BAND_POINTS: usize = 1 << 14;

/// Points at whole multiples of the step, so that the grids of all layers coincide.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grid {
    /// Distance between neighbouring points, mm.
    pub step: f64,
    /// The lowest point, in steps.
    pub low: I64Vec2,
    /// Points in x.
    pub columns: usize,
    /// Points in y.
    pub rows: usize,
}

impl Grid {
    /// The grid that covers a box grown by `margin` (mm).
    pub fn covering(bounds: &Bounds, margin: f64, step: f64) -> Self {
        let low = ((bounds.min - margin) / step).floor().as_i64vec2();
        let high = ((bounds.max + margin) / step).ceil().as_i64vec2();
        let size = (high - low + 1).max(I64Vec2::ZERO);
        Self { step, low, columns: size.x as usize, rows: size.y as usize }
    }

    /// Position of a point, mm.
    pub fn place(&self, column: usize, row: usize) -> DVec2 {
        (self.low + I64Vec2::new(column as i64, row as i64)).as_dvec2() * self.step
    }

    /// Number of points.
    pub fn points(&self) -> usize {
        self.columns * self.rows
    }

    /// The index of the point nearest to a position (mm); `None` beyond the grid.
    pub fn nearest(&self, place: DVec2) -> Option<usize> {
        let at = (place / self.step).round().as_i64vec2() - self.low;
        let within = at.cmpge(I64Vec2::ZERO).all() && at.x < self.columns as i64 && at.y < self.rows as i64;
        within.then(|| at.y as usize * self.columns + at.x as usize)
    }

    /// The columns whose points lie from `low` to `high` (mm).
    pub fn columns_between(&self, low: f64, high: f64) -> Range<usize> {
        let column = |x: f64| (x / self.step - self.low.x as f64).clamp(0.0, self.columns as f64);
        up(column(low))..(column(high) as usize + 1).min(self.columns)
    }

    /// The rows whose points lie from `low` to `high` (mm).
    pub fn rows_between(&self, low: f64, high: f64) -> Range<usize> {
        let row = |y: f64| self.row_at(y).clamp(0.0, self.rows as f64);
        up(row(low))..(row(high) as usize + 1).min(self.rows)
    }

    /// Rows of one band.
    pub(super) fn band_rows(&self) -> usize {
        (BAND_POINTS / self.columns.max(1)).clamp(1, self.rows.max(1))
    }

    pub(super) fn row_at(&self, y: f64) -> f64 {
        y / self.step - self.low.y as f64
    }
}

/// Rounds up, for values that are not negative; without a call into the maths library.
pub(super) fn up(x: f64) -> usize {
    let down = x as usize;
    down + usize::from(x > down as f64)
}

/// A height in double or in single precision, mm.
pub trait Height: Copy + PartialOrd + Default + Send + Sync + Add<Output = Self> + Mul<Output = Self> {
    /// From double precision.
    fn of(height: f64) -> Self;
    /// In double precision.
    fn mm(self) -> f64;
}

impl Height for f64 {
    fn of(height: f64) -> Self {
        height
    }

    fn mm(self) -> f64 {
        self
    }
}

impl Height for f32 {
    fn of(height: f64) -> Self {
        height as Self
    }

    fn mm(self) -> f64 {
        self.into()
    }
}

/// A rectangle of a height field.
#[derive(Debug)]
pub struct Band<'a, H = f64> {
    /// The whole grid.
    pub grid: &'a Grid,
    /// The first row.
    pub first: usize,
    /// The columns.
    pub columns: Range<usize>,
    /// Heights, mm, row after row.
    pub heights: Vec<H>,
    /// Number of point evaluations, summed over the pieces.
    pub work: usize,
}

impl<'a, H: Height> Band<'a, H> {
    /// A band without metal.
    pub(super) fn bare(grid: &'a Grid, rows: Range<usize>, columns: Range<usize>) -> Self {
        let heights = vec![H::default(); rows.len() * columns.len()];
        Self { grid, first: rows.start, columns, heights, work: 0 }
    }

    /// The rows with their numbers.
    pub fn rows(&self) -> impl Iterator<Item = (usize, &[H])> {
        self.heights.chunks(self.columns.len().max(1)).enumerate().map(|(k, row)| (self.first + k, row))
    }

    /// The sections of column ranges, from left to right, that lie in the band, counted from the band's first column.
    pub(super) fn parts<'s>(
        &self,
        stretches: &'s [Range<usize>],
    ) -> impl Iterator<Item = Range<usize>> + use<'s, '_, 'a, H> {
        let first = stretches.partition_point(|stretch| stretch.end <= self.columns.start);
        let reaching = stretches[first..].iter().take_while(|stretch| stretch.start < self.columns.end);
        reaching.map(|stretch| self.within(stretch))
    }

    /// The section of a column range that lies in the band, counted from the band's first column.
    pub(super) fn within(&self, columns: &Range<usize>) -> Range<usize> {
        let at = |column: usize| column.clamp(self.columns.start, self.columns.end) - self.columns.start;
        at(columns.start)..at(columns.end).max(at(columns.start))
    }
}

/// Computes all bands of a layer and passes each to `visit`. The results come back in order from the lowest band to the
/// highest, whatever the number of threads.
pub fn bands<R: Send>(strokes: &[Stroke], grid: &Grid, visit: impl Fn(Band<'_>) -> R + Sync) -> Vec<R> {
    let frames: Vec<Frame> = strokes.iter().filter_map(Stroke::frame).collect();
    let height = grid.band_rows();
    let reaching = reaching(&frames, grid, height);
    let answer = |(k, reaching): (usize, &Vec<&Frame>)| {
        let rows = k * height..(k * height + height).min(grid.rows);
        let mut band = Band::bare(grid, rows, 0..grid.columns);
        for frame in reaching {
            match frame.section {
                Section::Parabola => lay::<Domed>(frame, &mut band),
                Section::Ellipse => lay::<Even>(frame, &mut band),
                Section::Stadium => lay::<Rimmed>(frame, &mut band),
            }
        }
        visit(band)
    };
    reaching.par_iter().enumerate().map(answer).collect()
}

/// The pieces that reach each band of `height` rows.
pub(super) fn reaching<'f>(frames: &'f [Frame], grid: &Grid, height: usize) -> Vec<Vec<&'f Frame>> {
    let mut reaching: Vec<Vec<&Frame>> = vec![Vec::new(); grid.rows.div_ceil(height)];
    for frame in frames {
        let (a, b) = (frame.from.y, frame.from.y + frame.along.y * frame.length);
        let low = grid.row_at(a.min(b) - frame.a).max(0.0) as usize / height;
        let high = grid.row_at(a.max(b) + frame.a).max(0.0) as usize / height;
        reaching.iter_mut().take(high + 1).skip(low).for_each(|band| band.push(frame));
    }
    reaching
}

fn lay<F: Footprint>(frame: &Frame, band: &mut Band<'_>) {
    let grid = band.grid;
    let first = band.first;
    let mut work = 0;
    for (k, row) in band.heights.chunks_mut(grid.columns).enumerate() {
        let y = grid.place(0, first + k).y;
        let Some((low, high, plain_low, plain_high)) = frame.row(y) else { continue };
        let all = grid.columns_between(low, high);
        let plain = grid.columns_between(plain_low, plain_high);
        let plain = plain.start.clamp(all.start, all.end)..plain.end.clamp(all.start, all.end);
        let plain = if plain.is_empty() { all.end..all.end } else { plain };
        let place = |column: usize| DVec2::new((grid.low.x + column as i64) as f64 * grid.step, y);
        add(&mut row[all.start..plain.start], all.start, |column| frame.height_of::<F>(place(column)));
        add(&mut row[plain.clone()], plain.start, |column| frame.passed_over::<F>(place(column)));
        add(&mut row[plain.end..all.end], plain.end, |column| frame.height_of::<F>(place(column)));
        work += all.len();
    }
    band.work += work;
}

#[inline]
fn add(row: &mut [f64], first: usize, height: impl Fn(usize) -> f64) {
    for (k, value) in row.iter_mut().enumerate() {
        *value += height(first + k);
    }
}
