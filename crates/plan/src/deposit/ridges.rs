//! Parallel beads of one size side by side: most of a raster. One line across them tells everything.
//!
//! With lengths in half bead widths, heights in bead heights, and crests δ apart, 1 ≤ δ < 2, only neighbours overlap.
//! Between two crests a bead is alone up to s = δ − 1 from its crest, with height 1 − s²; from there both add up to 2 −
//! s² − (δ − s)², which is least at the ends of that interval, 1 − (δ − 1)², and greatest in the middle, 2 − δ²/2.

use super::stroke::Frame;
use super::tiles::SIDE;
use super::{LOW, OVERFILL, VOID, field};
use glam::DVec2;
use std::ops::Range;

/// Most beads that are treated together.
pub(super) const MOST: usize = 12;
/// Points across a square for its means: denser than its grid points.
const SAMPLES: usize = 96;
const LANES: usize = 8;

/// A square crossed by parallel beads. Their voids and humps are stripes along them.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ridges {
    /// Positions of the crests across the beads, in half bead widths from the middle of the square, ascending.
    crests: [f64; MOST],
    count: usize,
    half_width: f64,
    height: f64,
    /// The fraction of the area that is low.
    pub(super) low: f64,
    /// Mean height, mm.
    pub(super) mean: f64,
    /// Mean of the squared height, mm².
    pub(super) square: f64,
    /// Least and greatest height, mm.
    pub(super) least: f64,
    pub(super) greatest: f64,
    /// Whether voids or humps occur between the beads.
    striped: bool,
    /// The nominal bead height over the height of these beads.
    scale: f64,
}

/// A row whose points differ by less than this across the beads, in half bead widths, runs along them.
const ALONG: f64 = 1e-9;
/// Added and subtracted again, this rounds to a whole number: 1.5 · 2⁵².
const TO_WHOLE: f64 = 6_755_399_441_055_744.0;

/// A void or a hump between the beads: an interval across them, in half bead widths.
#[derive(Debug, Clone, Copy)]
struct Stripe {
    low: f64,
    high: f64,
    /// Where it is deepest or highest.
    extreme: f64,
    overfilled: bool,
}

/// The points of a square, as in [`Ridges::stripes`] but in half bead widths.
struct Lines {
    start: f64,
    step: f64,
    row_step: f64,
    rows: usize,
    points: usize,
}

impl Lines {
    /// Calls `found` for each row with points in a stripe: the row, the points, the one nearest to the extreme, and
    /// that point's position across.
    fn meet(&self, stripe: &Stripe, mut found: impl FnMut(usize, Range<usize>, usize, f64)) {
        let start = |row: usize| self.start + row as f64 * self.row_step;
        if self.step.abs() < ALONG {
            let inside = |row: &usize| stripe.low < start(*row) && start(*row) < stripe.high;
            return (0..self.rows).filter(inside).for_each(|row| found(row, 0..self.points, 0, start(row)));
        }
        let at = |place: f64| (place - self.start) / self.step;
        let (low, high, extreme) = (at(stripe.low), at(stripe.high), at(stripe.extreme));
        let (low, high, by) = (low.min(high), low.max(high), self.row_step / self.step);
        let mut met = self.rows_met(stripe);
        while met != 0 {
            let row = met.trailing_zeros() as usize;
            met &= met - 1;
            if row >= self.rows {
                break;
            }
            let moved = row as f64 * by;
            let within = |at: f64| (at - moved).clamp(-1.0, self.points as f64);
            let (first, end) = ((within(low) + 1.0) as usize, field::up(within(high).max(0.0)));
            if first < end {
                let extreme = ((within(extreme) + 0.5).max(0.0) as usize).clamp(first, end - 1);
                found(row, first..end, extreme, start(row) + extreme as f64 * self.step);
            }
        }
    }

    /// The rows, one bit each, that may have a point in a stripe. Most stripes are so narrow that most rows have none.
    fn rows_met(&self, stripe: &Stripe) -> u64 {
        // In grid points: where the middle of the stripe crosses the first row, its shift from row to row, and half its
        // width.
        let at = (0.5 * (stripe.low + stripe.high) - self.start) / self.step;
        let by = self.row_step / self.step;
        let half = (0.5 * (stripe.high - stripe.low) / self.step).abs() + ALONG;
        let from_whole = |place: f64| ((place + TO_WHOLE) - TO_WHOLE - place).abs();
        let meets = |row: usize| from_whole(at - row as f64 * by) <= half;
        // Along the grid and at 45° to it all rows are alike.
        if SIDE as f64 * from_whole(by) < ALONG {
            return if meets(0) { u64::MAX } else { 0 };
        }
        (0..SIDE).fold(0, |rows, row| rows | u64::from(meets(row)) << row)
    }
}

