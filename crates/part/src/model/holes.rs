//! Holes in a surface, closed with triangles of the least total area.
//!
//! A hole is a loop of open edges. It is closed by the triangulation of its loop with the least area, found by dynamic
//! programming (Barequet and Sharir 1995, "Filling gaps in the boundary of a polyhedron"); no vertex is added.

use super::repair::mend;
use super::{Import, Mesh, NO_NEIGHBOUR};
use glam::DVec3;
use std::collections::BTreeMap;

/// Loops with more edges are left open: the time grows with the cube of their number.
const MOST_EDGES: usize = 400;

/// What was closed.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Closed {
    /// Holes that were closed.
    pub holes: usize,
    /// Triangles that close them.
    pub triangles: usize,
    /// The widest of them, in the units of the file.
    pub widest: f64,
    /// Holes that were left open: too wide, with too many edges, or touching another one.
    pub left: usize,
    /// The widest of those, in the units of the file.
    pub widest_left: f64,
}

impl Closed {
    /// What was done, as sentences.
    pub fn sentences(&self) -> Vec<String> {
        let Self { holes, triangles, widest, left, widest_left } = *self;
        let count = |n: usize, word: &str| if n == 1 { format!("1 {word}") } else { format!("{n} {word}s") };
        let closed = (holes > 0).then(|| {
            let (holes, triangles) = (count(holes, "hole"), count(triangles, "triangle"));
            format!("{holes} closed with {triangles}; the widest measures {widest:.3} across.")
        });
        let open = (left > 0).then(|| {
            let left = count(left, "hole");
            format!(
                "{left} left open: wider than asked for, with more than {MOST_EDGES} edges, or touching others; the widest \
                 measures {widest_left:.3} across."
            )
        });
        closed.into_iter().chain(open).collect()
    }
}

/// Closes the holes at most `widest` across, in units of the file, and repairs the result.
pub fn close(import: Import, widest: f64) -> (Import, Closed) {
    let Import { mut mesh, repair, .. } = import;
    let (loops, touching) = loops(&mesh);
    let mut closed = Closed { left: touching, ..Closed::default() };
    for corners in loops {
        let across = extent(&mesh, &corners);
        if across > widest || corners.len() > MOST_EDGES {
            closed.left += 1;
            closed.widest_left = closed.widest_left.max(across);
            continue;
        }
        let cover = least_area(&mesh, &corners);
        closed.holes += 1;
        closed.triangles += cover.len();
        closed.widest = closed.widest.max(across);
        mesh.triangles.extend(cover);
    }
    let (mesh, mut mended) = mend(mesh.vertices, mesh.triangles);
    mended.triangles_read = repair.triangles_read;
    mended.damage = repair.damage;
    mended.appended_bytes = repair.appended_bytes;
    mended.degenerate += repair.degenerate;
    mended.duplicate += repair.duplicate;
    mended.vertices_merged += repair.vertices_merged;
    mended.flipped += repair.flipped;
    mended.inside_out |= repair.inside_out;
    mended.normals_against_winding = repair.normals_against_winding;
    (Import { mesh, repair: mended, ..import }, closed)
}

/// The loops of open edges, against the direction of their triangles, and the number of vertices where loops touch.
fn loops(mesh: &Mesh) -> (Vec<Vec<u32>>, usize) {
    let mut next: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for (corners, across) in mesh.triangles.iter().zip(&mesh.neighbours) {
        for edge in (0..3).filter(|&edge| across[edge] == NO_NEIGHBOUR) {
            next.entry(corners[(edge + 1) % 3]).or_default().push(corners[edge]);
        }
    }
    let touching = next.values().filter(|ends| ends.len() > 1).count();
    // A loop can be followed only where there is exactly one way on.
    let mut next: BTreeMap<u32, u32> =
        next.into_iter().filter(|(_, to)| to.len() == 1).map(|(from, to)| (from, to[0])).collect();
    let mut loops = Vec::new();
    while let Some((start, mut at)) = next.pop_first() {
        let mut corners = vec![start];
        while at != start {
            corners.push(at);
            match next.remove(&at) {
                Some(to) => at = to,
                None => break,
            }
        }
        if at == start && corners.len() > 2 {
            loops.push(corners);
        }
    }
    (loops, touching)
}

/// The rim of an open surface, or a hole in it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Opening {
    /// Twice its area over its length: the radius of a round opening, the width of a slit.
    pub width: f64,
    /// Length of its edges, in units of the mesh.
    pub length: f64,
    /// A point on it.
    pub place: DVec3,
}

/// The openings of a surface, the widest first, in units of the mesh. Open edges that touch form one opening.
pub fn openings(mesh: &Mesh) -> Vec<Opening> {
    let mut edges: Vec<[u32; 2]> = Vec::new();
    for (corners, across) in mesh.triangles.iter().zip(&mesh.neighbours) {
        let open = (0..3).filter(|&edge| across[edge] == NO_NEIGHBOUR);
        edges.extend(open.map(|edge| [corners[edge], corners[(edge + 1) % 3]]));
    }
    let mut at: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
    for (i, edge) in edges.iter().enumerate() {
        edge.iter().for_each(|corner| at.entry(*corner).or_default().push(i));
    }
    let place = |corner: u32| mesh.vertices[corner as usize];
    let (mut seen, mut found) = (vec![false; edges.len()], Vec::new());
    for first in 0..edges.len() {
        let (mut next, mut length, mut area) = (vec![first], 0.0, DVec3::ZERO);
        let origin = place(edges[first][0]);
        while let Some(i) = next.pop() {
            if std::mem::replace(&mut seen[i], true) {
                continue;
            }
            let [a, b] = edges[i].map(place);
            length += a.distance(b);
            area += (a - origin).cross(b - origin) / 2.0;
            next.extend(edges[i].iter().filter_map(|corner| at.get(corner)).flatten().filter(|i| !seen[**i]));
        }
        if length > 0.0 {
            found.push(Opening { width: 2.0 * area.length() / length, length, place: origin });
        }
    }
    found.sort_by(|a, b| b.width.total_cmp(&a.width));
    found
}

/// Diagonal of the bounding box of a loop.
fn extent(mesh: &Mesh, corners: &[u32]) -> f64 {
    let places = || corners.iter().map(|&corner| mesh.vertices[corner as usize]);
    let (low, high) = (places().reduce(DVec3::min), places().reduce(DVec3::max));
    low.zip(high).map_or(0.0, |(low, high)| low.distance(high))
}

/// The triangulation of a loop with the least area, from the least area that closes the loop between each pair of its
/// corners.
fn least_area(mesh: &Mesh, corners: &[u32]) -> Vec<[u32; 3]> {
    let count = corners.len();
    let place = |k: usize| mesh.vertices[corners[k] as usize];
    let area = |i: usize, m: usize, k: usize| (place(m) - place(i)).cross(place(k) - place(i)).length() / 2.0;
    let mut least = vec![vec![(0.0_f64, 0_usize); count]; count];
    for span in 2..count {
        for i in 0..count - span {
            let k = i + span;
            let choices = (i + 1..k).map(|m| (least[i][m].0 + least[m][k].0 + area(i, m, k), m));
            least[i][k] = choices.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or_default();
        }
    }
    let (mut cover, mut open) = (Vec::with_capacity(count - 2), vec![(0, count - 1)]);
    while let Some((i, k)) = open.pop() {
        if k - i < 2 {
            continue;
        }
        let m = least[i][k].1;
        cover.push([i, m, k].map(|corner| corners[corner]));
        open.extend([(i, m), (m, k)]);
    }
    cover
}
