//! Offsets whose outline can be drawn edge by edge, without a boolean of everything with everything.
//!
//! Every edge moves sideways. Where two edges move apart an arc or a tip joins them, where they move into each other they
//! are cut off at their intersection; an edge between two such places that is used up is left out, which is exact since
//! there the offset is what the half-planes of the edges have in common. If the rings that result cross nowhere, keep
//! their sense, and lie within each other as the rings that they come from, they bound the offset. Anything else is left to
//! the boolean ([`offset`](mod@crate::offset)).

use crate::bands::Bands;
use crate::grid::{GridPoint, from_grid, to_grid};
use crate::{Bounds, Join, Polygon, Region, Ring};
use glam::DVec2;

/// Sine of a turn between two edges that counts as none.
const STRAIGHT: f64 = 1e-9;
/// Two edges that turn by more than this (cosine) are left to the boolean.
const SHARPEST: f64 = -0.9;

/// The offset of a region, where it is a simple one.
pub(crate) fn simple_offset(region: &Region, distance: f64, join: Join) -> Option<Region> {
    let polygon = |polygon: &Polygon| {
        let outer = moved(&polygon.outer, distance, join)?;
        Some(Polygon {
            outer,
            holes: polygon.holes.iter().map(|hole| moved(hole, distance, join)).collect::<Option<_>>()?,
        })
    };
    let result = Region::from_normalised(region.polygons().iter().map(polygon).collect::<Option<_>>()?);
    (crosses_nowhere(&result) && nests_as(&result, region)).then_some(result)
}

/// An edge that moves sideways.
struct Edge {
    /// Where it begins before and after it has moved, mm.
    from: DVec2,
    moved: DVec2,
    way: DVec2,
    length: f64,
}

impl Edge {
    /// Where the line of this edge meets that of the next, as distances from the beginnings of both, mm.
    fn meets(&self, next: &Self) -> (f64, f64) {
        let (between, sine) = (next.moved - self.moved, self.way.perp_dot(next.way));
        (between.perp_dot(next.way) / sine, between.perp_dot(self.way) / sine)
    }
}

/// How the offset goes on from an edge to the next.
#[derive(Clone, Copy, PartialEq)]
enum Corner {
    /// Straight on.
    Straight,
    /// The edges move apart.
    Gap,
    /// They are cut off where they meet, at these distances from their beginnings, mm.
    Cut(f64, f64),
}

fn corner(edges: &[Edge], i: usize, j: usize, distance: f64) -> Option<Corner> {
    let (edge, next) = (&edges[i], &edges[j]);
    let (sine, cosine) = (edge.way.perp_dot(next.way), edge.way.dot(next.way));
    if cosine < SHARPEST {
        return None;
    }
    let neighbours = (i + 1) % edges.len() == j;
    if sine.abs() < STRAIGHT {
        neighbours.then_some(Corner::Straight)
    } else if sine * distance > 0.0 {
        neighbours.then_some(Corner::Gap)
    } else {
        let (end, start) = edge.meets(next);
        Some(Corner::Cut(end, start))
    }
}

/// A ring offset by itself.
fn moved(ring: &Ring, distance: f64, join: Join) -> Option<Ring> {
    let edges: Vec<Edge> = ring
        .edges()
        .filter_map(|(a, b)| {
            let (length, way) = (a.distance(b), (b - a).try_normalize()?);
            Some(Edge { from: a, moved: a - distance * way.perp(), way, length })
        })
        .collect();
    if edges.len() < 3 {
        return None;
    }
    let (kept, corners) = without_used_up(&edges, distance)?;
    let mut points: Vec<GridPoint> = Vec::with_capacity(kept.len() + 8);
    for (k, &i) in kept.iter().enumerate() {
        let (edge, next) = (&edges[i], &edges[kept[(k + 1) % kept.len()]]);
        match corners[k] {
            Corner::Straight => points.push(to_grid(next.moved)),
            Corner::Cut(end, _) => points.push(to_grid(edge.moved + end * edge.way)),
            Corner::Gap => join_gap(&mut points, edge, next, distance, join)?,
        }
    }
    points.dedup();
    while points.len() > 1 && points.first() == points.last() {
        points.pop();
    }
    // As the boolean does, a hole begins at its leftmost point, and an outer ring at the point before it.
    let leftmost = (0..points.len()).min_by_key(|&i| (points[i].x, points[i].y))?;
    let back = usize::from(ring.area() > 0.0);
    let count = points.len();
    points.rotate_left((leftmost + count - back) % count);
    let offset = Ring::new(points.into_iter().map(from_grid).collect());
    (offset.points().len() >= 3 && offset.area() * ring.area() > 0.0).then_some(offset)
}

/// The numbers of the edges that are left, and how each goes on to the next; edges between two cuts that are used up are
/// left out. `None` where an edge beside a gap is used up.
fn without_used_up(edges: &[Edge], distance: f64) -> Option<(Vec<usize>, Vec<Corner>)> {
    let (mut kept, mut corners): (Vec<usize>, Vec<Corner>) =
        (Vec::with_capacity(edges.len()), Vec::with_capacity(edges.len()));
    let used_up = |before: Corner, i: usize, after: Corner| {
        let start = if let Corner::Cut(_, start) = before { start } else { 0.0 };
        let end = if let Corner::Cut(end, _) = after { end } else { edges[i].length };
        end <= start
    };
    for i in 0..edges.len() {
        while let Some(&last) = kept.last() {
            let after = corner(edges, last, i, distance)?;
            let Some(&before) = corners.last() else {
                corners.push(after);
                break;
            };
            if !used_up(before, last, after) {
                corners.push(after);
                break;
            }
            if !matches!((before, after), (Corner::Cut(..), Corner::Cut(..))) {
                return None;
            }
            kept.pop();
            corners.pop();
        }
        kept.push(i);
    }
    close(edges, kept, corners, distance, used_up)
}

