//! `beadwright guide`: the curve to which the layers of a bent part are perpendicular, for `plan --chart`.

use crate::{file, model, profile, progress, say};
use anyhow::{Context, ensure};
use beadwright::chart::{Chart, Guide};
use beadwright::glam::DVec3;
use beadwright::middle_line::middle_line;
use std::io::Write;
use std::path::Path;
use std::sync::Arc;

#[derive(clap::Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    model: model::Model,
    #[command(flatten)]
    wanted: profile::Wanted,
}

/// Accuracy to which the curve of a file is followed, mm.
const CHORD: f64 = 0.05;

pub(crate) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let path = &arguments.model.model;
    let placed = arguments.model.placing.moves();
    let as_it_is = || {
        ensure!(
            !placed,
            "{}: a part can be turned, scaled and moved; a curve is taken as it is, in mm",
            path.display()
        );
        Ok(())
    };
    let ending = path.extension().map(|ending| ending.to_ascii_lowercase());
    let guide = match ending.as_ref().and_then(|ending| ending.to_str()) {
        Some("csv" | "txt") => {
            as_it_is()?;
            Guide::through(&table(path)?).with_context(|| path.display().to_string())?
        }
        Some("igs" | "iges") => match iges(path)? {
            Some(points) => {
                as_it_is()?;
                Guide::through(&points).with_context(|| path.display().to_string())?
            }
            None => found(arguments)?,
        },
        _ => found(arguments)?,
    };
    let (length, radius) = (guide.length(), guide.tightest());
    writeln!(std::io::stdout(), "{}", Chart::Guide(Arc::new(guide)))?;
    let mut out = say::done(true);
    match radius {
        Some(radius) => writeln!(out, "{length:.1} mm long, bent at {radius:.1} mm radius where it is tightest")?,
        None => writeln!(out, "{length:.1} mm long, straight")?,
    }
    Ok(())
}

/// The guide found from the sections of a part.
fn found(arguments: &Arguments) -> anyhow::Result<Guide> {
    let name = arguments.wanted.profile.as_deref().unwrap_or(profile::USUAL);
    let profile = profile::load(name, &arguments.wanted.set)?;
    let (task, bar) = progress::task()?;
    let import = arguments.model.placed(&profile, model::Use::AsDrawn, &task)?;
    let guide = middle_line(&import.mesh, &task).with_context(|| arguments.model.model.display().to_string())?;
    bar.finish_and_clear();
    Ok(Guide::through(guide.points())?)
}

/// The curve of an IGES file; `None` where it holds surfaces and no curves.
fn iges(path: &Path) -> anyhow::Result<Option<Vec<DVec3>>> {
    let Some(drawing) = model::read_iges(path, &file::model(path)?)? else { return Ok(None) };
    let curves: Vec<_> = drawing.independent_curves().collect();
    ensure!(
        curves.len() == 1,
        "{}: it holds {} curves, but a guide is a single one: join them in CAD",
        path.display(),
        curves.len()
    );
    Ok(Some(curves.iter().flat_map(|curve| &curve.parts).flat_map(|part| part.points_by_chord(CHORD)).collect()))
}

/// The points of a table; a first line without numbers is its heading.
fn table(path: &Path) -> anyhow::Result<Vec<DVec3>> {
    let text = file::text(path)?;
    let row = |line: &str| -> Option<DVec3> {
        let numbers: Option<Vec<f64>> = line.split([',', ';', '\t']).map(|word| word.trim().parse().ok()).collect();
        let point = DVec3::from_array(numbers?.try_into().ok()?);
        point.is_finite().then_some(point)
    };
    let mut lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty()).peekable();
    lines.next_if(|(_, line)| row(line).is_none());
    let point = |(number, line): (usize, &str)| {
        row(line).with_context(|| {
            format!("{}, line {}: x, y and z in mm are expected, not \"{line}\"", path.display(), number + 1)
        })
    };
    lines.map(point).collect()
}
