//! Straight pieces in a tree of bounding boxes: finds those that may meet without comparing every pair.
//!
//! Consecutive pieces share the smallest boxes, so the tree of an outline is small. The boxes are aligned with the
//! longest piece: scan lines then have flat boxes that meet few others, while boxes along x and y would overlap each
//! other wherever the lines are slanted.

use crate::Bounds;
use glam::DVec2;
use std::ops::Range;

/// A straight piece from one point to another, mm.
pub type Piece = [DVec2; 2];

/// Boxes are enlarged by this fraction of the largest coordinate, so that rounding loses no piece.
const ROUNDING: f64 = 1e-9;
/// Most pieces in one of the smallest boxes.
const MOST: usize = 12;

/// A tree of bounding boxes over pieces.
pub struct Boxes {
    /// Unit vector along which the boxes are aligned.
    axis: DVec2,
    /// The pieces in the frame of `axis`, and the box of each.
    pieces: Vec<Piece>,
    boxes: Vec<Bounds>,
    /// The tree, depth first: each node is followed by everything under its first child, then by its second child.
    /// Empty without pieces.
    nodes: Vec<Node>,
}

#[derive(Debug, Clone, Copy)]
struct Node {
    around: Bounds,
    below: Below,
}

#[derive(Debug, Clone, Copy)]
enum Below {
    /// Two children: the first follows the node, this is the index of the second.
    Halves(u32),
    /// A leaf: the pieces from the first index up to the second, exclusive.
    Pieces(u32, u32),
}

impl Boxes {
    /// Builds the tree; all coordinates must be finite.
    pub fn new(mut pieces: Vec<Piece>) -> Self {
        let axis = longest(&pieces).try_normalize().unwrap_or(DVec2::X);
        pieces.iter_mut().flatten().for_each(|p| *p = turned(axis, *p));
        let greatest = pieces.iter().flatten().fold(DVec2::ONE, |greatest, p| greatest.max(p.abs()));
        let rounding = ROUNDING * greatest.max_element();
        let around = |&[a, b]: &Piece| Bounds { min: a.min(b) - rounding, max: a.max(b) + rounding };
        let boxes: Vec<Bounds> = pieces.iter().map(around).collect();
        let mut leaves = leaves(&pieces, &boxes);
        let mut nodes = Vec::with_capacity(2 * leaves.len());
        grow(&mut nodes, &mut leaves);
        Self { axis, pieces, boxes, nodes }
    }

    /// Visits each pair of pieces whose boxes meet once.
    ///
    /// ```
    /// use planar::{DVec2, boxes::Boxes};
    ///
    /// // Two diagonals of a square, and a piece far from both.
    /// let piece = |x0: f64, y0: f64, x1: f64, y1: f64| [DVec2::new(x0, y0), DVec2::new(x1, y1)];
    /// let pieces = vec![piece(0.0, 0.0, 10.0, 10.0), piece(0.0, 10.0, 10.0, 0.0), piece(50.0, 0.0, 60.0, 0.0)];
    /// let mut pairs = 0;
    /// Boxes::new(pieces).pairs(|_, _| pairs += 1);
    /// assert_eq!(pairs, 1);
    /// ```
    pub fn pairs(&self, mut visit: impl FnMut(usize, usize)) {
        if !self.nodes.is_empty() {
            self.pairs_within(0, &mut visit);
        }
    }

    fn pairs_within(&self, node: usize, visit: &mut impl FnMut(usize, usize)) {
        match self.nodes[node].below {
            Below::Halves(other) => {
                self.pairs_within(node + 1, visit);
                self.pairs_within(other as usize, visit);
                self.pairs_between(node + 1, other as usize, visit);
            }
            Below::Pieces(first, end) => {
                for i in first..end {
                    self.pairs_of(i as usize, i + 1..end, visit);
                }
            }
        }
    }

