//! `beadwright export`.

use crate::{profile, program};
use anyhow::Context;
use beadwright::export::{self, Beads, FORMATS};
use beadwright::files::write_file;
use std::io::Write;
use std::path::PathBuf;

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// plan.json, or toolpaths in 3MF.
    plan: PathBuf,
    #[command(flatten)]
    wanted: profile::Wanted,
    /// File to write; its ending tells the format: .csv (a table of all pieces of beads), .vtp (ParaView, VTK,
    /// pyvista) or .3mf (the 3MF Toolpath extension).
    #[arg(long, short, value_name = "FILE")]
    output: PathBuf,
}

pub(crate) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let extension = arguments.output.extension().map(|end| end.to_string_lossy().into_owned()).unwrap_or_default();
    let format = export::format(&extension).with_context(|| {
        let known: Vec<String> = FORMATS.iter().map(|f| format!(".{} ({})", f.extension, f.purpose)).collect();
        format!("{}: the ending tells the format, and it may be {}", arguments.output.display(), known.join(" or "))
    })?;
    let source = program::Source::open(&arguments.plan)?;
    let plan = source.plan().with_context(|| {
        format!("{}: plans are exported; give the plan.json of the program", arguments.plan.display())
    })?;
    let profile = source.profile(&arguments.wanted)?;
    let beads = Beads { header: &plan.header, layers: &plan.layers, profile: &profile };
    let bytes = (format.write)(&beads).with_context(|| format!("{}", arguments.plan.display()))?;
    write_file(&arguments.output, &bytes)?;
    let passes: usize = plan.layers.iter().map(|layer| layer.passes.len()).sum();
    writeln!(std::io::stdout(), "{passes} passes in {} layers in {}", plan.layers.len(), arguments.output.display())?;
    Ok(())
}
