//! `beadwright deviation`: how far a scan of the built part lies from the part.

use crate::{file, model, profile, progress};
use anyhow::Context;
use beadwright::adapt::scan;
use beadwright::deviation::{Deviation, Doubt, Figures, deviation};
use beadwright::model::Units;
use std::io::Write;
use std::path::PathBuf;

#[derive(clap::Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    model: model::Model,
    /// Scan, in the coordinates of the part as it is planned, with z = 0 on the plate: a surface or cloud of points (PLY,
    /// STL, OBJ, 3MF, AMF), lines of x, y, z (CSV, XYZ), or a height map. It need not be closed.
    scan: PathBuf,
    /// Unit of the scan's coordinates, if its file does not give it.
    #[arg(long, value_parser = model::parse_units, value_name = "mm|cm|m|in", default_value = "mm")]
    scan_units: Units,
    /// The scan is of the part's preform: what lies outside the part is to be milled off.
    #[arg(long)]
    preform: bool,
    #[command(flatten)]
    wanted: profile::Wanted,
    /// Print machine-readable JSON.
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let name = arguments.wanted.profile.as_deref().unwrap_or(profile::USUAL);
    let profile = profile::load(name, &arguments.wanted.set)?;
    let (task, bar) = progress::task()?;
    let use_as = if arguments.preform { model::Use::Preform } else { model::Use::AsDrawn };
    let mut part = arguments.model.placed(&profile, use_as, &task)?.mesh;
    if arguments.preform {
        let lift = profile.preform_settings().lift();
        part.vertices.iter_mut().for_each(|vertex| vertex.z += lift);
    }
    let context = || format!("{}", arguments.scan.display());
    let mut scan = scan::read(&file::read(&arguments.scan)?, &task).with_context(context)?;
    let millimetres = arguments.scan_units.in_mm();
    scan.points.iter_mut().for_each(|point| *point *= millimetres);
    let compared = deviation(&part, &scan.points, profile.fill.machining_allowance, &task);
    bar.finish_and_clear();
    let Deviation { figures, plate, doubts, .. } = compared.with_context(context)?;
    let mut out = std::io::stdout().lock();
    if arguments.json {
        let value = serde_json::json!({ "format": scan.format, "figures": figures, "plate": plate, "doubts": doubts });
        return Ok(writeln!(out, "{value:#}")?);
    }
    for doubt in &doubts {
        writeln!(out, "warning: {doubt}{}", remedy(doubt))?;
    }
    let (scan, format) = (arguments.scan.display(), scan.format);
    writeln!(out, "{scan} against {}: {format} of {} points", arguments.model.model.display(), figures.points)?;
    if plate > 0 {
        writeln!(out, "{plate} points of the plate around the part are left out")?;
    }
    print(&mut out, &figures)
}

/// What to change in the command.
fn remedy(doubt: &Doubt) -> String {
    let named = |unit: &Units| Units::ALL.iter().find(|(_, of)| of == unit).map_or("in", |(name, _)| *name);
    match doubt {
        Doubt::ScanUnit(unit) => format!(" Give --scan-units {}.", named(unit)),
        Doubt::PartUnit(unit) => format!(" Give --units {}.", named(unit)),
        Doubt::Off(_) => " --turn, --centre and --shift place the part.".to_owned(),
        Doubt::Open(_) => String::new(),
    }
}

fn print(out: &mut impl Write, figures: &Figures) -> anyhow::Result<()> {
    let length = |length: f64| format!("{length:+.3} mm");
    let extreme = |of: beadwright::deviation::Extreme| {
        format!("{}  x {:.1} y {:.1} z {:.1}", length(of.distance), of.at.x, of.at.y, of.at.z)
    };
    let percent = |part: f64| format!("{:.1} %", 100.0 * part);
    let allowance = figures.allowance;
    let rows = [
        ("mean".to_owned(), length(figures.mean)),
        ("standard deviation".to_owned(), format!("{:.3} mm", figures.standard_deviation)),
        ("farthest outside".to_owned(), extreme(figures.highest)),
        ("farthest inside".to_owned(), extreme(figures.lowest)),
    ];
    let within = || (format!("within the allowance, 0 to {allowance} mm"), percent(figures.within));
    let within = (allowance > 0.0).then(within);
    let beyond = if within.is_some() { "outside beyond it" } else { "outside" };
    let shares = [
        (beyond.to_owned(), percent(figures.above)),
        ("inside, where metal is missing".to_owned(), percent(figures.below)),
    ];
    writeln!(out)?;
    for (name, value) in rows.into_iter().chain(within).chain(shares) {
        writeln!(out, "  {name:<40} {value}")?;
    }
    Ok(())
}
