//! `beadwright clad`: cladding over a surface or a pipe, as a model with its bodies, for `plan --onto`.

use crate::{file, model, profile, progress, say};
use anyhow::Context;
use beadwright::chart::Chart;
use beadwright::cladding::{self, Cladding, CladdingError};
use beadwright::model::outline;
use beadwright::model::stl;
use beadwright::profile::Body;
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
    /// Where the cladding begins along the axis, mm; where the face does if left out.
    #[arg(long, value_name = "MM", requires = "around", allow_hyphen_values = true)]
    from: Option<f64>,
    /// Where it ends along the axis, mm.
    #[arg(long, value_name = "MM", requires = "around", allow_hyphen_values = true)]
    to: Option<f64>,
    /// Model of the cladding to write (STL); its bodies come beside it, as NAME.bodies.toml.
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
    let is_base =
        arguments.output.canonicalize().is_ok_and(|path| model.canonicalize().is_ok_and(|model| model == path));
    anyhow::ensure!(!is_base, "{}: that is the base; give the cladding a file of its own", arguments.output.display());
    let (task, bar) = progress::task()?;
    let base = arguments.model.placed(&profile, model::Use::AsDrawn, &task)?.mesh;
    let thickness = f64::from(arguments.layers) * profile.layers.height;
    let context = || model.display().to_string();
    let cladding = match &arguments.around {
        Some(around) => {
            let chart: Chart = format!("cylinder:{around}").parse().context("--around")?;
            let Chart::Cylinder(cylinder) = chart else { anyhow::bail!("--around {around}: a cylinder is expected") };
            let clad = cladding::around(&base, cylinder, [arguments.from, arguments.to], thickness);
            clad.map_err(|error| match error {
                CladdingError::Gaps { .. } => anyhow::anyhow!("{error}, each with --from and --to."),
                _ => error.into(),
            })
            .with_context(context)?
        }
        None => {
            let plane: Chart = format!("plane:up={}", arguments.up).parse().context("--up")?;
            let up = plane.sheet(0.0).at(DVec3::ZERO).normal;
            let area = arguments.area.as_ref().map(|path| {
                let outlines = outline::read(&file::read(path)?).with_context(|| path.display().to_string())?;
                anyhow::Ok(outlines.region(1.0))
            });
            let area = area.transpose()?;
            cladding::over(&base, up, arguments.step, area.as_ref(), thickness, &task).with_context(context)?
        }
    };
    bar.finish_and_clear();
    write(arguments, &cladding)
}

fn write(arguments: &Arguments, Cladding { mesh, chart }: &Cladding) -> anyhow::Result<()> {
    let (path, beside) = (&arguments.output, arguments.output.with_extension("bodies.toml"));
    let name = path.file_stem().map_or("cladding".into(), |stem| stem.to_string_lossy().into_owned());
    let corners = |corners: &[u32; 3]| corners.map(|corner| mesh.vertices[corner as usize]);
    let bodies = Body::write(&[Body::of(&name, chart.clone())]);
    file::write(path, &stl::write(&name, mesh.triangles.iter().map(corners)))?;
    file::write(&beside, bodies.as_bytes())?;
    let mut out = say::done(false);
    let layers = arguments.layers;
    let helix = if chart.goes_around() { " --set 'fill.around=\"helix\"'" } else { "" };
    writeln!(
        out,
        "{}: {:.1} cm³ for {layers} layer{}. Plan it with\n  beadwright plan {0} --onto {} --bodies {}{helix}",
        path.display(),
        mesh.volume() / 1000.0,
        if layers == 1 { "" } else { "s" },
        arguments.model.model.display(),
        beside.display(),
    )?;
    Ok(())
}
