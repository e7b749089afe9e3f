//! What has a colour of its own at each of its points, on the graphics card: a scan, as triangles or, where it has none, as
//! points; the bodies of the part; the bent plate.

use super::pipelines::Pipelines;
use crate::view3d::scanned::Scanned;
use eframe::egui_wgpu::wgpu::{self, util::DeviceExt as _};

/// Coloured points on the graphics card, and the triangles between them.
#[derive(Debug)]
pub(super) struct Scan {
    points: wgpu::Buffer,
    count: u32,
    /// Corners of the triangles, with their number.
    triangles: Option<(wgpu::Buffer, u32)>,
}

impl Scan {
    /// Sends points, each with its place in the colour map, and the triangles between them; `None` where they are too large for
    /// a buffer.
    pub(super) fn new(device: &wgpu::Device, coloured: &[[f32; 4]], corners: &[[u32; 3]]) -> Option<Self> {
        let (points, triangles) = (bytemuck::cast_slice(coloured), bytemuck::cast_slice(corners));
        if points.len().max(triangles.len()) as u64 > device.limits().max_buffer_size {
            return None;
        }
        let buffer = |label: &str, contents: &[u8], usage: wgpu::BufferUsages| {
            device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: Some(label), contents, usage })
        };
        let indices = || buffer("triangles between coloured points", triangles, wgpu::BufferUsages::INDEX);
        Some(Self {
            points: buffer("coloured points", points, wgpu::BufferUsages::VERTEX),
            count: coloured.len() as u32,
            triangles: (!triangles.is_empty()).then(|| (indices(), corners.len() as u32 * 3)),
        })
    }

    /// Draws it in the colours that are bound.
    pub(super) fn draw(&self, pass: &mut wgpu::RenderPass<'_>, pipelines: &Pipelines) {
        match &self.triangles {
            Some((corners, count)) => {
                pass.set_pipeline(&pipelines.scan);
                pass.set_vertex_buffer(0, self.points.slice(..));
                pass.set_index_buffer(corners.slice(..), wgpu::IndexFormat::Uint32);
                pass.draw_indexed(0..*count, 0, 0..1);
            }
            None => {
                pass.set_pipeline(&pipelines.scan_point);
                pass.set_vertex_buffer(0, self.points.slice(..));
                pass.draw(0..4, 0..self.count);
            }
        }
    }
}

/// Coloured points by a colour map of their own.
#[derive(Debug)]
pub(super) struct Mapped {
    binding: wgpu::BindGroup,
    points: Option<Scan>,
    version: Option<u64>,
}

impl Mapped {
    /// Nothing yet; the colour map is bound.
    pub(super) fn new(binding: wgpu::BindGroup) -> Self {
        Self { binding, points: None, version: None }
    }

    /// Sends points where they have changed.
    pub(super) fn sync(&mut self, device: &wgpu::Device, version: u64, scanned: Option<&Scanned>) {
        if self.version != Some(version) {
            self.version = Some(version);
            self.points = scanned.and_then(|scanned| Scan::new(device, &scanned.points, &scanned.triangles));
        }
    }

    /// Whether there is anything to draw.
    pub(super) fn is_there(&self) -> bool {
        self.points.is_some()
    }

    /// Draws it, and then binds the usual colours.
    pub(super) fn draw(&self, pass: &mut wgpu::RenderPass<'_>, pipelines: &Pipelines, usual: &wgpu::BindGroup) {
        if let Some(points) = &self.points {
            pass.set_bind_group(0, &self.binding, &[]);
            points.draw(pass, pipelines);
            pass.set_bind_group(0, usual, &[]);
        }
    }
}
