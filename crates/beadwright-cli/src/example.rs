//! `beadwright example`.

use crate::{file, say};
use anyhow::Context;
use beadwright::example;
use std::io::Write;
use std::path::PathBuf;

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Name of the part.
    name: Option<String>,
    /// File to write, - for standard output, or a folder for NAME.stl; NAME.stl if left out. A file name ending in .igs or
    /// .iges writes the centre-lines of a thin wall.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

pub(crate) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let mut out = std::io::stdout().lock();
    let Some(name) = &arguments.name else {
        for example in example::ALL {
            writeln!(out, "{:<10} {}", example.name, example.about)?;
        }
        return Ok(());
    };
    let names = || example::ALL.iter().map(|e| e.name).collect::<Vec<_>>().join(", ");
    let example = example::find(name)
        .with_context(|| format!("there is no example part \"{name}\". The parts are {}.", names()))?;
    let usual = format!("{name}.stl");
    let path = match &arguments.output {
        Some(folder) if folder.is_dir() => folder.join(usual),
        Some(path) => path.clone(),
        None => PathBuf::from(usual),
    };
    let wants_curves = path.extension().is_some_and(|e| e == "igs" || e == "iges");
    let bytes = match (wants_curves, example.iges()) {
        (false, _) => example.stl(),
        (true, Some(text)) => text.into_bytes(),
        (true, None) => anyhow::bail!("{name} is not a thin wall and has no centre-lines; write it as STL"),
    };
    drop(out);
    file::write(&path, &bytes)?;
    let mut out = say::done(file::is_standard(&path));
    writeln!(out, "{}: {}", path.display(), example.about)?;
    let Some(bodies) = example.bodies().filter(|_| !wants_curves) else { return Ok(()) };
    if file::is_standard(&path) {
        let chart = example.chart.map(|chart| format!("Plan it with --chart {chart}.\n"));
        return Ok(write!(out, "{}", chart.unwrap_or_default())?);
    }
    let beside = path.with_extension("bodies.toml");
    file::write(&beside, bodies.as_bytes())?;
    writeln!(out, "{}: how its layers lie. Plan it with --bodies {}.", beside.display(), beside.display())?;
    Ok(())
}
