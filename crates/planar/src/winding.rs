//! Resolves crossing rings by their winding number, without a sweep over the whole plane.
//!
//! At every crossing the two rings swap their continuations: in on one, out on the other. What remains are closed
//! curves that nowhere cross, along each side of which the winding number is constant. Those with the wanted number on
//! their left and one less on their right bound the result. Rings that touch without crossing are left to the boolean.

use crate::boxes::{Boxes, Piece};
use crate::grid::{GridPoint, from_grid, to_grid};
use crate::{Bounds, Polygon, Region, Ring};
use glam::DVec2;
use std::ops::RangeBounds;

/// The region around which closed rings wind at least `level` times, rounded to the grid. `None` where rings touch or
/// overlap, or where a winding number is not `allowed`.
pub(crate) fn region_within(rings: Vec<Vec<DVec2>>, level: i32, allowed: impl RangeBounds<i32>) -> Option<Region> {
    let edges = Edges::of(&rings)?;
    let boxes = Boxes::new(edges.ends.clone());
    let crossings = edges.crossings(&boxes)?;
    let curves = if crossings.is_empty() { as_they_are(rings) } else { edges.exchanged(&crossings)? };
    let (mut kept, mut turns_off) = (Vec::new(), false);
    for curve in curves {
        let right = curve.winding_on_the_right(&boxes);
        if !allowed.contains(&right) || !allowed.contains(&(right + 1)) {
            return None;
        }
        if right == level - 1 {
            turns_off |= curve.turns_off;
            kept.push(on_grid(&curve.points));
        }
    }
    kept.retain(|curve| curve.len() >= 3);
    // A corner where rings crossed was rounded to the grid: it may have moved onto a neighbour.
    (!turns_off || cross_nowhere(&kept)).then(|| nested(kept))
}

/// Whether no two edges cross or touch, except neighbours at their common end; exact on the grid.
fn cross_nowhere(rings: &[Vec<GridPoint>]) -> bool {
    let rings: Vec<Vec<DVec2>> = rings.iter().map(|ring| ring.iter().map(|&p| from_grid(p)).collect()).collect();
    let crossings = Edges::of(&rings).and_then(|edges| edges.crossings(&Boxes::new(edges.ends.clone())));
    crossings.is_some_and(|crossings| crossings.is_empty())
}

/// Rings that nowhere cross, as curves.
fn as_they_are(rings: Vec<Vec<DVec2>>) -> Vec<Curve> {
    let mut first = 0;
    let curve = |points: Vec<DVec2>| {
        let edges = (first..first + points.len()).collect();
        first += points.len();
        Curve { points, edges, turns_off: false }
    };
    rings.into_iter().map(curve).collect()
}

/// All edges of some rings.
struct Edges {
    ends: Vec<Piece>,
    /// For each edge, the one that follows it in its ring.
    next: Vec<usize>,
}

/// Where two edges cross, and how far along each of them, from 0 to 1.
struct Crossing {
    edges: [usize; 2],
    along: [f64; 2],
    place: DVec2,
}

/// A closed curve that crosses no other.
struct Curve {
    points: Vec<DVec2>,
    /// The edge on which it continues from each point.
    edges: Vec<usize>,
    /// Whether it changes from one ring to another at some crossing.
    turns_off: bool,
}

impl Edges {
    /// `None` where a ring has fewer than three points or two equal ones in succession.
    fn of(rings: &[Vec<DVec2>]) -> Option<Self> {
        let count = rings.iter().map(Vec::len).sum();
        let (mut ends, mut next) = (Vec::with_capacity(count), Vec::with_capacity(count));
        for ring in rings {
            let (first, n) = (ends.len(), ring.len());
            ends.extend((0..n).map(|k| [ring[k], ring[(k + 1) % n]]));
            next.extend((0..n).map(|k| first + (k + 1) % n));
            if n < 3 || ends[first..].iter().any(|[a, b]| a == b) {
                return None;
            }
        }
        Some(Self { ends, next })
    }

