//! How each kind of thing is drawn.

use super::chunks::{Dot, Point};
use super::target::{COLOUR, DEPTH};
use crate::view3d::beads::{Bead, Cap};
use eframe::egui_wgpu::wgpu::{self, VertexFormat, VertexStepMode};

/// The pipelines for pictures with a given number of samples per pixel, cut by a section or not.
#[derive(Debug)]
pub(super) struct Pipelines {
    pub samples: u32,
    /// Whether they cut away what lies beyond the section.
    pub cut: bool,
    pub ribbon: wgpu::RenderPipeline,
    pub cap: wgpu::RenderPipeline,
    /// Where the section cuts a bead.
    pub face: wgpu::RenderPipeline,
    pub line: wgpu::RenderPipeline,
    pub dot: wgpu::RenderPipeline,
    pub ground: wgpu::RenderPipeline,
    pub floor: wgpu::RenderPipeline,
    pub opaque: wgpu::RenderPipeline,
    pub glass: wgpu::RenderPipeline,
    pub solid: wgpu::RenderPipeline,
    pub scan: wgpu::RenderPipeline,
    /// A scan without triangles.
    pub scan_point: wgpu::RenderPipeline,
}

type Layout<'a> = Option<wgpu::VertexBufferLayout<'a>>;

/// What differs from pipeline to pipeline.
struct Recipe<'a> {
    module: &'a wgpu::ShaderModule,
    vertex: &'a str,
    fragment: &'a str,
    buffers: &'a [Layout<'a>],
    topology: wgpu::PrimitiveTopology,
    /// Whether it hides what lies behind it, instead of being blended over it.
    hides: bool,
}

const STRIP: wgpu::PrimitiveTopology = wgpu::PrimitiveTopology::TriangleStrip;
const TRIANGLES: wgpu::PrimitiveTopology = wgpu::PrimitiveTopology::TriangleList;
const LINES: wgpu::PrimitiveTopology = wgpu::PrimitiveTopology::LineList;

impl Pipelines {
    pub(super) fn new(device: &wgpu::Device, bindings: &wgpu::BindGroupLayout, samples: u32, cut: bool) -> Self {
        let module = |label, text: &'static str| {
            let source = wgpu::ShaderSource::Wgsl(text.into());
            device.create_shader_module(wgpu::ShaderModuleDescriptor { label: Some(label), source })
        };
        let beads = module(
            "beads",
            concat!(include_str!("common.wgsl"), include_str!("beads.wgsl"), include_str!("faces.wgsl")),
        );
        let marks = module("marks", concat!(include_str!("common.wgsl"), include_str!("marks.wgsl")));
        let surface = module(
            "surface",
            concat!(include_str!("common.wgsl"), include_str!("surface.wgsl"), include_str!("scan.wgsl")),
        );
        let make = |recipe: &Recipe<'_>| pipeline(device, bindings, samples, recipe);
        let lay = |module, vertex, fragment, buffers, topology, hides| {
            make(&Recipe { module, vertex, fragment, buffers, topology, hides })
        };
        let (ribbon, cap) = (ribbon_buffers(), cap_buffers());
        let (scan, scan_point) =
            ([buffer(16, VertexStepMode::Vertex, &SCAN)], [buffer(16, VertexStepMode::Instance, &SCAN)]);
        let (line, dot, plain) = (
            [buffer(size_of::<Point>(), VertexStepMode::Vertex, &POINT)],
            [buffer(size_of::<Dot>(), VertexStepMode::Instance, &DOT)],
            [buffer(12, VertexStepMode::Vertex, &PLAIN)],
        );
        // Only cut pictures pay for the section: their fragments cannot be skipped before they are shaded.
        let either = |whole, part| if cut { part } else { whole };
        let bead = either("bead", "cut_bead");
        let (line_colour, dot_colour) = (either("line_colour", "cut_line"), either("dot_colour", "cut_dot"));
        let scan_colour = either("scan_colour", "cut_scan");
        let (opaque, glass) = (either("opaque", "cut_opaque"), either("glass", "cut_glass"));
        Self {
            samples,
            cut,
            ribbon: lay(&beads, "ribbon", bead, &ribbon, STRIP, true),
            cap: lay(&beads, "cap", bead, &cap, TRIANGLES, true),
            face: lay(&beads, "face", "cut_face", &ribbon, STRIP, true),
            line: lay(&marks, "line", line_colour, &line, LINES, false),
            dot: lay(&marks, "dot_mark", dot_colour, &dot, STRIP, true),
            ground: lay(&marks, "ground", "ground_colour", &[], STRIP, false),
            floor: lay(&marks, "floor", "floor_colour", &[], STRIP, false),
            opaque: lay(&surface, "surface", opaque, &plain, TRIANGLES, true),
            glass: lay(&surface, "surface", glass, &plain, TRIANGLES, false),
            solid: lay(&surface, "solid", "opaque", &line, TRIANGLES, true),
            scan: lay(&surface, "scan", scan_colour, &scan, TRIANGLES, true),
            scan_point: lay(&surface, "scan_point", scan_colour, &scan_point, STRIP, true),
        }
    }
}

