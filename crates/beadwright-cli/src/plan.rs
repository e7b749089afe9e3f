//! `beadwright plan`: streams the layers of a plan into its files and prints a summary.

use crate::{model, profile, program, progress};
use beadwright::compare::MAP_PIXELS;
use beadwright::deposit::{DepositSettings, Figures, Judge};
use beadwright::files::{Folder, PlanFiles, Programs, Start, Written};
use beadwright::layer::Layer;
use beadwright::model::{Part, RepairReport};
use beadwright::plan::choice::{self, Choice};
use beadwright::plan::{self, Header, PlanError, Sink, Summary};
use beadwright::planar::Bounds;
use beadwright::profile::Profile;
use beadwright::report::{self, rows};
use beadwright::{dialect, fill};
use glam::DVec3;
use std::io::Write;
use std::path::PathBuf;

#[derive(clap::Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    model: model::Model,
    /// Profile: a built-in name (see `beadwright profile list`) or a TOML file.
    #[arg(long, short, default_value = "cmt-al2319-kuka", value_name = "NAME|FILE")]
    profile: String,
    /// Height of a wall given by its centre-lines (IGES), mm; that of the highest of them if left out.
    #[arg(long, value_name = "MM", value_parser = parse_height)]
    height: Option<f64>,
    #[arg(long, short, value_name = "NAME", help = strategy_help())]
    strategy: Option<String>,
    /// Make the strategy hybrid follow the paper to the letter.
    #[arg(long)]
    literal: bool,
    #[arg(long, value_name = "NAME|DIR", help = post_help())]
    post: Vec<String>,
    /// Change a value of the profile, such as fill.raster_angle=45; may be given several times.
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Write the programs from this layer on, counted from 1, to continue a build that was stopped; plan.json and the
    /// report keep all layers.
    #[arg(long, value_name = "LAYER", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..))]
    from_layer: u32,
    /// Begin that layer with this pass, counted from 1: the one that was interrupted is welded anew.
    #[arg(long, value_name = "PASS", default_value_t = 1, requires = "from_layer", value_parser = clap::value_parser!(u32).range(1..))]
    from_pass: u32,
    /// Write programs that only move the torch, to run before the first bead: the same paths at the same speeds, but
    /// with arc, gas and wire always off. Their names begin with "dry_"; plan.json and the report stay as they are.
    #[arg(long)]
    dry_run: bool,
    /// Folder for the files that are written.
    #[arg(long, short, default_value = "beadwright-out", value_name = "DIR")]
    output: PathBuf,
    /// Also write a picture of this layer, counted from 1, as SVG.
    #[arg(long, value_name = "LAYER")]
    picture: Vec<usize>,
    /// Skip the deposit model: faster, but no voids and no height fields in the report.
    #[arg(long)]
    no_deposit: bool,
    /// Grid spacing of the deposit model, mm; a twentieth of the bead width if left out.
    #[arg(long, value_name = "MM", value_parser = parse_grid, conflicts_with = "no_deposit")]
    grid: Option<f64>,
    /// Write the files even where the program would leave the part, be laid on nothing, or drag the torch over beads.
    #[arg(long)]
    allow_findings: bool,
    /// Print the metrics as JSON instead of the summary.
    #[arg(long)]
    json: bool,
    /// Number of threads; all of the machine's if left out. The result does not depend on it.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
}

fn strategy_help() -> String {
    format!("Strategy instead of the profile's: {}", fill::STRATEGIES.map(|strategy| strategy.name()).join(", "))
}

fn post_help() -> String {
    format!(
        "Dialect instead of the profile's, may be given several times: {}, or the path of a folder with a dialect of your \
         own, such as ./gantry",
        dialect::names().join(", ")
    )
}

fn parse_height(text: &str) -> Result<f64, String> {
    let height: f64 = text.parse().map_err(|_| "a height in mm is expected".to_owned())?;
    if (0.1..=20_000.0).contains(&height) {
        Ok(height)
    } else {
        Err("the height must lie between 0.1 and 20000 mm".to_owned())
    }
}

