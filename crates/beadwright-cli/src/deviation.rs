//! `beadwright deviation`: how far a scan of the built part, or what a plan builds, lies from the part.

use crate::program::Source;
use crate::{model, profile, progress, scanned};
use anyhow::Context;
use beadwright::as_built::{self, AsBuilt};
use beadwright::deviation::{Deviation, Doubt, Figures, deviation};
use beadwright::model::{Mesh, Units};
use beadwright::profile::Profile;
use beadwright::task::Task;
use std::io::Write;
use std::path::{Path, PathBuf};

#[derive(clap::Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    model: model::Model,
    /// Scan, in the coordinates of the part as it is planned, with z = 0 on the plate: a surface or cloud of points
    /// (PLY, STL, OBJ, 3MF, AMF), lines of x, y, z (CSV, XYZ), or a height map. It need not be closed. Or a plan.json:
    /// then the shape that its beads build is compared, with its own profile.
    #[arg(value_name = "SCAN|PLAN")]
    scan: PathBuf,
    #[command(flatten)]
    scanner: scanned::Scanner,
    /// Unit of the scan's coordinates, if its file does not give it.
    #[arg(long, value_parser = model::parse_units, value_name = "mm|cm|m|in", default_value = "mm")]
    scan_units: Units,
    /// The scan shows the part's preform: what lies outside the part is to be milled off.
    #[arg(long)]
    preform: bool,
    /// The existing part that the plan was made with: both are placed as one.
    #[arg(long, value_name = "MODEL", conflicts_with = "preform")]
    onto: Option<PathBuf>,
    #[command(flatten)]
    wanted: profile::Wanted,
    /// Print machine-readable JSON.
    #[arg(long)]
    json: bool,
}

/// A plan that shares less than this fraction with a part is that of another part, or of one placed elsewhere.
const ELSEWHERE: f64 = 0.5;

/// Advice on how to place the part as it was planned.
const PLACED: &str = "place the part as it was for the plan, with its --units, --scale, --turn, --centre, --shift, --lay-flat, --orient \
                      and --onto.";

/// What was compared with the part.
struct Compared {
    /// What it is: the format of a scan, or a plan.
    format: String,
    deviation: Deviation,
    /// What the metal of a plan has in common with the part.
    built: Option<AsBuilt>,
}

pub(crate) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let (task, bar) = progress::task()?;
    let compared = if is_plan(&arguments.scan) { arguments.plan(&task) } else { arguments.scan(&task) };
    bar.finish_and_clear();
    let Compared { format, deviation, built } = compared?;
    let Deviation { figures, plate, doubts, .. } = deviation;
    let mut out = std::io::stdout().lock();
    if arguments.json {
        let mut value = serde_json::json!({ "format": format, "figures": figures, "plate": plate, "doubts": doubts });
        if let Some(built) = built {
            value["built"] = serde_json::json!(built);
            value["built"]["agreement"] = built.agreement().into();
        }
        return Ok(writeln!(out, "{value:#}")?);
    }
    if let Some(built) = built.as_ref().filter(|built| built.agreement() < ELSEWHERE) {
        let share = 100.0 * built.agreement();
        writeln!(out, "warning: plan and part have only {share:.1} % in common: {PLACED}")?;
    } else {
        for doubt in &doubts {
            writeln!(out, "warning: {doubt}{}", remedy(doubt))?;
        }
    }
    let (scan, part) = (arguments.scan.display(), arguments.model.model.display());
    writeln!(out, "{scan} against {part}: {format} of {} points", figures.points)?;
    if plate > 0 {
        writeln!(out, "{plate} points of the plate around the part are left out")?;
    }
    if let Some(built) = &built {
        writeln!(
            out,
            "beads are taken to be as high as their layers; the plan's built top shows where they end by the deposit model"
        )?;
        print_built(&mut out, built)?;
    }
    print(&mut out, &figures)
}

/// Whether a file is a plan: no scan is an object of JSON.
fn is_plan(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("json"))
}

impl Arguments {
    /// The part as it was planned.
    fn part(&self, profile: &Profile, task: &Task) -> anyhow::Result<Mesh> {
        if let Some(base) = &self.onto {
            return Ok(self.model.placed_onto(base, profile, task)?.0.mesh);
        }
        let use_as = if self.preform { model::Use::Preform } else { model::Use::AsDrawn };
        let mut part = self.model.placed(profile, use_as, task)?.mesh;
        if self.preform {
            let lift = profile.preform_settings().lift();
            part.vertices.iter_mut().for_each(|vertex| vertex.z += lift);
        }
        Ok(part)
    }

    fn scan(&self, task: &Task) -> anyhow::Result<Compared> {
        let name = self.wanted.profile.as_deref().unwrap_or(profile::USUAL);
        let profile = profile::load(name, &self.wanted.set)?;
        let part = self.part(&profile, task)?;
        let context = || format!("{}", self.scan.display());
        let scan = self.scanner.read(&self.scan, self.scan_units.in_mm(), task)?;
        let compared = deviation(&part, &scan.points, profile.fill.machining_allowance, task);
        let deviation = compared.with_context(context)?;
        Ok(Compared { format: scan.format.to_string(), deviation, built: None })
    }

    fn plan(&self, task: &Task) -> anyhow::Result<Compared> {
        anyhow::ensure!(
            self.scanner.file().is_none(),
            "{}: a plan is in the coordinates of the part. Leave out --scanner, or give a scan.",
            self.scan.display()
        );
        let source = Source::open(&self.scan)?;
        let profile = source.profile(&self.wanted)?;
        let part = self.part(&profile, task)?;
        let layers = source.plan().map_or(&[][..], |plan| &plan.layers);
        let built = as_built::as_built(layers, &profile, &part, task);
        let built = built.with_context(|| format!("{}", self.scan.display()))?;
        Ok(Compared { format: "surface of its beads".to_owned(), deviation: built.surface.clone(), built: Some(built) })
    }
}

fn print_built(out: &mut impl Write, built: &AsBuilt) -> anyhow::Result<()> {
    let cubic = |volume: f64| volume / 1e3;
    writeln!(
        out,
        "{:.1} % of their joint volume is shared: beads take up {:.1} of {:.1} cm³ of the part, and {:.1} cm³ outside \
         it (counted in voxels of {:.2} mm; {:.1} cm³ are laid)",
        100.0 * built.agreement(),
        cubic(built.common),
        cubic(built.part),
        cubic(built.metal - built.common),
        built.step,
        cubic(built.laid)
    )?;
    Ok(())
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
