//! The number of ends of scan lines as a function of their angle.
//!
//! Every crossing of a scan line with a ring is an end at which a path turns. Their number U(α) (Han et al. 2018, eqs
//! 6–8) changes only where a line passes a vertex that is a local extreme across the lines, or where there is room for
//! one more line. These angles have closed forms, so the number is known exactly for all angles: there is no sweep in
//! small steps that could miss the best one. At any angle a ring has few extremes, so there are few such angles.

use crate::Region;
use crate::scan::{Spacing, count_and_length};
use glam::DVec2;
use std::f64::consts::PI;

/// The number of ends as a step function of the angle, from 0 to π.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Turns {
    /// The angle from which each number holds, and the number; ascending, the first at 0.
    steps: Vec<(f64, i64)>,
    /// Directions of edges, radians in 0..π, and their length, mm: the longest first.
    edges: Vec<(f64, f64)>,
}

/// At most this many edge directions are kept.
const MOST_EDGES: usize = 24;

/// Directions closer than this count as one, radians.
const SAME_ANGLE: f64 = 1e-6;

impl Turns {
    /// Counts the ends of scan lines through a region, for every angle.
    pub fn new(region: &Region, spacing: Spacing) -> Self {
        let corners: Vec<Corner> = region.rings().flat_map(|ring| Corner::all(ring.points())).collect();
        if corners.is_empty() {
            return Self::default();
        }
        let edges = edge_directions(&corners);
        let hull = Hull::new(&corners);
        let mut steps = Vec::new();
        for piece in pieces(&hull, spacing) {
            let mut events: Vec<(f64, i64)> = Vec::new();
            for stretch in hull.stretches(piece.from, piece.to) {
                corners.iter().for_each(|c| c.events(&stretch, &piece, spacing, &mut events));
            }
            events.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
            // Counted once, far from all events; from there the changes are added up.
            let (place, known) = widest_gap(&piece, &events);
            let before: i64 = events[..known].iter().map(|e| e.1).sum();
            let mut count = ends_at(region, place, spacing) - before;
            steps.push((piece.from, count));
            for (angle, change) in events {
                count += change;
                steps.push((angle, count));
            }
        }
        Self { steps, edges }
    }

    /// The number of ends at an angle, radians.
    pub fn at(&self, angle: f64) -> i64 {
        let after = self.steps.partition_point(|s| s.0 <= angle.rem_euclid(PI));
        after.checked_sub(1).map_or(0, |i| self.steps[i].1)
    }

    /// The angle (radians) from which each number holds, and the number; ascending.
    pub fn steps(&self) -> &[(f64, i64)] {
        &self.steps
    }

    /// Directions of the longest edges, radians, and their lengths, mm.
    pub fn edges(&self) -> &[(f64, f64)] {
        &self.edges
    }

    /// The same function for lines turned by `angle` (radians): what was at `angle` is then at 0.
    pub fn turned(&self, angle: f64) -> Self {
        let turn = |a: f64| (a - angle).rem_euclid(PI);
        let mut steps: Vec<(f64, i64)> = self.steps.iter().map(|s| (turn(s.0), s.1)).collect();
        steps.sort_by(|a, b| a.0.total_cmp(&b.0));
        if steps.first().is_some_and(|s| s.0 > 0.0) {
            steps.insert(0, (0.0, self.at(angle)));
        }
        Self { steps, edges: self.edges.iter().map(|e| (turn(e.0), e.1)).collect() }
    }

    /// The sum of two such functions.
    pub fn plus(&self, other: &Self) -> Self {
        if self.steps.is_empty() {
            return other.clone();
        }
        let mut angles: Vec<f64> = self.steps.iter().chain(&other.steps).map(|s| s.0).collect();
        angles.sort_unstable_by(f64::total_cmp);
        angles.dedup();
        let steps = angles.into_iter().map(|a| (a, self.at(a) + other.at(a))).collect();
        Self { steps, edges: merged(self.edges.iter().chain(&other.edges).copied().collect()) }
    }

    /// The middle of the widest range of angles with the least number of ends, radians, and that number; `None` without
    /// any lines.
    ///
    /// ```
    /// use planar::scan::Spacing;
    /// use planar::{DVec2, Polygon, Region, Ring, turns::Turns};
    /// use std::f64::consts::PI;
    ///
    /// // Lines along the long side of a plate are the fewest.
    /// let corners = [(0.0, 0.0), (40.0, 0.0), (40.0, 10.0), (0.0, 10.0)].map(DVec2::from);
    /// let plate = Region::from(Polygon::simple(Ring::new(corners.to_vec())));
    /// let (angle, _) = Turns::new(&plate, Spacing::AtMost(1.0)).least().ok_or("no lines")?;
    /// assert!(angle.min(PI - angle) < 0.05);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn least(&self) -> Option<(f64, i64)> {
        let least = self.steps.iter().map(|s| s.1).min()?;
        let ends = self.steps.iter().skip(1).map(|s| s.0).chain([PI]);
        let stretches = self.steps.iter().zip(ends).filter(|(s, _)| s.1 == least);
        let widest = stretches.max_by(|a, b| (a.1 - a.0.0).total_cmp(&(b.1 - b.0.0)))?;
        Some(((widest.0.0 + widest.1) / 2.0, least))
    }
}

