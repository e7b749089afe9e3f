//! The graphics card: what is stored on it, and how a picture is made there.
//!
//! | file | what it does |
//! | --- | --- |
//! | `chunks` | the layers in print order |
//! | `values` | what their colours are made from |
//! | `draw` | the order in which things are drawn |
//! | `surface` | the model |
//! | `scan` | a scan of the built part, the bodies of the part, the bent plate |
//! | `solids` | plate, torch, robot, positioner and table |
//! | `growing` | a buffer that can grow |
//! | `globals` | the data passed to all shaders |
//! | `pipelines` | how each kind of thing is drawn |
//! | `target` | what the picture is drawn into |
//! | `*.wgsl` | the shaders |

mod chunks;
mod draw;
mod globals;
mod growing;
mod pipelines;
mod scan;
mod solids;
mod surface;
mod target;
mod values;

use super::camera::Camera;
use super::palette;
use super::scene::Scene;
use super::style::{Colour, Style};
use chunks::Chunk;
use draw::Shot;
use eframe::egui_wgpu::{RenderState, wgpu};
use globals::Globals;
use growing::Growing;
use pipelines::Pipelines;
use scan::{Mapped, Scan};
pub(crate) use solids::BELOW;
use surface::Surface;
pub(super) use target::Target;
use wgpu::util::DeviceExt as _;

/// How finely a picture is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Quality {
    /// Strips across a bead.
    pub strips: u32,
    /// Samples per pixel.
    pub samples: u32,
    /// Whether every segment is drawn, instead of rough ones.
    pub exact: bool,
    /// Whether ends and corners are round.
    pub caps: bool,
    /// One layer in this many is drawn, as high as all of them; the top one always is.
    pub every: usize,
}

/// Plain beads, a highlighted pass and a highlighted segment.
const LOOKS: usize = 3;

/// How strongly the highlight colour is blended over the beads.
const ACCENTS: [f32; LOOKS] = [0.0, 0.6, 0.95];

/// Everything stored on the graphics card.
#[derive(Debug)]
pub(super) struct Gpu {
    device: wgpu::Device,
    queue: wgpu::Queue,
    /// Whether the CPU draws, because there is no graphics card.
    pub software: bool,
    layout: wgpu::BindGroupLayout,
    globals: [wgpu::Buffer; LOOKS],
    bindings: [wgpu::BindGroup; LOOKS],
    map: wgpu::Texture,
    map_of: Option<Colour>,
    /// Coarse, then fine.
    fans: [(wgpu::Buffer, u32); 2],
    pipelines: Vec<Pipelines>,
    chunks: Vec<Chunk>,
    synced: Option<(u64, Colour)>,
    surface: Option<Surface>,
    surface_version: Option<u64>,
    /// A scan in the colours of its deviation.
    scan: Mapped,
    /// The part in the colours of its bodies.
    pieces: Mapped,
    bent_plate: Option<Scan>,
    solids: Growing,
}

impl Gpu {
    pub(super) fn new(state: &RenderState) -> Self {
        let (device, queue) = (state.device.clone(), state.queue.clone());
        let layout = layout(&device);
        let map = colour_map(&device);
        let globals: [wgpu::Buffer; LOOKS] = std::array::from_fn(|_| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("globals"),
                size: size_of::<Globals>() as u64,
                usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        });
        let bindings = std::array::from_fn(|i| bind(&device, &layout, &globals[i], &map));
        let [scan, pieces] = [Colour::HeightError, Colour::Body].map(|colour| {
            let map = colour_map(&device);
            write_map(&queue, &map, colour);
            Mapped::new(bind(&device, &layout, &globals[0], &map))
        });
        Self {
            software: state.adapter.get_info().device_type == wgpu::DeviceType::Cpu,
            fans: [fan(&device, 10, &[2]), fan(&device, 20, &[1, 2])],
            device,
            queue,
            layout,
            globals,
            bindings,
            map,
            map_of: None,
            pipelines: Vec::new(),
            chunks: Vec::new(),
            synced: None,
            surface: None,
            surface_version: None,
            scan,
            pieces,
            bent_plate: None,
            solids: Growing::new("plate, torch, machine"),
        }
    }

    /// A target for a picture of this many pixels, or as many as the card allows.
    pub(super) fn target(&self, pixels: [u32; 2], samples: u32) -> Target {
        let most = self.device.limits().max_texture_dimension_2d;
        Target::new(&self.device, pixels.map(|n| n.clamp(1, most)), samples)
    }

    /// Sends what has changed since the last picture.
    pub(super) fn sync(&mut self, scene: &Scene, style: &Style) {
        let state = (scene.version(), style.colour);
        if self.synced != Some(state) {
            chunks::sync(&mut self.chunks, (&self.device, &self.queue), scene, style.colour);
            self.synced = Some(state);
            let plate = scene.bent_plate();
            self.bent_plate = plate.and_then(|(points, corners)| Scan::new(&self.device, &points, corners));
        }
        if self.surface_version != Some(scene.mesh_version()) {
            self.surface_version = Some(scene.mesh_version());
            self.surface = scene.mesh().and_then(|mesh| Surface::new(&self.device, mesh));
        }
        if self.map_of != Some(style.colour) {
            self.map_of = Some(style.colour);
            write_map(&self.queue, &self.map, style.colour);
        }
        self.scan.sync(&self.device, scene.scan_version(), scene.scan());
        self.pieces.sync(&self.device, scene.pieces_version(), scene.pieces().map(|pieces| &**pieces));
    }

    /// Renders a picture.
    pub(super) fn draw(&mut self, scene: &Scene, style: &Style, camera: &Camera, quality: Quality, target: &Target) {
        self.sync(scene, style);
        let mut globals = Globals::new(scene, style, camera, target.pixels, quality);
        for (buffer, part) in self.globals.iter().zip(ACCENTS) {
            let [r, g, b] = palette::CHOSEN.map(|c| f32::from(c) / 255.0);
            globals.accent = [r, g, b, part];
            self.queue.write_buffer(buffer, 0, bytemuck::bytes_of(&globals));
        }
        let solids = solids::solids(style);
        self.solids.write((&self.device, &self.queue), 0, &solids);
        let wanted = |p: &Pipelines| (p.samples, p.cut) == (target.samples, style.section.is_some());
        if !self.pipelines.iter().any(wanted) {
            let cut = style.section.is_some();
            self.pipelines.push(Pipelines::new(&self.device, &self.layout, target.samples, cut));
        }
        let mut encoder =
            self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("3-D view") });
        if let Some(pipelines) = self.pipelines.iter().find(|p| wanted(p)) {
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("3-D view"),
                color_attachments: &[Some(draw::colour(target, style.dark))],
                depth_stencil_attachment: Some(draw::depth(target)),
                ..Default::default()
            });
            pass.set_bind_group(0, &self.bindings[0], &[]);
            let (from_above, solid_vertices) = (camera.back().z > 0.0, solids.len() as u32);
            Shot { gpu: self, pipelines, scene, style, quality, from_above, solid_vertices }.draw(&mut pass);
        }
        self.queue.submit([encoder.finish()]);
    }

    /// The fan that matches the strips of a ribbon: its rim goes through the same points.
    fn fan(&self, quality: Quality) -> &(wgpu::Buffer, u32) {
        &self.fans[usize::from(quality.strips > 2)]
    }

    /// Waits until all drawing is done.
    pub(super) fn wait(&self) -> Result<(), String> {
        target::wait(&self.device)
    }

    /// The pixels of a picture, row by row: red, green, blue, alpha.
    pub(super) fn read(&self, target: &Target) -> Result<Vec<u8>, String> {
        target.read(&self.device, &self.queue)
    }
}

