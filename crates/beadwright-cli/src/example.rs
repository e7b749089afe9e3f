//! `beadwright example`.

use crate::output::write_file;
use anyhow::Context;
use beadwright::example;
use std::io::Write;
use std::path::PathBuf;

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Name of the part.
    name: Option<String>,
    /// File to write; NAME.stl when it is left out.
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
    let path = arguments.output.clone().unwrap_or_else(|| PathBuf::from(format!("{name}.stl")));
    write_file(&path, &example.stl())?;
    writeln!(out, "{}: {}", path.display(), example.about)?;
    Ok(())
}