impl Ridges {
    /// The beads like `frame` whose crests lie at `offsets` (mm across, from the middle of the square, in any order),
    /// over a square that extends `half` mm to each side of its middle, half a grid step included. `None` if more than
    /// two beads overlap anywhere, or none lies somewhere, or a void lies beyond the last crest, for a nominal bead of
    /// this height.
    pub(super) fn of(frame: &Frame, offsets: &mut [f64], half: f64, nominal_height: f64) -> Option<Self> {
        let (a, scale) = (frame.a, nominal_height / frame.height);
        let reach = half * (frame.along.x.abs() + frame.along.y.abs()) / a;
        offsets.sort_unstable_by(f64::total_cmp);
        offsets.iter_mut().for_each(|offset| *offset /= a);
        let (least, greatest) = extremes(offsets, reach)?;
        let striped = least <= VOID * scale || greatest >= OVERFILL * scale;
        if striped {
            let (first, last) = (offsets.first()?, offsets.last()?);
            let edge = (1.0 - VOID * scale).max(0.0).sqrt();
            if first + reach >= edge || reach - last >= edge {
                return None;
            }
        }
        let mut crests = [0.0; MOST];
        crests.get_mut(..offsets.len())?.iter_mut().zip(&*offsets).for_each(|(c, offset)| *c = *offset);
        let h = frame.height;
        let means = Means::over(&crests[..offsets.len()], frame.along * half / a, (LOW * scale) as f32);
        Some(Self {
            crests,
            count: offsets.len(),
            half_width: a,
            height: h,
            low: means.low,
            mean: h * means.height,
            square: h * h * means.square,
            least: h * least,
            greatest: h * greatest,
            striped,
            scale,
        })
    }

    /// Finds the points of a square that lie in a void or a hump. Its first point lies `start` mm across from its
    /// middle, the next point in the row `step` mm farther and the next row `row_step`; there are `rows` rows of
    /// `points` points. `found` receives whether it is a hump, the row, the range of points, the deepest or highest of
    /// them, and its height in mm; calls for one row come in the order of its points.
    pub(super) fn stripes(
        &self,
        (start, step, row_step): (f64, f64, f64),
        (rows, points): (usize, usize),
        mut found: impl FnMut(bool, usize, Range<usize>, usize, f64),
    ) {
        if !self.striped {
            return;
        }
        let a = self.half_width;
        let lines = Lines { start: start / a, step: step / a, row_step: row_step / a, rows, points };
        let pairs = self.crests[..self.count].windows(2);
        let stripes =
            pairs.flat_map(|pair| between(pair[0], pair[1], self.scale).into_iter().flatten().map(move |s| (pair, s)));
        let add = |(pair, stripe): (&[f64], Stripe)| {
            // No third bead reaches the gap.
            let bead = |crest: f64, place: f64| (1.0 - (place - crest).powi(2)).max(0.0);
            let height = |place: f64| (bead(pair[0], place) + bead(pair[1], place)) * self.height;
            lines.meet(&stripe, |row, points, at, place| found(stripe.overfilled, row, points, at, height(place)));
        };
        if step < 0.0 { stripes.rev().for_each(add) } else { stripes.for_each(add) }
    }

    /// A function giving the mean height, mm, over an interval of `length` mm across the beads, by its middle.
    pub(super) fn means(&self, length: f64) -> impl Fn(f64) -> f32 {
        const THIRD: f32 = 1.0 / 3.0;
        let per_mm = 1.0 / self.half_width;
        let half = (0.5 * length * per_mm) as f32;
        let scale = self.height as f32 / (2.0 * half);
        // Groups of crests side by side; unused entries hold infinity, too far away to count.
        let mut crests = [[f32::INFINITY; 4]; MOST / 4];
        crests
            .as_flattened_mut()
            .iter_mut()
            .zip(&self.crests[..self.count])
            .for_each(|(to, crest)| *to = *crest as f32);
        let some = self.count.div_ceil(4);
        let swept = |s: f32| {
            let s = s.clamp(-1.0, 1.0);
            s - s * s * s * THIRD
        };
        move |middle| {
            let middle = (middle * per_mm) as f32;
            let mut sums = [0.0; 4];
            for crests in &crests[..some] {
                for (sum, crest) in sums.iter_mut().zip(crests) {
                    *sum += swept(middle - crest + half) - swept(middle - crest - half);
                }
            }
            sums.iter().sum::<f32>() * scale
        }
    }
}

/// The voids and humps between two crests that are 1 to 2 half bead widths apart.
fn between(a: f64, b: f64, scale: f64) -> [Option<Stripe>; 2] {
    let (half, middle) = ((b - a) / 2.0, (a + b) / 2.0);
    let crown = 2.0 - 2.0 * half * half;
    // Within this distance of the middle both beads add up to more than a limit.
    let above = |limit: f64| ((crown - limit * scale) / 2.0).max(0.0).sqrt();
    if crown > OVERFILL * scale {
        let reach = above(OVERFILL);
        return [Some(Stripe { low: middle - reach, high: middle + reach, extreme: middle, overfilled: true }), None];
    }
    // A single bead is too low within `edge` of the middle; the deepest point is where the other bead begins.
    let (edge, deepest) = (half - (1.0 - VOID * scale).max(0.0).sqrt(), 1.0 - half);
    if edge <= deepest {
        return [None, None];
    }
    match above(VOID) {
        0.0 => [
            Some(Stripe { low: middle - edge, high: middle + edge, extreme: middle - deepest, overfilled: false }),
            None,
        ],
        inner => [-1.0, 1.0].map(|side| {
            let (p, q) = (middle + side * inner, middle + side * edge);
            Some(Stripe { low: p.min(q), high: p.max(q), extreme: middle + side * deepest, overfilled: false })
        }),
    }
}

