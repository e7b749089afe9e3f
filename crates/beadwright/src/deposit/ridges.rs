//! Parallel beads of one size side by side: most of a raster. One line across them tells all.
//!
//! With lengths in half bead widths a, heights in bead heights, and δ from crest to crest, 1 ≤ δ < 2, only neighbours
//! meet. Between two crests a bead stands alone up to δ − 1, as high as 1 − s²; from there both add up to
//! 2 − s² − (δ − s)², which is least at its ends, 1 − (δ − 1)², and greatest in the middle, 2 − δ²/2.

use super::stroke::Frame;
use super::{LOW, OVERFILL, VOID};
use glam::DVec2;

/// More beads than these beside each other are not taken together.
pub(super) const MOST: usize = 12;
/// Places across a square for its means: nearer to each other than its points.
const SAMPLES: usize = 64;
const LANES: usize = 8;

/// A square crossed by parallel beads that leave neither void nor hump in it.
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
}

impl Ridges {
    /// The beads like `frame` whose crests lie at `offsets` (mm across, from the middle of the square, in any order), over
    /// a square that reaches `half` mm to every side of its middle, half a step of the grid included. `None` where a place in it, or between its crests,
    /// might be a void or overfilled for a nominal bead of that height.
    pub(super) fn of(frame: &Frame, offsets: &mut [f64], half: f64, nominal_height: f64) -> Option<Self> {
        let (a, scale) = (frame.a, nominal_height / frame.height);
        let reach = half * (frame.along.x.abs() + frame.along.y.abs()) / a;
        offsets.sort_unstable_by(f64::total_cmp);
        offsets.iter_mut().for_each(|offset| *offset /= a);
        let (least, greatest) = extremes(offsets, reach)?;
        if least <= VOID * scale || greatest >= OVERFILL * scale {
            return None;
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
        })
    }

    /// Mean height, mm, over a stretch of `length` mm across the beads around `middle`.
    pub(super) fn mean_around(&self, middle: f64, length: f64) -> f64 {
        let (middle, half) = ((middle / self.half_width) as f32, (0.5 * length / self.half_width) as f32);
        let swept = |s: f32| {
            let s = s.max(-1.0).min(1.0);
            s - s * s * s / 3.0
        };
        let of = |crest: &f32| swept(middle + half - crest) - swept(middle - half - crest);
        f64::from(self.crests[..self.count].iter().map(of).sum::<f32>() / (2.0 * half)) * self.height
    }
}

/// Bounds of the height over `reach` to both sides of the middle; `None` where more than two beads meet, or none does.
fn extremes(crests: &[f64], reach: f64) -> Option<(f64, f64)> {
    let (first, last) = (crests.first()?, crests.last()?);
    // Beyond the outer crests one bead stands alone.
    let alone = |distance: f64| 1.0 - distance.max(0.0).powi(2);
    let mut bounds = (alone(first + reach).min(alone(reach - last)), 1.0_f64);
    for pair in crests.windows(2).filter(|pair| pair[0] < reach && pair[1] > -reach) {
        let gap = pair[1] - pair[0];
        if !(1.0..2.0).contains(&gap) {
            return None;
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
        for gap in [1.0, 1.18, 1.476, 1.7, 1.809, 1.95] {
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