    /// Where edges cross; `None` where two touch other than as neighbours.
    fn crossings(&self, boxes: &Boxes) -> Option<Vec<Crossing>> {
        let (mut found, mut touching) = (Vec::new(), false);
        boxes.pairs(|i, j| {
            if touching {
                return;
            }
            match self.meeting(i, j) {
                Meeting::None => {}
                Meeting::Touch => touching = true,
                Meeting::Crossing(crossing) => found.push(crossing),
            }
        });
        (!touching).then_some(found)
    }

    fn meeting(&self, i: usize, j: usize) -> Meeting {
        let ([a, b], [c, d]) = (self.ends[i], self.ends[j]);
        if self.next[i] == j || self.next[j] == i {
            // Neighbours meet at their common end, unless one runs back over the other.
            let back = (b - a).dot(d - c) < 0.0 && side(a, b, c) == 0.0 && side(a, b, d) == 0.0;
            return if back { Meeting::Touch } else { Meeting::None };
        }
        if !(a.min(b).cmple(c.max(d)) & c.min(d).cmple(a.max(b))).all() {
            return Meeting::None;
        }
        let apart = |from: f64, to: f64| from != 0.0 && to != 0.0 && (from > 0.0) == (to > 0.0);
        let (from, to) = (side(c, d, a), side(c, d, b));
        if apart(from, to) {
            return Meeting::None;
        }
        let sides = [from, to, side(a, b, c), side(a, b, d)];
        if apart(sides[2], sides[3]) {
            return Meeting::None;
        }
        if sides.contains(&0.0) {
            return Meeting::Touch;
        }
        let along = [sides[0] / (sides[0] - sides[1]), sides[2] / (sides[2] - sides[3])];
        Meeting::Crossing(Crossing { edges: [i, j], along, place: a.lerp(b, along[0]) })
    }

    /// The curves that result when rings swap their continuations at every crossing. `None` where crossings are so
    /// close together that their order along an edge is uncertain.
    fn exchanged(&self, crossings: &[Crossing]) -> Option<Vec<Curve>> {
        let mut cuts: Vec<(usize, f64, usize)> = (0..crossings.len())
            .flat_map(|k| [0, 1].map(|side| (crossings[k].edges[side], crossings[k].along[side], k)))
            .collect();
        cuts.sort_unstable_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)).then(a.2.cmp(&b.2)));
        // Stations: the start of each edge, followed by its crossings in order.
        let count = self.ends.len() + cuts.len();
        let (mut points, mut edges) = (Vec::with_capacity(count), Vec::with_capacity(count));
        let mut begins = Vec::with_capacity(self.ends.len());
        let mut visits = vec![[None; 2]; crossings.len()];
        let mut cuts = cuts.into_iter().peekable();
        for (i, &[from, to]) in self.ends.iter().enumerate() {
            begins.push(points.len());
            points.push(from);
            edges.push(i);
            while let Some((_, _, k)) = cuts.next_if(|cut| cut.0 == i) {
                let Crossing { edges: [one, _], place, .. } = crossings[k];
                if is_unsure(points.last(), place) {
                    return None;
                }
                visits[k][usize::from(one != i)] = Some(points.len());
                points.push(place);
                edges.push(i);
            }
            if is_unsure(points.last(), to) {
                return None;
            }
        }
        let mut next: Vec<usize> = (1..=points.len()).collect();
        for (i, &following) in self.next.iter().enumerate() {
            let last = begins.get(i + 1).copied().unwrap_or(points.len()) - 1;
            next[last] = begins[following];
        }
        for visit in visits {
            let [Some(one), Some(other)] = visit else { return None };
            next.swap(one, other);
            edges.swap(one, other);
        }
        Some(self.curves(&points, &edges, &next))
    }

    /// Follows stations from one to the next.
    fn curves(&self, points: &[DVec2], edges: &[usize], next: &[usize]) -> Vec<Curve> {
        let (mut seen, mut curves, mut stations) = (vec![false; points.len()], Vec::new(), Vec::new());
        for start in 0..points.len() {
            let mut at = start;
            stations.clear();
            while !std::mem::replace(&mut seen[at], true) {
                stations.push(at);
                at = next[at];
            }
            if stations.len() >= 3 {
                curves.push(Curve {
                    points: stations.iter().map(|&k| points[k]).collect(),
                    edges: stations.iter().map(|&k| edges[k]).collect(),
                    turns_off: stations.iter().any(|&k| points[k] != self.ends[edges[k]][0]),
                });
            }
        }
        curves
    }
}

