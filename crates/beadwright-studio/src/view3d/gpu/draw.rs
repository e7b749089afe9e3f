//! One picture: what is drawn, and in which order.

use super::chunks::{Chunk, Ranges};
use super::pipelines::Pipelines;
use super::surface::Surface;
use super::target::Target;
use super::{Gpu, Quality, background};
use crate::view3d::beads::Bead;
use crate::view3d::pick::Pick;
use crate::view3d::scene::Scene;
use crate::view3d::style::{Colour, Style};
use eframe::egui_wgpu::wgpu;

/// Everything a picture is made from.
pub(super) struct Shot<'a> {
    pub gpu: &'a Gpu,
    pub pipelines: &'a Pipelines,
    pub scene: &'a Scene,
    pub style: &'a Style,
    pub quality: Quality,
    pub from_above: bool,
    pub solid_vertices: u32,
}

impl Shot<'_> {
    /// Draws solid things first, then what is blended over them.
    pub(super) fn draw(&self, pass: &mut wgpu::RenderPass<'_>) {
        let Self { gpu, pipelines, scene, style, quality, .. } = *self;
        let mut drawn: Vec<(&Chunk, Ranges)> =
            gpu.chunks.iter().map(|chunk| (chunk, chunk.ranges(scene, style, quality.every))).collect();
        if self.from_above {
            // Drawing hidden beads first would shade them for nothing, so the top layers come first.
            drawn.reverse();
            for (_, ranges) in &mut drawn {
                ranges.beads.reverse();
                ranges.rough.reverse();
            }
        }
        let any_bead = style.beads && drawn.iter().any(|(_, r)| !r.beads.is_empty());
        let surface = gpu.surface.as_ref().filter(|_| style.mesh);
        let coloured = [(&gpu.pieces, style.pieces), (&gpu.scan, style.scan)];
        let scan = coloured.into_iter().find(|(mapped, shown)| *shown && mapped.is_there()).map(|(mapped, _)| mapped);
        if let Some(surface) = surface.filter(|_| !any_bead && scan.is_none()) {
            draw_surface(pass, &pipelines.opaque, surface);
        }
        if let Some(scan) = scan {
            scan.draw(pass, pipelines, &gpu.bindings[0]);
        }
        if let Some(plate) = gpu.bent_plate.as_ref().filter(|_| style.bent) {
            plate.draw(pass, pipelines);
        }
        if style.beads {
            drawn
                .iter()
                .for_each(|(chunk, range)| draw_beads(pass, pipelines, gpu.fan(quality), chunk, range, quality));
            self.draw_highlight(pass);
        }
        if let Some(solids) = gpu.solids.from(0).filter(|_| self.solid_vertices > 0) {
            pass.set_pipeline(&pipelines.solid);
            pass.set_vertex_buffer(0, solids);
            pass.draw(0..self.solid_vertices, 0..1);
        }
        for (chunk, range) in &drawn {
            draw_points(pass, &pipelines.dot, chunk.dots.from(0).filter(|_| style.starts), 0..4, range.dots.clone());
            let travels = chunk.travels.from(0).filter(|_| style.travels);
            draw_points(pass, &pipelines.line, travels, range.travels.clone(), 0..1);
        }
        pass.set_pipeline(if style.floor.is_some() { &pipelines.floor } else { &pipelines.ground });
        pass.draw(0..4, 0..1);
        if let Some(surface) = surface {
            // Glass would tint the colours of a scan or a movement.
            if any_bead && scan.is_none() && style.colour != Colour::Movement {
                draw_surface(pass, &pipelines.glass, surface);
            }
            draw_points(pass, &pipelines.line, Some(surface.edges.slice(..)), 0..surface.edge_vertices, 0..1);
        }
    }

    /// Draws the highlighted pass and its segment again over themselves, in the highlight colour.
    fn draw_highlight(&self, pass: &mut wgpu::RenderPass<'_>) {
        let Self { gpu, pipelines, scene, style, quality, .. } = *self;
        let Some(Pick { layer, pass: number, segment }) = style.highlight else { return };
        let Some(beads) = scene.drawn_layer(layer) else { return };
        let Some(span) = beads.passes().get(number) else { return };
        let shown = style.shown(layer, beads.len());
        for (look, segments) in [(1, span.segments.clone()), (2, beads.segments_of(beads.piece(segment)))] {
            let segments = segments.start.min(shown)..segments.end.min(shown);
            pass.set_bind_group(0, &gpu.bindings[look], &[]);
            for chunk in &gpu.chunks {
                if let Some(ranges) = chunk.place(beads, layer, segments.clone()) {
                    draw_beads(pass, pipelines, gpu.fan(quality), chunk, &ranges, quality);
                }
            }
        }
        pass.set_bind_group(0, &gpu.bindings[0], &[]);
    }
}

