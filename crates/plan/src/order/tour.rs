//! Stops, gates and tours: a travelling salesman problem in which every town has several gates.

use crate::fill::Path;
use glam::DVec2;
use planar::Bounds;

/// Most vertices of a closed pass considered as its start by the search; in the end its start may move along the whole
/// path.
const MOST_GATES: usize = 48;

/// Where a stop is entered and left.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gate {
    /// Where the pass begins, mm.
    pub enter: DVec2,
    /// Where it ends, mm.
    pub leave: DVec2,
}

impl Gate {
    fn at(point: DVec2) -> Self {
        Self { enter: point, leave: point }
    }

    /// Entry and exit swapped.
    pub fn flipped(self) -> Self {
        Self { enter: self.leave, leave: self.enter }
    }
}

/// A pass as seen by the ordering.
#[derive(Debug, Clone, PartialEq)]
pub enum Stop {
    /// Entered and left at the same point.
    Ring {
        /// Vertices at which it may begin, mm.
        gates: Vec<DVec2>,
        /// The closed path along which its start may move, mm; empty where only the gates are possible.
        path: Vec<DVec2>,
    },
    /// Entered at one end and left at the other.
    Line {
        /// Entry and exit in its own direction.
        gate: Gate,
        /// Whether it may be laid from its end to its start.
        reversible: bool,
    },
}

/// A stop on a tour.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Visit {
    /// Index of the stop.
    pub stop: usize,
    /// Where it is entered, mm.
    pub enter: DVec2,
    /// Where it is left, mm.
    pub leave: DVec2,
}

impl Visit {
    /// A visit to a stop by one of its gates.
    pub fn new(stop: usize, gate: Gate) -> Self {
        Self { stop, enter: gate.enter, leave: gate.leave }
    }

    /// The same stop, traversed in reverse.
    pub fn flipped(self) -> Self {
        Self { stop: self.stop, enter: self.leave, leave: self.enter }
    }
}

/// Where a tour begins and ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Ends {
    /// It returns to its first stop.
    Closed,
    /// It begins at a point, mm, and ends anywhere.
    From(DVec2),
}

impl Stop {
    /// A pass as a stop.
    pub fn of(pass: &Path) -> Self {
        let first = pass.points.first().copied().unwrap_or_default();
        if pass.closed {
            return Self::ring(pass.points.clone());
        }
        let gate = Gate { enter: first, leave: pass.points.last().copied().unwrap_or(first) };
        Self::Line { gate, reversible: pass.reversible }
    }

    /// A closed path that may begin anywhere.
    pub fn ring(path: Vec<DVec2>) -> Self {
        Self::Ring { gates: thinned(&path), path }
    }

    /// A stop entered and left at any one of some points.
    pub fn anywhere(points: impl IntoIterator<Item = DVec2>) -> Self {
        Self::Ring { gates: thinned(&points.into_iter().collect::<Vec<_>>()), path: Vec::new() }
    }

    /// The gates from which a search may choose.
    pub fn gates(&self) -> impl Iterator<Item = Gate> + '_ {
        let (points, ways): (&[DVec2], [Option<Gate>; 2]) = match self {
            Self::Ring { gates, .. } => (gates, [None, None]),
            Self::Line { gate, reversible } => (&[], [Some(*gate), reversible.then_some(gate.flipped())]),
        };
        points.iter().map(|&p| Gate::at(p)).chain(ways.into_iter().flatten())
    }

    /// Whether it may be traversed in reverse.
    pub fn reversible(&self) -> bool {
        matches!(self, Self::Ring { .. } | Self::Line { reversible: true, .. })
    }

    /// The gate with the shortest path from `from` through the stop to `to`.
    pub fn best_gate(&self, from: Option<DVec2>, to: Option<DVec2>) -> Gate {
        let way = |gate: &Gate| gap(from, Some(gate.enter)) + gap(Some(gate.leave), to);
        self.gates().min_by(|a, b| way(a).total_cmp(&way(b))).unwrap_or(Gate::at(DVec2::ZERO))
    }

    /// [`best_gate`](Self::best_gate), but with the start of a closed path anywhere on it.
    pub fn best_start(&self, from: Option<DVec2>, to: Option<DVec2>) -> Gate {
        let vertex = self.best_gate(from, to);
        let Self::Ring { path, .. } = self else { return vertex };
        let way = |p: DVec2| gap(from, Some(p)) + gap(Some(p), to);
        let on_edge = |(&a, &b): (&DVec2, &DVec2)| turning_point(a, b, from.or(to)?, to.or(from)?).into();
        let edges = path.iter().zip(path.iter().cycle().skip(1));
        let starts = edges.filter_map(on_edge);
        let best = starts.min_by(|a: &DVec2, b: &DVec2| way(*a).total_cmp(&way(*b)));
        // A vertex wins unless the middle of an edge is truly better.
        best.filter(|&p| way(p) < way(vertex.enter) - 1e-6).map_or(vertex, Gate::at)
    }
}

/// A circle around the gates of a stop, and around everything between them.
pub(super) struct Circle {
    middle: DVec2,
    radius: f64,
}

