//! Offsets drawn edge by edge, without a sweep over everything.
//!
//! Every edge moves sideways. Where two edges move apart an arc or a tip joins them, where they move into each other they
//! are cut off at their intersection; an edge between two such places that is used up is left out, which is exact since
//! there the offset is what the half-planes of the edges have in common. Where an edge beside a gap is used up, the way leads
//! over the corner itself, and winds clockwise around what must not count. The offset is what the rings that result wind
//! around ([`winding`](crate::winding)); what touches itself is left to the boolean ([`offset`](mod@crate::offset)).

use crate::winding::region_within;
use crate::{Join, Region, Ring};
use glam::DVec2;

/// Sine of a turn between two edges that counts as none.
const STRAIGHT: f64 = 1e-9;
/// Edges that turn into each other more sharply than this (cosine) are led over the corner.
const SHARPEST: f64 = -0.9;

/// The offset of a region, where its rings touch nowhere.
pub(crate) fn edgewise_offset(region: &Region, distance: f64, join: Join) -> Option<Region> {
    let gaps = Gaps::at(distance, join);
    let rings = region.rings().map(|ring| moved(ring, distance, &gaps)).collect::<Option<Vec<_>>>()?;
    region_within(rings.into_iter().filter(|ring| ring.len() >= 3).collect(), 1, ..)
}

/// How edges that move apart are joined.
struct Gaps {
    /// Where the cosine of the turn is greater than this, by a tip.
    tip: f64,
    /// Else by an arc with a point after each such angle, radians, if arcs are wanted.
    step: Option<f64>,
}

/// A tip that reaches no farther beyond the arc than this part of the tolerance is drawn for it: one point for two.
const TIP: f64 = 0.2;

impl Gaps {
    fn at(distance: f64, join: Join) -> Self {
        match join {
            // The tip reaches farther by a quarter of the distance times the versed sine of the turn.
            Join::Round(tolerance) => {
                Self { tip: 1.0 - 4.0 * TIP * tolerance / distance.abs(), step: Some(Join::step(tolerance, distance)) }
            }
            // It lies 1 / cos(half the turn) distances from the corner.
            Join::Miter(limit) => Self { tip: 2.0 / (limit * limit) - 1.0, step: None },
        }
    }
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
    /// They move into each other, and one of them is used up.
    Over,
}

fn corner(edges: &[Edge], i: usize, j: usize, distance: f64) -> Option<Corner> {
    let (edge, next) = (&edges[i], &edges[j]);
    let (sine, cosine) = (edge.way.perp_dot(next.way), edge.way.dot(next.way));
    let neighbours = (i + 1) % edges.len() == j;
    if sine.abs() < STRAIGHT {
        (neighbours && cosine > 0.0).then_some(Corner::Straight)
    } else if sine * distance > 0.0 {
        neighbours.then_some(Corner::Gap)
    } else {
        let (end, start) = edge.meets(next);
        Some(Corner::Cut(end, start))
    }
}

/// [`corner`], unless the edges turn back so sharply that the half-planes of their neighbours matter.
fn blunt_corner(edges: &[Edge], i: usize, j: usize, distance: f64) -> Option<Corner> {
    let sharp = |corner: &Corner| matches!(corner, Corner::Cut(..)) && edges[i].way.dot(edges[j].way) < SHARPEST;
    corner(edges, i, j, distance).filter(|corner| !sharp(corner))
}

/// A ring offset by itself; it may cross itself.
fn moved(ring: &Ring, distance: f64, gaps: &Gaps) -> Option<Vec<DVec2>> {
    let edges: Vec<Edge> = ring
        .edges()
        .filter_map(|(a, b)| {
            let length = a.distance(b);
            let way = Some((b - a) / length).filter(|way| way.is_finite())?;
            Some(Edge { from: a, moved: a - distance * way.perp(), way, length })
        })
        .collect();
    if edges.len() < 3 {
        return Some(Vec::new());
    }
    let (kept, corners) = without_used_up(&edges, distance).map_or_else(|| over_corners(&edges, distance), Some)?;
    let mut points: Vec<DVec2> = Vec::with_capacity(kept.len() + 8);
    for (k, &i) in kept.iter().enumerate() {
        let (edge, next) = (&edges[i], &edges[kept[(k + 1) % kept.len()]]);
        match corners[k] {
            Corner::Straight => points.push(next.moved),
            Corner::Cut(end, _) => points.push(edge.moved + end * edge.way),
            Corner::Gap => join_gap(&mut points, edge, next, gaps)?,
            Corner::Over => points.extend([edge.moved + edge.length * edge.way, next.from, next.moved]),
        }
    }
    points.dedup();
    while points.len() > 1 && points.first() == points.last() {
        points.pop();
    }
    Some(points)
}

/// All edges, each cut off where it meets the next one if that leaves something of both; else the way leads over the corner.
fn over_corners(edges: &[Edge], distance: f64) -> Option<(Vec<usize>, Vec<Corner>)> {
    let n = edges.len();
    let plain = (0..n).map(|i| corner(edges, i, (i + 1) % n, distance)).collect::<Option<Vec<_>>>()?;
    let start = |i: usize| if let Corner::Cut(_, start) = plain[(i + n - 1) % n] { start } else { 0.0 };
    let end = |i: usize| if let Corner::Cut(end, _) = plain[i] { end } else { edges[i].length };
    let left = |i: usize| start(i) >= 0.0 && start(i) < end(i) && end(i) <= edges[i].length;
    let corner = |i: usize| match plain[i] {
        Corner::Cut(..) if !left(i) || !left((i + 1) % n) => Corner::Over,
        corner => corner,
    };
    Some(((0..n).collect(), (0..n).map(corner).collect()))
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
            let after = blunt_corner(edges, last, i, distance)?;
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
        let seam = blunt_corner(edges, last, first, distance)?;
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
fn join_gap(points: &mut Vec<DVec2>, edge: &Edge, next: &Edge, gaps: &Gaps) -> Option<()> {
    if edge.way.dot(next.way) >= gaps.tip {
        points.push(edge.moved + edge.meets(next).0 * edge.way);
        return Some(());
    }
    // As the boolean does: whole steps, and what is left of the angle at the end.
    let (step, angle) = (gaps.step?, edge.way.angle_to(next.way));
    let count = ((angle.abs() - 1e-9).max(0.0) / step) as usize;
    let start = edge.moved + edge.length * edge.way;
    let turned = |k: usize| DVec2::from_angle((step * k as f64).copysign(angle)).rotate(start - next.from);
    points.push(start);
    points.extend((1..=count).map(|k| next.from + turned(k)));
    points.push(next.moved);
    Some(())
}
