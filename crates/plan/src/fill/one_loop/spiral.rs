//! Spirals: rings nested like onion skins, joined by ramps.
//!
//! Where every ring has at most one neighbour inside it, no flip is needed: over a few stepovers a ring ramps over to
//! the next, and the path has no corner at all. It begins at the outermost ring on even layers and ends there on odd
//! ones, so that a layer ends where the next begins.

use super::LoopSettings;
use super::rings::{POINTS_PER_STEPOVER, Ring, perimeter};
use crate::fill::sound;
use glam::DVec2;
use planar::polyline::point_at;

/// Length of a ramp, in stepovers, and the largest fraction of the shorter ring that it may take.
const RAMP: f64 = 3.0;
const MOST: f64 = 0.4;
/// Neighbouring rings are at most this many stepovers apart, averaged along the ring.
const FARTHEST: f64 = 1.3;
/// The ends of the path reach this far into the ramp next to them, as a fraction of the ramp.
const END: f64 = 0.45;
/// Positions for the ramps are tried this many stepovers apart.
const TRIES: f64 = 1.0;
/// Most positions tried.
const MOST_TRIES: usize = 64;

/// The open path through nested rings, from the outermost to the innermost; `None` if they are not nested or fewer than
/// three.
pub fn spiral(rings: &[Ring], settings: &LoopSettings) -> Option<Vec<DVec2>> {
    let chain = chain(rings, settings)?;
    let d = settings.stepover;
    let tries = ((perimeter(&chain[0]) / (TRIES * d)).ceil() as usize).clamp(1, MOST_TRIES);
    let mut all: Vec<Aligned> = (0..tries).map(|k| Aligned::of(&chain, k * chain[0].len() / tries, d)).collect();
    all.sort_by(|a, b| a.score.total_cmp(&b.score));
    // A ramp between rings that do not run side by side may cross them.
    all.iter().map(Aligned::path).find(|path| sound::crossing_pieces(std::slice::from_ref(path)).is_empty())
}

/// The rings from outside in, if each lies inside the one before and close to it.
fn chain(rings: &[Ring], settings: &LoopSettings) -> Option<Vec<Vec<DVec2>>> {
    let mut sorted: Vec<&Ring> = rings.iter().collect();
    sorted.sort_by_key(|ring| ring.level);
    if rings.len() < 3 || sorted.windows(2).any(|pair| pair[0].level == pair[1].level) {
        return None;
    }
    let nested = sorted.windows(2).all(|pair| {
        let outer = planar::Ring::new(pair[0].points.clone());
        let inner = &pair[1].points;
        let apart = || mean_distance(inner, &pair[0].points).max(mean_distance(&pair[0].points, inner));
        inner.first().is_some_and(|p| outer.contains(*p)) && apart() < FARTHEST * settings.stepover
    });
    // Make all run the same way.
    let turned = |ring: &Ring| {
        let mut points = ring.points.clone();
        if planar::Ring::new(points.clone()).area() < 0.0 {
            points.reverse();
        }
        points
    };
    nested.then(|| sorted.into_iter().map(turned).collect())
}

/// Mean distance of a sample of `points` from `others`, mm.
fn mean_distance(points: &[DVec2], others: &[DVec2]) -> f64 {
    let some = points.iter().step_by(points.len().div_ceil(MOST_TRIES));
    let distance = |p: &DVec2| others.iter().map(|q| q.distance_squared(*p)).fold(f64::INFINITY, f64::min).sqrt();
    some.clone().map(distance).sum::<f64>() / some.count() as f64
}

/// The rings, rotated so that they begin next to each other.
struct Aligned {
    rings: Vec<Vec<DVec2>>,
    ramps: Vec<f64>,
    score: f64,
    step: f64,
}

impl Aligned {
    fn of(chain: &[Vec<DVec2>], start: usize, stepover: f64) -> Self {
        let mut rings: Vec<Vec<DVec2>> = Vec::with_capacity(chain.len());
        let mut at = chain[0][start];
        for ring in chain {
            let square = |i: &usize| ring[*i].distance_squared(at);
            let nearest = (0..ring.len()).min_by(|a, b| square(a).total_cmp(&square(b))).unwrap_or(0);
            at = ring[nearest];
            let mut points = ring.clone();
            points.rotate_left(nearest);
            points.push(points[0]);
            rings.push(points);
        }
        let length = |ring: &[DVec2]| planar::polyline::length(ring);
        let ramps: Vec<f64> =
            rings.windows(2).map(|pair| (RAMP * stepover).min(MOST * length(&pair[0]).min(length(&pair[1])))).collect();
        // How much the rings turn over their ramps.
        let turn = |ring: &[DVec2], ramp: f64| {
            let way = |s: f64| {
                let (a, b) =
                    (point_at(ring, s).unwrap_or_default(), point_at(ring, s + 0.1 * stepover).unwrap_or_default());
                (b - a).normalize_or_zero()
            };
            (1..=4).map(|k| 1.0 - way(0.0).dot(way(ramp * f64::from(k) / 4.0))).fold(0.0, f64::max)
        };
        let score = rings.iter().zip(&ramps).map(|(ring, &ramp)| turn(ring, ramp)).sum();
        Self { rings, ramps, score, step: stepover / POINTS_PER_STEPOVER }
    }

    fn path(&self) -> Vec<DVec2> {
        let first = self.ramps.first().copied().unwrap_or_default();
        let last = self.ramps.last().copied().unwrap_or_default();
        let mut path = Vec::new();
        let mut from = (1.0 - END) * first;
        for (k, ring) in self.rings.iter().enumerate() {
            let length = planar::polyline::length(ring);
            let mut s = from;
            while s < length {
                path.extend(point_at(ring, s));
                s += self.step;
            }
            match self.ramps.get(k) {
                Some(&ramp) => {
                    self.ramp(k, ramp, &mut path);
                    from = ramp;
                }
                None => {
                    let mut s = 0.0;
                    while s <= END * last {
                        path.extend(point_at(ring, s));
                        s += self.step;
                    }
                }
            }
        }
        path
    }

    /// Leads from the start of ring `k` to a ramp's length past the start of the next.
    fn ramp(&self, k: usize, ramp: f64, path: &mut Vec<DVec2>) {
        let count = (ramp / self.step).ceil().max(2.0) as usize;
        for j in 0..count {
            let t = j as f64 / count as f64;
            let [a, b] = [k, k + 1].map(|ring| point_at(&self.rings[ring], t * ramp).unwrap_or_default());
            // Begins and ends tangentially to the rings.
            path.push(a.lerp(b, t * t * (3.0 - 2.0 * t)));
        }
    }
}
