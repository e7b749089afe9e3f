//! A solid cut by a level plane: the part above it, closed by a flat face.
//!
//! A vertex exactly on the plane counts as above it, for all its triangles alike, as in slicing. Where the surface has holes
//! at the plane, they stay open.

use super::{Mesh, RepairReport};
use glam::{DVec2, DVec3};
use planar::triangulate::triangulate_by_edges;
use planar::{Polygon, Ring};
use std::collections::BTreeMap;

/// The part of a mesh above the height `z` (mm), moved down to z = 0; `None` if nothing lies above.
///
/// ```
/// use bead_part::{example, model::cut};
///
/// // A cross 20 mm high, of two arms of 100 × 36 mm.
/// let cross = example::find("cross").ok_or("no such example")?.mesh();
/// let (rest, _) = cut::above(&cross, 5.0).ok_or("nothing is left")?;
/// let area = 2.0 * 100.0 * 36.0 - 36.0 * 36.0;
/// assert!((rest.volume() - area * 15.0).abs() < 1e-3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn above(mesh: &Mesh, z: f64) -> Option<(Mesh, RepairReport)> {
    let mut cut = Cut { mesh, z, vertices: mesh.vertices.clone(), crossings: BTreeMap::new(), rim: BTreeMap::new() };
    let mut triangles: Vec<[u32; 3]> = Vec::with_capacity(mesh.triangles.len());
    for triangle in &mesh.triangles {
        cut.clip(triangle, &mut triangles);
    }
    let rings = cut.rings();
    for (outer, holes) in nested(&rings, &cut.vertices) {
        let corners: Vec<u32> = std::iter::once(outer).chain(holes.iter().copied()).flatten().copied().collect();
        let ring = |ring: &[u32]| Ring::new(places(ring, &cut.vertices));
        let face = Polygon { outer: ring(outer), holes: holes.iter().map(|hole| ring(hole)).collect() };
        // Wound counter-clockwise seen from below.
        triangles.extend(triangulate_by_edges(&face).into_iter().map(|[a, b, c]| [a, c, b].map(|i| corners[i])));
    }
    let floor = |vertices: Vec<DVec3>| vertices.into_iter().map(|v| v - DVec3::Z * z).collect();
    let (vertices, triangles) = compact(&cut.vertices, &triangles);
    (!triangles.is_empty()).then(|| Mesh::from_triangles(floor(vertices), triangles))
}

struct Cut<'a> {
    mesh: &'a Mesh,
    z: f64,
    vertices: Vec<DVec3>,
    /// The vertex on each edge that the plane cuts, by the edge's ends.
    crossings: BTreeMap<[u32; 2], u32>,
    /// The edges of the closing face: for each start, its ends.
    rim: BTreeMap<u32, Vec<u32>>,
}

impl Cut<'_> {
    fn is_above(&self, vertex: u32) -> bool {
        self.mesh.vertices[vertex as usize].z >= self.z
    }

    /// Adds the part of a triangle that lies above.
    fn clip(&mut self, triangle: &[u32; 3], kept: &mut Vec<[u32; 3]>) {
        let (mut corners, mut leaves, mut enters) = (Vec::with_capacity(4), None, None);
        for k in 0..3 {
            let (a, b) = (triangle[k], triangle[(k + 1) % 3]);
            let above = [a, b].map(|vertex| self.is_above(vertex));
            if above[0] {
                corners.push(a);
            }
            if above[0] != above[1] {
                let crossing = self.crossing(a, b);
                corners.push(crossing);
                *if above[0] { &mut leaves } else { &mut enters } = Some(crossing);
            }
        }
        corners.dedup();
        if corners.first() == corners.last() {
            corners.pop();
        }
        kept.extend((2..corners.len()).map(|k| [corners[0], corners[k - 1], corners[k]]));
        if let (Some(leaves), Some(enters)) = (leaves, enters)
            && leaves != enters
        {
            self.rim.entry(enters).or_default().push(leaves);
        }
    }

    /// The vertex where the plane cuts an edge.
    fn crossing(&mut self, a: u32, b: u32) -> u32 {
        let [low, high] = if self.is_above(a) { [b, a] } else { [a, b] };
        let [below, above] = [low, high].map(|vertex| self.mesh.vertices[vertex as usize]);
        if above.z == self.z {
            return high;
        }
        *self.crossings.entry([low, high]).or_insert_with(|| {
            let at = below.lerp(above, (self.z - below.z) / (above.z - below.z));
            self.vertices.push(at.with_z(self.z));
            self.vertices.len() as u32 - 1
        })
    }

    /// The closed rings of the rim, with the face on their left seen from above.
    fn rings(&mut self) -> Vec<Vec<u32>> {
        let mut rings = Vec::new();
        while let Some((&first, _)) = self.rim.first_key_value() {
            let mut ring = vec![first];
            let mut at = first;
            while let Some(next) = self.leave(at) {
                if next == first {
                    // Seen from below they run counter-clockwise.
                    ring.reverse();
                    rings.push(ring);
                    break;
                }
                ring.push(next);
                at = next;
            }
        }
        rings
    }

    fn leave(&mut self, at: u32) -> Option<u32> {
        let ends = self.rim.get_mut(&at)?;
        let next = ends.pop();
        if ends.is_empty() {
            self.rim.remove(&at);
        }
        next
    }
}

fn places(ring: &[u32], vertices: &[DVec3]) -> Vec<DVec2> {
    ring.iter().map(|&i| vertices[i as usize].truncate()).collect()
}

/// Rings with the holes in them: each hole belongs to the smallest ring around it.
fn nested<'r>(rings: &'r [Vec<u32>], vertices: &[DVec3]) -> Vec<(&'r [u32], Vec<&'r [u32]>)> {
    let shapes: Vec<Ring> = rings.iter().map(|ring| Ring::new(places(ring, vertices))).collect();
    let mut outers: Vec<usize> = (0..rings.len()).filter(|&i| shapes[i].area() > 0.0).collect();
    outers.sort_by(|&a, &b| shapes[a].area().total_cmp(&shapes[b].area()).then(a.cmp(&b)));
    let mut faces: Vec<(&[u32], Vec<&[u32]>)> = outers.iter().map(|&i| (&rings[i][..], Vec::new())).collect();
    for (hole, shape) in rings.iter().zip(&shapes).filter(|(_, shape)| shape.area() < 0.0) {
        let around = |&outer: &usize| shape.points().iter().filter(|p| shapes[outer].contains(**p)).count() * 2;
        let inside = outers.iter().position(|outer| around(outer) > shape.points().len());
        inside.into_iter().for_each(|k| faces[k].1.push(hole));
    }
    faces
}

/// The vertices that triangles use, and the triangles with their new numbers.
fn compact(vertices: &[DVec3], triangles: &[[u32; 3]]) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let mut numbers = vec![None; vertices.len()];
    let mut kept = Vec::new();
    let mut number = |i: u32| {
        *numbers[i as usize].get_or_insert_with(|| {
            kept.push(vertices[i as usize]);
            kept.len() as u32 - 1
        })
    };
    let triangles = triangles.iter().map(|t| t.map(&mut number)).collect();
    (kept, triangles)
}
