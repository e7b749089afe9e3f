//! Finds faults in a mesh and repairs those that need no guess: nothing moves by more than the width of a crack.
//!
//! 1. degenerate triangles are removed;
//! 2. vertices on open edges that lie within 1e-5 of the part's diagonal are merged (cracks from rounding);
//! 3. duplicate triangles are removed;
//! 4. triangles are turned to agree with their neighbours, each shell by its majority;
//! 5. a mesh that is inside out as a whole is turned over.

use super::Mesh;
use super::adjacency::{Adjacency, HalfEdge, ends};
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::collections::{HashMap, HashSet};

/// Vertices on open edges closer than this fraction of the diagonal are one.
const CRACK: f64 = 1e-5;

/// What was found in a mesh and what was done about it.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct RepairReport {
    /// Why the file does not hold what it says, where a damaged file was accepted.
    pub damage: Option<String>,
    /// Bytes after the last triangle, which some programs append; passed over.
    pub appended_bytes: usize,
    /// Triangles in the file.
    pub triangles_read: usize,
    /// Triangles that remain.
    pub triangles: usize,
    /// Vertices that remain.
    pub vertices: usize,
    /// Triangles without an area, removed.
    pub degenerate: usize,
    /// Duplicate triangles, removed.
    pub duplicate: usize,
    /// Vertices moved onto a neighbour to close a crack.
    pub vertices_merged: usize,
    /// Edges with a triangle on one side only: holes in the surface.
    pub open_edges: usize,
    /// Edges shared by three or more triangles.
    pub non_manifold_edges: usize,
    /// Triangles wound against their neighbours, turned.
    pub flipped: usize,
    /// Whether the whole mesh was inside out and was turned over.
    pub inside_out: bool,
    /// Stored normals that point against the winding of their triangle; the winding counts.
    pub normals_against_winding: usize,
    /// Connected surfaces.
    pub shells: usize,
}

impl RepairReport {
    /// Whether the mesh is closed and nothing had to be repaired.
    pub fn is_clean(&self) -> bool {
        let mended = self.degenerate + self.duplicate + self.vertices_merged + self.flipped;
        mended + self.open_edges + self.non_manifold_edges + self.normals_against_winding == 0
            && !self.inside_out
            && self.damage.is_none()
    }

    /// The faults as sentences; empty when the mesh is clean.
    ///
    /// ```
    /// use bead_part::model::Mesh;
    /// use glam::DVec3;
    ///
    /// // A tetrahedron without its slanted face.
    /// let corners = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    /// let (_, report) = Mesh::from_triangles(corners, vec![[0, 2, 1], [0, 1, 3], [2, 0, 3]]);
    /// assert_eq!(report.sentences(), ["3 open edges: the surface has holes."]);
    /// ```
    pub fn sentences(&self) -> Vec<String> {
        let plural = |n: usize, one: &str, many: &str| format!("{n} {}", if n == 1 { one } else { many });
        let mut lines: Vec<String> =
            self.damage.iter().map(|what| format!("The file is damaged and was read as it is: {what}.")).collect();
        let mut say = |n: usize, one: &str, many: &str, tail: &str| {
            if n > 0 {
                lines.push(format!("{}{tail}.", plural(n, one, many)));
            }
        };
        say(self.appended_bytes, "byte", "bytes", " after the last triangle passed over");
        say(self.degenerate, "triangle", "triangles", " without an area removed");
        say(self.duplicate, "duplicate triangle", "duplicate triangles", " removed");
        say(self.vertices_merged, "vertex", "vertices", " merged to close cracks");
        say(self.flipped, "triangle", "triangles", " with the wrong winding turned over");
        say(self.normals_against_winding, "stored normal", "stored normals", " against the winding ignored");
        say(self.open_edges, "open edge", "open edges", ": the surface has holes");
        say(self.non_manifold_edges, "edge", "edges", " shared by three or more triangles");
        if self.inside_out {
            lines.push("The mesh was inside out and was turned over.".to_owned());
        }
        lines
    }
}