fn draw_beads(
    pass: &mut wgpu::RenderPass<'_>,
    pipelines: &Pipelines,
    fan: &(wgpu::Buffer, u32),
    chunk: &Chunk,
    ranges: &Ranges,
    quality: Quality,
) {
    const BEAD: u64 = size_of::<Bead>() as u64;
    let (buffer, values, pieces) = if quality.exact {
        (&chunk.beads, &chunk.bead_values, &ranges.beads)
    } else {
        (&chunk.rough, &chunk.rough_values, &ranges.rough)
    };
    if let (Some(before), Some(here), Some(values)) = (buffer.from(0), buffer.from(BEAD), values.from(0))
        && pieces.iter().any(|beads| !beads.is_empty())
    {
        pass.set_pipeline(&pipelines.ribbon);
        pass.set_vertex_buffer(0, here);
        pass.set_vertex_buffer(1, before);
        pass.set_vertex_buffer(2, here.buffer().slice(2 * BEAD..));
        pass.set_vertex_buffer(3, values);
        for beads in pieces {
            pass.draw(0..2 * (quality.strips + 1), beads.clone());
        }
        if pipelines.cut {
            pass.set_pipeline(&pipelines.face);
            pieces.iter().for_each(|beads| pass.draw(0..4, beads.clone()));
        }
    }
    if let (Some(caps), Some(values)) = (chunk.caps.from(0), chunk.cap_values.from(0))
        && quality.caps
        && !ranges.caps.is_empty()
    {
        pass.set_pipeline(&pipelines.cap);
        pass.set_vertex_buffer(0, caps);
        pass.set_vertex_buffer(1, values);
        pass.set_index_buffer(fan.0.slice(..), wgpu::IndexFormat::Uint16);
        pass.draw_indexed(0..fan.1, 0, ranges.caps.clone());
    }
}

fn draw_surface(pass: &mut wgpu::RenderPass<'_>, pipeline: &wgpu::RenderPipeline, surface: &Surface) {
    pass.set_pipeline(pipeline);
    pass.set_vertex_buffer(0, surface.vertices.slice(..));
    pass.set_index_buffer(surface.indices.slice(..), wgpu::IndexFormat::Uint32);
    pass.draw_indexed(0..surface.count, 0, 0..1);
}

fn draw_points(
    pass: &mut wgpu::RenderPass<'_>,
    pipeline: &wgpu::RenderPipeline,
    points: Option<wgpu::BufferSlice<'_>>,
    vertices: std::ops::Range<u32>,
    instances: std::ops::Range<u32>,
) {
    if let Some(points) = points.filter(|_| !vertices.is_empty() && !instances.is_empty()) {
        pass.set_pipeline(pipeline);
        pass.set_vertex_buffer(0, points);
        pass.draw(vertices, instances);
    }
}

/// The picture, cleared to the background colour.
pub(super) fn colour(target: &Target, dark: bool) -> wgpu::RenderPassColorAttachment<'_> {
    let [r, g, b] = background(dark).map(|c| f64::from(c) / 255.0);
    wgpu::RenderPassColorAttachment {
        view: target.many.as_ref().unwrap_or(&target.view),
        depth_slice: None,
        resolve_target: target.many.as_ref().map(|_| &target.view),
        ops: wgpu::Operations {
            load: wgpu::LoadOp::Clear(wgpu::Color { r, g, b, a: 1.0 }),
            store: if target.many.is_some() { wgpu::StoreOp::Discard } else { wgpu::StoreOp::Store },
        },
    }
}

/// The depths, cleared to the farthest.
pub(super) fn depth(target: &Target) -> wgpu::RenderPassDepthStencilAttachment<'_> {
    let ops = wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Discard };
    wgpu::RenderPassDepthStencilAttachment { view: &target.depth, depth_ops: Some(ops), stencil_ops: None }
}