/// Joins the last edge to the first, and leaves out what is used up there.
fn close(
    edges: &[Edge],
    mut kept: Vec<usize>,
    mut corners: Vec<Corner>,
    distance: f64,
    used_up: impl Fn(Corner, usize, Corner) -> bool,
) -> Option<(Vec<usize>, Vec<Corner>)> {
    loop {
        let (&[first, .., last], &[after_first, .., before_last]) = (&kept[..], &corners[..]) else { return None };
        if kept.len() < 4 {
            return None;
        }
        let seam = corner(edges, last, first, distance)?;
        let cut = |corner: Corner| matches!(corner, Corner::Cut(..));
        if used_up(before_last, last, seam) {
            if !cut(before_last) || !cut(seam) {
                return None;
            }
            kept.pop();
            corners.pop();
        } else if used_up(seam, first, after_first) {
            if !cut(seam) || !cut(after_first) {
                return None;
            }
            kept.remove(0);
            corners.remove(0);
        } else {
            corners.push(seam);
            return Some((kept, corners));
        }
    }
}

/// The points that join two edges that move apart; `None` for a tip that would be too long.
fn join_gap(points: &mut Vec<GridPoint>, edge: &Edge, next: &Edge, distance: f64, join: Join) -> Option<()> {
    let (start, end) = (edge.moved + edge.length * edge.way, next.moved);
    match join {
        Join::Round(tolerance) => {
            // As the boolean does: whole steps, and what is left of the angle at the end.
            let (angle, step) = (edge.way.angle_to(next.way), Join::step(tolerance, distance));
            let count = ((angle.abs() - 1e-9).max(0.0) / step) as usize;
            let turned = |k: usize| DVec2::from_angle((step * k as f64).copysign(angle)).rotate(start - next.from);
            points.push(to_grid(start));
            points.extend((1..=count).map(|k| to_grid(next.from + turned(k))));
            points.push(to_grid(end));
        }
        Join::Miter(limit) => {
            // The tip reaches 1 / cos(half the turn) distances from the corner.
            if (1.0 + edge.way.dot(next.way)) / 2.0 < 1.0 / (limit * limit) {
                return None;
            }
            points.push(to_grid(edge.moved + edge.meets(next).0 * edge.way));
        }
    }
    Some(())
}

/// Whether no two edges of a region's rings cross or touch but neighbours at their common end; exact on the grid.
fn crosses_nowhere(region: &Region) -> bool {
    let (mut pieces, mut next, mut ends) = (Vec::new(), Vec::new(), Vec::new());
    for ring in region.rings() {
        let (first, count) = (pieces.len(), ring.points().len());
        pieces.extend(ring.edges().map(|(a, b)| [a, b]));
        ends.extend(ring.edges().map(|(a, b)| [to_grid(a), to_grid(b)]));
        next.extend((0..count).map(|k| first + (k + 1) % count));
    }
    let mut clear = true;
    Bands::new(pieces).pairs(|i, j| {
        clear = clear && (next[i] == j || next[j] == i || !touch(ends[i], ends[j]));
    });
    clear
}

/// Whether two pieces on the grid cross or touch.
fn touch([a, b]: [GridPoint; 2], [c, d]: [GridPoint; 2]) -> bool {
    // Coordinates reach ±5e8, so that nothing here leaves 64 bits.
    let side = |p: GridPoint, q: GridPoint, r: GridPoint| {
        let (u, v) = (
            (i64::from(q.x) - i64::from(p.x), i64::from(q.y) - i64::from(p.y)),
            (i64::from(r.x) - i64::from(p.x), i64::from(r.y) - i64::from(p.y)),
        );
        (u.0 * v.1 - u.1 * v.0).signum()
    };
    let apart = |a: i32, b: i32, c: i32, d: i32| a.max(b) < c.min(d) || c.max(d) < a.min(b);
    !apart(a.x, b.x, c.x, d.x)
        && !apart(a.y, b.y, c.y, d.y)
        && side(a, b, c) * side(a, b, d) <= 0
        && side(c, d, a) * side(c, d, b) <= 0
}

/// Whether the rings lie within each other as those of another region, ring for ring.
fn nests_as(region: &Region, other: &Region) -> bool {
    let [inside, expected] = [region, other].map(nesting);
    inside == expected
}

/// For every ring, the numbers of the rings that it lies in.
fn nesting(region: &Region) -> Vec<Vec<usize>> {
    let rings: Vec<(&Ring, Option<Bounds>)> =
        region.rings().map(|ring| (ring, Bounds::of(ring.points().iter().copied()))).collect();
    let around = |k: usize| {
        let within = |&i: &usize| {
            let (Some(&p), Some(bounds)) = (rings[k].0.points().first(), &rings[i].1) else { return false };
            i != k && bounds.min.cmple(p).all() && bounds.max.cmpge(p).all() && rings[i].0.contains(p)
        };
        (0..rings.len()).filter(within).collect()
    };
    if rings.len() == 1 { vec![Vec::new()] } else { (0..rings.len()).map(around).collect() }
}
