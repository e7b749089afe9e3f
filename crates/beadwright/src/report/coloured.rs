//! A surface in several colours, for [`Sheet::coloured`](super::sheet::Sheet::coloured).
//!
//! Its data is base64 of a deflated body, all numbers little-endian: the number of nodes and of corners of triangles (u32); where
//! the nodes are (f32, x y z); the corners of the triangles (u32); the colours of the nodes (u8, red green blue).

use super::encode::deflated;
use crate::model::{Mesh, cut::compact};
use crate::palette::Rgb;
use glam::DVec3;

/// Surfaces, each in a colour of its own.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Coloured {
    nodes: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    colours: Vec<Rgb>,
    pub(super) key: Vec<(String, Rgb)>,
}

impl Coloured {
    /// Adds a surface, by this name in the key.
    pub fn add(&mut self, name: &str, mesh: &Mesh, colour: Rgb) {
        let first = self.nodes.len() as u32;
        let (nodes, triangles) = compact(&mesh.vertices, &mesh.triangles);
        self.nodes.extend(nodes);
        self.triangles.extend(triangles.iter().map(|corners| corners.map(|corner| corner + first)));
        self.colours.resize(self.nodes.len(), colour);
        self.key.push((name.to_owned(), colour));
    }

    /// Its data as text.
    pub(super) fn encoded(&self) -> String {
        let counts = [self.nodes.len(), 3 * self.triangles.len()].map(|count| count as u32);
        let floats = self.nodes.iter().flat_map(|p| p.to_array()).flat_map(|v| (v as f32).to_le_bytes());
        let corners = self.triangles.iter().flatten().flat_map(|corner| corner.to_le_bytes());
        let bytes = counts.iter().flat_map(|count| count.to_le_bytes()).chain(floats).chain(corners);
        deflated(&bytes.chain(self.colours.iter().copied().flatten()).collect::<Vec<u8>>())
    }
}