pub(crate) fn parse_grid(text: &str) -> Result<f64, String> {
    let step: f64 = text.parse().map_err(|_| "a length in mm is expected".to_owned())?;
    if (1e-3..=100.0).contains(&step) { Ok(step) } else { Err("the grid must lie between 0.001 and 100 mm".to_owned()) }
}

pub(crate) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    if let Some(threads) = arguments.threads {
        rayon::ThreadPoolBuilder::new().num_threads(threads.into()).build_global()?;
    }
    let mut settings = arguments.set.clone();
    settings.extend(arguments.strategy.iter().map(|s| format!("fill.strategy=\"{s}\"")));
    settings.extend(arguments.literal.then(|| "hybrid.literal=true".to_owned()));
    let mut profile = profile::load(&arguments.profile, &settings)?;
    let part = arguments.model.part();
    let base = if arguments.post.is_empty() { profile::folder(&arguments.profile) } else { PathBuf::new() };
    if !arguments.post.is_empty() {
        profile.posts.clone_from(&arguments.post);
    }
    let programs = if arguments.dry_run { profile.clone().dry_run() } else { profile.clone() };
    let programs = profile::programs(&profile.posts, &base, &programs.job(&part))?;

    let (task, bar) = progress::task()?;
    let model = arguments.model.part_placed(profile.bead.width, arguments.height, &task)?;
    let Choice { profile, note } = choice::choose(&model, &profile, arguments.strategy.is_some(), &task)?;
    let settings = deposit_settings(arguments.grid, &profile, model.bounds())?;
    let start = Start { layer: arguments.from_layer as usize - 1, pass: arguments.from_pass as usize - 1 };
    let mut files = Files {
        folder: Folder::new(&arguments.output)?,
        programs: Some(programs),
        files: None,
        pictures: &arguments.picture,
        profile: &profile,
        judge: (!arguments.no_deposit).then(|| Judge::new(settings).with_pictures(MAP_PIXELS)),
        start,
    };
    let planned = plan::plan_into(&part, &model, &profile, &task, &mut files);
    bar.finish_and_clear();
    let mut summary = planned.map_err(|error| match error {
        PlanError::Sink(error) => error,
        PlanError::Cancelled(_) => anyhow::anyhow!("cancelled; nothing was written"),
        other => anyhow::anyhow!("{}: {other}", arguments.model.model.display()),
    })?;
    anyhow::ensure!(
        start.layer < summary.metrics.layers,
        "--from-layer {} lies above the part, which has {} layers",
        arguments.from_layer,
        summary.metrics.layers
    );
    if let Some(missing) = arguments.picture.iter().find(|number| **number == 0 || **number > summary.metrics.layers) {
        anyhow::bail!("--picture {missing}: the part has the layers 1 to {}", summary.metrics.layers);
    }
    if !summary.forbidden.is_empty() && !arguments.allow_findings {
        return Err(Refused(summary.forbidden).into());
    }
    let volumes = files.files.iter().flat_map(PlanFiles::notes);
    summary.notes.splice(0..0, note.into_iter().chain(volumes));
    let figures = files.judge.as_ref().map(|judge| *judge.total());
    let written = files.finish(&summary, &model.repair())?;

    let mut out = std::io::stdout().lock();
    if arguments.json {
        writeln!(out, "{}", serde_json::to_string_pretty(&summary.json(figures.as_ref()))?)?;
    } else {
        print_summary(&mut out, arguments, &profile, &model, &summary, figures.as_ref(), &written)?;
    }
    Ok(())
}

/// Programs that nobody should start.
#[derive(Debug, thiserror::Error)]
#[error("nothing was written, since the program should not be started:\n{}\n--allow-findings writes it all the same.", .0.join("\n"))]
pub(crate) struct Refused(Vec<String>);

/// Where the layers go.
struct Files<'a> {
    folder: Folder,
    /// The programs until the plan begins, then all files.
    programs: Option<Programs>,
    files: Option<PlanFiles>,
    pictures: &'a [usize],
    profile: &'a Profile,
    judge: Option<Judge>,
    /// Index of the first layer of the programs.
    start: Start,
}