const fn attribute(format: VertexFormat, offset: u64, shader_location: u32) -> wgpu::VertexAttribute {
    wgpu::VertexAttribute { format, offset, shader_location }
}

const PLAIN: [wgpu::VertexAttribute; 1] = [attribute(VertexFormat::Float32x3, 0, 0)];
const SCAN: [wgpu::VertexAttribute; 1] = [attribute(VertexFormat::Float32x4, 0, 0)];
const POINT: [wgpu::VertexAttribute; 2] =
    [attribute(VertexFormat::Float32x3, 0, 0), attribute(VertexFormat::Uint32, 12, 1)];
const DOT: [wgpu::VertexAttribute; 3] = [
    attribute(VertexFormat::Float32x3, 0, 0),
    attribute(VertexFormat::Uint32, 12, 1),
    attribute(VertexFormat::Uint32, 16, 2),
];
const BEAD: [wgpu::VertexAttribute; 3] = [
    attribute(VertexFormat::Float32x4, 0, 0),
    attribute(VertexFormat::Float32x4, 16, 1),
    attribute(VertexFormat::Uint32, 32, 5),
];
const BEFORE: [wgpu::VertexAttribute; 2] =
    [attribute(VertexFormat::Float32x3, 0, 2), attribute(VertexFormat::Uint32, 32, 6)];
const AFTER: [wgpu::VertexAttribute; 2] =
    [attribute(VertexFormat::Float32x3, 16, 3), attribute(VertexFormat::Uint32, 32, 7)];
const BEAD_VALUE: [wgpu::VertexAttribute; 1] = [attribute(VertexFormat::Float32, 0, 4)];
const CAP: [wgpu::VertexAttribute; 3] = [
    attribute(VertexFormat::Float32x3, 0, 0),
    attribute(VertexFormat::Float32x2, 12, 1),
    attribute(VertexFormat::Uint32, 20, 3),
];
const CAP_VALUE: [wgpu::VertexAttribute; 1] = [attribute(VertexFormat::Float32, 0, 2)];

/// The same buffer of beads bound three times: the bead being drawn, the one before it and the one after it.
fn ribbon_buffers() -> [Layout<'static>; 4] {
    let bead = |attributes| buffer(size_of::<Bead>(), VertexStepMode::Instance, attributes);
    [bead(&BEAD), bead(&BEFORE), bead(&AFTER), buffer(4, VertexStepMode::Instance, &BEAD_VALUE)]
}

fn cap_buffers() -> [Layout<'static>; 2] {
    let cap = buffer(size_of::<Cap>(), VertexStepMode::Instance, &CAP);
    [cap, buffer(4, VertexStepMode::Instance, &CAP_VALUE)]
}

fn buffer(stride: usize, step_mode: VertexStepMode, attributes: &[wgpu::VertexAttribute]) -> Layout<'_> {
    Some(wgpu::VertexBufferLayout { array_stride: stride as u64, step_mode, attributes })
}

fn pipeline(
    device: &wgpu::Device,
    bindings: &wgpu::BindGroupLayout,
    samples: u32,
    recipe: &Recipe<'_>,
) -> wgpu::RenderPipeline {
    let label = Some(recipe.vertex);
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label,
        bind_group_layouts: &[Some(bindings)],
        immediate_size: 0,
    });
    let blend = (!recipe.hides).then_some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING);
    let target = wgpu::ColorTargetState { format: COLOUR, blend, write_mask: wgpu::ColorWrites::ALL };
    let compilation_options = wgpu::PipelineCompilationOptions::default();
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label,
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: recipe.module,
            entry_point: Some(recipe.vertex),
            compilation_options: compilation_options.clone(),
            buffers: recipe.buffers,
        },
        primitive: wgpu::PrimitiveState { topology: recipe.topology, ..Default::default() },
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH,
            depth_write_enabled: Some(recipe.hides),
            // Equal depths pass too: a highlighted bead is drawn again over itself.
            depth_compare: Some(wgpu::CompareFunction::GreaterEqual),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        }),
        multisample: wgpu::MultisampleState { count: samples, ..Default::default() },
        fragment: Some(wgpu::FragmentState {
            module: recipe.module,
            entry_point: Some(recipe.fragment),
            compilation_options,
            targets: &[Some(target)],
        }),
        multiview_mask: None,
        cache: None,
    })
}
