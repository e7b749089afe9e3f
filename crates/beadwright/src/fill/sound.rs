//! Whether the passes of an island can be welded at all: they stay inside it and do not cross each other.
//!
//! Every fill is checked, whatever strategy it is of, so that a fault of a strategy never reaches a robot.

use super::Path;
use glam::DVec2;
use planar::Polygon;
use rstar::primitives::{GeomWithData, Line};
use rstar::{AABB, PointDistance, RTree, RTreeObject};

/// Centre-lines may leave the outline by this much, mm: coordinates are rounded.
pub const TOLERANCE_MM: f64 = 0.01;

/// A piece of a path: number of the path, number of the piece in it.
type Piece = GeomWithData<Line<[f64; 2]>, (usize, usize)>;

/// What is wrong with the passes of an island.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Fault {
    /// A centre-line leaves the island.
    Outside {
        /// Where, mm.
        place: DVec2,
        /// By how much, mm.
        by: f64,
    },
    /// Two passes cross, or one crosses itself.
    Crossing {
        /// Where, mm.
        place: DVec2,
    },
}

/// The first fault of an island's passes; centre-lines may lie outside by `allowance`, mm.
pub fn fault(paths: &[&Path], island: &Polygon, allowance: f64) -> Option<Fault> {
    outside(paths, island, allowance).or_else(|| {
        let lines: Vec<Vec<DVec2>> = paths.iter().map(|path| path.path()).collect();
        crossings(&lines).next().map(|(_, _, place)| Fault::Crossing { place })
    })
}

/// The place where a path is farthest outside.
fn outside(paths: &[&Path], island: &Polygon, allowance: f64) -> Option<Fault> {
    let edges = island.rings().flat_map(|ring| ring.edges()).map(|(a, b)| Line::new(a.to_array(), b.to_array()));
    let tree: RTree<Line<[f64; 2]>> = RTree::bulk_load(edges.collect());
    let by = |p: DVec2| {
        let outside = p.is_finite() && !island.contains(p);
        let distance = || tree.nearest_neighbor(&p.to_array()).map_or(0.0, |edge| edge.distance_2(&p.to_array()));
        if outside { distance().sqrt() } else { 0.0 }
    };
    let suspects = paths.iter().flat_map(|path| {
        let path = path.path();
        let cuts: Vec<Vec<f64>> = path.windows(2).map(|w| cuts(&tree, w[0], w[1])).collect();
        // A path that crosses no edge lies inside as its first point does.
        let pieces = if cuts.iter().all(Vec::is_empty) { 0 } else { cuts.len() };
        let near = path.windows(2).zip(&cuts).take(pieces).flat_map(|(w, cuts)| places(w[0], w[1], cuts));
        path.first().copied().into_iter().chain(near).collect::<Vec<_>>()
    });
    let worst = suspects.map(|p| (p, by(p))).max_by(|a, b| a.1.total_cmp(&b.1))?;
    let lost = paths.iter().flat_map(|path| &path.points).find(|p| !p.is_finite());
    match lost {
        Some(&place) => Some(Fault::Outside { place, by: f64::INFINITY }),
        None => (worst.1 > allowance.max(0.0) + TOLERANCE_MM).then_some(Fault::Outside { place: worst.0, by: worst.1 }),
    }
}

/// Where on a piece, from 0 to 1, it crosses the edges.
fn cuts(edges: &RTree<Line<[f64; 2]>>, from: DVec2, to: DVec2) -> Vec<f64> {
    let piece = Line::new(from.to_array(), to.to_array());
    edges.locate_in_envelope_intersecting(&piece.envelope()).filter_map(|edge| cut(&piece, edge)).collect()
}

/// Places at which a piece may lie farthest outside: between two cuts it lies either inside or outside, and one without cuts
/// as its ends do.
fn places(from: DVec2, to: DVec2, cuts: &[f64]) -> Vec<DVec2> {
    if cuts.is_empty() {
        return vec![to];
    }
    let mut ends: Vec<f64> = cuts.iter().copied().chain([0.0, 1.0]).collect();
    ends.sort_by(f64::total_cmp);
    let between = |w: &[f64]| {
        let count = ((w[1] - w[0]) * from.distance(to) / SAMPLE_MM).ceil().clamp(LEAST_SAMPLES, MOST_SAMPLES);
        (0..=count as usize).map(move |k| w[0] + (w[1] - w[0]) * k as f64 / count).collect::<Vec<_>>()
    };
    ends.windows(2).flat_map(between).map(|t| from.lerp(to, t)).collect()
}

/// Where on a piece it crosses an edge.
fn cut(piece: &Line<[f64; 2]>, edge: &Line<[f64; 2]>) -> Option<f64> {
    let [p, q, r, s] = [piece.from, piece.to, edge.from, edge.to].map(DVec2::from);
    let (u, v) = (q - p, s - r);
    let across = u.perp_dot(v);
    let (t, w) = ((r - p).perp_dot(v) / across, (r - p).perp_dot(u) / across);
    let on = |x: f64| (0.0..=1.0).contains(&x);
    (across != 0.0 && on(t) && on(w)).then_some(t)
}

/// Distance of the places at which a piece near the outline is looked at, mm.
const SAMPLE_MM: f64 = 0.25;
/// A piece between two edges that it crosses is looked at in this many places at least, and at most.
const LEAST_SAMPLES: f64 = 8.0;
const MOST_SAMPLES: f64 = 4000.0;

/// Where lines cross an earlier line, or an earlier piece of their own: numbers of both lines, and the place.
/// Neighbouring pieces, and touching ends, do not count.
pub fn crossings(lines: &[Vec<DVec2>]) -> impl Iterator<Item = (usize, usize, DVec2)> {
    let pieces = lines.iter().enumerate().flat_map(|(i, line)| {
        let ends =
            move |(k, w): (usize, &[DVec2])| GeomWithData::new(Line::new(w[0].to_array(), w[1].to_array()), (i, k));
        line.windows(2).filter(|w| w[0].is_finite() && w[1].is_finite()).enumerate().map(ends)
    });
    let tree: RTree<Piece> = RTree::bulk_load(pieces.collect());
    let mut found: Vec<(usize, usize, DVec2)> = Vec::new();
    for piece in &tree {
        let around: AABB<[f64; 2]> = piece.envelope();
        for other in tree.locate_in_envelope_intersecting(&around) {
            let ((i, k), (j, l)) = (piece.data, other.data);
            if (j < i || (j == i && l + 1 < k))
                && let Some(place) = crossing(piece, other)
            {
                found.push((i, j, place));
            }
        }
    }
    found.sort_by(|a, b| (a.0, a.1).cmp(&(b.0, b.1)).then(a.2.x.total_cmp(&b.2.x)));
    found.into_iter()
}

/// Where two pieces cross, their ends not counted.
fn crossing(a: &Piece, b: &Piece) -> Option<DVec2> {
    const INNER: f64 = 1e-6;
    let [p, q, r, s] = [a.geom().from, a.geom().to, b.geom().from, b.geom().to].map(DVec2::from);
    let (u, v) = (q - p, s - r);
    let across = u.perp_dot(v);
    let (t, w) = ((r - p).perp_dot(v) / across, (r - p).perp_dot(u) / across);
    let inside = |x: f64| (INNER..1.0 - INNER).contains(&x);
    (across != 0.0 && inside(t) && inside(w)).then(|| p + u * t)
}
