//! `beadwright export`.

use crate::{file, profile, program, progress, say};
use anyhow::Context;
use beadwright::export::{self, Beads, FORMATS, LAYER_FORMATS, LayerFormat};
use beadwright::heat::{self, HeatSettings, History};
use beadwright::layer::Layer;
use beadwright::plan::unrolled_once;
use beadwright::plan_file::PlanFile;
use beadwright::profile::Profile;
use std::io::Write;
use std::path::{Path, PathBuf};

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// plan.json, or toolpaths in 3MF; - for standard input.
    plan: PathBuf,
    #[command(flatten)]
    wanted: profile::Wanted,
    /// File to write; its extension gives the format: .csv or .parquet (a table of all pieces of beads), .vtp (ParaView, VTK,
    /// pyvista), .3mf (the 3MF Toolpath extension), .stl or .glb (the shape as built), .dxf, .svg or .png (drawings of
    /// layers: NAME-001.dxf and so on); - for standard output, with --format.
    #[arg(long, short, value_name = "FILE")]
    output: PathBuf,
    /// Format for standard output, named by its extension, for example csv.
    #[arg(long, value_name = "EXTENSION")]
    format: Option<String>,
    /// Draw only this layer, counted from 1, and keep the file's name as it is; for .dxf, .svg and .png.
    #[arg(long, value_name = "LAYER")]
    layer: Option<usize>,
    /// Also compute how warm the metal ahead of the torch is: a column in tables and .vtp.
    #[arg(long)]
    temperatures: bool,
}

pub(crate) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let source = program::Source::open(&arguments.plan)?;
    let plan = source.plan().with_context(|| {
        format!(
            "{}: only plans can be exported; give the plan.json that belongs to the program",
            arguments.plan.display()
        )
    })?;
    let standard = file::is_standard(&arguments.output);
    let ending = arguments.output.extension().map(|end| end.to_string_lossy().into_owned());
    let extension = arguments.format.clone().or(ending).unwrap_or_default();
    anyhow::ensure!(
        !standard || arguments.format.is_some(),
        "--output -: --format gives the format of standard output, such as --format csv"
    );
    if let Some(format) = export::layer_format(&extension) {
        anyhow::ensure!(
            !standard || arguments.layer.is_some(),
            "--output -: only one layer can be drawn there; choose it with --layer"
        );
        return drawings(arguments, plan, &source.profile(&arguments.wanted)?, format);
    }
    let format = export::format(&extension).with_context(|| {
        let known = FORMATS
            .iter()
            .map(|f| (f.extension, f.purpose))
            .chain(LAYER_FORMATS.iter().map(|f| (f.extension, f.purpose)));
        let known: Vec<String> = known.map(|(extension, purpose)| format!(".{extension} ({purpose})")).collect();
        format!("{}: the extension gives the format, and it may be {}", arguments.output.display(), known.join(" or "))
    })?;
    anyhow::ensure!(arguments.layer.is_none(), "--layer is only for drawings of layers (.dxf, .svg, .png)");
    let profile = source.profile(&arguments.wanted)?;
    let heat = arguments.temperatures.then(|| heat_of(plan, &profile)).transpose()?.flatten();
    let beads = Beads { header: &plan.header, layers: &plan.layers, profile: &profile, heat: heat.as_ref() };
    let bytes = (format.write)(&beads).with_context(|| format!("{}", arguments.plan.display()))?;
    file::write(&arguments.output, &bytes)?;
    let passes: usize = plan.layers.iter().map(|layer| layer.passes.len()).sum();
    writeln!(say::done(standard), "{passes} passes in {} layers in {}", plan.layers.len(), arguments.output.display())?;
    Ok(())
}

/// Temperatures of a plan as it is.
fn heat_of(plan: &PlanFile, profile: &Profile) -> anyhow::Result<Option<History>> {
    let over = Some(plan.header.extent.seen_from_above());
    let settings = HeatSettings { interpass: None, over, ..profile.heat_settings()? };
    let (task, bar) = progress::task()?;
    let history = heat::history(&mut plan.layers.clone(), &settings, &profile.weld_settings(), &task)?;
    bar.finish_and_clear();
    Ok(history)
}

/// One layer in the file, or each in one of its own.
fn drawings(arguments: &Arguments, plan: &PlanFile, profile: &Profile, format: &LayerFormat) -> anyhow::Result<()> {
    let mut out = say::done(file::is_standard(&arguments.output));
    let write = |path: &Path, layer: &Layer| -> anyhow::Result<()> {
        file::write(path, &(format.write)(&unrolled_once(layer, profile))?)
    };
    if let Some(number) = arguments.layer {
        let layer = number.checked_sub(1).and_then(|index| plan.layers.get(index));
        let layer =
            layer.with_context(|| format!("--layer {number}: the plan has the layers 1 to {}", plan.layers.len()))?;
        write(&arguments.output, layer)?;
        writeln!(out, "layer {number} in {}", arguments.output.display())?;
        return Ok(());
    }
    let stem = arguments.output.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    let path =
        |layer: &Layer| arguments.output.with_file_name(format!("{stem}-{:03}.{}", layer.index + 1, format.extension));
    plan.layers.iter().try_for_each(|layer| write(&path(layer), layer))?;
    let ends: Vec<String> =
        plan.layers.first().into_iter().chain(plan.layers.last()).map(|l| path(l).display().to_string()).collect();
    writeln!(out, "{} layers in {}", plan.layers.len(), ends.join(" to "))?;
    Ok(())
}
