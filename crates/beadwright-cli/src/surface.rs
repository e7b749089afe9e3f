//! `beadwright surface`: the surface of a model, over which layers lie, for `plan --bodies`.

use crate::{file, model, profile, progress, say};
use anyhow::Context;
use beadwright::chart::{Chart, Surface};
use beadwright::profile::Body;
use glam::{DVec2, DVec3};
use std::io::Write;
use std::path::PathBuf;
use std::sync::Arc;

#[derive(clap::Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    model: model::Model,
    /// Direction in which the layers are stacked; the surface is what is seen looking against it.
    #[arg(long, value_name = "X/Y/Z", default_value = "z", allow_hyphen_values = true)]
    up: String,
    /// Spacing of the grid on which heights are sampled, mm; finer detail is smoothed out.
    #[arg(long, value_name = "MM", default_value_t = 5.0, value_parser = parse_step)]
    step: f64,
    /// File of bodies to write, with one body whose layers follow the surface; standard output if left out.
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
    #[command(flatten)]
    wanted: profile::Wanted,
}

pub(crate) fn parse_step(text: &str) -> Result<f64, String> {
    let step: f64 = text.parse().map_err(|_| "a length in mm is expected".to_owned())?;
    if (0.1..=100.0).contains(&step) { Ok(step) } else { Err("the step must lie between 0.1 and 100 mm".to_owned()) }
}

pub(crate) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let name = arguments.wanted.profile.as_deref().unwrap_or(profile::USUAL);
    let profile = profile::load(name, &arguments.wanted.set)?;
    let (task, bar) = progress::task()?;
    let import = arguments.model.placed(&profile, model::Use::AsDrawn, &task)?;
    bar.finish_and_clear();
    let plane: Chart = format!("plane:up={}", arguments.up).parse().context("--up")?;
    let up = plane.sheet(0.0).at(DVec3::ZERO).normal;
    let context = || arguments.model.model.display().to_string();
    let surface = Surface::of_mesh(&import.mesh, up, arguments.step).with_context(context)?.rounded();
    let (steepest, place) = steepest(&surface);
    let (count, columns) = (surface.heights().len(), surface.columns());
    let part = arguments.model.part();
    let text = Body::write(&[Body::of(&part, Chart::Surface(Arc::new(surface)))]);
    match &arguments.output {
        Some(path) => file::write(path, text.as_bytes())?,
        None => write!(std::io::stdout(), "{text}")?,
    }
    let mut out = say::done(true);
    writeln!(
        out,
        "{} × {} heights {} mm apart; it slopes by up to {:.1}° (near {:.1}, {:.1} mm), where beads lie {:.1} % farther apart; at most 17.7° \
         and 5 % are planned.",
        columns,
        count / columns,
        arguments.step,
        (1.0 / steepest).acos().to_degrees(),
        place.x,
        place.y,
        100.0 * (steepest - 1.0)
    )?;
    Ok(())
}

/// The greatest stretch between heights, and where.
fn steepest(surface: &Surface) -> (f64, DVec2) {
    let rows = surface.heights().len() / surface.columns();
    // Without the margin, where the surface continues level.
    let cells =
        (1..rows - 2).flat_map(|j| (1..surface.columns() - 2).map(move |i| DVec2::new(i as f64 + 0.5, j as f64 + 0.5)));
    let at = |cell: DVec2| surface.from() + cell * surface.step();
    let stretched = cells.map(|cell| (surface.stretch(at(cell)), at(cell)));
    stretched.max_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((1.0, surface.from()))
}
