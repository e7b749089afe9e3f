//! `beadwright inspect`.

use crate::{convert, file, model, profile, program, progress, say};
use anyhow::Context;
use beadwright::dialect::reading;
use beadwright::export::toolpath;
use beadwright::model::iges::{IgesCurve, IgesFile};
use beadwright::model::{Import, Mesh, Solids, Units, decoded, holes, import_damaged, is_solid, outline, stl};
use beadwright::report::overhang;
use glam::DVec3;
use std::io::Write;
use std::path::{Path, PathBuf};

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// Model (STL, 3MF, OBJ, PLY, AMF, DXF, SVG, IGES, or STEP with a converter), plan.json, toolpaths in 3MF, or program in
    /// G-code, KRL, RAPID, FANUC TP, INFORM or URScript; - for standard input.
    file: PathBuf,
    /// Write the mended solid as STL, in the units of the file; with --output.
    #[arg(long, requires = "output")]
    repair: bool,
    /// File for the mended solid; - for standard output.
    #[arg(long, short, value_name = "FILE", requires = "repair")]
    output: Option<PathBuf>,
    /// Also close holes up to this size, measured across, in the units of the file.
    #[arg(long, value_name = "SIZE", requires = "repair", value_parser = parse_size)]
    fill_holes: Option<f64>,
    /// Write a picture of the overhanging faces, seen from below, as SVG.
    #[arg(long, value_name = "FILE")]
    overhang: Option<PathBuf>,
    #[command(flatten)]
    wanted: profile::Wanted,
    #[command(flatten)]
    reading: program::Reading,
    /// Print machine-readable JSON.
    #[arg(long)]
    json: bool,
}

fn parse_size(text: &str) -> Result<f64, String> {
    let size: f64 = text.parse().map_err(|_| "a size in the units of the file is expected".to_owned())?;
    if size > 0.0 && size.is_finite() { Ok(size) } else { Err("it must be above 0".to_owned()) }
}

pub(crate) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let bytes = file::model(&arguments.file)?;
    let bytes = &*decoded(&bytes).with_context(|| format!("{}", arguments.file.display()))?;
    if let Some(file) = model::read_iges(&arguments.file, bytes)? {
        return Ok(curves(&file, arguments)?);
    }
    if outline::drawing(bytes).is_some() {
        return drawing(bytes, arguments);
    }
    if toolpath::is_toolpath(bytes) || !is_solid(bytes) && is_program(bytes) {
        return read_program(arguments);
    }
    let (task, bar) = progress::task()?;
    let bytes = convert::solid(&arguments.file, bytes.to_vec())?;
    let import = import_damaged(&bytes, &task).with_context(|| format!("{}", arguments.file.display()))?;
    bar.finish_and_clear();
    let (import, remarks) = match arguments.fill_holes {
        Some(widest) => {
            let (import, closed) = holes::close(import, widest);
            (import, closed.sentences())
        }
        None => (import, Vec::new()),
    };
    if let Some(path) = &arguments.overhang {
        let picture = overhang::svg(&import.mesh).with_context(|| format!("{}", arguments.file.display()))?;
        file::write(path, picture.as_bytes())?;
    }
    let (low, high) = import.mesh.bounds();
    let (size, volume, repair) = (high - low, import.mesh.volume(), &import.repair);
    if let Some(path) = &arguments.output {
        write_mended(path, &import)?;
    }
    let mut out = say::done(arguments.output.as_deref().is_some_and(file::is_standard));
    if arguments.json {
        let value = serde_json::json!({
            "format": import.format, "units": import.units, "objects": import.objects, "min": low.to_array(), "max": high.to_array(), "volume": volume, "repair": repair,
        });
        writeln!(out, "{value:#}")?;
        return Ok(());
    }
    writeln!(out, "{}: {}", arguments.file.display(), import.format)?;
    let unit = if import.units.is_some() { "mm" } else { "units of the file" };
    writeln!(out, "  size       {:.3} × {:.3} × {:.3} ({unit})", size.x, size.y, size.z)?;
    writeln!(out, "  from       x {:.3} y {:.3} z {:.3}", low.x, low.y, low.z)?;
    writeln!(out, "  triangles  {}", repair.triangles)?;
    writeln!(out, "  vertices   {}", repair.vertices)?;
    writeln!(out, "  shells     {}", repair.shells)?;
    writeln!(out, "  volume     {volume:.3}{}", if repair.open_edges > 0 { " (not closed: approximate)" } else { "" })?;
    for object in &import.objects {
        writeln!(out, "  object     {}, {} triangles", object.name, object.triangles)?;
    }
    if (2..=MOST_SOLIDS).contains(&repair.shells) {
        list_solids(&mut out, &import.mesh)?;
    }
    if repair.is_clean() {
        writeln!(out, "  The mesh is closed and clean.")?;
    }
    for line in remarks.into_iter().chain(repair.sentences()) {
        writeln!(out, "  {line}")?;
    }
    if let Some(path) = &arguments.output {
        writeln!(out, "  The mended solid is in {}.", path.display())?;
    }
    Ok(())
}

/// Solids are listed up to this number of shells; a broken mesh has more.
const MOST_SOLIDS: usize = 50;

/// Each solid of several, with a point on it, in the coordinates of the file.
fn list_solids(out: &mut impl Write, mesh: &Mesh) -> anyhow::Result<()> {
    let solids = Solids::of(mesh);
    if solids.count() == 1 {
        return Ok(());
    }
    for number in 0..solids.count() {
        let volume = solids.mesh(&[number]).volume();
        let at = solids
            .point(number)
            .map_or_else(String::new, |p| format!(", at {:.4}/{:.4}/{:.4} in the file", p.x, p.y, p.z));
        writeln!(out, "  solid      {volume:.3}{at}")?;
    }
    Ok(())
}

