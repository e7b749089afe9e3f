//! Narrow regions as ladders: pairs of opposite boundary points, rung after rung, with the thickness between them.
//!
//! The boundary is sampled, the samples are joined by a constrained Delaunay triangulation, and every inner edge of it
//! is a rung (chordal axis: Prasad 1997). Triangles with two inner edges make ladders, those with three are forks, those
//! with one are ends. The middles of the rungs approach the medial axis; both sides stay known, so that any number of
//! lines can be laid along a ladder. Ladders that only run into a corner are pruned: those shorter than
//! [`CORNER`] times the rung at which they begin.

use crate::{Polygon, Region};
use glam::DVec2;
use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation};
use std::cmp::Ordering;

/// A free-ended ladder shorter than this many times the rung where it begins leads into a corner. A right angle gives
/// 0.5, a corner of 60° 0.87.
pub const CORNER: f64 = 1.2;

/// Two opposite points of the boundary, mm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rung {
    /// On the left as the ladder runs.
    pub left: DVec2,
    /// On the right.
    pub right: DVec2,
    /// Distance between the two sides here, mm: less than the rung's length where the rung is oblique.
    pub thickness: f64,
}

impl Rung {
    /// The point halfway between the sides.
    pub fn middle(&self) -> DVec2 {
        (self.left + self.right) / 2.0
    }

    fn flipped(self) -> Self {
        Self { left: self.right, right: self.left, ..self }
    }
}

/// A sequence of rungs.
#[derive(Debug, Clone, PartialEq)]
pub struct Ladder {
    /// At least one.
    pub rungs: Vec<Rung>,
    /// Whether its beginning and its end are free ends rather than at a fork.
    pub free: [bool; 2],
    /// Whether it closes to a loop.
    pub closed: bool,
}

impl Ladder {
    /// Length along the middles, mm.
    pub fn length(&self) -> f64 {
        self.rungs.windows(2).map(|w| w[0].middle().distance(w[1].middle())).sum()
    }

    fn reverse(&mut self) {
        self.rungs.reverse();
        self.rungs.iter_mut().for_each(|rung| *rung = rung.flipped());
        self.free.reverse();
    }
}

/// The ladders of a region, without those into corners; the boundary is sampled at least every `spacing` (mm).
///
/// ```
/// use planar::{DVec2, Polygon, Region, Ring, ladder::ladders};
///
/// // A strip is one ladder with two free ends.
/// let corners = [(0.0, 0.0), (40.0, 0.0), (40.0, 4.0), (0.0, 4.0)].map(DVec2::from);
/// let strip = Region::from(Polygon::simple(Ring::new(corners.to_vec())));
/// let found = ladders(&strip, 0.7);
/// assert_eq!(found.len(), 1);
/// assert_eq!(found[0].free, [true, true]);
/// ```
pub fn ladders(region: &Region, spacing: f64) -> Vec<Ladder> {
    region.polygons().iter().flat_map(|polygon| Mesh::of(polygon, spacing).ladders()).collect()
}

/// Triangles inside a polygon.
struct Mesh {
    points: Vec<DVec2>,
    /// Corners, and for the edge that starts at each corner the neighbouring triangle.
    triangles: Vec<([usize; 3], [Option<usize>; 3])>,
}

impl Mesh {
    fn of(polygon: &Polygon, spacing: f64) -> Self {
        let (mut vertices, mut edges) = (Vec::new(), Vec::new());
        for ring in polygon.rings() {
            let first = vertices.len();
            for (a, b) in ring.edges() {
                let count = (a.distance(b) / spacing).ceil().max(1.0) as usize;
                vertices.extend((0..count).map(|k| a.lerp(b, k as f64 / count as f64)));
            }
            let count = vertices.len() - first;
            edges.extend((0..count).map(|k| [first + k, first + (k + 1) % count]));
        }
        let spots = vertices.iter().map(|p| Point2::new(p.x, p.y)).collect();
        // Edges that cross others, possible only by rounding, are left out.
        let triangulation = ConstrainedDelaunayTriangulation::<Point2<f64>>::try_bulk_load_cdt(spots, edges, |_| {});
        let Ok(triangulation) = triangulation else { return Self { points: Vec::new(), triangles: Vec::new() } };
        let points = triangulation.vertices().map(|v| DVec2::new(v.position().x, v.position().y)).collect();
        let inside = insides(&triangulation);
        let mut numbers = vec![None; inside.len()];
        let kept: Vec<_> = triangulation.inner_faces().filter(|face| inside[face.fix().index()]).collect();
        for (number, face) in kept.iter().enumerate() {
            numbers[face.fix().index()] = Some(number);
        }
        let triangles = kept.iter().map(|face| {
            let across = face.adjacent_edges().map(|edge| {
                let free = !edge.is_constraint_edge();
                free.then(|| edge.rev().face().as_inner().and_then(|f| numbers[f.fix().index()])).flatten()
            });
            (face.vertices().map(|v| v.fix().index()), across)
        });
        Self { points, triangles: triangles.collect() }
    }