/// Points on an edge count as different from this distance on, mm: rounding moves a crossing by some 1e-11 mm where
/// coordinates are largest. In the wrong order, crossings would join curves that have nothing to do with each other.
const APART: f64 = 1e-9;

/// Whether it is uncertain that a point comes after the one before it.
fn is_unsure(before: Option<&DVec2>, place: DVec2) -> bool {
    before.is_some_and(|before| before.distance_squared(place) < APART * APART)
}

enum Meeting {
    None,
    /// They touch, or lie on top of each other.
    Touch,
    Crossing(Crossing),
}

impl Curve {
    fn winding_on_the_right(&self, boxes: &Boxes) -> i32 {
        let piece = |k: usize| [self.points[k], self.points[(k + 1) % self.points.len()]];
        let rise = |k: &usize| boxes.rise(piece(*k)).abs();
        let steepest = (0..self.points.len()).max_by(|a, b| rise(a).total_cmp(&rise(b))).unwrap_or(0);
        let [a, b] = piece(steepest);
        let before = boxes.winding_before((a + b) / 2.0, self.edges[steepest]);
        if boxes.rise([a, b]) > 0.0 { before - 1 } else { before }
    }
}

/// The points of a closed curve on the grid, without coincident ones and those between two edges in the same direction.
fn on_grid(curve: &[DVec2]) -> Vec<GridPoint> {
    let mut points: Vec<GridPoint> = curve.iter().map(|&p| to_grid(p)).collect();
    points.dedup();
    while points.len() > 1 && points.first() == points.last() {
        points.pop();
    }
    let n = points.len();
    let way =
        |from: GridPoint, to: GridPoint| (i64::from(to.x) - i64::from(from.x), i64::from(to.y) - i64::from(from.y));
    let bends = |i: &usize| {
        let ((ux, uy), (vx, vy)) = (way(points[(i + n - 1) % n], points[*i]), way(points[*i], points[(i + 1) % n]));
        ux * vy != uy * vx
    };
    let mut bent = Vec::with_capacity(n);
    bent.extend((0..n).filter(bends).map(|i| points[i]));
    bent
}

/// Curves that nowhere cross, with the region on their left, as polygons: each hole in the smallest ring around it. As
/// in the boolean's results, polygons and holes are ordered by their leftmost points; a hole begins at that point, an
/// outer ring at the one before.
fn nested(mut curves: Vec<Vec<GridPoint>>) -> Region {
    let (mut outers, mut holes): (Vec<(Polygon, Bounds, f64)>, Vec<Ring>) = (Vec::new(), Vec::new());
    let leftmost = |curve: &[GridPoint]| (0..curve.len()).min_by_key(|&i| (curve[i].x, curve[i].y)).unwrap_or(0);
    for curve in &mut curves {
        let first = leftmost(curve);
        curve.rotate_left(first);
    }
    curves.sort_by_key(|curve| (curve[0].x, curve[0].y));
    for curve in curves {
        let mut points: Vec<DVec2> = curve.into_iter().map(from_grid).collect();
        let area = Ring::new(points.clone()).area();
        if area > 0.0 {
            points.rotate_right(1);
        }
        let ring = Ring::new(points);
        match Bounds::of(ring.points().iter().copied()) {
            Some(bounds) if area > 0.0 => {
                outers.push((Polygon { outer: ring, holes: Vec::new() }, bounds, area));
            }
            _ => holes.push(ring),
        }
    }
    for hole in holes {
        let Some(&p) = hole.points().first() else { continue };
        let around = |(polygon, bounds, _): &&mut (Polygon, Bounds, f64)| {
            bounds.min.cmple(p).all() && bounds.max.cmpge(p).all() && polygon.outer.contains(p)
        };
        if let Some(smallest) = outers.iter_mut().filter(around).min_by(|a, b| a.2.total_cmp(&b.2)) {
            smallest.0.holes.push(hole);
        }
    }
    Region::from_normalised(outers.into_iter().map(|(polygon, ..)| polygon).collect())
}