/// The triangles of a cap as the viewer sees it, from the middle through rings to the rim; with the number of indices.
/// An index is the ring (2 is the rim) × 256 + the angle in steps of 1.5°.
fn fan(device: &wgpu::Device, sides: u16, rings: &[u16]) -> (wgpu::Buffer, u32) {
    let vertex = |ring: u16, side: u16| ring << 8 | (side % sides * (240 / sides));
    let mut indices: Vec<u16> = Vec::new();
    for side in 0..sides {
        let mut inner = 0;
        for &ring in rings {
            let (a, b) = (vertex(ring, side), vertex(ring, side + 1));
            if inner == 0 {
                indices.extend([0, a, b]);
            } else {
                indices.extend([vertex(inner, side), a, b, vertex(inner, side), b, vertex(inner, side + 1)]);
            }
            inner = ring;
        }
    }
    let (contents, usage) = (bytemuck::cast_slice(&indices), wgpu::BufferUsages::INDEX);
    let buffer = wgpu::util::BufferInitDescriptor { label: Some("fan"), contents, usage };
    (device.create_buffer_init(&buffer), indices.len() as u32)
}

/// An empty colour map.
fn colour_map(device: &wgpu::Device) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some("colour map"),
        size: wgpu::Extent3d { width: palette::STEPS as u32, height: 1, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba8Unorm,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    })
}

/// Sends the colours of a map.
fn write_map(queue: &wgpu::Queue, map: &wgpu::Texture, colour: Colour) {
    let texels: Vec<u8> = palette::map(colour).iter().flat_map(|&[r, g, b]| [r, g, b, 255]).collect();
    let (offset, bytes_per_row, rows_per_image) = (0, Some(texels.len() as u32), None);
    let row = wgpu::TexelCopyBufferLayout { offset, bytes_per_row, rows_per_image };
    queue.write_texture(map.as_image_copy(), &texels, row, map.size());
}

/// The background of a picture.
pub(super) fn background(dark: bool) -> palette::Rgb {
    if dark { [26, 28, 32] } else { [243, 245, 248] }
}

fn layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let entry = |binding, ty| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
        ty,
        count: None,
    };
    let globals = wgpu::BindingType::Buffer {
        ty: wgpu::BufferBindingType::Uniform,
        has_dynamic_offset: false,
        min_binding_size: None,
    };
    let map = wgpu::BindingType::Texture {
        sample_type: wgpu::TextureSampleType::Float { filterable: false },
        view_dimension: wgpu::TextureViewDimension::D2,
        multisampled: false,
    };
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("3-D view"),
        entries: &[entry(0, globals), entry(1, map)],
    })
}

fn bind(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    globals: &wgpu::Buffer,
    map: &wgpu::Texture,
) -> wgpu::BindGroup {
    let map = &map.create_view(&wgpu::TextureViewDescriptor::default());
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("3-D view"),
        layout,
        entries: &[
            wgpu::BindGroupEntry { binding: 0, resource: globals.as_entire_binding() },
            wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::TextureView(map) },
        ],
    })
}
