//! `beadwright clad`: cladding over a surface or a pipe, as a model with its bodies, for `plan --onto`.

use crate::onto::Onto;
use crate::{file, model, onto, profile, progress, say};
use anyhow::Context;
use beadwright::chart::Chart;
use beadwright::chart::warp::WarpError;
use beadwright::cladding::{self, Cladding, CladdingError};
use beadwright::model::{Mesh, outline, stl};
use beadwright::profile::{Body, Profile};
use beadwright::task::Task;
use glam::DVec3;
use std::io::Write;
use std::path::PathBuf;

#[derive(clap::Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    model: model::Model,
    /// Number of layers.
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=100))]
    layers: u32,
    /// Direction from which the surface is seen and along which the layers are stacked.
    #[arg(long, value_name = "X/Y/Z", default_value = "z", allow_hyphen_values = true, conflicts_with = "around")]
    up: String,
    /// Outlines of what is clad (DXF or SVG, mm), in x and y of the base as it stands on the table.
    #[arg(long, value_name = "FILE", conflicts_with = "around")]
    area: Option<PathBuf>,
    /// Spacing of the grid on which heights are sampled, mm; finer detail is smoothed out.
    #[arg(long, value_name = "MM", default_value_t = 5.0, value_parser = crate::surface::parse_step)]
    step: f64,
    /// Clad a pipe, a bore or a shaft: the axis and the radius of the face, such as axis=z,radius=30 or axis=x,radius=40,side=inner.
    #[arg(long, value_name = "CYLINDER")]
    around: Option<String>,
    /// Where the cladding begins along the axis, mm; at the beginning of the face if left out.
    #[arg(long, value_name = "MM", requires = "around", allow_hyphen_values = true)]
    from: Option<f64>,
    /// Where it ends along the axis, mm; at the end of the face if left out.
    #[arg(long, value_name = "MM", requires = "around", allow_hyphen_values = true)]
    to: Option<f64>,
    /// Model of the cladding to write (STL); its bodies are written next to it, as NAME.bodies.toml.
    #[arg(long, short, value_name = "FILE", default_value = "cladding.stl")]
    output: PathBuf,
    #[command(flatten)]
    wanted: profile::Wanted,
}

pub(crate) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let name = arguments.wanted.profile.as_deref().unwrap_or(profile::USUAL);
    let profile = profile::load(name, &arguments.wanted.set)?;
    let model = &arguments.model.model;
    anyhow::ensure!(
        !file::is_standard(&arguments.output),
        "--output -: the cladding and its bodies are two files; give the model a name, such as cladding.stl"
    );
    onto::check_name(&arguments.output)?;
    let is_base =
        arguments.output.canonicalize().is_ok_and(|path| model.canonicalize().is_ok_and(|model| model == path));
    anyhow::ensure!(!is_base, "{}: that is the base; give the cladding a file of its own", arguments.output.display());
    anyhow::ensure!(
        !arguments.model.placing.moves(),
        "the cladding is written in the coordinates of the base's file, so the base is clad as it lies there: --turn, --shift, --scale \
         and the like are for `plan`, where they move both"
    );
    let (task, bar) = progress::task()?;
    let base = arguments.model.placed(&profile, model::Use::AsDrawn, &task)?.mesh;
    let mut cladding = made(arguments, &base, 0.0, &profile, &task)?;
    // Both stand on the table: cladding that reaches below its base lifts it.
    let lowest = cladding.mesh.bounds().0.z;
    if lowest < 0.0 {
        cladding = made(arguments, &base, -lowest, &profile, &task)?;
    }
    let lifted = (-lowest).max(0.0);
    let drawn = arguments.model.drawn(&task)?;
    let (unit, [from, to]) =
        (base.size().max_element() / drawn.size().max_element(), [&base, &drawn].map(|m| m.bounds().0));
    // Back to the units and coordinates of the file.
    cladding.mesh.vertices.iter_mut().for_each(|p| *p = (*p - DVec3::Z * lifted - from) / unit + to);
    bar.finish_and_clear();
    write(arguments, &cladding)
}

/// The cladding of the base, which is lifted by `lifted` mm.
fn made(arguments: &Arguments, base: &Mesh, lifted: f64, profile: &Profile, task: &Task) -> anyhow::Result<Cladding> {
    let mut base = base.clone();
    base.vertices.iter_mut().for_each(|p| p.z += lifted);
    let thickness = f64::from(arguments.layers) * profile.layers.height;
    let context = || arguments.model.model.display().to_string();
    let Some(around) = &arguments.around else {
        let plane: Chart = format!("plane:up={}", arguments.up).parse().context("--up")?;
        let up = plane.sheet(0.0).at(DVec3::ZERO).normal;
        let area = arguments.area.as_ref().map(|path| {
            let outlines = outline::read(&file::read(path)?).with_context(|| path.display().to_string())?;
            anyhow::Ok(outlines.region(1.0))
        });
        let area = area.transpose()?;
        let clad = cladding::over(&base, up, arguments.step, area.as_ref(), thickness, task);
        return clad.map_err(advised).with_context(context);
    };
    let chart: Chart = format!("cylinder:{around}").parse().context("--around")?;
    let Chart::Cylinder(mut cylinder) = chart else { anyhow::bail!("--around {around}: a cylinder is expected") };
    cylinder.through.z += lifted;
    let clad = cladding::around(&base, cylinder, [arguments.from, arguments.to], thickness);
    clad.map_err(advised).with_context(context)
}

/// An error with the flags that help.
fn advised(error: CladdingError) -> anyhow::Error {
    match error {
        CladdingError::Gaps { .. } => anyhow::anyhow!("{error}, each with --from and --to."),
        CladdingError::Warp(WarpError::Steep { .. }) => anyhow::anyhow!(
            "{error} Faces at several heights are clad one after another, each with --area; a finer --step keeps to what is level."
        ),
        _ => error.into(),
    }
}

fn write(arguments: &Arguments, Cladding { mesh, chart, bare }: &Cladding) -> anyhow::Result<()> {
    let (path, beside) = (&arguments.output, arguments.output.with_extension("bodies.toml"));
    let name = path.file_stem().map_or("cladding".into(), |stem| stem.to_string_lossy().into_owned());
    let corners = |corners: &[u32; 3]| corners.map(|corner| mesh.vertices[corner as usize]);
    let bodies = Body::write(&[Body::of(&name, chart.clone())]);
    file::write(path, &stl::write(&name, mesh.triangles.iter().map(corners)))?;
    file::write(&beside, bodies.as_bytes())?;
    let mut out = say::done(false);
    let (layers, s) = (arguments.layers, if arguments.layers == 1 { "" } else { "s" });
    if *bare > 0.0 {
        let what = if chart.goes_around() {
            "of the base under it is missing"
        } else {
            "is left out: too steep, hidden, or not there"
        };
        writeln!(out, "warning: {:.1} cm² {what}.", bare / 100.0)?;
    }
    writeln!(out, "{}: {layers} layer{s} of cladding. Plan it with", path.display())?;
    let onto = Onto {
        model: path,
        base: &arguments.model.model,
        bodies: &beside,
        accept_damaged: arguments.model.placing.accept_damaged,
        wanted: &arguments.wanted,
        set: if chart.goes_around() { &["fill.around=\"helix\""] } else { &[] },
    };
    writeln!(out, "  {}", onto.command())?;
    Ok(())
}