/// Writes the mended solid, as STL.
fn write_mended(path: &Path, import: &Import) -> anyhow::Result<()> {
    let is_stl = file::is_standard(path) || path.extension().is_some_and(|end| end.eq_ignore_ascii_case("stl"));
    anyhow::ensure!(is_stl, "{}: the mended solid is written as STL; give a name that ends in .stl", path.display());
    let mesh = &import.mesh;
    let facets = mesh.triangles.iter().map(|t| t.map(|i| mesh.vertices[i as usize]));
    file::write(path, &stl::write("mended by beadwright", facets))
}

/// What a drawing holds.
fn drawing(bytes: &[u8], arguments: &Arguments) -> anyhow::Result<()> {
    let outlines = outline::read(bytes).with_context(|| format!("{}", arguments.file.display()))?;
    let (size, region, mut out) = (outlines.size(), outlines.region(1.0), std::io::stdout().lock());
    let unit = outlines.units.and_then(|unit| Units::ALL.iter().find(|(_, known)| *known == unit));
    let unit = unit.map_or("units of the file", |(name, _)| *name);
    if arguments.json {
        let value = serde_json::json!({
            "format": outlines.format, "units": outlines.units, "size": size.to_array(), "outlines": outlines.rings.len(),
            "islands": region.polygons().len(), "area": region.area(), "notes": outlines.notes,
        });
        writeln!(out, "{value:#}")?;
        return Ok(());
    }
    writeln!(out, "{}: {}", arguments.file.display(), outlines.format)?;
    writeln!(out, "  size       {:.3} × {:.3} ({unit})", size.x, size.y)?;
    writeln!(out, "  outlines   {}, around {} islands", outlines.rings.len(), region.polygons().len())?;
    writeln!(out, "  area       {:.3}", region.area())?;
    outlines.notes.iter().try_for_each(|note| writeln!(out, "  {note}"))?;
    writeln!(out, "  With a height it becomes a part: `beadwright plan` with --height.")?;
    Ok(())
}

/// Whether the file holds a plan or a program. Models are also recognised by their content, and are not programs.
fn is_program(bytes: &[u8]) -> bool {
    let Ok(text) = std::str::from_utf8(bytes) else { return false };
    let solid = text.trim_start().get(..5).is_some_and(|word| word.eq_ignore_ascii_case("solid"));
    !text.contains('\0') && !solid && (text.trim_start().starts_with('{') || reading::recognise(text).is_some())
}

/// What a plan or a program holds.
fn read_program(arguments: &Arguments) -> anyhow::Result<()> {
    let (task, bar) = progress::task()?;
    let source = program::Source::open(&arguments.file)?;
    let profile = source.profile(&arguments.wanted)?;
    let loaded = source.load(&arguments.reading, &arguments.wanted, &profile, None, &task)?;
    bar.finish_and_clear();
    let (t, passes) = (&loaded.totals, || loaded.layers.iter().flat_map(|l| &l.passes));
    let points = || passes().flat_map(|p| &p.points);
    let low = points().fold(DVec3::INFINITY, |a, b| a.min(*b));
    let high = points().fold(DVec3::NEG_INFINITY, |a, b| a.max(*b));
    let speeds = || passes().flat_map(|p| p.segments()).map(|s| s.pace);
    let (slow, fast) = (speeds().fold(f64::INFINITY, f64::min), speeds().fold(0.0, f64::max));
    let mut out = std::io::stdout().lock();
    if arguments.json {
        let value = serde_json::json!({
            "format": loaded.language, "layers": loaded.layers.len(), "points": points().count(), "totals": t,
            "min": low.to_array(), "max": high.to_array(), "speed": [slow, fast], "notes": loaded.notes,
        });
        writeln!(out, "{value:#}")?;
        return Ok(());
    }
    writeln!(out, "{}: {}", arguments.file.display(), loaded.language)?;
    writeln!(out, "  layers            {}", loaded.layers.len())?;
    writeln!(out, "  arc starts        {}", t.arc_starts)?;
    writeln!(out, "  deposited length  {:.3} m on {} points", t.deposited_length_mm / 1e3, points().count())?;
    writeln!(out, "  travel length     {:.3} m", t.travel_length_mm / 1e3)?;
    writeln!(out, "  time              {:.1} min", t.total_time_s / 60.0)?;
    writeln!(out, "  deposition speed  {slow:.2} to {fast:.2} mm/s")?;
    writeln!(out, "  from              x {:.3} y {:.3} z {:.3}", low.x, low.y, low.z)?;
    writeln!(out, "  to                x {:.3} y {:.3} z {:.3}", high.x, high.y, high.z)?;
    loaded.notes.iter().try_for_each(|note| writeln!(out, "  note: {note}"))?;
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
    writeln!(out, "{}: IGES by {}, {} mm per unit", arguments.file.display(), file.system.trim(), file.unit_mm)?;
    writeln!(out, "  entity                                 read  not read")?;
    for e in &file.entities {
        writeln!(out, "  {:>3} {:<33} {:>5} {:>9}", e.entity, e.name, e.read, e.unread)?;
    }
    let own = || file.independent_curves();
    writeln!(out, "  {} curves, {} of them independent", file.curves.len(), own().count())?;
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
