//! `beadwright directions`: finds build directions for the pieces of a model and writes them as a file of bodies for
//! `plan --bodies`.

use crate::{file, model, profile, progress, say};
use anyhow::Context;
use beadwright::directions::{Found, Outcome, Settings, Tried, page, tried, untried};
use beadwright::profile::{Body, Profile};
use beadwright::{Part, Task};
use std::io::Write;
use std::path::PathBuf;

#[derive(clap::Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    model: model::Model,
    /// Largest angle between a wall and the direction in which it is built, degrees.
    #[arg(long, value_name = "DEG", default_value_t = Settings::LEAN, value_parser = parse_lean)]
    lean: f64,
    /// Largest angle between a direction and the vertical, degrees: what the positioner can tilt, or the torch can lean.
    /// Beyond 90 only branches on branches go, in layers around the one that carries them.
    #[arg(long, value_name = "DEG", default_value_t = Settings::TILT, value_parser = parse_tilt)]
    tilt: f64,
    /// List the divisions without planning each for trial, which takes as long as planning the part several times.
    #[arg(long)]
    no_trial: bool,
    /// Which of the divisions found to write, counted from 1.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u64).range(1..))]
    choice: u64,
    /// File of bodies to write; standard output if left out.
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
    /// HTML page to write: each division in 3-D with its bodies in colours, and its figures.
    #[arg(long, value_name = "FILE")]
    page: Option<PathBuf>,
    #[command(flatten)]
    wanted: profile::Wanted,
}

/// Bodies for a part whose directions are found as it is planned: the best of those that can be welded, or, if none can, those
/// whose plan says why; and a sentence about them.
pub(crate) fn bodies(
    name: &str,
    part: &Part,
    (profile, kept): (&Profile, bool),
    task: &Task,
) -> anyhow::Result<(Vec<Body>, String)> {
    anyhow::ensure!(
        profile.layers.are_level() && profile.layers.bodies.is_empty(),
        "--directions auto: the profile says how layers lie (layers.chart, layers.bodies): leave that out."
    );
    let settings = Settings::usual(profile.bead.width);
    let Found { divisions, .. } = tried(name, part, profile, kept, settings, task)?;
    let best = divisions.into_iter().next().with_context(|| name.to_owned())?;
    let sentence = format!("Directions were found while planning (--directions auto): {}.", best.about());
    Ok((best.into_bodies(), sentence))
}

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
    let (name, open_edges) = (arguments.model.part(), import.repair.open_edges);
    let settings = Settings { lean: arguments.lean, tilt: arguments.tilt, bead: profile.bead.width };
    if !arguments.no_trial {
        say::size(&import.mesh, &profile)?;
    }
    let part = Part::Mesh(import);
    let found = if arguments.no_trial {
        untried(&name, &part, settings, &task)?
    } else {
        tried(&name, &part, &profile, false, settings, &task)?
    };
    bar.finish_and_clear();
    let model = &arguments.model.model;
    let mut out = say::done(arguments.output.is_none());
    let lean = arguments.lean;
    writeln!(out, "level layers: {:.1} cm² overhang by more than {lean}°", found.level / 100.0)?;
    let offered: Vec<&Tried> = found.offered().collect();
    for (number, tried) in offered.iter().enumerate() {
        let verdict = tried.verdict().map_or(String::new(), |verdict| format!(" {verdict}"));
        writeln!(out, "{}. {}.{verdict}", number + 1, tried.about())?;
    }
    if found.divisions.len() == 1 {
        writeln!(out, "No other direction avoids much of it.")?;
    }
    if let Some(Outcome::Refused { .. }) = offered.first().map(|tried| &tried.outcome) {
        let hangs = |tried: &&Tried| matches!(tried.outcome, Outcome::Refused { hangs: true, .. });
        let preform = if offered.iter().any(hangs) { ", or add metal below overhangs (plan --preform)" } else { "" };
        writeln!(out, "So the part cannot be welded as it is. Edit the bodies{preform}.")?;
    }
    if let Some(sentence) = found.about_tilted() {
        writeln!(out, "{sentence}")?;
    }
    if open_edges > 0 {
        writeln!(out, "The surface is open ({open_edges} edges); bodies are made of solids.")?;
    }
    let Some(Tried { bodies, .. }) = offered.get(arguments.choice as usize - 1) else {
        anyhow::bail!("--choice {}: there are {} to choose from", arguments.choice, offered.len());
    };
    if let (Some(page), Some(mesh)) = (&arguments.page, part.mesh()) {
        file::write(page, page::page(&name, mesh, &found).html().as_bytes())?;
        writeln!(out, "{}: the divisions in 3-D.", page.display())?;
    }
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
