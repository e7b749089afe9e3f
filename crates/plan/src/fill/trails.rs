//! The fewest paths that lay every edge of a plane graph once and never cross (Li et al., 2.2).
//!
//! 1. At every node the edge ends are paired without crossings, so that the paths turn as little as possible; at a
//!    node with an odd number of ends, one stays free and a path ends there. (Least sum of squared turns over all
//!    non-crossing pairings, by dynamic programming over the cyclic order.)
//! 2. This always leaves odd/2 open paths (odd: number of such nodes), and any number of closed ones. A closed path
//!    is merged into another path that it meets at a node: two pairs that bound one region of the node's disc, (a, b)
//!    and (c, d) in cyclic order, become (b, c) and (d, a); with a free end f, (a, b) becomes (b, f) and a is then
//!    free. Neither change makes a crossing. The cheapest merge goes first, until none is left: max(1, odd/2) paths for
//!    each connected graph.
//!
//! Where two paths meet, a region bounded by a pair of each always exists, since neighbouring regions of the disc share
//! a pair.

use std::f64::consts::{PI, TAU};

/// One end of an edge, seen from its node: twice the edge's number, plus one at the edge's far end.
pub type Dart = usize;

/// The other end of the same edge.
pub fn other_end(dart: Dart) -> Dart {
    dart ^ 1
}

/// A plane graph as seen from its nodes.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Network {
    /// For every node its darts counter-clockwise, each with the angle (rad) at which it leaves.
    pub stars: Vec<Vec<(Dart, f64)>>,
    /// For every edge, its wall: a merge never turns from one edge of a wall to another edge of the same wall.
    pub walls: Vec<usize>,
}

/// A path along edges.
#[derive(Debug, Clone, PartialEq)]
pub struct Trail {
    /// Each edge by the dart at which the path enters it.
    pub darts: Vec<Dart>,
    /// Whether it ends where it began.
    pub closed: bool,
}

/// Covers every edge once with as few trails as possible.
pub fn trails(network: &Network) -> Vec<Trail> {
    let mut weave = Weave::new(network);
    while let Some(merge) = weave.best_merge() {
        weave.apply(merge);
    }
    weave.trails
}

/// Pairs two darts, and either pairs two others or leaves one free.
#[derive(Debug, Clone, Copy)]
struct Merge {
    joined: (Dart, Dart),
    rest: (Dart, Option<Dart>),
}

struct Weave<'a> {
    network: &'a Network,
    /// Angle of each dart, rad.
    angles: Vec<f64>,
    partner: Vec<Option<Dart>>,
    trails: Vec<Trail>,
    /// The trail of each edge.
    trail_of: Vec<usize>,
}

impl<'a> Weave<'a> {
    fn new(network: &'a Network) -> Self {
        let mut angles = vec![0.0; 2 * network.walls.len()];
        network.stars.iter().flatten().for_each(|&(dart, angle)| angles[dart] = angle);
        let partner = vec![None; angles.len()];
        let mut weave = Self { network, angles, partner, trails: Vec::new(), trail_of: vec![0; network.walls.len()] };
        for star in &network.stars {
            for (a, b) in pairing(star) {
                weave.pair(a, Some(b));
            }
        }
        weave.trace();
        weave
    }

    fn pair(&mut self, a: Dart, b: Option<Dart>) {
        self.partner[a] = b;
        if let Some(b) = b {
            self.partner[b] = Some(a);
        }
    }

    /// Follows the partners: open trails first, from free end to free end.
    fn trace(&mut self) {
        self.trails.clear();
        let mut seen = vec![false; self.trail_of.len()];
        let free = (0..self.partner.len()).filter(|&dart| self.partner[dart].is_none());
        for first in free.chain(0..self.partner.len()) {
            if seen[first / 2] {
                continue;
            }
            let mut darts = Vec::new();
            let mut next = Some(first);
            while let Some(dart) = next.filter(|dart| !seen[dart / 2]) {
                seen[dart / 2] = true;
                self.trail_of[dart / 2] = self.trails.len();
                darts.push(dart);
                next = self.partner[other_end(dart)];
            }
            self.trails.push(Trail { darts, closed: next.is_some() });
        }
    }

    /// The merge that adds the least to the sum of squared turns.
    fn best_merge(&self) -> Option<Merge> {
        let mut best: Option<(f64, Merge)> = None;
        for star in &self.network.stars {
            for region in self.regions(star) {
                for (cost, merge) in self.merges(&region) {
                    if best.is_none_or(|(least, _)| cost < least - 1e-9) {
                        best = Some((cost, merge));
                    }
                }
            }
        }
        best.map(|(_, merge)| merge)
    }

