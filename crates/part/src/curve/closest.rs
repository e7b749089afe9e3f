//! The nearest point of a curve: Newton's method, started on the nearest chords between samples.

use super::Nurbs;
use super::sample::nearest_on_segment;
use glam::DVec3;

/// Samples in each knot span, per degree.
const SAMPLES: usize = 8;

/// Newton's method starts from at most this many chords: the nearest among those nearer than both neighbours.
const FOLLOWED: usize = 8;

/// Distances that differ by less than this fraction of the coordinates are equal.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// A point of a curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Closest {
    /// Its parameter.
    pub parameter: f64,
    /// The point, mm.
    pub point: DVec3,
    /// Distance from the point asked for, mm.
    pub distance: f64,
}

impl Nurbs {
    /// The point of the curve nearest to `target`, mm.
    ///
    /// ```
    /// use bead_part::curve::Nurbs;
    /// use glam::DVec3;
    ///
    /// let line = Nurbs::line(DVec3::ZERO, DVec3::X * 10.0)?;
    /// let closest = line.closest(DVec3::new(4.0, 3.0, 0.0));
    /// assert!((closest.distance - 3.0).abs() < 1e-9);
    /// assert!(closest.point.distance(DVec3::X * 4.0) < 1e-9);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn closest(&self, target: DVec3) -> Closest {
        let samples = self.even_parameters();
        let points: Vec<DVec3> = samples.iter().map(|&u| self.point(u)).collect();
        let chords: Vec<(f64, f64)> = points.windows(2).map(|w| nearest_on_segment(target, w[0], w[1])).collect();
        let is_low = |i: &usize| {
            let before = i.checked_sub(1).is_none_or(|j| chords[j].1 >= chords[*i].1);
            before && chords.get(i + 1).is_none_or(|next| next.1 >= chords[*i].1)
        };
        let mut low: Vec<usize> = (0..chords.len()).filter(is_low).collect();
        low.sort_by(|&a, &b| chords[a].1.total_cmp(&chords[b].1));
        let around = |i: usize| {
            let start = samples[i] + (samples[i + 1] - samples[i]) * chords[i].0;
            (samples[i.saturating_sub(1)], start, samples[(i + 2).min(samples.len() - 1)])
        };
        let found = low.into_iter().take(FOLLOWED).map(|i| self.descend(target, around(i)));
        let first = self.closest_at(target, samples[0]);
        found.fold(first, |best, next| if next.distance < best.distance { next } else { best })
    }

    fn closest_at(&self, target: DVec3, parameter: f64) -> Closest {
        let point = self.point(parameter);
        Closest { parameter, point, distance: point.distance(target) }
    }

    fn even_parameters(&self) -> Vec<f64> {
        let breaks = self.breaks();
        let pieces = SAMPLES * self.degree;
        let inside =
            |w: &[f64]| (0..pieces).map(|i| w[0] + (w[1] - w[0]) * i as f64 / pieces as f64).collect::<Vec<_>>();
        let last = self.domain().1;
        breaks.windows(2).flat_map(inside).chain([last]).collect()
    }

    /// Minimises the distance, starting from the middle of three parameters and never passing the outer two.
    fn descend(&self, target: DVec3, (low, start, high): (f64, f64, f64)) -> Closest {
        let (mut low, mut high, mut u) = (low, high, start);
        let mut best = self.closest_at(target, start);
        for _ in 0..60 {
            let [point, velocity, acceleration] = self.derivatives(u);
            let offset = point - target;
            // Where the distance is flat, rounding hides that the later point is better.
            if offset.length() <= best.distance + ROUNDING * (point.length() + target.length()) {
                best = Closest { parameter: u, point, distance: offset.length() };
            }
            // The distance decreases where this is negative.
            let slope = offset.dot(velocity);
            if slope > 0.0 {
                high = u
            } else {
                low = u
            }
            let next = u - slope / (velocity.length_squared() + offset.dot(acceleration));
            let next = if next >= low && next <= high { next } else { (low + high) / 2.0 };
            if (next - u).abs() <= 1e-15 * (1.0 + u.abs()) {
                break;
            }
            u = next;
        }
        best
    }
}
