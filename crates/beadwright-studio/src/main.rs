//! `beadwright-studio`: the desktop program.

use beadwright_studio::Studio;
use beadwright_studio::settings::Store;
use clap::Parser;
use eframe::egui::ViewportBuilder;
use std::path::PathBuf;

/// See the part, the beads and the voids before wire is burnt; change a parameter; export the robot program.
#[derive(Parser)]
#[command(version)]
struct Arguments {
    /// A model (STL, IGES) or a project (.bwp) to open.
    file: Option<PathBuf>,
}

fn main() -> eframe::Result {
    let arguments = Arguments::parse();
    let viewport = ViewportBuilder::default()
        .with_inner_size([1280.0, 800.0])
        .with_min_inner_size([800.0, 500.0])
        .with_title("Beadwright Studio")
        .with_app_id("beadwright-studio")
        .with_drag_and_drop(true);
    let options = eframe::NativeOptions { viewport, ..eframe::NativeOptions::default() };
    let app: eframe::AppCreator<'_> =
        Box::new(move |cc| Ok(Box::new(Studio::new(cc, Store::of_user(), arguments.file.as_deref()))));
    eframe::run_native("Beadwright Studio", options, app)
}
