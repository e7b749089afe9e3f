//! `beadwright export`.

use crate::{profile, program, progress};
use anyhow::Context;
use beadwright::export::{self, FORMATS};
use beadwright::files::write_file;
use std::io::Write;
use std::path::PathBuf;

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// plan.json.
    plan: PathBuf,
    #[command(flatten)]
    wanted: profile::Wanted,
    /// File to write; its ending tells the format: .csv (a table of all pieces of beads) or .vtp (ParaView, VTK, pyvista).
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
    anyhow::ensure!(
        source.plan().is_some(),
        "{}: plans are exported; give the plan.json of the program",
        arguments.plan.display()
    );
    let profile = source.profile(&arguments.wanted)?;
    let (task, bar) = progress::task()?;
    let loaded = source.load(&program::Reading::default(), &arguments.wanted, &profile, None, &task)?;
    let pieces = export::pieces(&loaded.layers, &profile);
    bar.finish_and_clear();
    write_file(&arguments.output, &(format.write)(&pieces))?;
    writeln!(std::io::stdout(), "{} pieces of beads in {}", pieces.len(), arguments.output.display())?;
    Ok(())
}