    fn pairs_between(&self, one: usize, other: usize, visit: &mut impl FnMut(usize, usize)) {
        let (a, b) = (&self.nodes[one], &self.nodes[other]);
        if !a.around.meets(&b.around) {
            return;
        }
        match (a.below, b.below) {
            (Below::Pieces(first, end), Below::Pieces(from, to)) => {
                for i in (first..end).filter(|&i| self.boxes[i as usize].meets(&b.around)) {
                    self.pairs_of(i as usize, from..to, visit);
                }
            }
            // The first child of a node directly follows it.
            (Below::Halves(second), _) => {
                self.pairs_between(one + 1, other, visit);
                self.pairs_between(second as usize, other, visit);
            }
            (_, Below::Halves(second)) => {
                self.pairs_between(one, other + 1, visit);
                self.pairs_between(one, second as usize, visit);
            }
        }
    }

    fn pairs_of(&self, i: usize, others: Range<u32>, visit: &mut impl FnMut(usize, usize)) {
        let own = &self.boxes[i];
        for j in others.start as usize..others.end as usize {
            if self.boxes[j].meets(own) {
                visit(i, j);
            }
        }
    }

    /// Visits the pieces that a ray from the point, backwards along the axis, crosses.
    fn before(&self, point: DVec2, mut visit: impl FnMut(usize)) {
        let p = turned(self.axis, point);
        let crosses = |&number: &usize| {
            let [a, b] = self.pieces[number];
            (a.y > p.y) != (b.y > p.y) && p.x > (b.x - a.x) * (p.y - a.y) / (b.y - a.y) + a.x
        };
        let mut node = 0;
        let mut open = Vec::new();
        while let Some(Node { around, below }) = self.nodes.get(node) {
            let near = around.min.y <= p.y && p.y <= around.max.y && around.min.x <= p.x;
            match *below {
                Below::Halves(other) if near => {
                    open.push(other as usize);
                    node += 1;
                    continue;
                }
                Below::Pieces(first, end) if near => {
                    (first as usize..end as usize).filter(crosses).for_each(&mut visit);
                }
                _ => {}
            }
            let Some(next) = open.pop() else { break };
            node = next;
        }
    }

    /// Whether a point lies inside the rings whose edges are the first `edges` pieces (even-odd rule).
    pub fn inside(&self, point: DVec2, edges: usize) -> bool {
        let mut inside = false;
        self.before(point, |number| inside ^= number < edges);
        inside
    }

    /// How far a piece rises perpendicular to the axis, mm.
    pub(crate) fn rise(&self, [a, b]: Piece) -> f64 {
        self.axis.perp_dot(b - a)
    }

    /// Winding number of the closed rings whose edges are the pieces, just before `point` along the axis; `point` lies
    /// on piece `on`.
    pub(crate) fn winding_before(&self, point: DVec2, on: usize) -> i32 {
        let mut winding = 0;
        self.before(point, |number| {
            let [a, b] = self.pieces[number];
            let around = if b.y > a.y { -1 } else { 1 };
            winding += if number == on { 0 } else { around };
        });
        winding
    }
}

/// The direction of the longest piece.
fn longest(pieces: &[Piece]) -> DVec2 {
    let mut longest = (0.0, DVec2::ZERO);
    for &[a, b] in pieces {
        let square = a.distance_squared(b);
        if square > longest.0 {
            longest = (square, b - a);
        }
    }
    longest.1
}

/// The leaves: each holds a few consecutive pieces.
fn leaves(pieces: &[Piece], boxes: &[Bounds]) -> Vec<Node> {
    let mut leaves = Vec::with_capacity(pieces.len() / MOST + 8);
    let mut first = 0;
    while first < pieces.len() {
        let most = (first + MOST).min(pieces.len());
        let joined = |k: &usize| pieces[*k][0] == pieces[*k - 1][1];
        let end = (first + 1..most).take_while(joined).last().map_or(first + 1, |last| last + 1);
        let around = boxes[first + 1..end].iter().fold(boxes[first], |around, more| around.with(more));
        leaves.push(Node { around, below: Below::Pieces(first as u32, end as u32) });
        first = end;
    }
    leaves
}