    /// The regions of a node's disc, each as the pairs met on a walk around it; a free end is paired with itself.
    fn regions(&self, star: &[(Dart, f64)]) -> Vec<Vec<(Dart, Dart)>> {
        let place = |dart: Dart| star.iter().position(|&(d, _)| d == dart);
        let mut regions = Vec::new();
        let mut seen = vec![false; star.len()];
        for first in 0..star.len() {
            let mut region = Vec::new();
            let mut here = first;
            while !std::mem::replace(&mut seen[here], true) {
                let dart = star[(here + 1) % star.len()].0;
                let across = self.partner[dart].unwrap_or(dart);
                region.push((dart, across));
                let Some(next) = place(across) else { break };
                here = next;
            }
            regions.push(region);
        }
        regions
    }

    /// The merges of a closed trail with another one in a region, each with its cost.
    fn merges(&self, region: &[(Dart, Dart)]) -> Vec<(f64, Merge)> {
        let mut merges = Vec::new();
        for (i, &(a, b)) in region.iter().enumerate() {
            for &(c, d) in &region[i + 1..] {
                let (one, other) = (self.trail_of[a / 2], self.trail_of[c / 2]);
                if one == other || !(self.trails[one].closed || self.trails[other].closed) {
                    continue;
                }
                // Their order around the region is a, b, c, d.
                let candidates = match (a == b, c == d) {
                    (false, false) => vec![Merge { joined: (b, c), rest: (d, Some(a)) }],
                    (true, false) => free_merges(a, (c, d)).to_vec(),
                    (false, true) => free_merges(c, (a, b)).to_vec(),
                    (true, true) => Vec::new(),
                };
                let before = self.cost(a, b) + self.cost(c, d);
                let allowed = candidates.into_iter().filter(|m| self.is_allowed(m));
                merges.extend(allowed.map(|m| {
                    let rest = m.rest.1.map_or(0.0, |dart| self.cost(m.rest.0, dart));
                    (self.cost(m.joined.0, m.joined.1) + rest - before, m)
                }));
            }
        }
        merges
    }

    fn is_allowed(&self, merge: &Merge) -> bool {
        let wall = |dart: Dart| self.network.walls[dart / 2];
        let turns_back = |a: Dart, b: Dart| a / 2 != b / 2 && wall(a) == wall(b);
        !turns_back(merge.joined.0, merge.joined.1) && !merge.rest.1.is_some_and(|b| turns_back(merge.rest.0, b))
    }

    fn cost(&self, a: Dart, b: Dart) -> f64 {
        if a == b { 0.0 } else { turn(self.angles[a], self.angles[b]).powi(2) }
    }

    fn apply(&mut self, merge: Merge) {
        self.pair(merge.joined.0, Some(merge.joined.1));
        self.pair(merge.rest.0, merge.rest.1);
        self.trace();
    }
}

/// A free end joined to either end of a pair; the other end then becomes free.
fn free_merges(free: Dart, (a, b): (Dart, Dart)) -> [Merge; 2] {
    [Merge { joined: (b, free), rest: (a, None) }, Merge { joined: (a, free), rest: (b, None) }]
}

/// The turn of a path that comes in along one dart and leaves along another, rad: 0 is straight on, π straight back.
pub fn turn(a: f64, b: f64) -> f64 {
    let between = (a - b).rem_euclid(TAU);
    PI - between.min(TAU - between)
}

/// The non-crossing pairing with the least sum of squared turns; if the number of darts is odd, one is left free.
fn pairing(star: &[(Dart, f64)]) -> Vec<(Dart, Dart)> {
    let count = star.len();
    // For the `length` darts from `start` on: the least cost, and the partner of the first.
    let mut best = vec![vec![(0.0, None); count + 1]; count + 1];
    for length in 1..=count {
        for start in 0..=count - length {
            let end = start + length;
            // If the first stays free, the others must be even in number.
            let mut found = if length % 2 == 1 { (best[start + 1][length - 1].0, None) } else { (f64::INFINITY, None) };
            for with in start + 1..end {
                let (inside, after) = (with - start - 1, end - with - 1);
                if inside % 2 + after % 2 > length % 2 {
                    continue;
                }
                let here = turn(star[start].1, star[with].1).powi(2);
                let cost = here + best[start + 1][inside].0 + best[with + 1][after].0;
                if cost < found.0 - 1e-9 {
                    found = (cost, Some(with));
                }
            }
            best[start][length] = found;
        }
    }
    let mut pairs = Vec::with_capacity(count / 2);
    let mut open = vec![(0, count)];
    while let Some((start, length)) = open.pop().filter(|_| count > 0) {
        match best[start][length].1 {
            Some(with) => {
                pairs.push((star[start].0, star[with].0));
                open.push((start + 1, with - start - 1));
                open.push((with + 1, start + length - with - 1));
            }
            None if length > 1 => open.push((start + 1, length - 1)),
            None => {}
        }
    }
    pairs
}
