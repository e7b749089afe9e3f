//! `beadwright preform`: the part with what is milled off again.

use crate::{file, model, profile, progress, remedy, say};
use anyhow::Context;
use beadwright::Profile;
use beadwright::export::solids;
use beadwright::glam::DVec3;
use beadwright::model::holes::{self, Opening};
use beadwright::model::{Import, Mesh, Part, stl};
use beadwright::plan::PlanError;
use beadwright::preform::Preform;
use beadwright::preform::figures::Figures;
use beadwright::preform::orient::{self, Oriented};
use beadwright::slice::Surface;
use beadwright::task::Task;
use std::convert::Infallible;
use std::io::Write;
use std::path::PathBuf;

#[derive(clap::Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    model: model::Model,
    #[command(flatten)]
    wanted: profile::Wanted,
    /// File to write: the preform as STL, or with the part in it as 3MF; NAME_preform.stl if left out.
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Print the figures as JSON instead of the summary.
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let name = arguments.wanted.profile.as_deref().unwrap_or(profile::USUAL);
    let profile = profile::load(name, &arguments.wanted.set)?;
    let (task, bar) = progress::task()?;
    let Import { mesh: mut part, .. } = arguments.model.placed(&profile, model::Use::Preform, &task)?;
    is_solid(&part, &profile).with_context(|| format!("{}", arguments.model.model.display()))?;
    let settings = profile.preform_settings();
    let preform = Preform::of(&part, &settings, &task)?;
    let ways = orient::best(&part, &settings, &profile.preform_rates(), &task)?;
    let now = Oriented::of(&part, DVec3::NEG_Z, &settings, &profile.preform_rates(), &task)?;
    bar.finish_and_clear();
    let figures = Figures::of(&part, &preform, &settings, &profile.preform_rates());
    let mesh = preform.mesh();
    part.vertices.iter_mut().for_each(|vertex| vertex.z += preform.lift);

    let path = arguments.output.clone().unwrap_or_else(|| format!("{}_preform.stl", arguments.model.part()).into());
    let bytes = match path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("3mf")) {
        true => solids::threemf(&[("preform", &mesh), ("part", &part)])?,
        false => {
            let corners = |t: &[u32; 3]| t.map(|corner| mesh.vertices[corner as usize]);
            stl::write(&format!("preform of {}", arguments.model.part()), mesh.triangles.iter().map(corners))
        }
    };
    file::write(&path, &bytes)?;

    if arguments.json {
        let way_up = |way: &Oriented| serde_json::json!({ "down": way.down, "figures": way.figures });
        let json = serde_json::json!({
            "figures": figures,
            "lift": preform.lift,
            "as_it_lies": now.figures,
            "ways_up": ways.iter().map(way_up).collect::<Vec<_>>(),
        });
        return Ok(writeln!(std::io::stdout(), "{json:#}")?);
    }
    let mut out = say::done(file::is_standard(&path));
    writeln!(out, "{}: preform of {}", path.display(), arguments.model.model.display())?;
    for (name, value) in rows(&figures, &profile) {
        writeln!(out, "  {name:<22} {value}")?;
    }
    let height = if preform.lift < 0.0 { "below the top of the plate" } else { "above the plate" };
    writeln!(out, "  {:<22} {:.1} mm {height}", "the part's foot", preform.lift.abs())?;
    if let Some(best) = ways.first() {
        let saved = 1.0 - best.figures.score() / now.figures.score();
        if saved > WORTH_TURNING {
            writeln!(out, "another way up saves {:.0} %: --orient turns the part.", 100.0 * saved)?;
        }
    }
    Ok(())
}

/// A part is turned for this part of its cost.
const WORTH_TURNING: f64 = 0.01;

/// What there is to say of a preform.
fn rows(figures: &Figures, profile: &Profile) -> Vec<(&'static str, String)> {
    let currency = &profile.cost.currency;
    let ratio = |kg: f64, ratio: f64| format!("{kg:.3} kg, {ratio:.2} kg bought per kg of the part");
    let plate = match figures.cut_height {
        Some(cut) => format!("{:.3} kg, sawn off {cut:.1} mm above it", figures.plate_kg),
        None => format!("{:.3} kg, part of the part", figures.plate_kg),
    };
    let mut rows = vec![
        ("part", format!("{:.3} kg", figures.part_kg)),
        ("preform", format!("{:.3} kg", figures.preform_kg)),
        ("plate", plate),
        ("preform and plate", ratio(figures.preform_kg + figures.plate_kg, figures.buy_to_fly)),
        ("block", ratio(figures.billet_kg, figures.billet_buy_to_fly)),
        ("milled off", format!("{:.3} kg", figures.milled_kg)),
        ("arc", format!("{:.2} h, without pauses", figures.arc_hours)),
        ("milling", format!("{:.2} h, from the block {:.2} h", figures.milling_hours, figures.billet_milling_hours)),
    ];
    let prices = figures.price.zip(figures.billet_price);
    rows.extend(
        prices
            .map(|(price, billet)| ("price", format!("{price:.2} {currency}, from the block {billet:.2} {currency}"))),
    );
    rows
}

/// Refuses a surface that is not closed, unless the profile says that it is the skin of a solid.
fn is_solid(mesh: &Mesh, profile: &Profile) -> anyhow::Result<()> {
    let opening = holes::openings(mesh).into_iter().next();
    match opening.filter(|opening| opening.width > profile.bead.width) {
        Some(Opening { width, place, .. }) if profile.slice.surface != Some(Surface::Solid) => {
            let error: PlanError<Infallible> = PlanError::Open { width, place };
            let remedy = remedy::of_plan(&error).unwrap_or_default();
            anyhow::bail!("only solids have a preform: {error} {remedy}")
        }
        _ => Ok(()),
    }
}

/// What a preform would add to a part that was refused; `None` for a surface that is not closed.
pub(crate) fn remedy(part: &Mesh, profile: &Profile, task: &Task) -> anyhow::Result<Option<String>> {
    if is_solid(part, profile).is_err() {
        return Ok(None);
    }
    let settings = profile.preform_settings();
    let figures = Figures::of(part, &Preform::of(part, &settings, task)?, &settings, &profile.preform_rates());
    let more = figures.preform_kg - figures.part_kg;
    let percent = 100.0 * more / figures.part_kg;
    Ok(Some(format!(
        "--preform plans the part with what is milled off again: {more:.3} kg more to weld ({percent:.0} %)."
    )))
}

/// The preform of a solid, to be planned in its place.
pub(crate) fn of_part(part: Part, profile: &Profile, task: &Task) -> anyhow::Result<Part> {
    let Part::Mesh(import) = part else {
        anyhow::bail!("only solids have a preform, and this part is given by curves")
    };
    is_solid(&import.mesh, profile)?;
    let settings = profile.preform_settings();
    let preform = Preform::of(&import.mesh, &settings, task)?;
    let figures = Figures::of(&import.mesh, &preform, &settings, &profile.preform_rates());
    let Figures { part_kg, preform_kg, milled_kg, .. } = figures;
    let out = &mut say::done(true);
    writeln!(
        out,
        "the preform weighs {preform_kg:.3} kg, the part {part_kg:.3} kg; {milled_kg:.3} kg are milled off."
    )?;
    Ok(Part::Mesh(Import { mesh: preform.mesh(), ..import }))
}
