//! `beadwright repair`: what a scan of a damaged part lacks, as metal to be welded with its bodies, for `plan --onto`.

use crate::onto::Onto;
use crate::{file, model, onto, profile, progress, say};
use anyhow::Context;
use beadwright::adapt::scan;
use beadwright::chart::{Chart, SurfaceError};
use beadwright::damage::{self, Damage, DamageError, Left, Movement, Reason, Repair, Settings, Stretch};
use beadwright::model::{Mesh, Solids, Units, stl};
use beadwright::profile::{Body, Profile, Solid};
use beadwright::task::Task;
use glam::DVec3;
use std::io::Write;
use std::path::{Path, PathBuf};

#[derive(clap::Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    model: model::Model,
    /// Scan of the damaged part, in the coordinates of the part as it is planned, with z = 0 on the plate: a surface (PLY, STL, OBJ,
    /// 3MF, AMF). It need not be closed.
    #[arg(value_name = "SCAN")]
    scan: PathBuf,
    /// Unit of the scan's coordinates, if its file does not give it.
    #[arg(long, value_parser = model::parse_units, value_name = "mm|cm|m|in", default_value = "mm")]
    scan_units: Units,
    /// Direction from which all damage is welded, along which layers are stacked; that in which each damage is open if left out.
    #[arg(long, value_name = "X/Y/Z", allow_hyphen_values = true)]
    up: Option<String>,
    /// How far the scan may lie inside the part before metal counts as missing, mm.
    #[arg(long, value_name = "MM", default_value_t = 0.5, value_parser = parse_tolerance)]
    tolerance: f64,
    /// Metal welded above the part's surface, at most, mm, to be milled off: one layer if left out, which is the least. Around edges and
    /// corners too narrow for a bead it is more.
    #[arg(long, value_name = "MM", value_parser = parse_allowance)]
    allowance: Option<f64>,
    /// Angle between the sides of a groove and its floor, degrees, where damage is so steep that it is milled to a groove first.
    #[arg(long, value_name = "DEG", default_value_t = 45.0, value_parser = parse_sides)]
    sides: f64,
    /// Spacing of the grid on which heights are sampled, mm; finer detail is smoothed out.
    #[arg(long, value_name = "MM", default_value_t = 2.0, value_parser = crate::surface::parse_step)]
    step: f64,
    /// Model of the metal to write (STL); its bodies come beside it, as NAME.bodies.toml, and the damaged part with its grooves milled,
    /// as NAME.base.stl.
    #[arg(long, short, value_name = "FILE", default_value = "repair.stl")]
    output: PathBuf,
    #[command(flatten)]
    wanted: profile::Wanted,
}

fn parse_sides(text: &str) -> Result<f64, String> {
    let sides: f64 = text.parse().map_err(|_| "an angle in degrees is expected".to_owned())?;
    if (20.0..=80.0).contains(&sides) {
        Ok(sides)
    } else {
        Err("the angle must lie between 20 and 80 degrees".to_owned())
    }
}

fn parse_tolerance(text: &str) -> Result<f64, String> {
    length(text, 0.05..=20.0)
}

fn parse_allowance(text: &str) -> Result<f64, String> {
    length(text, 0.1..=50.0)
}

fn length(text: &str, range: std::ops::RangeInclusive<f64>) -> Result<f64, String> {
    let length: f64 = text.parse().map_err(|_| "a length in mm is expected".to_owned())?;
    let wrong = || format!("the length must lie between {} and {} mm", range.start(), range.end());
    if range.contains(&length) { Ok(length) } else { Err(wrong()) }
}

/// Damage may be bare to this fraction before it is said: its rim is.
const BARE: f64 = 0.05;
/// What lies this much higher or lower is said, mm.
const OFF_PLATE: f64 = 0.05;

