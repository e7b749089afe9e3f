//! `beadwright directions`: finds build directions for the pieces of a model and writes them as a file of bodies for
//! `plan --bodies`.

use crate::{file, model, profile, progress, say};
use anyhow::Context;
use beadwright::chart::Chart;
use beadwright::directions::{Division, Found, Outcome, Settings, Tried, tried};
use beadwright::profile::{Body, Profile};
use beadwright::{Mesh, Task};
use std::io::Write;
use std::path::PathBuf;

#[derive(clap::Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    model: model::Model,
    /// Largest angle between a wall and the direction in which it is built, degrees.
    #[arg(long, value_name = "DEG", default_value_t = LEAN, value_parser = parse_lean)]
    lean: f64,
    /// Largest angle between a direction and the vertical, degrees: what the positioner can tilt, or the torch can lean.
    /// Beyond 90 only branches on branches go, in layers around the one that carries them.
    #[arg(long, value_name = "DEG", default_value_t = TILT, value_parser = parse_tilt)]
    tilt: f64,
    /// Which of the divisions found to write, counted from 1.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u64).range(1..))]
    choice: u64,
    /// File of bodies to write; standard output if left out.
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
    #[command(flatten)]
    wanted: profile::Wanted,
}

/// Bodies for a part whose directions are found as it is planned: the best of those that can be welded.
pub(crate) fn bodies(part: &str, mesh: &Mesh, profile: &Profile, task: &Task) -> anyhow::Result<Vec<Body>> {
    let settings = Settings { lean: LEAN, tilt: TILT, bead: profile.bead.width };
    let Found { divisions, .. } = tried(part, mesh, profile, settings, task)?;
    let can = divisions.into_iter().find(|found| found.is_planned() || found.outcome == Outcome::Untried);
    let can = can.with_context(|| {
        format!("--directions auto: no division of {part} can be welded. `beadwright directions` says why, and writes bodies that can be edited.")
    })?;
    Ok(can.bodies)
}

/// Largest angles of walls from the direction in which they are built, and of directions from the vertical, °.
const LEAN: f64 = 45.0;
const TILT: f64 = 90.0;

fn parse_lean(text: &str) -> Result<f64, String> {
    degrees(text, 5.0..=80.0)
}

fn parse_tilt(text: &str) -> Result<f64, String> {
    degrees(text, 5.0..=180.0)
}

fn degrees(text: &str, range: std::ops::RangeInclusive<f64>) -> Result<f64, String> {
    let degrees: f64 = text.parse().map_err(|_| "an angle in degrees is expected".to_owned())?;
    let wrong = || format!("the angle must lie between {} and {} degrees", range.start(), range.end());
    if range.contains(&degrees) { Ok(degrees) } else { Err(wrong()) }
}

pub(crate) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let name = arguments.wanted.profile.as_deref().unwrap_or(profile::USUAL);
    let profile = profile::load(name, &arguments.wanted.set)?;
    let (task, bar) = progress::task()?;
    let import = arguments.model.placed(&profile, model::Use::AsDrawn, &task)?;
    let settings = Settings { lean: arguments.lean, tilt: arguments.tilt, bead: profile.bead.width };
    let Found { divisions: mut found, tilted } =
        tried(&arguments.model.part(), &import.mesh, &profile, settings, &task)?;
    bar.finish_and_clear();
    let model = &arguments.model.model;
    let level = found.pop().with_context(|| model.display().to_string())?;
    let mut out = say::done(arguments.output.is_none());
    let lean = arguments.lean;
    writeln!(out, "level layers: {:.1} cm² overhang by more than {lean}°", level.division.hanging / 100.0)?;
    // Level layers are planned only where no division can be welded.
    if found.is_empty() || level.is_planned() {
        found.insert(0, level);
    }
    for (number, found) in found.iter().enumerate() {
        writeln!(out, "{}. {}{}", number + 1, sentence(&found.division), ending(found))?;
    }
    if !found[0].is_planned() {
        writeln!(
            out,
            "None of them can be welded as it is. The file can be edited, and `plan --preform` adds metal below overhangs."
        )?;
    }
    if let Some(tilted) = tilted {
        let (tilt, pieces) = (tilted.division.tilt.ceil(), tilted.bodies.len());
        writeln!(out, "As {pieces} bodies it could be welded with --tilt {tilt}, if the part can be turned so far.")?;
    }
    if import.repair.open_edges > 0 {
        writeln!(out, "The surface is open ({} edges); bodies are made of solids.", import.repair.open_edges)?;
    }
    let Some(Tried { bodies, .. }) = found.get(arguments.choice as usize - 1) else {
        anyhow::bail!("--choice {}: there are {} to choose from", arguments.choice, found.len());
    };
    let text = Body::write(bodies);
    match &arguments.output {
        Some(path) => {
            let is_model =
                |path: &PathBuf| path.canonicalize().is_ok_and(|path| model.canonicalize().is_ok_and(|m| m == path));
            anyhow::ensure!(
                !is_model(path),
                "{}: that is the model; give the bodies a file of their own",
                path.display()
            );
            file::write(path, text.as_bytes())?;
            let placed = if arguments.model.placing.moves() { ", placed as here" } else { "" };
            writeln!(out, "{}: number {}. Plan the part with --bodies {0}{placed}.", path.display(), arguments.choice)?;
        }
        None => write!(std::io::stdout(), "{text}")?,
    }
    Ok(())
}

fn sentence(division: &Division) -> String {
    let bodies = match &division.pieces[..] {
        [piece] => match &piece.chart {
            Chart::Guide(guide) => format!("1 body along its middle line, {:.0} mm long", guide.length()),
            chart if chart.is_level() => "level layers".to_owned(),
            chart => format!("1 body on {chart}"),
        },
        pieces => format!("{} bodies", pieces.len()),
    };
    let stock = if division.pieces.iter().any(|piece| piece.on_stock) {
        ", on metal that is there already (the hub, turned from bar stock)"
    } else {
        ""
    };
    let Division { hanging, tilt, lean, .. } = division;
    let leans = lean.map_or(String::new(), |lean| {
        format!(", walls that lean by up to {lean:.0}° (square to them, layers would begin with no room for a bead)")
    });
    format!("{bodies}{stock}: {:.1} cm² overhang, layers at up to {tilt:.0}° from level{leans}", hanging / 100.0)
}

/// What came of planning it, as the end of a sentence.
fn ending(found: &Tried) -> String {
    match &found.outcome {
        Outcome::Untried => ".".to_owned(),
        Outcome::Planned(metrics) => {
            let price = metrics.cost.map_or(String::new(), |cost| format!(", {cost:.0} {}", metrics.currency));
            let hours = metrics.total_time_s / 3600.0;
            format!(". It can be welded: {hours:.2} h, {:.2} kg of wire{price}.", metrics.wire_mass_kg)
        }
        Outcome::Refused(reason) => format!(". It cannot be welded: {reason}"),
    }
}