/// Repairs a mesh and reports what was done.
pub(crate) fn mend(vertices: Vec<DVec3>, triangles: Vec<[u32; 3]>) -> (Mesh, RepairReport) {
    let mut report = RepairReport { triangles_read: triangles.len(), ..RepairReport::default() };
    let mut mesh = Mesh { vertices, triangles, neighbours: Vec::new() };
    report.degenerate += drop_degenerate(&mut mesh);
    let mut adjacency = Adjacency::new(mesh.vertices.len(), &mesh.triangles);
    if !adjacency.odd_edges.is_empty() {
        adjacency = mend_edges(&mut mesh, adjacency, &mut report);
    }
    report.shells = turn_to_majority(&mut mesh, &mut adjacency, &mut report.flipped);
    for edge in &adjacency.odd_edges {
        let forward = edge.iter().filter(|h| h.forward).count();
        report.open_edges += usize::from(forward * 2 != edge.len());
        report.non_manifold_edges += usize::from(edge.len() > 2);
    }
    mesh.neighbours = adjacency.neighbours;
    if report.degenerate + report.duplicate + report.vertices_merged > 0 {
        drop_unused_vertices(&mut mesh);
    }
    if mesh.volume() < 0.0 {
        report.inside_out = true;
        mesh.triangles.iter_mut().zip(&mut mesh.neighbours).for_each(|(t, n)| turn(t, n));
    }
    report.triangles = mesh.triangles.len();
    report.vertices = mesh.vertices.len();
    (mesh, report)
}

/// Reverses one triangle, its neighbours with it.
fn turn(triangle: &mut [u32; 3], neighbours: &mut [u32; 3]) {
    triangle.swap(1, 2);
    neighbours.swap(0, 2);
}

/// Drops vertices that no triangle uses and keeps the others in order, so that bounds are those of the surface.
fn drop_unused_vertices(mesh: &mut Mesh) {
    let mut used: Vec<u32> = mesh.triangles.as_flattened().to_vec();
    used.sort_unstable();
    used.dedup();
    let mut new_index = vec![0; mesh.vertices.len()];
    for (new, &old) in used.iter().enumerate() {
        new_index[old as usize] = new as u32;
    }
    mesh.vertices = used.iter().map(|&v| mesh.vertices[v as usize]).collect();
    mesh.triangles.as_flattened_mut().iter_mut().for_each(|v| *v = new_index[*v as usize]);
}

fn drop_degenerate(mesh: &mut Mesh) -> usize {
    let before = mesh.triangles.len();
    mesh.triangles.retain(|&[a, b, c]| a != b && b != c && c != a);
    before - mesh.triangles.len()
}

/// The rare path: cracks and duplicates.
fn mend_edges(mesh: &mut Mesh, mut adjacency: Adjacency, report: &mut RepairReport) -> Adjacency {
    let merged = merge_cracks(mesh, &adjacency.odd_edges);
    if merged > 0 {
        report.vertices_merged = merged;
        report.degenerate += drop_degenerate(mesh);
        adjacency = Adjacency::new(mesh.vertices.len(), &mesh.triangles);
    }
    report.duplicate = drop_duplicates(mesh, &adjacency.odd_edges);
    if report.duplicate > 0 {
        adjacency = Adjacency::new(mesh.vertices.len(), &mesh.triangles);
    }
    adjacency
}

/// Welds vertices of open edges that lie within the crack width of each other; returns how many moved.
fn merge_cracks(mesh: &mut Mesh, odd_edges: &[Vec<HalfEdge>]) -> usize {
    let tolerance = mesh.size().length() * CRACK;
    let open = odd_edges.iter().filter(|edge| edge.iter().filter(|h| h.forward).count() * 2 != edge.len());
    let mut border: Vec<u32> = open
        .flat_map(|edge| edge.first())
        .flat_map(|h| <[u32; 2]>::from(ends(mesh.triangles[h.triangle as usize], h.edge)))
        .collect();
    border.sort_unstable();
    border.dedup();
    let cell = |v: DVec3| (v / tolerance).floor().as_i64vec3().to_array();
    let mut cells: HashMap<[i64; 3], Vec<u32>> = HashMap::new();
    let mut target: HashMap<u32, u32> = HashMap::new();
    for &vertex in &border {
        let at = mesh.vertices[vertex as usize];
        let [x, y, z] = cell(at);
        let around = (0..27).map(|k| [x + k % 3 - 1, y + k / 3 % 3 - 1, z + k / 9 - 1]);
        let near = around
            .filter_map(|c| cells.get(&c))
            .flatten()
            .find(|&&other| mesh.vertices[other as usize].distance(at) <= tolerance);
        match near {
            Some(&other) => _ = target.insert(vertex, other),
            None => cells.entry([x, y, z]).or_default().push(vertex),
        }
    }
    if !target.is_empty() {
        for corner in mesh.triangles.iter_mut().flatten() {
            *corner = target.get(corner).copied().unwrap_or(*corner);
        }
    }
    target.len()
}