/// Adds the tree over some leaves, halved repeatedly along the axis in which their middles are most spread out.
fn grow(nodes: &mut Vec<Node>, leaves: &mut [Node]) {
    let [first, rest @ ..] = leaves else { return };
    if rest.is_empty() {
        nodes.push(*first);
        return;
    }
    let twice = |leaf: &Node| leaf.around.min + leaf.around.max;
    let at = twice(first);
    let (around, middles) = rest.iter().fold((first.around, Bounds { min: at, max: at }), |(around, middles), leaf| {
        let at = twice(leaf);
        (around.with(&leaf.around), middles.with(&Bounds { min: at, max: at }))
    });
    let (half, size) = (leaves.len() / 2, middles.size());
    let place = |leaf: &Node| if size.x > size.y { twice(leaf).x } else { twice(leaf).y };
    leaves.select_nth_unstable_by(half, |a, b| place(a).total_cmp(&place(b)));
    let own = nodes.len();
    nodes.push(Node { around, below: Below::Halves(0) });
    let (one, other) = leaves.split_at_mut(half);
    grow(nodes, one);
    nodes[own].below = Below::Halves(nodes.len() as u32);
    grow(nodes, other);
}

fn turned(axis: DVec2, p: DVec2) -> DVec2 {
    DVec2::new(p.dot(axis), axis.perp_dot(p))
}

#[cfg(test)]
mod tests {
    use super::Boxes;
    use glam::DVec2;
    use std::collections::BTreeSet;

    /// Pieces of every length and direction, from a fixed sequence.
    fn pieces(count: usize) -> Vec<[DVec2; 2]> {
        let mut state = 1_u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as f64 / f64::from(1 << 24)
        };
        let mut piece = || {
            let (at, way) = (DVec2::new(next(), next()) * 100.0, DVec2::new(next(), next()) - 0.5);
            [at, at + way * 60.0 * next().powi(3)]
        };
        (0..count).map(|_| piece()).collect()
    }

    #[test]
    fn every_pair_that_crosses_is_visited_once() {
        let pieces = pieces(400);
        let side = |a: DVec2, b: DVec2, p: DVec2| (b - a).perp_dot(p - a);
        let crosses = |i: usize, j: usize| {
            let ([a, b], [c, d]) = (pieces[i], pieces[j]);
            side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0
        };
        let all = (0..pieces.len()).flat_map(|i| (0..i).map(move |j| (j, i)));
        let crossing: BTreeSet<_> = all.filter(|&(i, j)| crosses(i, j)).collect();
        let (mut visited, mut visits) = (BTreeSet::new(), 0);
        Boxes::new(pieces.clone()).pairs(|i, j| {
            visits += 1;
            visited.insert((i.min(j), i.max(j)));
        });
        assert_eq!(visits, visited.len(), "a pair was visited twice");
        assert!(crossing.len() > 100 && crossing.is_subset(&visited), "{} crossings", crossing.len());
    }

    #[test]
    fn inside_agrees_with_the_polygon() {
        let ring: Vec<DVec2> =
            (0..40).map(|k| DVec2::from_angle(f64::from(k) * 0.157) * f64::from(5 + k % 3 * 4)).collect();
        let polygon = crate::Ring::new(ring);
        let boxes = Boxes::new(polygon.edges().map(|(a, b)| [a, b]).collect());
        let places = pieces(500).into_iter().map(|[p, _]| p * 0.3 - 15.0);
        let (mut inside, mut total) = (0, 0);
        for place in places {
            assert_eq!(boxes.inside(place, 40), polygon.contains(place), "{place}");
            inside += usize::from(polygon.contains(place));
            total += 1;
        }
        assert!(inside > 50 && inside < total);
    }
}
