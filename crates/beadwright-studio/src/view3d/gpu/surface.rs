//! The model and the torch as triangles.

use super::chunks::Point;
use super::globals::role;
use beadwright::model::{Mesh, NO_NEIGHBOUR};
use eframe::egui_wgpu::wgpu::{self, util::DeviceExt as _};
use glam::{DVec3, Vec3};

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

/// The ends of the sharp edges of the surface, as [`Point`]s.
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

/// A torch pointing down with its tip at a given place, mm, as triangles.
pub(super) fn torch(tip: DVec3) -> Vec<Point> {
    /// Height above the tip and radius, mm: the wire, the gas nozzle, the neck.
    const PROFILE: [(f32, f32, u32); 6] = [
        (0.0, 0.6, role::NOZZLE),
        (12.0, 0.6, role::NOZZLE),
        (12.0, 7.0, role::NOZZLE),
        (30.0, 9.5, role::TORCH),
        (75.0, 9.5, role::TORCH),
        (75.0, 0.0, role::TORCH),
    ];
    const SIDES: usize = 20;
    let at = |i: usize, (height, radius, _): (f32, f32, u32)| {
        let (sin, cos) = (i as f32 * std::f32::consts::TAU / SIDES as f32).sin_cos();
        tip.as_vec3() + Vec3::new(radius * cos, radius * sin, height)
    };
    let mut points = Vec::with_capacity(SIDES * 6 * (PROFILE.len() - 1));
    for ring in PROFILE.windows(2) {
        for i in 0..SIDES {
            let [a, b, c, d] = [at(i, ring[0]), at(i + 1, ring[0]), at(i, ring[1]), at(i + 1, ring[1])];
            points.extend([a, b, c, b, d, c].map(|v| Point { at: v.into(), role: ring[0].2 }));
        }
    }
    points
}
