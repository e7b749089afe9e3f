//! `beadwright preform`: the part plus the stock that is milled off afterwards.

use crate::{file, model, profile, progress, remedy, say};
use anyhow::Context;
use beadwright::Profile;
use beadwright::export::solids;
use beadwright::glam::DVec3;
use beadwright::model::{Mesh, Part, stl};
use beadwright::plan::PlanError;
use beadwright::plan::stock::{Stocked, is_closed};
use beadwright::preform::Preform;
use beadwright::preform::faces::{self, Face};
use beadwright::preform::figures::Figures;
use beadwright::preform::orient::{self, Oriented};
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
    /// File to write: the preform alone as STL, or with the part inside it as 3MF; NAME_preform.stl if left out.
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Also write a table (CSV) of the part's faces, each with its area, place and normal, and the least, mean and greatest
    /// thickness of the metal over it.
    #[arg(long, value_name = "FILE")]
    faces: Option<PathBuf>,
    /// Print the figures as JSON instead of the summary.
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let name = arguments.wanted.profile.as_deref().unwrap_or(profile::USUAL);
    let profile = profile::load(name, &arguments.wanted.set)?;
    let (task, bar) = progress::task()?;
    let import = arguments.model.placed(&profile, model::Use::Preform, &task)?;
    let context = || format!("{}", arguments.model.model.display());
    is_closed(&import.mesh, &profile).map_err(refused).with_context(context)?;
    let (settings, rates) = (profile.preform_settings(), profile.preform_rates());
    // The first goes from step to step, the second evaluates many orientations in parallel.
    let (stocked, ways) = rayon::join(
        || Stocked::of(Part::Mesh(import.clone()), &profile, &task),
        || orient::best(&import.mesh, &settings, &rates, &task),
    );
    let (Stocked { part, preform, figures }, ways) = (stocked.map_err(refused)?, ways?);
    let now = Oriented::of(&import.mesh, DVec3::NEG_Z, &settings, &rates, &task)?;
    bar.finish_and_clear();
    let (mesh, milled) = part.mesh().zip(part.milled()).context("only solids have a preform")?;

    let path = arguments.output.clone().unwrap_or_else(|| format!("{}_preform.stl", arguments.model.part()).into());
    let bytes = match path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("3mf")) {
        true => solids::threemf(&[("preform", mesh), ("part", &milled.mesh)])?,
        false => {
            let corners = |t: &[u32; 3]| t.map(|corner| mesh.vertices[corner as usize]);
            stl::write(&format!("preform of {}", arguments.model.part()), mesh.triangles.iter().map(corners))
        }
    };
    file::write(&path, &bytes)?;
    if let Some(path) = &arguments.faces {
        file::write(path, table(&faces::faces(&milled.mesh, &milled.stock)).as_bytes())?;
    }

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

/// The faces as CSV.
fn table(faces: &[Face]) -> String {
    let mut text = "face,area_mm2,x_mm,y_mm,z_mm,nx,ny,nz,least_stock_mm,mean_stock_mm,most_stock_mm\n".to_owned();
    for (number, Face { area, place, normal, stock }) in faces.iter().enumerate() {
        let values = [*area].into_iter().chain(place.to_array()).chain(normal.to_array()).chain(*stock);
        let values: String = values.map(|value| format!(",{value:.3}")).collect();
        text.push_str(&format!("{}{values}\n", number + 1));
    }
    text
}

/// A part is turned if that saves this fraction of its cost.
const WORTH_TURNING: f64 = 0.01;

/// The figures of a preform: name, and value with its unit.
fn rows(figures: &Figures, profile: &Profile) -> Vec<(&'static str, String)> {
    let currency = &profile.cost.currency;
    let ratio = |kg: f64, ratio: f64| format!("{kg:.3} kg, {ratio:.2} kg bought per kg of the part");
    let plate = match figures.cut_height {
        Some(cut) => format!("{:.3} kg, sawn off {cut:.1} mm above it", figures.plate_kg),
        None => format!("{:.3} kg, stays with the part", figures.plate_kg),
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

/// What a preform would add to a part that was refused; `None` for a surface that is not closed.
pub(crate) fn remedy(part: &Mesh, profile: &Profile, task: &Task) -> anyhow::Result<Option<String>> {
    if is_closed::<std::convert::Infallible>(part, profile).is_err() {
        return Ok(None);
    }
    let settings = profile.preform_settings();
    let figures = Figures::of(part, &Preform::of(part, &settings, task)?, &settings, &profile.preform_rates());
    let more = figures.preform_kg - figures.part_kg;
    let percent = 100.0 * more / figures.part_kg;
    Ok(Some(format!(
        "--preform plans the part plus the stock that is milled off afterwards: {more:.3} kg more to weld ({percent:.0} %)."
    )))
}

/// The preform of a solid, to be planned in its place.
pub(crate) fn of_part(part: Part, profile: &Profile, task: &Task) -> anyhow::Result<Part> {
    let Stocked { part, figures, .. } = Stocked::of(part, profile, task).map_err(refused)?;
    let out = &mut say::done(true);
    figures.sentences(&profile.cost.currency).iter().try_for_each(|sentence| writeln!(out, "{sentence}"))?;
    Ok(part)
}

/// Why there is no preform, and what to do.
fn refused(error: PlanError<Infallible>) -> anyhow::Error {
    match error {
        PlanError::Open { .. } => {
            let remedy = remedy::of_plan(&error).unwrap_or_default();
            anyhow::anyhow!("only solids have a preform: {error} {remedy}")
        }
        PlanError::Cancelled(cancelled) => cancelled.into(),
        other => other.into(),
    }
}
