//! `beadwright inspect`.

use crate::{model, progress};
use beadwright::model::iges::{IgesCurve, IgesFile};
use std::io::Write;
use std::path::PathBuf;

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The model: binary or ASCII STL, or IGES.
    file: PathBuf,
    /// Print JSON for machines.
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    if let Some(file) = model::read_iges(&arguments.file)? {
        return Ok(curves(&file, arguments)?);
    }
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

/// What an IGES file holds.
fn curves(file: &IgesFile, arguments: &Arguments) -> std::io::Result<()> {
    let mut out = std::io::stdout().lock();
    if arguments.json {
        let entities: Vec<_> = file
            .entities
            .iter()
            .map(|e| serde_json::json!({ "entity": e.entity, "name": e.name, "read": e.read, "unread": e.unread }))
            .collect();
        let curves: Vec<_> = file
            .curves
            .iter()
            .map(|c| serde_json::json!({ "entry": c.entry, "entity": c.entity, "name": c.name, "length": length(c) }))
            .collect();
        let value = serde_json::json!({ "format": "IGES", "system": file.system, "unit_mm": file.unit_mm, "entities": entities, "curves": curves, "warnings": file.warnings });
        return writeln!(out, "{value:#}");
    }
    writeln!(out, "{}: IGES by {}, {} mm a unit", arguments.file.display(), file.system.trim(), file.unit_mm)?;
    writeln!(out, "  entity                                 read  not read")?;
    for e in &file.entities {
        writeln!(out, "  {:>3} {:<33} {:>5} {:>9}", e.entity, e.name, e.read, e.unread)?;
    }
    let own = || file.independent_curves();
    writeln!(out, "  {} curves, {} of them stand for themselves", file.curves.len(), own().count())?;
    for curve in own() {
        let bounds = curve.parts.iter().map(|part| part.bounds());
        let (low, high) = bounds.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))).unwrap_or_default();
        writeln!(
            out,
            "  D{:<6} {:<12} {:9.2} mm long, z {:.2} to {:.2} mm",
            curve.entry,
            curve.name,
            length(curve),
            low.z,
            high.z
        )?;
    }
    file.warnings.iter().try_for_each(|warning| writeln!(out, "  warning: {warning}"))
}

fn length(curve: &IgesCurve) -> f64 {
    curve.parts.iter().map(|part| part.length()).sum()
}
