//! A scan on the graphics card: its triangles, or its points where it has none.

use super::pipelines::Pipelines;
use crate::view3d::scanned::Scanned;
use eframe::egui_wgpu::wgpu::{self, util::DeviceExt as _};

/// A scan on the graphics card.
#[derive(Debug)]
pub(super) struct Scan {
    points: wgpu::Buffer,
    count: u32,
    /// Corners of the triangles, with their number.
    triangles: Option<(wgpu::Buffer, u32)>,
}

impl Scan {
    /// Sends a scan; `None` where it is too large for a buffer.
    pub(super) fn new(device: &wgpu::Device, scan: &Scanned) -> Option<Self> {
        let (points, triangles) = (bytemuck::cast_slice(&scan.points), bytemuck::cast_slice(&scan.triangles));
        if points.len().max(triangles.len()) as u64 > device.limits().max_buffer_size {
            return None;
        }
        let buffer = |label: &str, contents: &[u8], usage: wgpu::BufferUsages| {
            device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: Some(label), contents, usage })
        };
        let indices = || buffer("triangles of the scan", triangles, wgpu::BufferUsages::INDEX);
        Some(Self {
            points: buffer("scan", points, wgpu::BufferUsages::VERTEX),
            count: scan.points.len() as u32,
            triangles: (!triangles.is_empty()).then(|| (indices(), scan.triangles.len() as u32 * 3)),
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