pub(crate) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let name = arguments.wanted.profile.as_deref().unwrap_or(profile::USUAL);
    let profile = profile::load(name, &arguments.wanted.set)?;
    let settings = arguments.settings(&profile)?;
    let files = Files::of(&arguments.output)?;
    files.differ_from(&[&arguments.model.model, &arguments.scan])?;
    let (task, bar) = progress::task()?;
    let part = arguments.model.placed(&profile, model::Use::AsDrawn, &task)?.mesh;
    let beside = arguments.model.drawn(&task)?.bounds().0.z;
    let scan = arguments.scan(&task)?;
    let movement = damage::moved(&part, &scan, settings, &task).map_err(advised)?;
    let (scan, lowest) = standing(scan);
    let found = |lower: f64| {
        let found = damage::repair(&lowered(&part, lower), &lowered(&scan, lower - lowest), settings, &task);
        found.map_err(advised).with_context(|| arguments.scan.display().to_string())
    };
    // How much lower than the part the program lies, mm: `plan` sets the lowest point of scan and metal on z = 0.
    let mut lower = lowest;
    let mut repair = found(lower)?;
    let under = repair.damages.iter().map(|damage| damage.mesh.bounds().0.z).fold(0.0, f64::min);
    if under < 0.0 {
        lower += under;
        repair = found(lower)?;
    }
    bar.finish_and_clear();
    let mut out = say::done(false);
    if beside.abs() > OFF_PLATE && !arguments.model.placing.moves() {
        writeln!(
            out,
            "warning: the part's file begins at z {beside:.1} mm, and the part was set on the plate; the scan is taken as it is. It must lie where \
             the part is planned."
        )?;
    }
    if lower.abs() > OFF_PLATE {
        let (by, way, against) = if lower > 0.0 { (lower, "lower", "higher") } else { (-lower, "higher", "lower") };
        writeln!(
            out,
            "warning: `plan` takes the lowest point of scan and metal for z = 0, so the program lies {by:.1} mm {way} than the part: set the \
             robot's base that much {against}."
        )?;
    }
    if let Some(movement) = &movement {
        writeln!(out, "{}", apart(movement))?;
    }
    for Stretch { place, area, across } in &repair.through {
        writeln!(
            out,
            "warning: the damage {} goes right through the part, over {:.1} cm², {across:.0} mm across: nothing lies under it there, so it \
             stays bare. Weld a plate under it that backs it, and scan the part again with it: it is filled from there.",
            at(*place, lower),
            area / 100.0
        )?;
    }
    write_unseen(&mut out, &repair.unseen, lower)?;
    for left in &repair.left {
        writeln!(out, "{}", left_out(left, settings, lower))?;
    }
    let tolerance = settings.tolerance;
    if repair.damages.is_empty() {
        anyhow::ensure!(repair.left.is_empty(), "nothing can be welded, and nothing was written");
        writeln!(
            out,
            "no metal is missing: the scan lies more than {tolerance} mm inside the part nowhere, or only in places smaller than a bead."
        )?;
        return Ok(());
    }
    for Damage { place, bare, .. } in repair.damages.iter().filter(|damage| damage.bare > BARE) {
        writeln!(
            out,
            "warning: {:.0} % of the damage {} stays bare: it is too narrow for a bead there, or nothing lies under it along the direction \
             of welding.",
            100.0 * bare,
            at(*place, lower)
        )?;
    }
    for Damage { place, missing, unresolved, .. } in &repair.damages {
        let Some(true_missing) = unresolved else { continue };
        writeln!(
            out,
            "warning: the grid is too coarse for the damage {}: {:.1} cm³ are missing there, but {:.1} cm³ would be welded besides what is \
             milled. Give a finer --step, such as {}.",
            at(*place, lower),
            true_missing / 1e3,
            missing / 1e3,
            finer(settings)
        )?;
    }
    files.write(&repair)?;
    for (number, damage) in repair.damages.iter().enumerate() {
        writeln!(out, "{}. {}", number + 1, sentence(damage, lower))?;
    }
    writeln!(
        out,
        "{}: the metal to be welded, up to {} mm above the part. {}: the damaged part, its grooves milled. Plan it with",
        files.metal.display(),
        settings.allowance,
        files.base.display()
    )?;
    let Files { metal, base, bodies } = &files;
    let wanted = &arguments.wanted;
    let onto = Onto { model: metal, base, bodies, accept_damaged: false, wanted, set: &[] };
    writeln!(out, "  {}", onto.command())?;
    Ok(())
}

