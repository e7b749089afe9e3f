//! From drop to first planned layer: `cargo bench -p beadwright-studio --bench first_layer`.
//!
//! Drives the planner of the window, without a window: ms from the request until the part is read and placed, until the
//! layer in view is planned (the *first layer*), until the 3-D view has drawn part and layer (on any adapter; pipelines
//! and buffers are made anew each time; the planner goes on meanwhile but is heard only then), until all layers are
//! planned, and until they are judged and checked. The bunny of 1.1 million
//! triangles lies in the folder that `BEADWRIGHT_MODELS` names; the propeller in `examples/`.

use beadwright_studio::planner::{Event, Failure, Planner};
use beadwright_studio::project::{Project, Source};
use beadwright_studio::state::PlanState;
use beadwright_studio::view3d::{Style, View3d, headless};
use eframe::egui_wgpu::RenderState;
use glam::DVec2;
use std::error::Error;
use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

/// Size of the picture, pixels.
const PIXELS: [u32; 2] = [1280, 800];

/// Longest wait for a part.
const PATIENCE: Duration = Duration::from_secs(600);

fn main() -> Result<(), Box<dyn Error>> {
    println!("milliseconds          part  first layer  drawn  all layers  checked  layers  VmHWM MiB");
    // A file of choice, in a process of its own: the most memory is then its own.
    if let Some(path) = std::env::args().skip(1).find(|arg| !arg.starts_with('-')) {
        return measure(Path::new(&path));
    }
    measure(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/propeller.stl"))?;
    let Some(packed) = std::env::var_os("BEADWRIGHT_MODELS").map(|folder| PathBuf::from(folder).join(BUNNY)) else {
        println!("the bunny is skipped: BEADWRIGHT_MODELS is not set");
        return Ok(());
    };
    if !packed.exists() {
        println!("the bunny is skipped: there is no {}", packed.display());
        return Ok(());
    }
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("bunny.stl");
    io::copy(&mut flate2::read::GzDecoder::new(File::open(packed)?), &mut File::create(&path)?)?;
    measure(&path)
}

const BUNNY: &str = "bunny_1114k.stl.gz";

/// Plans a file twice, as if dropped and then planned again, and prints a line for each.
fn measure(path: &Path) -> Result<(), Box<dyn Error>> {
    let state = headless().inspect_err(|error| println!("nothing is drawn: {error}")).ok();
    let (sender, bell) = channel();
    let mut planner = Planner::new(move |_| sender.send(()).unwrap_or_default());
    let project = Project { source: Some(Source::File(path.to_owned())), ..Project::default() };
    let name = path.file_stem().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    run(&mut planner, &bell, state.as_ref(), &project, &name)?;
    // A change of a parameter begins with what is read already.
    let profile = beadwright::profile::edit::with_value(&project.profile, "fill.raster_angle", "30")?;
    run(&mut planner, &bell, state.as_ref(), &Project { profile, ..project }, &format!("{name}, changed"))
}

fn run(
    planner: &mut Planner,
    bell: &Receiver<()>,
    state: Option<&RenderState>,
    project: &Project,
    name: &str,
) -> Result<(), Box<dyn Error>> {
    let clock = Instant::now();
    let now = || clock.elapsed().as_secs_f64() * 1e3;
    let [mut part, mut first, mut drawn, mut all] = [f64::NAN; 4];
    let mut plan = PlanState::default();
    planner.plan(project, 0);
    while !plan.is_complete() {
        bell.recv_timeout(PATIENCE)?;
        for event in planner.events() {
            match &event {
                Event::Part(..) => part = now(),
                Event::Preview(..) => first = now(),
                Event::Planned(_) => all = now(),
                Event::Failed(
                    Failure::Sentence(text) | Failure::Units(text, _) | Failure::Damaged(text) | Failure::Height(text),
                ) => {
                    return Err(text.as_str().into());
                }
                _ => {}
            }
            let seen = matches!(event, Event::Preview(..));
            plan.take(event);
            if let Some(state) = state.filter(|_| seen) {
                draw(&plan, state)?;
                drawn = now();
            }
        }
    }
    let (checked, layers) = (now(), plan.layers.len());
    println!(
        "{name:20} {part:5.0}  {first:11.0}  {drawn:5.0}  {all:10.0}  {checked:7.0}  {layers:6}  {:9}",
        peak_mib()
    );
    Ok(())
}

/// Draws part and beads as the window does first.
fn draw(plan: &PlanState, state: &RenderState) -> Result<(), String> {
    let mut view = View3d::default();
    view.camera.fit_points(&plan.scene.outline(), DVec2::new(f64::from(PIXELS[0]), f64::from(PIXELS[1])));
    view.time_frame(state, &plan.scene, &Style::default(), PIXELS, false).map(|_| ())
}

/// The most memory this process ever held, MiB; 0 where the system does not say.
fn peak_mib() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kib = line.and_then(|line| line.split_whitespace().next()?.parse::<u64>().ok());
    kib.unwrap_or_default() / 1024
}
