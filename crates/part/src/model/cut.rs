//! A solid cut by a level plane, or by another surface: the part above it, closed by a face along the cut.
//!
//! A vertex exactly on the cut counts as above it, for all its triangles alike, as in slicing. Where the surface of the solid
//! has holes at the cut, they stay open.

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
    let Pieces { vertices, mut kept, face } = pieces(mesh, &Level(z));
    kept.extend(face);
    let floor = |vertices: Vec<DVec3>| vertices.into_iter().map(|v| v - DVec3::Z * z).collect();
    let (vertices, triangles) = compact(&vertices, &kept);
    (!triangles.is_empty()).then(|| Mesh::from_triangles(floor(vertices), triangles))
}

/// A surface along which solids are cut.
pub(crate) trait Along {
    /// Whether a point lies above it, or on it.
    fn is_above(&self, p: DVec3) -> bool;

    /// Where it cuts the edge between a point below and one above.
    fn crossing(&self, below: DVec3, above: DVec3) -> DVec3;

    /// Its points side by side, seen from above.
    fn flat(&self, p: DVec3) -> DVec2;
}

/// A level plane at this height, mm.
struct Level(f64);

impl Along for Level {
    fn is_above(&self, p: DVec3) -> bool {
        p.z >= self.0
    }

    fn crossing(&self, below: DVec3, above: DVec3) -> DVec3 {
        below.lerp(above, (self.0 - below.z) / (above.z - below.z)).with_z(self.0)
    }

    fn flat(&self, p: DVec3) -> DVec2 {
        p.truncate()
    }
}

/// What lies above a cut.
pub(crate) struct Pieces {
    /// The vertices of the solid, then those on the cut.
    pub(crate) vertices: Vec<DVec3>,
    /// Triangles of the solid's surface.
    pub(crate) kept: Vec<[u32; 3]>,
    /// Triangles along the cut, that close it.
    pub(crate) face: Vec<[u32; 3]>,
}

/// Cuts a solid along a surface.
pub(crate) fn pieces(mesh: &Mesh, along: &dyn Along) -> Pieces {
    let vertices = mesh.vertices.clone();
    let is_above = vertices.iter().map(|p| along.is_above(*p)).collect();
    let mut cut = Cut { along, vertices, is_above, crossings: BTreeMap::new(), rim: BTreeMap::new() };
    let (mut kept, mut face) = (Vec::with_capacity(mesh.triangles.len()), Vec::new());
    for triangle in &mesh.triangles {
        cut.clip(triangle, &mut kept);
    }
    let rings = cut.rings();
    let places = |ring: &[u32]| -> Vec<DVec2> { ring.iter().map(|&i| along.flat(cut.vertices[i as usize])).collect() };
    for (outer, holes) in nested(&rings, &places) {
        let corners: Vec<u32> = std::iter::once(outer).chain(holes.iter().copied()).flatten().copied().collect();
        let ring = |ring: &[u32]| Ring::new(places(ring));
        let shape = Polygon { outer: ring(outer), holes: holes.iter().map(|hole| ring(hole)).collect() };
        // Wound counter-clockwise seen from below.
        face.extend(triangulate_by_edges(&shape).into_iter().map(|[a, b, c]| [a, c, b].map(|i| corners[i])));
    }
    Pieces { vertices: cut.vertices, kept, face }
}

struct Cut<'a> {
    along: &'a dyn Along,
    vertices: Vec<DVec3>,
    /// Of the vertices of the solid.
    is_above: Vec<bool>,
    /// The vertex on each edge that is cut, by the edge's ends.
    crossings: BTreeMap<[u32; 2], u32>,
    /// The edges of the closing face: for each start, its ends.
    rim: BTreeMap<u32, Vec<u32>>,
}

impl Cut<'_> {
    fn is_above(&self, vertex: u32) -> bool {
        self.is_above[vertex as usize]
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

    /// The vertex where an edge is cut.
    fn crossing(&mut self, a: u32, b: u32) -> u32 {
        let [low, high] = if self.is_above(a) { [b, a] } else { [a, b] };
        let [below, above] = [low, high].map(|vertex| self.vertices[vertex as usize]);
        let at = self.along.crossing(below, above);
        if at == above {
            return high;
        }
        *self.crossings.entry([low, high]).or_insert_with(|| {
            self.vertices.push(at);
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

/// Rings with the holes in them: each hole belongs to the smallest ring around it.
fn nested<'r>(rings: &'r [Vec<u32>], places: &dyn Fn(&[u32]) -> Vec<DVec2>) -> Vec<(&'r [u32], Vec<&'r [u32]>)> {
    let shapes: Vec<Ring> = rings.iter().map(|ring| Ring::new(places(ring))).collect();
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
pub fn compact(vertices: &[DVec3], triangles: &[[u32; 3]]) -> (Vec<DVec3>, Vec<[u32; 3]>) {
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
