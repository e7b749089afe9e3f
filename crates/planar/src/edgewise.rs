//! Offsets drawn edge by edge, without a sweep over the whole plane.
//!
//! Every edge moves sideways. Where two edges move apart, an arc or a tip joins them; where they move into each other,
//! they are cut off at their intersection. An edge used up between two such cuts is left out, which is exact because
//! the offset there is the intersection of the edges' half-planes. Where an edge is used up by one cut alone, or edges
//! turn back sharply, the path leads through the corner of the outline instead and winds clockwise around what must not
//! count. The offset is what the resulting rings wind around ([`winding`](crate::winding)); rings that touch themselves
//! are left to the boolean ([`offset`](mod@crate::offset)).

use crate::winding::region_within;
use crate::{Join, Region, Ring};
use glam::DVec2;

/// Sine of the angle between two edges below which they count as parallel.
const STRAIGHT: f64 = 1e-9;
/// Where the cosine of the turn between two edges is below this, the path leads over the corner.
const SHARPEST: f64 = -0.9;

/// The offset of a region, where its rings touch nowhere.
pub(crate) fn edgewise_offset(region: &Region, distance: f64, join: Join) -> Option<Region> {
    let gaps = Gaps::at(distance, join);
    let rings = region.rings().map(|ring| moved(ring, distance, &gaps)).collect::<Option<Vec<_>>>()?;
    region_within(rings.into_iter().filter(|ring| ring.len() >= 3).collect(), 1, ..)
}

/// How edges that move apart are joined.
struct Gaps {
    /// Joined by a tip where the cosine of the turn is at least this,
    tip: f64,
    /// and otherwise by an arc with one point per this angle, radians; `None` where no arcs are wanted.
    step: Option<f64>,
}

/// A tip is drawn in place of an arc if it reaches no farther beyond it than this fraction of the tolerance: one point
/// instead of two.
const TIP: f64 = 0.2;

impl Gaps {
    fn at(distance: f64, join: Join) -> Self {
        let (limit, step) = match join {
            Join::Round(tolerance) => (1.0 + TIP * tolerance / distance.abs(), Some(Join::step(tolerance, distance))),
            Join::Miter(limit) => (limit, None),
        };
        // A tip lies 1 / cos(half the turn) distances from the corner.
        Self { tip: 2.0 / (limit * limit) - 1.0, step }
    }
}

/// An edge that is moved sideways.
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

/// How the offset continues from an edge to the next.
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

impl Corner {
    fn is_cut(self) -> bool {
        matches!(self, Self::Cut(..))
    }
}

/// How an edge continues to a later one if those between them are left out. `None` where the two do not meet, or where
/// neighbours run back over each other.
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