/// Twice the signed area of a triangle, its sign exact: positive where `r` lies left of the line from `p` to `q`.
fn side(p: DVec2, q: DVec2, r: DVec2) -> f64 {
    let [p, q, r] = [p, q, r].map(|p| robust::Coord { x: p.x, y: p.y });
    robust::orient2d(p, q, r)
}

#[cfg(test)]
mod tests {
    use super::region_within;
    use glam::DVec2;

    fn square(x: f64, y: f64, side: f64) -> Vec<DVec2> {
        [(0.0, 0.0), (side, 0.0), (side, side), (0.0, side)].map(|(u, v)| DVec2::new(x + u, y + v)).to_vec()
    }

    fn areas(rings: &[Vec<DVec2>], level: i32) -> Option<Vec<f64>> {
        let region = region_within(rings.to_vec(), level, ..)?;
        Some(region.polygons().iter().map(crate::Polygon::area).collect())
    }

    #[test]
    fn overlapping_squares() {
        let rings = [square(0.0, 0.0, 4.0), square(3.0, 2.0, 4.0)];
        assert_eq!(areas(&rings, 1), Some(vec![30.0]));
        assert_eq!(areas(&rings, 2), Some(vec![2.0]));
        assert_eq!(areas(&rings, 3), Some(Vec::new()));
        let cut = [rings[0].clone(), rings[1].iter().rev().copied().collect()];
        assert_eq!(areas(&cut, 1), Some(vec![14.0]));
    }

    #[test]
    fn a_bow_tie_keeps_the_lobe_that_it_winds_around_forwards() {
        let bow = [(0.0, 0.0), (4.0, 4.0), (4.0, 0.0), (0.0, 4.0)].map(DVec2::from).to_vec();
        assert_eq!(areas(std::slice::from_ref(&bow), 1), Some(vec![4.0]));
        // Around the other lobe it winds backwards.
        assert_eq!(region_within(vec![bow], 1, 0..), None);
    }

    #[test]
    fn holes_lie_in_the_ring_around_them_and_islands_in_holes_are_alone() {
        let hole = |ring: Vec<DVec2>| ring.into_iter().rev().collect();
        let rings =
            [square(0.0, 0.0, 20.0), hole(square(2.0, 2.0, 16.0)), square(5.0, 5.0, 8.0), hole(square(6.0, 6.0, 3.0))];
        assert_eq!(areas(&rings, 1), Some(vec![400.0 - 256.0, 64.0 - 9.0]));
    }

    /// A corner of one triangle lies 1e-14 mm outside the edge of another, found in a propeller's preform: followed in the
    /// wrong order, both outlines were one curve, and their union was empty.
    #[test]
    fn crossings_in_no_sure_order_are_left_to_the_boolean() {
        let ring = |points: &[(f64, f64)]| points.iter().copied().map(DVec2::from).collect();
        let one = ring(&[(21.2682, 31.5316), (21.128, 31.7322), (11.0, 22.0)]);
        let other = ring(&[(21.2639, 31.529), (21.1981, 31.6319), (21.1241, 31.7291), (10.0, 21.0)]);
        assert_eq!(areas(&[one, other], 1), None);
    }

    #[test]
    fn what_touches_is_left_to_the_boolean() {
        for (x, y) in [(4.0, 0.0), (4.0, 2.0), (4.0, 4.0), (0.0, 0.0), (2.0, -4.0)] {
            assert_eq!(areas(&[square(0.0, 0.0, 4.0), square(x, y, 4.0)], 1), None, "{x} {y}");
        }
    }
}
