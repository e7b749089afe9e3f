//! One piece of bead laid onto a rectangle of the height field in single precision: the closed forms of
//! [`stroke`](super::stroke) with lengths in half bead widths, straight-line code that becomes vector instructions.
//!
//! Positions are computed in double precision at the start of each row and stepped from there, so a part far from the
//! origin loses no accuracy. The error of a piece stays below 1e-4 of its height: the far end of a piece of 1000 half
//! bead widths is accurate to 6e-5 of one.

use super::field::Band;
use super::stroke::{Domed, Even, Frame, Rimmed};
use crate::bead::Section;
use std::f32::consts::{FRAC_1_PI, FRAC_PI_2};
use std::ops::Range;

/// Most columns of a rectangle.
pub(super) const MOST_COLUMNS: usize = 512;

/// 0, 1, 2, …: how far each column lies from the first.
static RAMP: [f32; MOST_COLUMNS] = {
    let mut ramp = [0.0; MOST_COLUMNS];
    let mut k = 0;
    while k < MOST_COLUMNS {
        ramp[k] = k as f32;
        k += 1;
    }
    ramp
};

/// Adds a piece to the band.
pub(super) fn add(frame: &Frame, band: &mut Band<'_, f32>) {
    match frame.section {
        Section::Parabola => lay::<Domed>(frame, band),
        Section::Ellipse => lay::<Even>(frame, band),
        Section::Stadium => lay::<Rimmed>(frame, band),
    }
}

fn lay<F: Pool>(frame: &Frame, band: &mut Band<'_, f32>) {
    let (grid, width, first) = (band.grid, band.columns.len(), band.first);
    let way = frame.along / frame.a;
    let piece = Piece::new(frame, grid.step);
    let (a, b) = (frame.from.y, frame.from.y + frame.along.y * frame.length);
    let row_of = |y: f64| (grid.row_at(y) - first as f64).max(0.0) as usize;
    let rows = row_of(a.min(b) - frame.a)..(row_of(a.max(b) + frame.a) + 1).min(band.heights.len() / width);
    // Position of the first column along and across the piece.
    let d = grid.place(band.columns.start, first) - frame.from;
    let (along, across) = (d.dot(way), way.perp_dot(d));
    for k in rows {
        let y = k as f64 * grid.step;
        let start = ((along + y * way.y) as f32, (across + y * way.x) as f32);
        let columns = piece.reaches(start, width);
        band.work += columns.len();
        let row = &mut band.heights[k * width..][columns.clone()];
        let (whole, rest) = row.as_chunks_mut::<LANES>();
        let (ramp, last) = RAMP[columns].as_chunks::<LANES>();
        whole.iter_mut().zip(ramp).for_each(|(heights, ramp)| piece.lay::<F>(heights, ramp, start));
        piece.lay::<F>(rest, last, start);
    }
}

/// Columns computed side by side.
const LANES: usize = 8;
/// In pieces longer than this, in half bead widths, it is cheaper to compute the corners beside the round ends than to
/// find where they begin.
const SHORT: f32 = 4.0;

/// A piece of bead, with lengths in half bead widths.
struct Piece {
    length: f32,
    height: f32,
    /// How far a column lies along the piece and across it, and the reciprocals.
    step: (f32, f32),
    per_step: (f32, f32),
    /// Columns per half bead width.
    columns: f32,
}

impl Piece {
    fn new(frame: &Frame, grid_step: f64) -> Self {
        let step = frame.along * grid_step / frame.a;
        Self {
            length: (frame.length / frame.a) as f32,
            height: frame.height as f32,
            step: (step.x as f32, -step.y as f32),
            per_step: ((1.0 / step.x) as f32, (-1.0 / step.y) as f32),
            columns: (frame.a / grid_step) as f32,
        }
    }

    /// The columns of a row that the piece may reach, and a few more so that they can be computed side by side: beyond
    /// its end the piece adds nothing. The first of `width` columns lies at `start` along and across.
    fn reaches(&self, start: (f32, f32), width: usize) -> Range<usize> {
        let (low, high) = if self.length < SHORT { self.round(start) } else { self.boxed(start, 1.0) };
        if low <= high && low < width as f32 && high >= 0.0 {
            let (first, end) = (low as u32 as usize, (high.min(width as f32) as u32 as usize + 1).min(width));
            first..(first + (end - first).next_multiple_of(LANES)).min(width)
        } else {
            0..0
        }
    }

    /// The interval of columns in which the row lies within the piece, lengthened by `more` at both ends.
    fn boxed(&self, start: (f32, f32), more: f32) -> (f32, f32) {
        let between = |low: f32, high: f32, start: f32, per_step: f32| {
            let (a, b) = ((low - start) * per_step, (high - start) * per_step);
            (a.min(b), a.max(b))
        };
        let across = between(-1.0, 1.0, start.1, self.per_step.1);
        let along = between(-more, self.length + more, start.0, self.per_step.0);
        (across.0.max(along.0), across.1.min(along.1))
    }

    /// The same, with round ends.
    fn round(&self, start: (f32, f32)) -> (f32, f32) {
        // Where the row meets the pool at an end; NaN, which is skipped, where it does not.
        let pool = |t: f32| {
            let aside = (t * self.step.1 - start.1 * self.step.0) * self.columns;
            let middle = -(t * self.step.0 + start.1 * self.step.1) * self.columns;
            let half = (1.0 - aside * aside).sqrt();
            ((middle - half) * self.columns, (middle + half) * self.columns)
        };
        let (low, high) = self.boxed(start, 0.0);
        let (low, high) = if low <= high { (low, high) } else { (f32::INFINITY, f32::NEG_INFINITY) };
        let [begin, end] = [pool(start.0), pool(start.0 - self.length)];
        (low.min(begin.0).min(end.0), high.max(begin.1).max(end.1))
    }

