//! Rendering without a window: for tests, benchmarks and pictures made by scripts.

use eframe::egui_wgpu::{RenderState, RendererOptions, WgpuConfiguration, WgpuSetup};

/// A renderer without a window, on the best adapter available; `WGPU_BACKEND` and `WGPU_ADAPTER_NAME` are respected.
///
/// # Errors
/// A sentence if there is no adapter.
pub fn headless() -> Result<RenderState, String> {
    let configuration = WgpuConfiguration { wgpu_setup: WgpuSetup::without_display_handle(), ..Default::default() };
    pollster::block_on(async {
        let instance = configuration.wgpu_setup.new_instance().await;
        RenderState::create(&configuration, &instance, None, RendererOptions::default()).await
    })
    .map_err(|error| format!("there is nothing to draw with: {error}"))
}
