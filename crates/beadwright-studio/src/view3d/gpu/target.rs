//! What a picture is rendered into, and how it is read back.

use eframe::egui_wgpu::wgpu;
use std::sync::mpsc;
use std::time::Duration;

/// The format that egui shows.
pub(super) const COLOUR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

/// Depths, 1 near and 0 far.
pub(super) const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// A picture, its depths, and its samples.
#[derive(Debug)]
pub(in crate::view3d) struct Target {
    pub pixels: [u32; 2],
    pub samples: u32,
    texture: wgpu::Texture,
    pub view: wgpu::TextureView,
    pub depth: wgpu::TextureView,
    /// The samples before they are averaged, if there is more than one per pixel.
    pub many: Option<wgpu::TextureView>,
}

impl Target {
    pub(in crate::view3d) fn new(device: &wgpu::Device, pixels: [u32; 2], samples: u32) -> Self {
        let make = |label, format, sample_count, extra| {
            device.create_texture(&wgpu::TextureDescriptor {
                label: Some(label),
                size: wgpu::Extent3d { width: pixels[0], height: pixels[1], depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT | extra,
                view_formats: &[],
            })
        };
        let view = |texture: &wgpu::Texture| texture.create_view(&wgpu::TextureViewDescriptor::default());
        let read = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_SRC;
        let none = wgpu::TextureUsages::empty();
        let texture = make("3-D view", COLOUR, 1, read);
        Self {
            pixels,
            samples,
            view: view(&texture),
            depth: view(&make("3-D view, depth", DEPTH, samples, none)),
            many: (samples > 1).then(|| view(&make("3-D view, samples", COLOUR, samples, none))),
            texture,
        }
    }

    /// The picture as rows of red, green, blue, alpha.
    pub(super) fn read(&self, device: &wgpu::Device, queue: &wgpu::Queue) -> Result<Vec<u8>, String> {
        let [width, height] = self.pixels;
        let row = (width * 4).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let buffer = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("picture"),
            size: u64::from(row) * u64::from(height),
            usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: None };
        let into = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
        encoder.copy_texture_to_buffer(self.texture.as_image_copy(), into, self.texture.size());
        queue.submit([encoder.finish()]);
        let (sender, receiver) = mpsc::channel();
        buffer.map_async(wgpu::MapMode::Read, .., move |result| {
            // Nobody receives this if the wait below has failed.
            let _ = sender.send(result);
        });
        wait(device)?;
        let sentence = |error: &dyn std::fmt::Display| format!("the picture could not be read back: {error}");
        receiver.recv().map_err(|e| sentence(&e))?.map_err(|e| sentence(&e))?;
        let bytes = buffer.get_mapped_range(..).map_err(|e| sentence(&e))?;
        let rows = bytes.chunks_exact(row as usize);
        Ok(rows.flat_map(|row| &row[..width as usize * 4]).copied().collect())
    }
}

/// Waits until the graphics card has finished all its work.
pub(super) fn wait(device: &wgpu::Device) -> Result<(), String> {
    let timeout = Some(Duration::from_secs(60));
    let done = device.poll(wgpu::PollType::Wait { submission_index: None, timeout });
    done.map(|_| ()).map_err(|error| format!("the graphics card does not answer: {error}"))
}
