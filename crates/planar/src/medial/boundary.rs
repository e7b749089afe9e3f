//! The edges of a polygon, and which of them is nearest: a tree of boxes over the edges in ring order.

use crate::{Bounds, Polygon};
use glam::DVec2;

/// Edges under one leaf of the tree.
const LEAF: usize = 4;

/// One edge, and where it lies on its ring.
#[derive(Clone, Copy)]
pub(super) struct Edge {
    pub a: DVec2,
    pub b: DVec2,
    /// Neighbours on the ring.
    pub previous: usize,
    pub next: usize,
    ring: usize,
    /// Distance of `a` along the ring from its start, mm.
    start: f64,
}

/// A point on the boundary.
#[derive(Clone, Copy)]
pub(super) struct Foot {
    pub edge: usize,
    pub at: DVec2,
    pub distance: f64,
}

pub(super) struct Boundary {
    pub edges: Vec<Edge>,
    ring_lengths: Vec<f64>,
    /// Binary tree: the children of box i are 2i and 2i + 1, the root is 1, the leaves are the second half.
    boxes: Vec<Bounds>,
}

impl Boundary {
    pub(super) fn of(polygon: &Polygon) -> Self {
        let mut edges: Vec<Edge> = Vec::new();
        let mut ring_lengths = Vec::new();
        for (ring, points) in polygon.rings().enumerate() {
            let (first, count) = (edges.len(), points.points().len());
            let mut start = 0.0;
            for (i, (a, b)) in points.edges().enumerate() {
                let (previous, next) = (first + (i + count - 1) % count, first + (i + 1) % count);
                edges.push(Edge { a, b, previous, next, ring, start });
                start += a.distance(b);
            }
            ring_lengths.push(start);
        }
        let boxes = boxes_over(&edges);
        Self { edges, ring_lengths, boxes }
    }

    pub(super) fn length(&self) -> f64 {
        self.ring_lengths.iter().sum()
    }

    /// The point of one edge that is nearest to `p`.
    pub(super) fn foot_on(&self, edge: usize, p: DVec2) -> Foot {
        let Edge { a, b, .. } = self.edges[edge];
        let along = b - a;
        let t = (p - a).dot(along) / along.length_squared();
        let at = if t > 0.0 { if t < 1.0 { a + along * t } else { b } } else { a };
        Foot { edge, at, distance: p.distance(at) }
    }

    /// The point of the boundary nearest to `p` and nearer than `limit`, mm.
    pub(super) fn nearest(&self, p: DVec2, limit: f64) -> Option<Foot> {
        self.nearest_but(p, limit, |_| false)
    }

    /// [`Self::nearest`] without the edges that `skip` names.
    pub(super) fn nearest_but(&self, p: DVec2, limit: f64, skip: impl Fn(usize) -> bool) -> Option<Foot> {
        let mut best = None;
        self.search(1, p, limit, &skip, &mut best);
        best
    }

    /// Looks under one box for a point nearer than `limit` and the best so far; the nearer half first.
    fn search(&self, index: usize, p: DVec2, limit: f64, skip: &impl Fn(usize) -> bool, best: &mut Option<Foot>) {
        let limit_now = |best: &Option<Foot>| best.map_or(limit, |foot| foot.distance);
        if let Some(leaf) = index.checked_sub(self.boxes.len() / 2) {
            for edge in (leaf * LEAF..self.edges.len().min((leaf + 1) * LEAF)).filter(|&e| !skip(e)) {
                let foot = self.foot_on(edge, p);
                if foot.distance < limit_now(best) {
                    *best = Some(foot);
                }
            }
            return;
        }
        let child = |i: usize| (distance_to_box(self.boxes[i], p), i);
        let (near, far) = (child(2 * index), child(2 * index + 1));
        for (distance, child) in if near.0 <= far.0 { [near, far] } else { [far, near] } {
            if distance < limit_now(best) {
                self.search(child, p, limit, skip, best);
            }
        }
    }

    /// Distance between two points of the boundary along it, mm; infinite on different rings.
    pub(super) fn along(&self, p: &Foot, q: &Foot) -> f64 {
        let (e, f) = (&self.edges[p.edge], &self.edges[q.edge]);
        if e.ring != f.ring {
            return f64::INFINITY;
        }
        let gap = (e.start + e.a.distance(p.at) - f.start - f.a.distance(q.at)).abs();
        gap.min(self.ring_lengths[e.ring] - gap)
    }

    /// Whether `p` lies inside, given the point of the boundary nearest to it.
    pub(super) fn inside(&self, foot: &Foot, p: DVec2) -> bool {
        let edge = &self.edges[foot.edge];
        // If the nearest point is a vertex, that vertex juts out towards p.
        let juts_inwards = |at: usize| {
            let (before, after) = (&self.edges[self.edges[at].previous], &self.edges[at]);
            (before.b - before.a).perp_dot(after.b - after.a) < 0.0
        };
        if foot.at == edge.a {
            juts_inwards(foot.edge)
        } else if foot.at == edge.b {
            juts_inwards(edge.next)
        } else {
            (edge.b - edge.a).perp_dot(p - edge.a) > 0.0
        }
    }
}

fn boxes_over(edges: &[Edge]) -> Vec<Bounds> {
    const NOTHING: Bounds = Bounds { min: DVec2::INFINITY, max: DVec2::NEG_INFINITY };
    let leaves = edges.len().div_ceil(LEAF).next_power_of_two();
    let mut boxes = vec![NOTHING; 2 * leaves];
    for (leaf, edges) in edges.chunks(LEAF).enumerate() {
        boxes[leaves + leaf] = Bounds::of(edges.iter().flat_map(|e| [e.a, e.b])).unwrap_or(NOTHING);
    }
    for i in (1..leaves).rev() {
        let (l, r) = (boxes[2 * i], boxes[2 * i + 1]);
        boxes[i] = Bounds { min: l.min.min(r.min), max: l.max.max(r.max) };
    }
    boxes
}

/// Infinite for the empty box.
fn distance_to_box(bounds: Bounds, p: DVec2) -> f64 {
    (bounds.min - p).max(p - bounds.max).max(DVec2::ZERO).length()
}