impl Arguments {
    fn settings(&self, profile: &Profile) -> anyhow::Result<Settings> {
        let layer = profile.layers.height;
        let allowance = self.allowance.unwrap_or(layer);
        anyhow::ensure!(
            allowance >= layer,
            "--allowance {allowance}: at least the height of a layer, {layer} mm, is needed; layers end where the part does only by chance"
        );
        let up = self.up.as_ref().map(|up| {
            let plane: Chart = format!("plane:up={up}").parse().context("--up")?;
            anyhow::Ok(plane.sheet(0.0).at(DVec3::ZERO).normal)
        });
        let (step, tolerance, sides, bead) = (self.step, self.tolerance, self.sides, profile.bead.width);
        Ok(Settings { up: up.transpose()?, step, tolerance, allowance, layer, bead, sides })
    }

    /// The scan, mm.
    fn scan(&self, task: &Task) -> anyhow::Result<Mesh> {
        let context = || self.scan.display().to_string();
        let scan = scan::read(&file::read(&self.scan)?, task).with_context(context)?;
        let unit = self.scan_units.in_mm();
        Ok(Mesh::from_triangles(scan.points.iter().map(|p| *p * unit).collect(), scan.triangles).0)
    }
}

/// A scan, standing on z = 0, and how high its lowest point lay above the plate.
fn standing(mut scan: Mesh) -> (Mesh, f64) {
    let lowest = scan.bounds().0.z.max(0.0);
    // Below the plate there is only noise.
    scan.vertices.iter_mut().for_each(|p| p.z = (p.z - lowest).max(0.0));
    (scan, lowest)
}

/// Says that a scan lies shifted or turned.
fn apart(Movement { shift, turn, off, left }: &Movement) -> String {
    let angle = turn.length().to_degrees();
    let level = shift.z.abs() < OFF_PLATE && angle < 0.05;
    let by_flag = if level {
        format!(", or move the part to it with --shift ({:.1},{:.1} mm besides what is given)", shift.x, shift.y)
    } else {
        String::new()
    };
    format!(
        "warning: {:.0} % of the scan lies off the part, but only {:.0} % would if it were moved: it seems to be shifted by {:.1} mm \
         (x {:.1} y {:.1} z {:.1}) and turned by {angle:.1}°, and much of the damage is imaginary then. Unless the part is worn so evenly, \
         align the scan with the part in the scanner's program (best fit) first{by_flag}.",
        100.0 * off,
        100.0 * left,
        shift.length(),
        shift.x + 0.0,
        shift.y + 0.0,
        shift.z + 0.0
    )
}

/// Stretches without a scan that are named one by one.
const NAMED: usize = 3;

/// Says what of the part the scan does not show.
fn write_unseen(out: &mut impl Write, unseen: &[Stretch], lower: f64) -> anyhow::Result<()> {
    if unseen.is_empty() {
        return Ok(());
    }
    let area: f64 = unseen.iter().map(|stretch| stretch.area).sum();
    let named = unseen.iter().take(NAMED).map(|Stretch { place, area, across }| {
        format!("{:.1} cm² {}, {across:.0} mm across", area / 100.0, at(*place, lower))
    });
    let rest = if unseen.len() > NAMED { ", and smaller ones" } else { "" };
    writeln!(
        out,
        "warning: the scan does not show {:.1} cm² of the part: {}{rest}. Whether metal is missing there is not known, and nothing is \
         welded there: scan these places as well if they may be damaged.",
        area / 100.0,
        named.collect::<Vec<_>>().join("; ")
    )?;
    Ok(())
}

/// Says that a place is not welded, why, and what helps.
fn left_out(Left { place, depth, up, reason }: &Left, settings: Settings, lower: f64) -> String {
    let remedy = match reason {
        Reason::Through => "Weld a plate under it that backs it, and scan the part again.".to_owned(),
        Reason::Unseen => "Scan it again, from a direction in which its floor is seen.".to_owned(),
        Reason::Coarse => format!("Give a finer --step, such as {}.", finer(settings)),
        Reason::Narrow | Reason::Hidden | Reason::Steep => {
            "Another direction (--up) may do; what is worn all around an axis is welded with `clad --around`."
                .to_owned()
        }
    };
    format!(
        "warning: the damage {}, {depth:.1} mm deep, is not welded along {}: {reason}. {remedy}",
        at(*place, lower),
        words(*up)
    )
}

/// A spacing of the grid that shows more, mm.
fn finer(settings: Settings) -> f64 {
    let tenths = (settings.step / 2.0).min(settings.bead / 3.0) * 10.0;
    tenths.floor().max(1.0) / 10.0
}