/// An angle within the widest interval without events, and how many events come before it.
fn widest_gap(piece: &Piece, events: &[(f64, i64)]) -> (f64, usize) {
    let starts = [piece.from].into_iter().chain(events.iter().map(|e| e.0));
    let ends = events.iter().map(|e| e.0).chain([piece.to]);
    let gaps = starts.zip(ends).enumerate();
    let widest = gaps.max_by(|(_, a), (_, b)| (a.1 - a.0).total_cmp(&(b.1 - b.0)));
    // Not its middle: if the part is symmetric, two vertices may lie on one line there.
    widest.map_or((piece.from, 0), |(known, (from, to))| (from + 0.382 * (to - from), known))
}

/// The number of ends of scan lines through a region at one angle, radians.
pub fn ends_at(region: &Region, angle: f64, spacing: Spacing) -> i64 {
    2 * count_and_length(region, angle, spacing).0 as i64
}

/// A vertex that is an extreme across the lines for angles from `from` to `from + turn`, radians.
struct Corner {
    at: DVec2,
    next: DVec2,
    from: f64,
    turn: f64,
    /// Whether it is the lowest point there, before angles are taken modulo π.
    lowest: bool,
}

impl Corner {
    fn all(ring: &[DVec2]) -> impl Iterator<Item = Self> + '_ {
        let n = ring.len();
        (0..n).map(move |i| {
            let (before, at, next) = (ring[(i + n - 1) % n], ring[i], ring[(i + 1) % n]);
            let (into, out) = (at - before, next - at);
            let turn = into.angle_to(out);
            let from = if turn > 0.0 { into.to_angle() } else { into.to_angle() + turn };
            Self { at, next, from, turn: turn.abs(), lowest: turn > 0.0 }
        })
    }

    /// The intervals within `from..to` in which the vertex is an extreme, and whether it is then the lowest.
    fn extremes(&self, from: f64, to: f64) -> impl Iterator<Item = (f64, f64, bool)> + '_ {
        let first = self.from.rem_euclid(PI);
        let odd = ((self.from - first) / PI).round().rem_euclid(2.0) == 1.0;
        [(first, odd), (first - PI, !odd)].into_iter().filter_map(move |(begin, odd)| {
            let (a, b) = (begin.max(from), (begin + self.turn).min(to));
            (a < b).then_some((a, b, self.lowest != odd))
        })
    }

    /// Adds the angles at which lines pass the vertex while it is an extreme, and the change in the number of ends.
    fn events(&self, stretch: &Stretch, piece: &Piece, spacing: Spacing, events: &mut Vec<(f64, i64)>) {
        let (own, across) = (self.at - stretch.low, stretch.high - stretch.low);
        for (from, to, lowest) in self.extremes(stretch.from, stretch.to) {
            let up = if lowest { -2 } else { 2 };
            match spacing {
                // Lines divide the extent: the position of a vertex among them is a monotone function of the angle.
                Spacing::AtMost(_) => {
                    let gaps = piece.gaps as f64;
                    let place = |angle: f64| {
                        let normal = normal(angle);
                        gaps * own.dot(normal) / across.dot(normal)
                    };
                    let (first, last) = (place(from), place(to));
                    let (low, high) = (first.min(last), first.max(last));
                    if !(low.is_finite() && high.is_finite()) {
                        continue;
                    }
                    let change = if last > first { up } else { -up };
                    for line in (low.ceil() as i64).max(1)..=(high.floor() as i64).min(piece.gaps - 1) {
                        let level = own - across * (line as f64 / gaps);
                        events.push((near(level.to_angle(), (from + to) / 2.0).clamp(from, to), change));
                    }
                }
                Spacing::Exact(distance) => {
                    let (reach, direction) = (own.length(), own.to_angle());
                    for line in 1..=(reach / distance) as i64 {
                        let lean = (line as f64 * distance / reach).min(1.0).asin();
                        // Rising before the normal points along `own`, falling after it.
                        for (angle, change) in [(direction - PI + lean, up), (direction - lean, -up)] {
                            let turns = (angle / PI).floor() * PI;
                            let (angle, flipped) = (angle - turns, (turns / PI).rem_euclid(2.0) >= 0.5);
                            if !flipped && (from..to).contains(&angle) {
                                events.push((angle, change));
                            }
                        }
                    }
                }
            }
        }
    }
}

/// The angle, plus or minus half turns, that is nearest to another.
fn near(angle: f64, other: f64) -> f64 {
    angle + ((other - angle) / PI).round() * PI
}

