//! Frame times of the 3-D view: `cargo bench -p beadwright-studio --bench frames [-- SEGMENTS…]`.
//!
//! The part is the vase, planned with a built-in profile, side by side until there are enough segments.
//! *Far* shows all of it, *near* is four times nearer, where every segment is drawn; *moving* is what a drag shows.
//! Prints a line for 10,000, 100,000 and 1,000,000 segments, or for the numbers given. Works on any adapter.

use beadwright::plan::plan;

use beadwright::layer::Layer;
use beadwright::profile::Profile;
use beadwright::task::Task;
use beadwright::weld::Torch;
use beadwright::{example, model};
use beadwright_studio::view3d::{LayerBeads, Scene, Style, View3d, headless, pick};
use eframe::egui_wgpu::RenderState;
use glam::{DVec2, DVec3};
use std::error::Error;
use std::sync::Arc;
use std::time::Instant;

/// Size of the picture, pixels.
const PIXELS: [u32; 2] = [1280, 800];

/// Frames of each kind.
const FRAMES: usize = 9;

fn main() -> Result<(), Box<dyn Error>> {
    let wanted: Vec<usize> = std::env::args().skip(1).filter_map(|arg| arg.parse().ok()).collect();
    let wanted = if wanted.is_empty() { vec![10_000, 100_000, 1_000_000] } else { wanted };
    let state = match headless() {
        Ok(state) => state,
        Err(error) => {
            println!("no figures: {error}");
            return Ok(());
        }
    };
    let info = state.adapter.get_info();
    println!("{} ({:?}), {} × {} pixels, milliseconds", info.name, info.backend, PIXELS[0], PIXELS[1]);
    let profile = Profile::built_in("cmt-al2319-kuka")?;
    let import = model::import(&example::find("vase").ok_or("there is no vase")?.stl(), &Task::default())?;
    let layers = plan("vase", &import.mesh, &profile, &Task::default())?.layers;
    println!("segments  build  upload  frame far  moving  near  pick longest  B/segment  VmHWM MiB");
    for segments in wanted {
        measure(&state, &layers, &Torch::of(&profile.weld_settings()), segments)?;
    }
    Ok(())
}

/// Prints the figures for a part of that many segments.
fn measure(state: &RenderState, layers: &[Layer], torch: &Torch, segments: usize) -> Result<(), Box<dyn Error>> {
    let clock = Instant::now();
    let scene = batch(layers, torch, segments);
    let build = clock.elapsed();
    let style = Style::default();
    let mut view = View3d::default();
    let size = DVec2::new(f64::from(PIXELS[0]), f64::from(PIXELS[1]));
    view.camera.fit(scene.bounds().ok_or("nothing is laid")?, size);
    let upload = view.time_frame(state, &scene, &style, PIXELS, false)?.upload;
    let median = |view: &mut View3d, moving: bool| -> Result<f64, String> {
        let mut times = Vec::with_capacity(FRAMES);
        for _ in 0..FRAMES {
            view.camera.orbit(DVec2::new(11.0, 3.0));
            times.push(view.time_frame(state, &scene, &style, PIXELS, moving)?.render);
        }
        times.sort_by(f64::total_cmp);
        Ok(times[FRAMES / 2])
    };
    let (full, moving) = (median(&mut view, false)?, median(&mut view, true)?);
    let middle = view.camera.target;
    view.camera.zoom(4.0, middle);
    let near = median(&mut view, false)?;
    let longest = longest_pick(&scene, &style, &view, size);
    println!(
        "{:8}  {:5.0}  {:6.0}  {:9.1}  {:6.1}  {:4.0}  {longest:12.1}  {:9.1}  {:9}",
        scene.segments(),
        build.as_secs_f64() * 1e3,
        upload * 1e3,
        full * 1e3,
        moving * 1e3,
        near * 1e3,
        scene.bytes() as f64 / scene.segments() as f64,
        peak_mib(),
    );
    Ok(())
}

/// The part many times side by side, as a batch on one plate: every layer holds all of them.
fn batch(layers: &[Layer], torch: &Torch, segments: usize) -> Scene {
    let each: usize = layers.iter().flat_map(|layer| &layer.passes).map(|pass| pass.segments().count()).sum();
    let copies = segments.div_ceil(each.max(1));
    let (side, pitch) = ((copies as f64).sqrt().ceil() as usize, 120.0);
    let (mut scene, mut torch) = (Scene::default(), torch.clone());
    for layer in layers {
        let copy = |i: usize| {
            let shift = DVec3::new((i % side) as f64, (i / side) as f64, 0.0) * pitch;
            layer.passes.iter().cloned().map(move |mut pass| {
                pass.points.iter_mut().for_each(|point| *point += shift);
                pass
            })
        };
        let all = Layer { passes: (0..copies).flat_map(copy).collect(), ..layer.clone() };
        scene.set_layer(layer.index, Arc::new(LayerBeads::of(&all, &mut torch)));
    }
    scene
}

/// The longest of 100 picks all over the picture, ms.
fn longest_pick(scene: &Scene, style: &Style, view: &View3d, size: DVec2) -> f64 {
    let places = (0..100).map(|i| size * DVec2::new(0.05 + 0.1 * f64::from(i % 10), 0.05 + 0.1 * f64::from(i / 10)));
    let time = |at: DVec2| {
        let clock = Instant::now();
        std::hint::black_box(pick(scene, style, &view.camera, size, at));
        clock.elapsed().as_secs_f64() * 1e3
    };
    places.map(time).fold(0.0, f64::max)
}

/// The most memory this process ever held, MiB; 0 where the system does not say.
fn peak_mib() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kib = line.and_then(|line| line.split_whitespace().next()?.parse::<u64>().ok());
    kib.unwrap_or_default() / 1024
}
