//! Parallel beads of one size side by side: most of a raster. One line across them tells all.
//!
//! With lengths in half bead widths a, heights in bead heights, and δ from crest to crest, 1 ≤ δ < 2, only neighbours
//! meet. Between two crests a bead stands alone up to δ − 1, as high as 1 − s²; from there both add up to
//! 2 − s² − (δ − s)², which is least at its ends, 1 − (δ − 1)², and greatest in the middle, 2 − δ²/2.

use super::stroke::Frame;
use super::{LOW, OVERFILL, VOID, field};
use glam::DVec2;
use std::ops::Range;

/// More beads than these beside each other are not taken together.
pub(super) const MOST: usize = 12;
/// Places across a square for its means: nearer to each other than its points.
const SAMPLES: usize = 64;
const LANES: usize = 8;

/// A square crossed by parallel beads. Their voids and humps are stripes along them.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ridges {
    /// Where the crests lie across the beads, in half bead widths from the middle of the square, rising.
    crests: [f32; MOST],
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
    stripes: [Stripe; MOST_STRIPES],
    stripe_count: usize,
}

/// More voids and humps beside each other are not taken together.
const MOST_STRIPES: usize = 2 * MOST;

/// A row whose points differ by less than this across, in half bead widths, runs along the beads.
const ALONG: f64 = 1e-9;

/// Where the beads leave a void or a hump between them: places across in half bead widths.
#[derive(Debug, Clone, Copy, Default)]
struct Stripe {
    low: f64,
    high: f64,
    /// Where it is deepest or highest.
    extreme: f64,
    overfilled: bool,
}

impl Ridges {
    /// The beads like `frame` whose crests lie at `offsets` (mm across, from the middle of the square, in any order), over
    /// a square that reaches `half` mm to every side of its middle, half a step of the grid included. `None` where more
    /// than two beads meet or none does, or where a void lies beyond the last crest, for a nominal bead of that height.
    pub(super) fn of(frame: &Frame, offsets: &mut [f64], half: f64, nominal_height: f64) -> Option<Self> {
        let (a, scale) = (frame.a, nominal_height / frame.height);
        let reach = half * (frame.along.x.abs() + frame.along.y.abs()) / a;
        offsets.sort_unstable_by(f64::total_cmp);
        offsets.iter_mut().for_each(|offset| *offset /= a);
        let (least, greatest) = extremes(offsets, reach)?;
        let mut stripes = [Stripe::default(); MOST_STRIPES];
        let mut stripe_count = 0;
        if least <= VOID * scale || greatest >= OVERFILL * scale {
            let (first, last) = (offsets.first()?, offsets.last()?);
            let edge = (1.0 - VOID * scale).max(0.0).sqrt();
            if first + reach >= edge || reach - last >= edge {
                return None;
            }
            for stripe in offsets.windows(2).flat_map(|pair| between(pair[0], pair[1], scale)).flatten() {
                *stripes.get_mut(stripe_count)? = stripe;
                stripe_count += 1;
            }
        }
        let mut crests = [0.0; MOST];
        crests.get_mut(..offsets.len())?.iter_mut().zip(&*offsets).for_each(|(c, offset)| *c = *offset as f32);
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
            stripes,
            stripe_count,
        })
    }

    /// The voids and humps along a row of points, the first of them `start` mm across from the middle of the square and
    /// each next one `step` mm farther: whether it is a hump, which points, the deepest or highest of them, its height in mm.
    pub(super) fn stripes(
        &self,
        start: f64,
        step: f64,
        points: usize,
    ) -> impl Iterator<Item = (bool, Range<usize>, usize, f64)> {
        let (start, step) = (start / self.half_width, step / self.half_width);
        let end = start + step * (points - 1) as f64;
        let (low, high, columns) = (start.min(end), start.max(end), 1.0 / step);
        let at = move |place: f64| ((place - start) * columns).clamp(-1.0, points as f64);
        let met = self.stripes[..self.stripe_count].iter().filter(move |s| s.low < high && s.high > low);
        met.filter_map(move |stripe| {
            let (a, b) = if step.abs() < ALONG { (-1.0, points as f64) } else { (at(stripe.low), at(stripe.high)) };
            let (first, end) = ((a.min(b) + 1.0) as u32, a.max(b));
            // Most stripes are so narrow that no point of the row lies in them.
            if f64::from(first) >= end {
                return None;
            }
            let found = first as usize..field::up(end);
            let extreme = (at(stripe.extreme).max(0.0).round() as usize).clamp(found.start, found.end - 1);
            Some((stripe.overfilled, found, extreme, self.height_at(start + extreme as f64 * step)))
        })
    }

    /// The height, mm, at a place across in half bead widths.
    fn height_at(&self, place: f64) -> f64 {
        let bead = |crest: &f32| (1.0 - (place - f64::from(*crest)).powi(2)).max(0.0);
        self.crests[..self.count].iter().map(bead).sum::<f64>() * self.height
    }

    /// Mean height, mm, over a stretch of `length` mm across the beads around `middle`.
    pub(super) fn mean_around(&self, middle: f64, length: f64) -> f64 {
        let (middle, half) = ((middle / self.half_width) as f32, (0.5 * length / self.half_width) as f32);
        let swept = |s: f32| {
            let s = s.clamp(-1.0, 1.0);
            s - s * s * s / 3.0
        };
        let of = |crest: &f32| swept(middle + half - crest) - swept(middle - half - crest);
        f64::from(self.crests[..self.count].iter().map(of).sum::<f32>() / (2.0 * half)) * self.height
    }
}

/// The voids and humps between two crests, 1 to 2 half bead widths apart.
fn between(a: f64, b: f64, scale: f64) -> [Option<Stripe>; 2] {
    let (half, middle) = ((b - a) / 2.0, (a + b) / 2.0);
    let crown = 2.0 - 2.0 * half * half;
    // Within this distance of the middle both beads add up to more than a limit.
    let above = |limit: f64| ((crown - limit * scale) / 2.0).max(0.0).sqrt();
    if crown > OVERFILL * scale {
        let reach = above(OVERFILL);
        return [Some(Stripe { low: middle - reach, high: middle + reach, extreme: middle, overfilled: true }), None];
    }
    // A bead alone is too low within `edge` of the middle; the deepest place is where the other begins.
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

/// Bounds of the height over `reach` to both sides of the middle; `None` where more than two beads meet, or none does.
fn extremes(crests: &[f64], reach: f64) -> Option<(f64, f64)> {
    let (first, last) = (crests.first()?, crests.last()?);
    // Beyond the outer crests one bead stands alone.
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
    /// Of beads whose crests lie in the square that `half`, its half diagonal turned into the direction of the beads, spans.
    fn over(crests: &[f32], half: DVec2, low: f32) -> Self {
        let half = half.abs().as_vec2();
        let (reach, flat) = (half.x + half.y, (half.x - half.y).abs());
        let step = 2.0 * reach / SAMPLES as f32;
        let places: [f32; SAMPLES] = std::array::from_fn(|k| (k as f32 + 0.5) * step - reach);
        let mut heights = [0.0_f32; SAMPLES];
        for crest in crests {
            for (height, place) in heights.iter_mut().zip(&places) {
                let s = place - crest;
                *height += (1.0 - s * s).max(0.0);
            }
        }
        // How much of the square lies at a distance across: all its width up to `flat`, then less and less.
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

    /// The bounds hold at every place, and are reached where both ends of a gap lie in the square.
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