/// A ring offset on its own; the result may cross itself.
fn moved(ring: &Ring, distance: f64, gaps: &Gaps) -> Option<Vec<DVec2>> {
    let mut edges: Vec<Edge> = ring
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
    let left = Left::of(&mut edges, distance)?;
    let mut points: Vec<DVec2> = Vec::with_capacity(left.edges.len() + 8);
    for (k, corner) in left.corners.into_iter().enumerate() {
        let (edge, next) = (&edges[left.edges[k]], &edges[left.edges[(k + 1) % left.edges.len()]]);
        match corner {
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

/// The remaining edges of a ring, without those that are used up between two cuts.
struct Left {
    /// Their indices.
    edges: Vec<usize>,
    /// How each continues to the next, the last one to the first.
    corners: Vec<Corner>,
}

impl Left {
    /// `None` where an edge runs back over its neighbour. The edges are rotated to begin after a gap if there is one,
    /// since nothing is left out across a gap.
    fn of(edges: &mut [Edge], distance: f64) -> Option<Self> {
        let n = edges.len();
        let behind = (0..n).find(|&i| corner(edges, i, (i + 1) % n, distance) == Some(Corner::Gap));
        edges.rotate_left(behind.map_or(0, |gap| (gap + 1) % n));
        let seam = if behind.is_some() { Corner::Gap } else { Corner::Over };
        let mut left = Self { edges: vec![0], corners: Vec::with_capacity(n) };
        for i in 1..n {
            left.go_on(edges, i, distance)?;
        }
        left.give_way(edges, seam);
        left.corners.push(seam);
        if seam == Corner::Over {
            left.cut_seam(edges, distance);
        }
        Some(left)
    }

    /// Adds an edge, and leaves out those before it that are used up.
    fn go_on(&mut self, edges: &[Edge], i: usize, distance: f64) -> Option<()> {
        while let Some(&last) = self.edges.last() {
            let after = corner(edges, last, i, distance);
            if after.is_none() && last + 1 == i {
                return None;
            }
            let before = self.before();
            match after.filter(|after| !is_sharp(*after, &edges[last], &edges[i])) {
                Some(after) if is_used_up(before, &edges[last], after) && before.is_cut() && after.is_cut() => {
                    self.edges.pop();
                    self.corners.pop();
                }
                Some(after) if !is_used_up(before, &edges[last], after) || !after.is_cut() => {
                    self.give_way(edges, after);
                    self.corners.push(after);
                    self.edges.push(i);
                    break;
                }
                _ => {
                    self.give_way(edges, Corner::Over);
                    self.lead_over(i);
                    break;
                }
            }
        }
        Some(())
    }

    /// The corner before the last edge; nothing is cut off the first one.
    fn before(&self) -> Corner {
        self.corners.last().copied().unwrap_or(Corner::Over)
    }

    /// If the last edge is used up by the cut before it alone, leads the path over that corner instead.
    fn give_way(&mut self, edges: &[Edge], after: Corner) {
        let before = self.before();
        if let [.., _, last] = self.edges[..]
            && before.is_cut()
            && is_used_up(before, &edges[last], after)
        {
            self.edges.pop();
            self.corners.pop();
            self.lead_over(last);
        }
    }

    /// Continues from the last edge over all corners up to edge `to`, along the edges left out between them.
    fn lead_over(&mut self, to: usize) {
        let next = self.edges.last().map_or(to, |last| last + 1);
        self.edges.extend(next..=to);
        self.corners.resize(self.edges.len() - 1, Corner::Over);
    }

    /// Cuts off the last edge and the first where they meet, if something of both remains.
    fn cut_seam(&mut self, edges: &[Edge], distance: f64) {
        let ([after, .., before, seam], [first, .., last]) = (&mut self.corners[..], edges) else { return };
        let cut = corner(edges, edges.len() - 1, 0, distance).filter(|cut| !is_sharp(*cut, last, first));
        let left = |cut: &Corner| !is_used_up(*before, last, *cut) && !is_used_up(*cut, first, *after);
        *seam = cut.filter(left).unwrap_or(*seam);
    }
}

/// Whether two edges that are cut off turn back so sharply that the half-planes of their neighbours matter too.
fn is_sharp(corner: Corner, edge: &Edge, next: &Edge) -> bool {
    corner.is_cut() && edge.way.dot(next.way) < SHARPEST
}

/// Whether nothing is left of an edge between two corners.
fn is_used_up(before: Corner, edge: &Edge, after: Corner) -> bool {
    let start = if let Corner::Cut(_, start) = before { start } else { 0.0 };
    let end = if let Corner::Cut(end, _) = after { end } else { edge.length };
    end <= start
}

/// The points that join two edges that move apart; `None` for a tip that would be too long.
fn join_gap(points: &mut Vec<DVec2>, edge: &Edge, next: &Edge, gaps: &Gaps) -> Option<()> {
    if edge.way.dot(next.way) >= gaps.tip {
        points.push(edge.moved + edge.meets(next).0 * edge.way);
        return Some(());
    }
    // As the boolean does: whole steps, then the rest of the angle.
    let (step, angle) = (gaps.step?, edge.way.angle_to(next.way));
    let count = ((angle.abs() - 1e-9).max(0.0) / step) as usize;
    let start = edge.moved + edge.length * edge.way;
    let turned = |k: usize| DVec2::from_angle((step * k as f64).copysign(angle)).rotate(start - next.from);
    points.push(start);
    points.extend((1..=count).map(|k| next.from + turned(k)));
    points.push(next.moved);
    Some(())
}
