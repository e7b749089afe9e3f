//! A buffer on the graphics card that can grow.

use bytemuck::Pod;
use eframe::egui_wgpu::wgpu;

/// Spare bytes after the last item: a draw may read the instance after its last one.
const SPARE: u64 = 64;

/// Items of one size, in a buffer that is replaced by a larger one when it is full.
#[derive(Debug)]
pub(super) struct Growing {
    buffer: Option<wgpu::Buffer>,
    label: &'static str,
    /// Bytes in use.
    used: u64,
}

impl Growing {
    pub(super) fn new(label: &'static str) -> Self {
        Self { buffer: None, label, used: 0 }
    }

    /// Writes items from index `first` on, overwriting existing ones and appending the rest.
    pub(super) fn write<T: Pod>(&mut self, gpu: (&wgpu::Device, &wgpu::Queue), first: usize, items: &[T]) {
        let bytes: &[u8] = bytemuck::cast_slice(items);
        if bytes.is_empty() {
            return;
        }
        let offset = (first * size_of::<T>()) as u64;
        let end = offset + bytes.len() as u64;
        if self.buffer.as_ref().is_none_or(|buffer| buffer.size() < end + SPARE) {
            self.grow(gpu, end + SPARE);
        }
        if let Some(buffer) = &self.buffer {
            gpu.1.write_buffer(buffer, offset, bytes);
        }
        self.used = self.used.max(end);
    }

    fn grow(&mut self, (device, queue): (&wgpu::Device, &wgpu::Queue), needed: u64) {
        // The first buffer gets the exact size, since a scene often arrives all at once.
        let size = if self.buffer.is_some() { needed + needed / 2 } else { needed };
        let size = size.min(device.limits().max_buffer_size).max(needed).next_multiple_of(4);
        let usage = wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::COPY_SRC;
        let label = Some(self.label);
        let larger = device.create_buffer(&wgpu::BufferDescriptor { label, size, usage, mapped_at_creation: false });
        if let Some(old) = self.buffer.as_ref().filter(|_| self.used > 0) {
            let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label });
            encoder.copy_buffer_to_buffer(old, 0, &larger, 0, self.used);
            queue.submit([encoder.finish()]);
        }
        self.buffer = Some(larger);
    }

    /// Everything from byte `offset` on; `None` while nothing is written there.
    pub(super) fn from(&self, offset: u64) -> Option<wgpu::BufferSlice<'_>> {
        self.buffer.as_ref().filter(|_| offset < self.used).map(|buffer| buffer.slice(offset..))
    }
}
