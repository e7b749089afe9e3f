//! A body that bends, for [`Sheet::bent`](super::sheet::Sheet::bent).
//!
//! Its data is base64 of a deflated body, all numbers little-endian: the number of nodes, of shapes and of corners of
//! triangles (u32); where the nodes are (f32, x y z), then for each shape how far each of them moves; the corners of the
//! triangles (u32).

use super::encode::deflated;
use glam::DVec3;

/// A surface of triangles, and shapes to which it bends.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Bent {
    /// Where its nodes are, mm.
    pub nodes: Vec<DVec3>,
    /// Its triangles, by index of their nodes.
    pub triangles: Vec<[u32; 3]>,
    /// Names of the shapes, each with how far every node moves, mm.
    pub shapes: Vec<(String, Vec<DVec3>)>,
}

impl Bent {
    /// Its data as text.
    pub(super) fn encoded(&self) -> String {
        let counts = [self.nodes.len(), self.shapes.len(), 3 * self.triangles.len()].map(|count| count as u32);
        let places = self.shapes.iter().flat_map(|(_, moved)| moved);
        let floats = self.nodes.iter().chain(places).flat_map(|p| p.to_array()).flat_map(|v| (v as f32).to_le_bytes());
        let corners = self.triangles.iter().flatten().flat_map(|corner| corner.to_le_bytes());
        let bytes: Vec<u8> = counts.iter().flat_map(|count| count.to_le_bytes()).chain(floats).chain(corners).collect();
        deflated(&bytes)
    }
}