/// Removes duplicate triangles. Two faces back to back are kept when they separate two solids that touch, that is, when
/// each of their edges has further triangles in both directions.
fn drop_duplicates(mesh: &mut Mesh, odd_edges: &[Vec<HalfEdge>]) -> usize {
    let mut edges_of: HashMap<u32, usize> = HashMap::new();
    for edge in odd_edges {
        let balanced = edge.len() >= 4 && edge.iter().filter(|h| h.forward).count() * 2 == edge.len();
        for half in edge {
            *edges_of.entry(half.triangle).or_default() += usize::from(balanced);
        }
    }
    let mut suspects: Vec<u32> = edges_of.keys().copied().collect();
    suspects.sort_unstable();
    let mut seen: HashSet<[u32; 3]> = HashSet::new();
    let mut drop: HashSet<u32> = HashSet::new();
    for &t in &suspects {
        let triangle = mesh.triangles[t as usize];
        let mut key = triangle;
        key.sort_unstable();
        let separates_solids = edges_of[&t] == 3;
        // With three balanced edges, the two sides of a wall count as different faces.
        let key = if separates_solids && !even(triangle) { [key[0], key[2], key[1]] } else { key };
        if !seen.insert(key) {
            drop.insert(t);
        }
    }
    let mut index = 0;
    mesh.triangles.retain(|_| {
        index += 1;
        !drop.contains(&(index - 1))
    });
    drop.len()
}

/// Whether the corners are an even permutation of their sorted order.
fn even([a, b, c]: [u32; 3]) -> bool {
    (a < b) as u8 + ((b < c) as u8) + ((c < a) as u8) == 2
}

/// Makes neighbouring triangles agree, shell by shell; returns the number of shells.
fn turn_to_majority(mesh: &mut Mesh, adjacency: &mut Adjacency, flipped: &mut usize) -> usize {
    // Edges of two triangles in the same direction: one of the two is wrong.
    let mut against: HashMap<u32, Vec<u32>> = HashMap::new();
    for edge in &adjacency.odd_edges {
        if let [a, b] = edge[..]
            && a.forward == b.forward
        {
            against.entry(a.triangle).or_default().push(b.triangle);
            against.entry(b.triangle).or_default().push(a.triangle);
        }
    }
    let count = mesh.triangles.len();
    // One extra entry stands for "no neighbour": always visited, so the walk needs no unpredictable branch.
    let mut visited = vec![false; count + 1];
    visited[count] = true;
    let mut turned = vec![false; if against.is_empty() { 0 } else { count }];
    let (mut shells, mut any_turned) = (0, false);
    // All triangles, shell by shell; the entry at `end` is written before it is known whether it counts.
    let mut found = vec![0; count + 1];
    let mut end = 0;
    for seed in 0..count {
        if visited[seed] {
            continue;
        }
        visited[seed] = true;
        shells += 1;
        found[end] = seed as u32;
        let first = end;
        end += 1;
        let mut next = first;
        while next < end {
            let t = found[next] as usize;
            next += 1;
            for n in adjacency.neighbours[t] {
                let seen = std::mem::replace(&mut visited[count.min(n as usize)], true);
                found[end] = n;
                if !seen && !turned.is_empty() {
                    turned[n as usize] = turned[t];
                }
                end += usize::from(!seen);
            }
            for &n in against.get(&(t as u32)).into_iter().flatten() {
                if !std::mem::replace(&mut visited[n as usize], true) {
                    turned[n as usize] = !turned[t];
                    found[end] = n;
                    end += 1;
                }
            }
        }
        if !turned.is_empty() {
            let shell = &found[first..end];
            let minority = shell.iter().filter(|&&t| turned[t as usize]).count();
            let invert = minority * 2 > shell.len();
            shell.iter().for_each(|&t| turned[t as usize] ^= invert);
            any_turned |= minority > 0;
        }
    }
    if any_turned {
        for (triangle, _) in mesh.triangles.iter_mut().zip(&turned).filter(|(_, t)| **t) {
            triangle.swap(1, 2);
            *flipped += 1;
        }
        *adjacency = Adjacency::new(mesh.vertices.len(), &mesh.triangles);
    }
    shells
}