impl Files<'_> {
    /// Writes what comes last, and moves everything into place.
    fn finish(mut self, summary: &Summary, repair: &RepairReport) -> anyhow::Result<Written> {
        if let Some(files) = self.files {
            self.folder.extend(files.end(summary, repair, self.judge.as_ref().map(Judge::total))?)?;
        }
        Ok(self.folder.commit()?)
    }
}

impl Sink for Files<'_> {
    type Error = anyhow::Error;

    fn begin(&mut self, header: &Header) -> anyhow::Result<()> {
        let Some(programs) = self.programs.take() else { return Ok(()) };
        let (files, chunks) = PlanFiles::begin(header, self.profile, programs, self.start);
        self.files = Some(files);
        Ok(self.folder.extend(chunks)?)
    }

    fn layer(&mut self, layer: Layer) -> anyhow::Result<()> {
        if self.pictures.contains(&(layer.index + 1)) {
            let title = format!("Layer {}, z {:.2} mm", layer.index + 1, layer.z);
            self.folder.append(&format!("layer-{:03}.svg", layer.index + 1), &report::svg::layer(&layer, &title))?;
        }
        let Start { layer: index, pass } = self.start;
        anyhow::ensure!(
            layer.index != index || pass == 0 || pass < layer.passes.len(),
            "--from-pass {}: the passes of layer {} are numbered 1 to {}",
            pass + 1,
            index + 1,
            layer.passes.len()
        );
        let welded = plan::welded(&layer, self.profile);
        let judgement = self.judge.as_mut().map(|judge| judge.layer(&welded));
        if let Some(files) = &mut self.files {
            self.folder.extend(files.layer(&layer, judgement.as_ref()))?;
        }
        Ok(())
    }
}

/// How the layers of a part are judged: the grid as asked for, or one that fits the part.
pub(crate) fn deposit_settings(
    grid: Option<f64>,
    profile: &Profile,
    (low, high): (DVec3, DVec3),
) -> anyhow::Result<DepositSettings> {
    let bounds = Bounds { min: low.truncate(), max: high.truncate() };
    program::fitted(grid, plan::deposit_settings(profile), &bounds, (high.z / profile.layers.height) as usize)
}

fn print_summary(
    out: &mut impl Write,
    arguments: &Arguments,
    profile: &Profile,
    model: &Part,
    summary: &Summary,
    figures: Option<&Figures>,
    written: &Written,
) -> std::io::Result<()> {
    let (part, (low, high), m) = (arguments.model.part(), model.bounds(), &summary.metrics);
    let (size, repair) = (high - low, model.repair());
    let of = match model {
        Part::Mesh(_) => format!("{} triangles", repair.triangles),
        Part::Curves { curves, .. } => format!("{} centre-lines", curves.count()),
    };
    writeln!(out, "{part}  {:.1} × {:.1} × {:.1} mm, {of}", size.x, size.y, size.z)?;
    writeln!(out, "profile {}, strategy {}", profile.name, profile.fill.strategy)?;
    let events = summary.warnings.summaries().map(|w| w.sentence());
    let forbidden = profile.forbidden().into_iter();
    for line in forbidden.chain(model.warnings()).chain(events).chain(summary.notes.iter().cloned()) {
        writeln!(out, "warning: {line}")?;
    }
    writeln!(out)?;
    for (name, value) in rows::totals(m).into_iter().chain(figures.map(rows::deposit).into_iter().flatten()) {
        writeln!(out, "  {name:<22} {value}")?;
    }
    writeln!(out)?;
    let Written { files, removed } = written;
    if !removed.is_empty() {
        writeln!(out, "{} files of an earlier plan removed: {}", removed.len(), shorten(removed))?;
    }
    writeln!(out, "{} files in {}: {}", files.len(), arguments.output.display(), shorten(files))
}

/// All names, or the first and the last of many.
pub(crate) fn shorten(files: &[String]) -> String {
    const SHOWN: usize = 8;
    match files {
        [first @ .., last] if files.len() > SHOWN => format!("{}, …, {last}", first[..SHOWN - 2].join(", ")),
        _ => files.join(", "),
    }
}
