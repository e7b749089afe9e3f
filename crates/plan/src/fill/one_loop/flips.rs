//! Flips: rings joined into one loop.
//!
//! Where two neighbouring rings run side by side, a section of each is removed and two links are laid between their
//! ends: the same metal in the same place, but two loops have become one. A spanning tree of flips over all
//! neighbouring rings makes one loop of an island, whatever its holes and branches.
//!
//! Flips are placed where both rings are straight and parallel, away from each other, and elsewhere on the next layers.

use super::LoopSettings;
use super::rings::{POINTS_PER_STEPOVER, Ring};
use super::room::Room;
use super::squares::Squares;
use glam::DVec2;

/// Rings farther apart than this many stepovers are not neighbours.
const FARTHEST: f64 = 1.6;
/// At most this fraction of a ring is taken out.
const MOST: f64 = 0.3;
/// Flips stay this many stepovers apart where they can.
const APART: f64 = 2.2;
/// Side of the squares of a checkerboard by which successive layers place flips in different places, in stepovers.
const FIELD: f64 = 4.0;
/// Number of layers after which a square has its turn again.
pub(super) const TURNS: i64 = 3;
/// No other ring may come closer to the middle between two rings than this fraction of their distance.
const BETWEEN: f64 = 0.35;
/// Points at which a link is checked, as fractions of it; and its least distance from the outline, in widths of the
/// narrowest bead.
const LINK: [f64; 3] = [0.25, 0.5, 0.75];
const NARROWEST: f64 = 0.45;

/// A place where two rings can be joined: a section of each, by the indices of its points.
#[derive(Debug, Clone, PartialEq)]
struct Flip {
    rings: [usize; 2],
    /// From one end to the other; the first points lie next to each other, and so do the last.
    stretches: [Vec<usize>; 2],
    place: DVec2,
    /// Cost: lower is better.
    score: f64,
}

/// Rings joined.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Joined {
    /// Closed lines: one, if all rings could be joined.
    pub loops: Vec<Vec<DVec2>>,
    /// Where they were joined.
    pub flips: Vec<DVec2>,
}

/// Joins rings by a spanning tree of flips.
pub fn join(rings: &[Ring], room: &Room, settings: &LoopSettings) -> Joined {
    let points = Points::of(rings);
    let squares = Squares::of(&points.at, FARTHEST * settings.stepover);
    let mut chosen: Vec<&Flip> = Vec::new();
    let mut groups = Groups::new(rings.len());
    let mut taken = vec![false; points.at.len()];
    let mut flips = candidates(&points, &squares, settings);
    flips.sort_by(|a, b| a.score.total_cmp(&b.score).then_with(|| a.stretches.cmp(&b.stretches)));
    // First well apart, then wherever possible.
    for apart in [APART * settings.stepover, 0.0] {
        for flip in &flips {
            let free = || flip.stretches.iter().flatten().all(|&point| !taken[point]);
            let far = |other: &&Flip| other.place.distance(flip.place) >= apart;
            let open = || flip.is_open(&points, room, &squares, settings);
            if groups.are_apart(flip.rings) && free() && chosen.iter().all(far) && open() {
                groups.join(flip.rings);
                points.take(flip, &mut taken);
                chosen.push(flip);
            }
        }
    }
    let places = chosen.iter().map(|flip| flip.place).collect();
    Joined { loops: points.joined(&chosen), flips: places }
}

/// Which rings are connected (union–find).
struct Groups(Vec<usize>);

impl Groups {
    fn new(count: usize) -> Self {
        Self((0..count).collect())
    }

    fn leader(&mut self, mut ring: usize) -> usize {
        while self.0[ring] != ring {
            self.0[ring] = self.0[self.0[ring]];
            ring = self.0[ring];
        }
        ring
    }

    fn are_apart(&mut self, rings: [usize; 2]) -> bool {
        let [a, b] = rings.map(|ring| self.leader(ring));
        a != b
    }

    fn join(&mut self, rings: [usize; 2]) {
        let [a, b] = rings.map(|ring| self.leader(ring));
        self.0[a] = b;
    }
}

