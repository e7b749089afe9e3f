//! One piece of bead laid onto a rectangle of the height field in single precision: the closed forms of
//! [`stroke`](super::stroke) with lengths in half bead widths, straight-line code that becomes vector instructions.
//!
//! Places are taken in double precision at the beginning of each row and stepped from there, so that a part far from
//! the origin loses nothing. The error of a piece stays below 1e-4 of its height: a piece of 1000 half
//! bead widths has the place of its far end to 6e-5 of one.

use super::field::Band;
use super::stroke::{Domed, Even, Frame, Rimmed};
use crate::bead::Section;
use std::f32::consts::{FRAC_1_PI, FRAC_PI_2};
use std::ops::Range;

/// A rectangle has no more columns than this.
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

/// Adds a piece.
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
    let piece = Piece {
        length: (frame.length / frame.a) as f32,
        height: frame.height as f32,
        step: ((way.x * grid.step) as f32, (-way.y * grid.step) as f32),
    };
    let (a, b) = (frame.from.y, frame.from.y + frame.along.y * frame.length);
    let row_of = |y: f64| (grid.row_at(y) - first as f64).max(0.0) as usize;
    let rows = row_of(a.min(b) - frame.a)..(row_of(a.max(b) + frame.a) + 1).min(band.heights.len() / width);
    for k in rows {
        let Some((low, high, plain_low, plain_high)) = frame.row(grid.place(0, first + k).y) else { continue };
        let all = band.within(&grid.columns_between(low, high));
        if all.is_empty() {
            continue;
        }
        let plain = band.within(&grid.columns_between(plain_low, plain_high));
        let plain = plain.start.clamp(all.start, all.end)..plain.end.clamp(all.start, all.end);
        let plain = if plain.is_empty() { all.end..all.end } else { plain };
        let d = grid.place(band.columns.start, first + k) - frame.from;
        let start = (d.dot(way) as f32, way.perp_dot(d) as f32);
        let row = &mut band.heights[k * width..][..width];
        for part in [all.start..plain.start, plain.clone(), plain.end..all.end] {
            piece.lay::<F>(row, part, start);
        }
        band.work += all.len();
    }
}

/// A piece of bead in half bead widths.
struct Piece {
    length: f32,
    height: f32,
    /// How far a column lies along the piece and across it.
    step: (f32, f32),
}

impl Piece {
    /// Adds the piece to some columns of a row whose first lies at `start` along and across.
    fn lay<F: Pool>(&self, row: &mut [f32], columns: Range<usize>, start: (f32, f32)) {
        if columns.is_empty() {
            return;
        }
        let (length, height) = (self.length, self.height);
        let along = |column: usize| start.0 + RAMP[column] * self.step.0;
        let ends = (along(columns.start), along(columns.end - 1));
        // Where the pool has wholly come, or is not yet to go, that end is left out.
        let (low, high) = (ends.0.min(ends.1), ends.0.max(ends.1));
        let places = row[columns.clone()].iter_mut().zip(&RAMP[columns]);
        let places = places.map(|(value, k)| (value, start.0 + k * self.step.0, start.1 + k * self.step.1));
        match (low >= 1.0, high <= length - 1.0) {
            (true, true) => places.for_each(|(value, _, y)| *value += height * F::whole(1.0 - y * y)),
            (false, true) => places.for_each(|(value, t, y)| *value += height * F::one_end(1.0 - y * y, t)),
            (true, false) => places.for_each(|(value, t, y)| *value += height * F::one_end(1.0 - y * y, length - t)),
            (false, false) => places.for_each(|(value, t, y)| {
                let inside = (1.0 - y * y).max(0.0);
                let chord = 1.0 / inside.max(f32::MIN_POSITIVE).sqrt();
                let swept = F::swept(inside, (length - t) * chord) - F::swept(inside, -t * chord);
                // Rounding must not take metal away.
                *value += height * swept.max(0.0);
            }),
        }
    }
}

/// [`Footprint`](super::stroke::Footprint) in single precision.
trait Pool {
    fn swept(inside: f32, u: f32) -> f32;

    fn whole(inside: f32) -> f32;

    /// What a long piece adds `t` half bead widths from one of its ends, where `inside` = 1 − y².
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
}

impl Pool for Rimmed {
    #[inline(always)]
    fn swept(inside: f32, u: f32) -> f32 {
        // Off the bead there is nothing to sweep.
        if inside > 0.0 { FRAC_1_PI * asin(u.clamp(-1.0, 1.0)) } else { 0.0 }
    }

    #[inline(always)]
    fn whole(inside: f32) -> f32 {
        if inside > 0.0 { 1.0 } else { 0.0 }
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