    /// Edge number `k` of a triangle, as it runs around it.
    fn edge(&self, triangle: usize, k: usize) -> (usize, usize) {
        let corners = self.triangles[triangle].0;
        (corners[k], corners[(k + 1) % 3])
    }

    fn links(&self, triangle: usize) -> usize {
        self.triangles[triangle].1.iter().flatten().count()
    }

    /// The rung by which a path leaves a triangle through an edge: the triangle runs counter-clockwise, so on the way
    /// out the end of the edge is on the left.
    fn rung(&self, triangle: usize, k: usize) -> Rung {
        let (right, left) = self.edge(triangle, k);
        let (left, right) = (self.points[left], self.points[right]);
        Rung { left, right, thickness: left.distance(right).min(self.altitude(triangle)) }
    }

    /// Distance of the corner of a sleeve triangle (two inner edges) from its boundary edge: the distance between the
    /// sides. Infinite for other triangles.
    fn altitude(&self, triangle: usize) -> f64 {
        if self.links(triangle) != 2 {
            return f64::INFINITY;
        }
        let side = self.triangles[triangle].1.iter().position(Option::is_none).unwrap_or(0);
        let (a, b) = self.edge(triangle, side);
        let (a, b, c) = (self.points[a], self.points[b], self.points[self.triangles[triangle].0[(side + 2) % 3]]);
        crate::polyline::distance_squared_to_segment(c, a, b).sqrt()
    }

    fn ladders(&self) -> Vec<Ladder> {
        let mut ladders = Vec::new();
        let mut used = vec![false; self.triangles.len()];
        // From every fork and every end; only loops remain after that.
        for start in 0..self.triangles.len() {
            if self.links(start) != 2 {
                used[start] = true;
                for k in 0..3 {
                    ladders.extend(self.walk(start, k, &mut used));
                }
            }
        }
        for start in 0..self.triangles.len() {
            if !used[start] {
                used[start] = true;
                let k = self.triangles[start].1.iter().position(Option::is_some).unwrap_or(0);
                ladders.extend(self.walk(start, k, &mut used));
            }
        }
        prune(ladders)
    }

    /// The ladder that leaves a triangle through one of its edges, up to a fork or an end. `None` where there is none
    /// or it was found from its other end.
    fn walk(&self, start: usize, k: usize, used: &mut [bool]) -> Option<Walked> {
        let (mut from, mut k) = (start, k);
        let mut next = self.triangles[from].1[k]?;
        // A ladder between two forks is found from both ends, but walked only once.
        let mut rungs = vec![self.rung(from, k)];
        let closed = loop {
            let entry = self.triangles[next].1.iter().position(|n| *n == Some(from)).unwrap_or(0);
            if next == start && self.links(start) == 2 {
                break true;
            }
            if self.links(next) != 2 {
                break false;
            }
            if used[next] {
                return None;
            }
            used[next] = true;
            from = next;
            k = (0..3).find(|&e| e != entry && self.triangles[from].1[e].is_some()).unwrap_or(0);
            rungs.push(self.rung(from, k));
            next = self.triangles[from].1[k]?;
        };
        // A single rung between two triangles that are not sleeves is found from both sides.
        if rungs.len() == 1 && next < start {
            return None;
        }
        let free = [self.links(start) == 1, self.links(next) == 1];
        let forks = [start, next];
        Some(Walked { ladder: Ladder { rungs, free, closed }, forks })
    }
}

/// A ladder with the triangles at its ends, by index.
#[derive(Debug, Clone)]
struct Walked {
    ladder: Ladder,
    forks: [usize; 2],
}