/// All points of all rings, numbered consecutively.
struct Points {
    at: Vec<DVec2>,
    ring: Vec<usize>,
    /// First point of each ring, and one past the last.
    start: Vec<usize>,
    way: Vec<DVec2>,
}

impl Points {
    fn of(rings: &[Ring]) -> Self {
        let mut points = Self { at: Vec::new(), ring: Vec::new(), start: vec![0], way: Vec::new() };
        for (number, Ring { points: own, .. }) in rings.iter().enumerate() {
            let n = own.len();
            let way = |i: usize| (own[(i + 1) % n] - own[(i + n - 1) % n]).normalize_or_zero();
            points.at.extend(own);
            points.ring.extend(std::iter::repeat_n(number, n));
            points.way.extend((0..n).map(way));
            points.start.push(points.at.len());
        }
        points
    }

    fn count(&self, ring: usize) -> usize {
        self.start[ring + 1] - self.start[ring]
    }

    /// The point `by` places further along its ring.
    fn further(&self, point: usize, by: isize) -> usize {
        let ring = self.ring[point];
        let (start, count) = (self.start[ring], self.count(ring) as isize);
        start + (point as isize - start as isize + by).rem_euclid(count) as usize
    }

    /// Marks the points of a flip, and half as many before and after it, so that no other flip uses them.
    fn take(&self, flip: &Flip, taken: &mut [bool]) {
        for stretch in &flip.stretches {
            let pad = stretch.len() as isize / 2;
            for &point in stretch {
                (-pad..=pad).for_each(|k| taken[self.further(point, k)] = true);
            }
        }
    }

    /// The closed lines that remain once the flips are made.
    fn joined(&self, flips: &[&Flip]) -> Vec<Vec<DVec2>> {
        let around = |i: usize| [Some(self.further(i, -1)), Some(self.further(i, 1))];
        let mut beside: Vec<[Option<usize>; 2]> = (0..self.at.len()).map(around).collect();
        for flip in flips {
            for pair in flip.stretches.iter().flat_map(|stretch| stretch.windows(2)) {
                replace(&mut beside, pair[0], Some(pair[1]), None);
                replace(&mut beside, pair[1], Some(pair[0]), None);
            }
            let [a, b] = &flip.stretches;
            for (&p, &q) in a.first().zip(b.first()).into_iter().chain(a.last().zip(b.last())) {
                replace(&mut beside, p, None, Some(q));
                replace(&mut beside, q, None, Some(p));
            }
        }
        let mut seen = vec![false; self.at.len()];
        let mut loops = Vec::new();
        for first in 0..self.at.len() {
            let mut line = Vec::new();
            let mut here = (beside[first] != [None, None]).then_some(first);
            while let Some(i) = here.filter(|&i| !std::mem::replace(&mut seen[i], true)) {
                line.push(self.at[i]);
                here = beside[i].into_iter().flatten().find(|&next| !seen[next]);
            }
            if line.len() >= 3 {
                loops.push(line);
            }
        }
        loops
    }
}

fn replace(beside: &mut [[Option<usize>; 2]], point: usize, old: Option<usize>, new: Option<usize>) {
    if let Some(slot) = beside[point].iter_mut().find(|slot| **slot == old) {
        *slot = new;
    }
}

/// A flip at every second point of every ring with each neighbour.
fn candidates(points: &Points, squares: &Squares, settings: &LoopSettings) -> Vec<Flip> {
    let reach = FARTHEST * settings.stepover;
    let mut flips = Vec::new();
    let mut nearby: Vec<usize> = Vec::new();
    for (i, &p) in points.at.iter().enumerate().filter(|(i, _)| i.is_multiple_of(2)) {
        nearby.clear();
        nearby.extend(squares.near(p).filter(|&j| points.at[j].distance_squared(p) < reach * reach));
        for j in nearest_of_each_ring(points, i, &nearby) {
            let (middle, gap) = ((p + points.at[j]) / 2.0, p.distance(points.at[j]));
            let own = [points.ring[i], points.ring[j]];
            let between = |&&k: &&usize| {
                !own.contains(&points.ring[k]) && points.at[k].distance_squared(middle) < (BETWEEN * gap).powi(2)
            };
            if nearby.iter().find(between).is_none() {
                flips.extend(flip(points, i, j, settings));
            }
        }
    }
    flips
}