/// Bounds of the height within `reach` on both sides of the middle; `None` where more than two beads overlap, or none
/// lies.
fn extremes(crests: &[f64], reach: f64) -> Option<(f64, f64)> {
    let (first, last) = (crests.first()?, crests.last()?);
    // Beyond the outer crests there is one bead alone.
    let alone = |distance: f64| 1.0 - distance.max(0.0).powi(2);
    let mut bounds = (alone(first + reach).min(alone(reach - last)), 1.0_f64);
    for pair in crests.windows(2) {
        let gap = pair[1] - pair[0];
        if !(1.0..2.0).contains(&gap) {
            return None;
        }
        if pair[0] >= reach || pair[1] <= -reach {
            continue;
        }
        bounds = (bounds.0.min(alone(gap - 1.0)), bounds.1.max(2.0 - gap * gap / 2.0));
    }
    Some(bounds)
}

/// Means over a square.
struct Means {
    low: f64,
    height: f64,
    square: f64,
}

impl Means {
    /// For beads whose crests lie within the square spanned by `half`, its half diagonal in the frame of the beads.
    fn over(crests: &[f64], half: DVec2, low: f32) -> Self {
        let half = half.abs().as_vec2();
        let (reach, flat) = (half.x + half.y, (half.x - half.y).abs());
        let step = 2.0 * reach / SAMPLES as f32;
        let places: [f32; SAMPLES] = std::array::from_fn(|k| (k as f32 + 0.5) * step - reach);
        let mut heights = [0.0_f32; SAMPLES];
        for crest in crests {
            let crest = *crest as f32;
            // The positions that the bead reaches, and a few more, where it adds nothing.
            let at = |place: f32| ((place + reach) / step).max(0.0) as usize;
            let near = at(crest - 1.0) / LANES..(at(crest + 1.0) / LANES + 1).min(SAMPLES / LANES);
            let lanes = heights.as_chunks_mut::<LANES>().0.iter_mut().zip(places.as_chunks::<LANES>().0);
            for (heights, places) in lanes.take(near.end).skip(near.start) {
                for (height, place) in heights.iter_mut().zip(places) {
                    let s = place - crest;
                    *height += (1.0 - s * s).max(0.0);
                }
            }
        }
        // Width of the square at a distance across: full up to `flat`, then decreasing.
        let fall = 1.0 / (reach - flat).max(1e-6 * reach);
        let [mut weights, mut lows, mut sums, mut squares] = [[0.0_f32; LANES]; 4];
        for (places, heights) in places.as_chunks::<LANES>().0.iter().zip(heights.as_chunks::<LANES>().0) {
            for k in 0..LANES {
                let weight = ((reach - places[k].abs()) * fall).min(1.0);
                weights[k] += weight;
                lows[k] += if heights[k] < low { weight } else { 0.0 };
                sums[k] += weight * heights[k];
                squares[k] += weight * heights[k] * heights[k];
            }
        }
        let total = weights.iter().sum::<f32>();
        let [low, height, square] = [lows, sums, squares].map(|lanes| f64::from(lanes.iter().sum::<f32>() / total));
        Self { low, height, square }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The bounds hold everywhere, and are attained where both ends of a gap lie in the square.
    #[test]
    fn heights_lie_within_their_bounds() {
        for gap in [1.01, 1.18, 1.476, 1.7, 1.809, 1.95] {
            for reach in [0.3, 1.0, 3.0] {
                for shift in [-0.7, 0.0, 0.2, 0.9] {
                    let crests: Vec<f64> = (-4..=4).map(|k| f64::from(k) * gap + shift).collect();
                    let near: Vec<f64> = crests.into_iter().filter(|c| c.abs() < 1.0 + reach).collect();
                    let height = |v: f64| near.iter().map(|c| (1.0 - (v - c).powi(2)).max(0.0)).sum::<f64>();
                    let (least, greatest) = extremes(&near, reach).unwrap();
                    let places = (-1000..=1000).map(|k| f64::from(k) / 1000.0 * reach);
                    let (mut low, mut high) = (f64::INFINITY, 0.0_f64);
                    places.map(height).for_each(|h| (low, high) = (low.min(h), high.max(h)));
                    assert!(low >= least - 1e-9 && high <= greatest + 1e-9, "{gap} {reach} {shift}: {low} {high}");
                    if reach == 3.0 {
                        assert!(low <= least + 1e-2 && high >= greatest - 1e-2, "{gap} {shift}: {low} {high}");
                    }
                }
            }
        }
        assert!(extremes(&[-0.4, 0.5], 1.0).is_none() && extremes(&[-1.0, 1.0], 1.0).is_none());
    }
}