impl Circle {
    pub(super) fn around(stop: &Stop) -> Self {
        let path: &[DVec2] = if let Stop::Ring { path, .. } = stop { path } else { &[] };
        let places = || stop.gates().flat_map(|gate| [gate.enter, gate.leave]).chain(path.iter().copied());
        let middle = Bounds::of(places()).map(|bounds| bounds.center()).unwrap_or_default();
        // Enlarged to allow for rounding.
        let radius = places().map(|p| p.distance(middle)).fold(0.0, f64::max) + 1e-9 * (1.0 + middle.length());
        Self { middle, radius }
    }

    /// Lower bound of the distance of any gate from a point, mm.
    pub(super) fn least_gap(&self, from: Option<DVec2>) -> f64 {
        (gap(from, Some(self.middle)) - self.radius).max(0.0)
    }

    /// Lower bound of the distance between any gates of two stops, mm.
    pub(super) fn least_distance(&self, other: &Self) -> f64 {
        (self.middle.distance(other.middle) - self.radius - other.radius).max(0.0)
    }

    /// Lower bound of the length of a path through any gate, mm.
    pub(super) fn least_way(&self, from: Option<DVec2>, to: Option<DVec2>) -> f64 {
        self.least_gap(from) + self.least_gap(to)
    }
}

/// At most [`MOST_GATES`] of the vertices of a path.
fn thinned(path: &[DVec2]) -> Vec<DVec2> {
    if path.len() <= MOST_GATES {
        return path.to_vec();
    }
    let count = path.len() as f64;
    (0..MOST_GATES).map(|k| path[(k as f64 * count / MOST_GATES as f64) as usize]).collect()
}

/// Distance between two points, mm; 0 if either is free.
#[inline]
pub fn gap(from: Option<DVec2>, to: Option<DVec2>) -> f64 {
    match (from, to) {
        (Some(a), Some(b)) => a.distance(b),
        _ => 0.0,
    }
}

/// Nearest point of a straight edge.
pub fn nearest_on(a: DVec2, b: DVec2, point: DVec2) -> DVec2 {
    let way = b - a;
    let t = (point - a).dot(way) / way.length_squared().max(f64::MIN_POSITIVE);
    a.lerp(b, t.clamp(0.0, 1.0))
}

/// The point of the edge from `a` to `b` through which the path from `from` to `to` is shortest (as light reflected by
/// a mirror).
fn turning_point(a: DVec2, b: DVec2, from: DVec2, to: DVec2) -> DVec2 {
    let length = a.distance(b);
    if length == 0.0 {
        return a;
    }
    let along = (b - a) / length;
    let place = |p: DVec2| ((p - a).dot(along), along.perp_dot(p - a).abs());
    let ((x, height), (other_x, other_height)) = (place(from), place(to));
    let heights = height + other_height;
    let t = if heights > 0.0 { x + (other_x - x) * height / heights } else { x };
    a + along * t.clamp(0.0, length)
}

/// Total length of the travels of a tour, mm.
pub fn length(tour: &[Visit], ends: Ends) -> f64 {
    let between: f64 = tour.windows(2).map(|w| w[0].leave.distance(w[1].enter)).sum();
    let (Some(first), Some(last)) = (tour.first(), tour.last()) else { return 0.0 };
    match ends {
        Ends::Closed => between + last.leave.distance(first.enter),
        Ends::From(start) => between + start.distance(first.enter),
    }
}

/// Where the visit before the one at `index` leaves, and where the one after it enters.
pub fn neighbours(tour: &[Visit], index: usize, ends: Ends) -> (Option<DVec2>, Option<DVec2>) {
    let alone = tour.len() < 2;
    let (first, last) = (tour.first().map(|v| v.enter), tour.last().map(|v| v.leave));
    let before = match (index.checked_sub(1), ends) {
        (Some(i), _) => Some(tour[i].leave),
        (None, Ends::From(start)) => Some(start),
        (None, Ends::Closed) => last.filter(|_| !alone),
    };
    let after = match (tour.get(index + 1), ends) {
        (Some(next), _) => Some(next.enter),
        (None, Ends::Closed) => first.filter(|_| !alone),
        (None, Ends::From(_)) => None,
    };
    (before, after)
}

/// Whether a closed path is a curve: many vertices, none of them a corner.
pub fn is_curved(path: &[DVec2]) -> bool {
    const COS_25: f64 = 0.9063;
    const LEAST_VERTICES: usize = 16;
    let n = path.len();
    let way = |i: usize| (path[(i + 1) % n] - path[i]).normalize_or_zero();
    n >= LEAST_VERTICES && (0..n).all(|i| way(i).dot(way((i + 1) % n)) > COS_25)
}

/// Centroid of the vertices' path, mm.
pub fn centroid(path: &[DVec2]) -> DVec2 {
    let around = path.iter().zip(path.iter().cycle().skip(1));
    let (sum, total) = around.fold((DVec2::ZERO, 0.0), |(sum, total), (a, b)| {
        let weight = a.distance(*b);
        (sum + (*a + *b) / 2.0 * weight, total + weight)
    });
    if total > 0.0 { sum / total } else { path.first().copied().unwrap_or_default() }
}
