//! `beadwright inspect`.

use crate::{model, progress};
use std::io::Write;
use std::path::PathBuf;

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The model: binary or ASCII STL.
    file: PathBuf,
    /// Print JSON for machines.
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let (task, bar) = progress::task()?;
    let import = model::read(&arguments.file, &task)?;
    bar.finish_and_clear();
    let (low, high) = import.mesh.bounds();
    let (size, volume, repair) = (high - low, import.mesh.volume(), &import.repair);
    let mut out = std::io::stdout().lock();
    if arguments.json {
        let value = serde_json::json!({
            "format": import.format, "min": low.to_array(), "max": high.to_array(), "volume": volume, "repair": repair,
        });
        writeln!(out, "{value:#}")?;
        return Ok(());
    }
    writeln!(out, "{}: {}", arguments.file.display(), import.format)?;
    writeln!(out, "  size       {:.3} × {:.3} × {:.3} (units of the file)", size.x, size.y, size.z)?;
    writeln!(out, "  from       x {:.3} y {:.3} z {:.3}", low.x, low.y, low.z)?;
    writeln!(out, "  triangles  {}", repair.triangles)?;
    writeln!(out, "  vertices   {}", repair.vertices)?;
    writeln!(out, "  shells     {}", repair.shells)?;
    writeln!(out, "  volume     {volume:.3}{}", if repair.open_edges > 0 { " (not closed: approximate)" } else { "" })?;
    if repair.is_clean() {
        writeln!(out, "  The mesh is closed and clean.")?;
    }
    for line in repair.sentences() {
        writeln!(out, "  {line}")?;
    }
    Ok(())
}