fn lowered(mesh: &Mesh, by: f64) -> Mesh {
    let mut mesh = mesh.clone();
    mesh.vertices.iter_mut().for_each(|p| p.z -= by);
    mesh
}

/// An error with the flags that help.
fn advised(error: DamageError) -> anyhow::Error {
    match error {
        DamageError::Surface(SurfaceError::Grid { heights, .. }) => anyhow::anyhow!(
            "a damaged place is so large that its surface would have {heights} heights: give a coarser --step"
        ),
        DamageError::Apart(_) => {
            anyhow::anyhow!("{error}; --turn, --centre and --shift place the part, --scan-units gives the scan's unit")
        }
        _ => error.into(),
    }
}

/// A place, in the coordinates of the part.
fn at(place: DVec3, lower: f64) -> String {
    format!("near x {:.1} y {:.1} z {:.1} mm", place.x, place.y, place.z + lower)
}

/// A direction as `--up` takes it.
fn words(up: DVec3) -> String {
    let [x, y, z] = up.to_array().map(|part| (part * 100.0).round() / 100.0 + 0.0);
    format!("{x}/{y}/{z}")
}

fn sentence(damage: &Damage, lower: f64) -> String {
    let Damage { chart, up, place, depth, missing, milled, .. } = damage;
    let layers = if matches!(chart, Chart::Surface(_)) { "layers that follow it" } else { "level layers" };
    let milling =
        if *milled > 0.05e3 { format!("; mill a groove of {:.1} cm³ first", milled / 1e3) } else { String::new() };
    format!(
        "{}: {depth:.1} mm deep, {:.1} cm³ missing, welded in {layers} along {}{milling}.",
        at(*place, lower),
        missing / 1e3,
        words(*up)
    )
}

/// The files that are written.
struct Files {
    metal: PathBuf,
    base: PathBuf,
    bodies: PathBuf,
}

impl Files {
    fn of(output: &Path) -> anyhow::Result<Self> {
        anyhow::ensure!(
            !file::is_standard(output),
            "--output -: the metal, its bodies and the damaged part are three files; give the metal a name, such as repair.stl"
        );
        onto::check_name(output)?;
        let beside = |extension: &str| output.with_extension(extension);
        Ok(Self { metal: output.to_owned(), base: beside("base.stl"), bodies: beside("bodies.toml") })
    }

    fn differ_from(&self, given: &[&Path]) -> anyhow::Result<()> {
        for path in [&self.metal, &self.base] {
            let same =
                |given: &&&Path| path.canonicalize().is_ok_and(|path| given.canonicalize().is_ok_and(|g| g == path));
            if let Some(given) = given.iter().find(same) {
                anyhow::bail!("{}: that would be overwritten; give --output another name", given.display());
            }
        }
        Ok(())
    }

    fn write(&self, repair: &Repair) -> anyhow::Result<()> {
        let name = self.metal.file_stem().map_or("repair".into(), |stem| stem.to_string_lossy().into_owned());
        let bodies: Vec<Body> = repair.damages.iter().enumerate().map(|(k, damage)| body(k, damage)).collect();
        let metal = repair.damages.iter().flat_map(|damage| triangles(&damage.mesh));
        file::write(&self.metal, &stl::write(&name, metal))?;
        file::write(&self.base, &stl::write(&format!("{name} base"), triangles(&repair.base)))?;
        file::write(&self.bodies, Body::write(&bodies).as_bytes())
    }
}

fn triangles(mesh: &Mesh) -> impl Iterator<Item = [DVec3; 3]> {
    mesh.triangles.iter().map(|corners| corners.map(|corner| mesh.vertices[corner as usize]))
}

/// The body of one damage; they lie so far apart that a point on each of its solids names it.
fn body(number: usize, damage: &Damage) -> Body {
    let solids = Solids::of(&damage.mesh);
    let points = (0..solids.count()).filter_map(|solid| solids.point(solid));
    let thousandths = |p: DVec3| (p * 1e3).round() / 1e3;
    Body {
        solids: points.map(thousandths).map(Solid::At).collect(),
        on_stock: true,
        ..Body::of(&format!("damage {}", number + 1), damage.chart.clone())
    }
}