impl Flip {
    /// Whether its links stay inside, and cross no ring.
    fn is_open(&self, points: &Points, room: &Room, squares: &Squares, settings: &LoopSettings) -> bool {
        let [a, b] = &self.stretches;
        let mut links = a.first().zip(b.first()).into_iter().chain(a.last().zip(b.last()));
        links.all(|(&i, &j)| {
            let (p, q) = (points.at[i], points.at[j]);
            let inside = LINK.iter().all(|&t| room.at(p.lerp(q, t)) >= NARROWEST * settings.width_limits.0);
            let crosses = |k: usize| {
                let next = points.further(k, 1);
                ![i, j].contains(&k) && ![i, j].contains(&next) && cross([p, q], [points.at[k], points.at[next]])
            };
            inside && !squares.near(p.midpoint(q)).any(crosses)
        })
    }
}

/// Whether two pieces cross.
fn cross([p, q]: [DVec2; 2], [r, s]: [DVec2; 2]) -> bool {
    let side = |a: DVec2, b: DVec2, c: DVec2| (b - a).perp_dot(c - a) > 0.0;
    side(p, q, r) != side(p, q, s) && side(r, s, p) != side(r, s, q)
}

/// For each ring with a higher number than that of point `i`, the nearest of the nearby points.
fn nearest_of_each_ring(points: &Points, i: usize, nearby: &[usize]) -> Vec<usize> {
    let square = |j: usize| points.at[j].distance_squared(points.at[i]);
    let mut nearest: Vec<usize> = Vec::new();
    for &j in nearby.iter().filter(|&&j| points.ring[j] > points.ring[i]) {
        match nearest.iter_mut().find(|k| points.ring[**k] == points.ring[j]) {
            Some(k) if square(j) < square(*k) => *k = j,
            Some(_) => {}
            None => nearest.push(j),
        }
    }
    nearest
}

fn flip(points: &Points, i: usize, j: usize, settings: &LoopSettings) -> Option<Flip> {
    let (rings, d) = ([points.ring[i], points.ring[j]], settings.stepover);
    let gap = points.at[i].distance(points.at[j]);
    let shorter = rings.map(|ring| points.count(ring)).into_iter().min()? as f64;
    let pieces = settings.flip_length * gap / d * POINTS_PER_STEPOVER;
    let pieces = pieces.min(MOST * shorter).round() as isize;
    if pieces < 3 {
        return None;
    }
    let (way, half) = (if points.way[i].dot(points.way[j]) > 0.0 { 1 } else { -1 }, pieces / 2);
    let stretch =
        |middle: usize, way: isize| (0..=pieces).map(|k| points.further(middle, way * (k - half))).collect::<Vec<_>>();
    let stretches = [stretch(i, 1), stretch(j, way)];
    let gaps = stretches[0].iter().zip(&stretches[1]).map(|(&p, &q)| points.at[p].distance(points.at[q]));
    let gaps: Vec<f64> = gaps.collect();
    let mean = gaps.iter().sum::<f64>() / gaps.len() as f64;
    let spread = (gaps.iter().map(|gap| (gap - mean).powi(2)).sum::<f64>() / gaps.len() as f64).sqrt();
    // How much a ring turns over the section, and over as much before and after it.
    let turn = |middle: usize| {
        let around = (-pieces - half..=pieces + half).map(|k| points.way[points.further(middle, k)]);
        1.0 - around.map(|way| way.dot(points.way[middle])).fold(1.0, f64::min)
    };
    let place = (points.at[i] + points.at[j]) / 2.0;
    let score = 4.0 * spread / d + turn(i) + turn(j) + 0.6 * (mean - d).abs() / d + out_of_turn(place, settings);
    Some(Flip { rings, stretches, place, score })
}

/// The cost of a position that belongs to another layer's turn. The squares' turns alternate along rows and columns.
fn out_of_turn(place: DVec2, settings: &LoopSettings) -> f64 {
    let square = ((place - settings.datum) / (FIELD * settings.stepover)).floor().as_i64vec2();
    let turn = (square.x + 2 * square.y - settings.layer as i64).rem_euclid(TURNS);
    if turn == 0 { 0.0 } else { 0.5 }
}