    /// Adds the piece to some columns of a row; `ramp` gives the offset of each from the one at `start` along and
    /// across.
    #[inline(always)]
    fn lay<F: Pool>(&self, heights: &mut [f32], ramp: &[f32], start: (f32, f32)) {
        let (Some(first), Some(last)) = (ramp.first(), ramp.last()) else { return };
        let (length, height) = (self.length, self.height);
        let ends = (start.0 + first * self.step.0, start.0 + last * self.step.0);
        // Where the pool has arrived completely, or has not begun to leave, that end is skipped.
        let (low, high) = (ends.0.min(ends.1), ends.0.max(ends.1));
        let places = heights.iter_mut().zip(ramp);
        let places = places.map(|(value, k)| (value, start.0 + k * self.step.0, start.1 + k * self.step.1));
        match (low >= 1.0, high <= length - 1.0) {
            (true, true) => places.for_each(|(value, _, y)| *value += height * F::whole(1.0 - y * y)),
            (false, true) => places.for_each(|(value, t, y)| *value += height * F::one_end(1.0 - y * y, t)),
            (true, false) => places.for_each(|(value, t, y)| *value += height * F::one_end(1.0 - y * y, length - t)),
            (false, false) => places.for_each(|(value, t, y)| {
                let inside = (1.0 - y * y).max(0.0);
                let chord = 1.0 / inside.max(f32::MIN_POSITIVE).sqrt();
                let swept = F::swept(inside, (length - t) * chord) - F::swept(inside, -t * chord);
                // Rounding must not remove metal.
                *value += height * swept.max(0.0);
            }),
        }
    }
}

/// [`Footprint`](super::stroke::Footprint) in single precision.
pub(super) trait Pool {
    fn swept(inside: f32, u: f32) -> f32;

    fn whole(inside: f32) -> f32;

    /// The fraction of the whole that is added while the pool moves from 0 to `u` half-chords, inside it.
    fn share(u: f32) -> f32;

    /// What a long piece adds at `t` half bead widths from one of its ends, where `inside` = 1 − y².
    #[inline(always)]
    fn one_end(inside: f32, t: f32) -> f32 {
        let inside = inside.max(0.0);
        let chord = inside.max(f32::MIN_POSITIVE).sqrt();
        (0.5 * Self::whole(inside) + Self::swept(inside, t / chord)).max(0.0)
    }
}

impl Pool for Domed {
    #[inline(always)]
    fn swept(inside: f32, u: f32) -> f32 {
        inside * FRAC_1_PI * swept(u)
    }

    #[inline(always)]
    fn whole(inside: f32) -> f32 {
        inside.max(0.0)
    }

    #[inline(always)]
    fn share(u: f32) -> f32 {
        FRAC_1_PI * swept(u)
    }
}

impl Pool for Even {
    #[inline(always)]
    fn swept(inside: f32, u: f32) -> f32 {
        0.5 * inside.sqrt() * u.clamp(-1.0, 1.0)
    }

    #[inline(always)]
    fn whole(inside: f32) -> f32 {
        inside.max(0.0).sqrt()
    }

    #[inline(always)]
    fn share(u: f32) -> f32 {
        0.5 * u.clamp(-1.0, 1.0)
    }
}

impl Pool for Rimmed {
    #[inline(always)]
    fn swept(inside: f32, u: f32) -> f32 {
        // Outside the bead there is nothing to sweep.
        if inside > 0.0 { FRAC_1_PI * asin(u.clamp(-1.0, 1.0)) } else { 0.0 }
    }

    #[inline(always)]
    fn whole(inside: f32) -> f32 {
        if inside > 0.0 { 1.0 } else { 0.0 }
    }

    #[inline(always)]
    fn share(u: f32) -> f32 {
        FRAC_1_PI * asin(u.clamp(-1.0, 1.0))
    }
}

/// u √(1 − u²) + asin u for u clamped to ±1, odd and exact at 0 and ±1. It is π/2 − (1 − u)^1.5 P(u) for u ≥ 0, with P
/// fitted at Chebyshev points; error 6e-7.
#[inline(always)]
fn swept(u: f32) -> f32 {
    const P: [f32; 5] = [FRAC_PI_2, 0.356_161_73, -0.054_236_05, 0.016_898_216, -0.004_072_184];
    let x = u.abs().min(1.0);
    let rest = 1.0 - x;
    let series = P.iter().rev().fold(0.0, |sum, p| sum * x + p);
    (FRAC_PI_2 - rest * rest.sqrt() * series).copysign(u)
}

/// Arc sine after Abramowitz and Stegun 4.4.46.
#[inline(always)]
fn asin(u: f32) -> f32 {
    const P: [f32; 8] = [
        FRAC_PI_2,
        -0.214_598_8,
        0.088_978_99,
        -0.050_174_303,
        0.030_891_88,
        -0.017_088_126,
        0.006_670_09,
        -0.001_262_491,
    ];
    let x = u.abs();
    let series = P.iter().rev().fold(0.0, |sum, p| sum * x + p);
    (FRAC_PI_2 - (1.0 - x).sqrt() * series).copysign(u)
}
