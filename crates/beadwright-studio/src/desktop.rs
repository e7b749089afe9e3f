//! The window on the desktop, and the arguments it starts with.

use beadwright::fill::StrategyName;
use beadwright_studio::Studio;
use beadwright_studio::settings::Store;
use beadwright_studio::view::{Mode, Side};
use beadwright_studio::view3d::Section;
use clap::{Parser, ValueEnum};
use eframe::egui::ViewportBuilder;
use std::path::PathBuf;
use std::process::ExitCode;

/// See the part, the beads and the voids before any wire is burnt, change parameters, export the robot program.
#[derive(Parser)]
#[command(version)]
struct Arguments {
    /// Model (STL, 3MF, AMF, OBJ, PLY, IGES, SVG, DXF) or project (.bwp) to open, or the name of an example part, such
    /// as propeller.
    file: Option<PathBuf>,
    /// View to start with.
    #[arg(long, value_name = "VIEW")]
    view: Option<View>,
    /// Panel to start with.
    #[arg(long, value_name = "PANEL")]
    panel: Option<Panel>,
    /// Highest layer to show, counted from 1.
    #[arg(long, value_name = "LAYER", value_parser = clap::value_parser!(u32).range(1..))]
    layer: Option<u32>,
    /// Show heights and voids in the layer view.
    #[arg(long)]
    heights: bool,
    /// Show in the layer view how the strategy arrives at its passes.
    #[arg(long)]
    steps: bool,
    /// Show the handles that move and turn the part.
    #[arg(long)]
    place: bool,
    /// Compare in 3-D.
    #[arg(long)]
    solid: bool,
    /// Show a section through the middle of the part, square to this axis.
    #[arg(long, value_name = "AXIS")]
    section: Option<Axis>,
    /// Scan of the built part to show, coloured by its distance from the part.
    #[arg(long, value_name = "FILE")]
    scan: Option<PathBuf>,
    /// Show plate and part as they bend while the metal cools.
    #[arg(long)]
    bent: bool,
    /// Show the arm of the robot cell.
    #[arg(long)]
    robot: bool,
    /// Second strategy to plan and show next to the first.
    #[arg(long, value_name = "STRATEGY")]
    compare_with: Option<StrategyName>,
    /// Change a value of the profile, such as fill.strategy=hybrid; may be given several times.
    #[arg(long, value_name = "KEY=VALUE", value_parser = setting)]
    set: Vec<(String, String)>,
    /// Folder for settings and the autosaved project, instead of the user's own.
    #[arg(long, value_name = "DIR")]
    store: Option<PathBuf>,
}

#[derive(Clone, Copy, ValueEnum)]
enum View {
    Solid,
    Layer,
    Compare,
}

#[derive(Clone, Copy, ValueEnum)]
enum Panel {
    Totals,
    Findings,
    Plots,
    Program,
    Directions,
    Export,
}

#[derive(Clone, Copy, ValueEnum)]
enum Axis {
    X,
    Y,
    Z,
}

/// A key and its value.
fn setting(text: &str) -> Result<(String, String), String> {
    let (key, value) = text.split_once('=').ok_or("write KEY=VALUE")?;
    Ok((key.to_owned(), value.to_owned()))
}

/// Opens the window and returns when it is closed.
pub(crate) fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let viewport = ViewportBuilder::default()
        .with_inner_size([1280.0, 800.0])
        .with_min_inner_size([800.0, 500.0])
        .with_title("Beadwright Studio")
        .with_app_id("beadwright-studio")
        .with_drag_and_drop(true);
    let options = eframe::NativeOptions { viewport, ..eframe::NativeOptions::default() };
    let app: eframe::AppCreator<'_> = Box::new(move |cc| Ok(Box::new(begin(cc, &arguments))));
    match eframe::run_native("Beadwright Studio", options, app) {
        Ok(()) => ExitCode::SUCCESS,
        // Without a window, only the console can say so.
        Err(error) => {
            let reason = error.to_string();
            let reason = reason.trim_end_matches('.');
            eprintln!(
                "error: the window cannot be opened: {reason}. It needs a screen, and a driver for Vulkan, Metal, Direct3D \
                 12 or OpenGL; on Linux, mesa-vulkan-drivers works without a graphics card."
            );
            ExitCode::FAILURE
        }
    }
}

fn begin(cc: &eframe::CreationContext<'_>, arguments: &Arguments) -> Studio {
    let store = arguments.store.clone().map_or_else(Store::of_user, Store::at);
    let mut studio = Studio::new(cc, store);
    // Before the first change, whose autosave would overwrite it.
    studio.offer_lost();
    for (key, value) in &arguments.set {
        studio.set_value(key, value);
    }
    if let Some(file) = &arguments.file {
        match file.to_str().filter(|name| !file.exists() && beadwright::example::find(name).is_some()) {
            Some(example) => studio.open_example(example),
            None => studio.open(file),
        }
    }
    arguments.scan.iter().for_each(|scan| studio.open_scan(scan));
    if let Some(strategy) = arguments.compare_with {
        studio.compare_with(Some(strategy));
    }
    let view = studio.view();
    view.mode = arguments.view.map_or(view.mode, |view| match view {
        View::Solid => Mode::Solid,
        View::Layer => Mode::Layer,
        View::Compare => Mode::Compare,
    });
    view.side = arguments.panel.map_or(view.side, |panel| match panel {
        Panel::Totals => Side::Totals,
        Panel::Findings => Side::Findings,
        Panel::Plots => Side::Plots,
        Panel::Program => Side::Program,
        Panel::Directions => Side::Directions,
        Panel::Export => Side::Export,
    });
    view.show.heights |= arguments.heights;
    view.show.regions |= arguments.steps;
    view.placing |= arguments.place;
    view.bend.shown |= arguments.bent;
    view.robot |= arguments.robot;
    view.compare_solid |= arguments.solid;
    // Parts lie around x = y = 0, and what is in front is cut away.
    let section = |axis: Axis| Section { axis: axis as usize, at: 0.0, lower: matches!(axis, Axis::Y) };
    view.section = arguments.section.map(section);
    arguments.layer.into_iter().for_each(|layer| view.look_at(layer as usize - 1));
    studio
}
