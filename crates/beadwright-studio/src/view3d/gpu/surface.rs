//! The model as triangles.

use super::globals::role;
use beadwright::model::{Mesh, NO_NEIGHBOUR};
use eframe::egui_wgpu::wgpu::{self, util::DeviceExt as _};
use glam::DVec3;

/// Edges whose faces meet at a smaller angle are not drawn: 30°.
const SMOOTH_COS: f64 = 0.866;

/// The model on the graphics card.
#[derive(Debug)]
pub(super) struct Surface {
    pub vertices: wgpu::Buffer,
    pub indices: wgpu::Buffer,
    pub count: u32,
    pub edges: wgpu::Buffer,
    pub edge_vertices: u32,
}

impl Surface {
    /// Sends a model; `None` where it has no triangles or is too large for a buffer.
    pub(super) fn new(device: &wgpu::Device, mesh: &Mesh) -> Option<Self> {
        let vertices: Vec<[f32; 3]> = mesh.vertices.iter().map(|v| v.as_vec3().into()).collect();
        let edges = edges(mesh);
        let sizes = [size_of_val(&vertices[..]), size_of_val(&mesh.triangles[..]), size_of_val(&edges[..])];
        if mesh.triangles.is_empty() || sizes.iter().any(|&size| size as u64 > device.limits().max_buffer_size) {
            return None;
        }
        let buffer = |label: &str, contents: &[u8], usage: wgpu::BufferUsages| {
            device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: Some(label), contents, usage })
        };
        Some(Self {
            vertices: buffer("model", bytemuck::cast_slice(&vertices), wgpu::BufferUsages::VERTEX),
            indices: buffer("triangles", bytemuck::cast_slice(&mesh.triangles), wgpu::BufferUsages::INDEX),
            count: mesh.triangles.len() as u32 * 3,
            edge_vertices: edges.len() as u32,
            // A buffer must not be empty.
            edges: buffer("edges", bytemuck::cast_slice(&[edges, vec![[0; 4]]].concat()), wgpu::BufferUsages::VERTEX),
        })
    }
}

/// The ends of the sharp edges of the surface, as points of lines.
fn edges(mesh: &Mesh) -> Vec<[u32; 4]> {
    let corner = |i: u32| mesh.vertices.get(i as usize).copied().unwrap_or_default();
    let normal = |t: &[u32; 3]| {
        let [a, b, c] = t.map(corner);
        (b - a).cross(c - a).normalize_or_zero()
    };
    let normals: Vec<DVec3> = mesh.triangles.iter().map(normal).collect();
    let mut ends = Vec::new();
    for (t, (triangle, neighbours)) in mesh.triangles.iter().zip(&mesh.neighbours).enumerate() {
        for side in 0..3 {
            let across = neighbours[side];
            let open = across == NO_NEIGHBOUR;
            let sharp = || normals.get(across as usize).is_some_and(|n| n.dot(normals[t]) < SMOOTH_COS);
            if open || (t < across as usize && sharp()) {
                for i in [triangle[side], triangle[(side + 1) % 3]] {
                    let [x, y, z] = corner(i).as_vec3().to_array().map(f32::to_bits);
                    ends.push([x, y, z, role::EDGE]);
                }
            }
        }
    }
    ends
}