/// Removes the ladders that run into corners, fork by fork, and joins the other two where only two remain at a fork. If
/// all ladders at a fork run into corners, only the shortest is removed: the shape is compact, and the others run
/// across it.
fn prune(mut walked: Vec<Walked>) -> Vec<Ladder> {
    loop {
        let corners: Vec<usize> = (0..walked.len()).filter(|&i| corner_length(&walked[i]).is_some()).collect();
        let Some(&first) = corners.first() else { break };
        let fork = inner_fork(&walked[first]);
        let mut gone: Vec<usize> = corners.into_iter().filter(|&i| inner_fork(&walked[i]) == fork).collect();
        gone.sort_by(|&a, &b| {
            corner_length(&walked[a]).partial_cmp(&corner_length(&walked[b])).unwrap_or(Ordering::Equal)
        });
        if gone.len() == ends_at(&walked, fork).len() {
            gone.truncate(1);
        }
        gone.sort_unstable();
        for &i in gone.iter().rev() {
            walked.swap_remove(i);
        }
        match ends_at(&walked, fork)[..] {
            [(i, end)] => walked[i].ladder.free[end] = true,
            [(i, a), (j, b)] if i == j => walked[i].ladder.closed = a != b,
            [(i, a), (j, b)] => join(&mut walked, (i, a), (j, b)),
            _ => {}
        }
    }
    walked.into_iter().map(|w| w.ladder).collect()
}

/// The length of a ladder that leads into a corner; `None` for any other.
fn corner_length(walked: &Walked) -> Option<f64> {
    let Ladder { rungs, free, .. } = &walked.ladder;
    let base = match free {
        [false, true] => rungs.first(),
        [true, false] => rungs.last(),
        _ => None,
    }?;
    let length = walked.ladder.length();
    (length < CORNER * base.left.distance(base.right)).then_some(length)
}

/// The fork at which a ladder with one free end begins.
fn inner_fork(walked: &Walked) -> usize {
    if walked.ladder.free[0] { walked.forks[1] } else { walked.forks[0] }
}

/// The ladders that meet at a fork, each with the end (0 or 1) that lies there.
fn ends_at(walked: &[Walked], fork: usize) -> Vec<(usize, usize)> {
    let ends = (0..walked.len()).flat_map(|i| [(i, 0), (i, 1)]);
    ends.filter(|&(i, end)| walked[i].forks[end] == fork && !walked[i].ladder.free[end]).collect()
}

/// Joins two ladders that meet into one.
fn join(walked: &mut Vec<Walked>, (i, i_end): (usize, usize), (j, j_end): (usize, usize)) {
    let turn = |w: &mut Walked| {
        w.ladder.reverse();
        w.forks.reverse();
    };
    if i_end == 0 {
        turn(&mut walked[i]);
    }
    if j_end == 1 {
        turn(&mut walked[j]);
    }
    let Walked { ladder, forks } = walked[j].clone();
    let first = &mut walked[i];
    first.ladder.rungs.extend(ladder.rungs);
    first.ladder.free[1] = ladder.free[1];
    first.forks[1] = forks[1];
    walked.swap_remove(j);
}

/// Which faces lie inside: from the outer face inwards, every constraint edge that is crossed changes sides.
fn insides(triangulation: &ConstrainedDelaunayTriangulation<Point2<f64>>) -> Vec<bool> {
    let count = triangulation.num_all_faces();
    let mut inside: Vec<Option<bool>> = vec![None; count];
    let outer = triangulation.outer_face();
    inside[outer.fix().index()] = Some(false);
    let mut open: Vec<(usize, bool)> = Vec::new();
    let mut visit = |face: usize, value: bool, open: &mut Vec<(usize, bool)>| {
        if inside[face].is_none() {
            inside[face] = Some(value);
            open.push((face, value));
        }
    };
    for edge in triangulation.convex_hull() {
        // The hull runs around the outer face; its twin belongs to an inner one.
        let value = edge.is_constraint_edge();
        for face in [edge.face(), edge.rev().face()] {
            if face.as_inner().is_some() {
                visit(face.fix().index(), value, &mut open);
            }
        }
    }
    let handles: Vec<_> = triangulation.inner_faces().collect();
    let mut by_index = vec![None; count];
    for handle in &handles {
        by_index[handle.fix().index()] = Some(*handle);
    }
    while let Some((face, value)) = open.pop() {
        let Some(handle) = by_index[face] else { continue };
        for edge in handle.adjacent_edges() {
            let across = edge.rev().face();
            if across.as_inner().is_some() {
                visit(across.fix().index(), value != edge.is_constraint_edge(), &mut open);
            }
        }
    }
    inside.into_iter().map(|value| value.unwrap_or(false)).collect()
}