fn normal(angle: f64) -> DVec2 {
    DVec2::from_angle(angle).perp()
}

fn edge_directions(corners: &[Corner]) -> Vec<(f64, f64)> {
    let direction = |c: &Corner| ((c.next - c.at).to_angle().rem_euclid(PI), c.at.distance(c.next));
    merged(corners.iter().map(direction).collect())
}

/// Equal directions merged, the longest first.
fn merged(mut edges: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    edges.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    let mut kept: Vec<(f64, f64)> = Vec::new();
    for (angle, length) in edges {
        // Directions just below π are those just above 0.
        let angle = if PI - angle < SAME_ANGLE { 0.0 } else { angle };
        match kept.last_mut().filter(|k| angle - k.0 < SAME_ANGLE) {
            Some(same) if angle >= same.0 => same.1 += length,
            _ => kept.push((angle, length)),
        }
    }
    kept.sort_by(|a, b| b.1.total_cmp(&a.1));
    kept.truncate(MOST_EDGES);
    kept
}

/// The convex hull, which bounds the lines.
struct Hull {
    points: Vec<DVec2>,
    /// Angles at which the lowest or the highest vertex changes; ascending, from 0 to π.
    changes: Vec<f64>,
}

/// Angles between which the lowest and the highest vertex stay the same.
struct Stretch {
    from: f64,
    to: f64,
    low: DVec2,
    high: DVec2,
}

impl Hull {
    fn new(corners: &[Corner]) -> Self {
        let points = crate::hull::convex_hull(&corners.iter().map(|c| c.at).collect::<Vec<_>>());
        let around = points.iter().zip(points.iter().cycle().skip(1));
        let mut changes: Vec<f64> = around.map(|(a, b)| (*b - *a).to_angle().rem_euclid(PI)).collect();
        changes.extend([0.0, PI]);
        changes.sort_unstable_by(f64::total_cmp);
        changes.dedup();
        Self { points, changes }
    }

    /// Lowest and highest vertex across lines of that angle.
    fn extremes(&self, angle: f64) -> (DVec2, DVec2) {
        let across = normal(angle);
        let height = |p: &DVec2| p.dot(across);
        let low = self.points.iter().copied().min_by(|a, b| height(a).total_cmp(&height(b))).unwrap_or_default();
        let high = self.points.iter().copied().max_by(|a, b| height(a).total_cmp(&height(b))).unwrap_or_default();
        (low, high)
    }

    fn stretches(&self, from: f64, to: f64) -> impl Iterator<Item = Stretch> + '_ {
        let pairs = self.changes.windows(2).map(move |w| (w[0].max(from), w[1].min(to)));
        pairs.filter(|(a, b)| a < b).map(|(a, b)| {
            let (low, high) = self.extremes((a + b) / 2.0);
            Stretch { from: a, to: b, low, high }
        })
    }
}

/// Angles between which the number of gaps between the lines stays the same.
struct Piece {
    from: f64,
    to: f64,
    gaps: i64,
}

fn pieces(hull: &Hull, spacing: Spacing) -> Vec<Piece> {
    let Spacing::AtMost(distance) = spacing else { return vec![Piece { from: 0.0, to: PI, gaps: 0 }] };
    let mut cuts = vec![0.0, PI];
    for stretch in hull.stretches(0.0, PI) {
        // The extent is |across| · sin(direction − angle): at most one rise and one fall in a stretch.
        let across = stretch.high - stretch.low;
        let (reach, direction) = (across.length(), across.to_angle());
        let extent = |angle: f64| across.dot(normal(angle));
        let (a, b) = (extent(stretch.from), extent(stretch.to));
        let top = direction - PI / 2.0;
        let highest = if (stretch.from..stretch.to).contains(&near(top, stretch.to)) { reach } else { a.max(b) };
        let levels = (a.min(b) / distance) as i64..=(highest / distance) as i64 + 1;
        let levels = levels.map(|k| k as f64 * distance).filter(|level| *level <= reach);
        for level in levels.chain([(distance / 2.0).min(reach)]) {
            let lean = (level / reach).min(1.0).asin();
            let angles = [direction - lean, direction - PI + lean].map(|a| a.rem_euclid(PI));
            cuts.extend(angles.into_iter().filter(|a| (stretch.from..stretch.to).contains(a)));
        }
    }
    cuts.sort_unstable_by(f64::total_cmp);
    cuts.dedup();
    let gaps = |angle: f64| {
        let (low, high) = hull.extremes(angle);
        let extent = (high - low).dot(normal(angle));
        if extent < distance / 2.0 { 0 } else { (extent / distance - 1e-9).ceil().max(1.0) as i64 }
    };
    cuts.windows(2).map(|w| Piece { from: w[0], to: w[1], gaps: gaps((w[0] + w[1]) / 2.0) }).collect()
}
