//! `beadwright plan`: streams the layers of a plan into its files and prints a summary.

use crate::several::{Build, Order, Several};
use crate::{directions, file, model, preform, profile, progress, remedy, say};
use anyhow::Context;
use beadwright::Finding;
use beadwright::chart::{Chart, ChartError};
use beadwright::check;
use beadwright::compare::{Chosen, MAP_PIXELS};
use beadwright::deposit::{DepositSettings, Figures, Judge, stack::Growth};
use beadwright::dialect;
use beadwright::files::{Folder, PlanFiles, Programs, REFUSED, Selection, Written};
use beadwright::fill::StrategyName;
use beadwright::finding::Words;
use beadwright::layer::Layer;
use beadwright::metrics::Metrics;
use beadwright::model::together::Place;
use beadwright::model::{Part, RepairReport};
use beadwright::plan::choice::{self, Choice};
use beadwright::plan::{self, Header, MAX_LAYERS, PlanError, Sink, Summary};
use beadwright::planar::Bounds;
use beadwright::profile::{Body, Profile};
use beadwright::read_back;
use beadwright::report::{self, rows};
use beadwright::task::Task;
use beadwright::warning::{WarningKind, WarningSummary};
use glam::DVec3;
use std::io::Write;
use std::path::{Path, PathBuf};

#[derive(clap::Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    pub(crate) model: model::Model,
    #[command(flatten)]
    pub(crate) several: Several,
    /// Profile: a built-in name (see `beadwright profile list`) or a TOML file.
    #[arg(long, short, default_value = "cmt-al2319-kuka", value_name = "NAME|FILE")]
    pub(crate) profile: String,
    /// Height of a wall given by its centre-lines (IGES), mm; that of the highest of them if left out. Height of a part given
    /// by its outlines (DXF, SVG), mm.
    #[arg(long, value_name = "MM", value_parser = parse_height)]
    pub(crate) height: Option<f64>,
    #[arg(long, short, value_name = "NAME", help = strategy_help())]
    pub(crate) strategy: Option<StrategyName>,
    /// Meaning of an open surface: the skin of a solid, whose contours are filled, or a wall, along which one bead is
    /// laid.
    #[arg(long, value_name = "solid|wall", value_parser = ["solid", "wall"])]
    surface: Option<String>,
    /// Meaning of curves that run side by side: the two sides of a wall, or the centre-lines of walls.
    #[arg(long, value_name = "sides|centre", value_parser = ["sides", "centre"])]
    curves: Option<String>,
    /// Shape of layers that are not level: around an axis, such as cylinder:axis=z,radius=36; on a cone, such as
    /// cone:axis=-z,tip=0/0/90,angle=30; perpendicular to a direction, such as plane:up=1/0/1, or to a curve, as
    /// `beadwright guide` prints it. In mm and degrees, in the coordinates of the part as it is placed on the table.
    #[arg(long, value_name = "KIND:KEY=VALUE,...", value_parser = parse_chart)]
    chart: Option<Chart>,
    /// Weld the part as several bodies, one after another, each with its own shape of layers: a TOML file with a [[body]] table for each.
    #[arg(long, value_name = "FILE", conflicts_with = "chart")]
    bodies: Option<PathBuf>,
    /// Divide the part into bodies as `beadwright directions` does: weld it as the first division that it offers.
    #[arg(long, value_name = "auto", value_parser = ["auto"], conflicts_with_all = ["chart", "bodies", "onto", "with", "preform", "from_z"])]
    directions: Option<String>,
    /// Weld onto an existing part: a model in the coordinates of the part's file. It is placed together with the part and not welded
    /// itself; the first layers must lie on it.
    #[arg(long, value_name = "MODEL", conflicts_with_all = ["with", "preform", "from_z", "lay_flat", "orient"])]
    onto: Option<PathBuf>,
    /// Make the strategy hybrid follow the paper to the letter.
    #[arg(long)]
    literal: bool,
    #[arg(long, value_name = "NAME|DIR", help = post_help())]
    pub(crate) post: Vec<String>,
    /// Change a value of the profile, such as fill.raster_angle=45; may be given several times.
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Plan the preform of the part: the part plus the stock that is milled off afterwards (section [preform] of the profile).
    #[arg(long)]
    pub(crate) preform: bool,
    /// Plan only what lies above this height of the placed part, mm: the cut then lies on the table.
    #[arg(long, value_name = "MM", value_parser = parse_height)]
    pub(crate) from_z: Option<f64>,
    /// Write the programs of these layers only, counted from 1, such as 3,10-20; plan.json and the report keep all layers.
    #[arg(long, value_name = "LIST", value_parser = parse_layers, conflicts_with = "from_layer")]
    layers: Option<Chosen>,
    /// Write the programs from this layer on, counted from 1, to continue a build that was stopped; plan.json and the
    /// report keep all layers.
    #[arg(long, value_name = "LAYER", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..))]
    from_layer: u32,
    /// Begin that layer with this pass, counted from 1: the one that was interrupted is welded again.
    #[arg(long, value_name = "PASS", default_value_t = 1, requires = "from_layer", value_parser = clap::value_parser!(u32).range(1..))]
    from_pass: u32,
    /// Write programs that only move the torch, to run before the first bead: the same paths at the same speeds, but
    /// with arc, gas and wire always off. Their names begin with "dry_"; plan.json and the report stay as they are.
    #[arg(long)]
    pub(crate) dry_run: bool,
    /// Folder for the files that are written.
    #[arg(long, short, default_value = "beadwright-out", value_name = "DIR")]
    pub(crate) output: PathBuf,
    /// Also write a picture of this layer, counted from 1, as SVG.
    #[arg(long, value_name = "LAYER")]
    picture: Vec<usize>,
    /// Skip the deposit model: faster, but no voids and no height fields in the report.
    #[arg(long)]
    pub(crate) no_deposit: bool,
    /// Grid spacing of the deposit model, mm; a twentieth of the bead width if left out.
    #[arg(long, value_name = "MM", value_parser = parse_grid, conflicts_with = "no_deposit")]
    pub(crate) grid: Option<f64>,
    /// Write the files even if the program would leave the part, weld in the air, or drag the torch over beads.
    #[arg(long)]
    pub(crate) allow_findings: bool,
    /// Print the metrics as JSON instead of the summary.
    #[arg(long)]
    pub(crate) json: bool,
    /// Number of threads; all of the machine's if left out. The result does not depend on it.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
}

fn strategy_help() -> String {
    format!("Strategy instead of the profile's: {}", StrategyName::list())
}

fn post_help() -> String {
    format!(
        "Dialect instead of the profile's, may be given several times: {}, or the path of a folder with a dialect of your \
         own, such as ./gantry",
        dialect::names().join(", ")
    )
}

fn parse_chart(text: &str) -> Result<Chart, String> {
    text.parse().map_err(|error: ChartError| error.to_string())
}

pub(crate) fn parse_height(text: &str) -> Result<f64, String> {
    let height: f64 = text.parse().map_err(|_| "a height in mm is expected".to_owned())?;
    if (0.1..=20_000.0).contains(&height) {
        Ok(height)
    } else {
        Err("the height must lie between 0.1 and 20000 mm".to_owned())
    }
}

pub(crate) fn parse_layers(text: &str) -> Result<Chosen, String> {
    let number = |text: &str| text.trim().parse::<usize>().ok().filter(|n| (1..=MAX_LAYERS).contains(n));
    let range = |part: &str| {
        let (from, to) = part.split_once('-').unwrap_or((part, part));
        let (from, to) = number(from).zip(number(to))?;
        (from <= to).then_some(from - 1..to)
    };
    let ranges: Option<Vec<_>> = text.split(',').map(range).collect();
    let ranges = ranges.ok_or_else(|| {
        format!("layers are counted from 1 to at most {MAX_LAYERS}, the lower first, such as 1,5,10-20")
    })?;
    Ok(Some(ranges.into_iter().flatten().collect()))
}

pub(crate) fn parse_grid(text: &str) -> Result<f64, String> {
    let step: f64 = text.parse().map_err(|_| "a length in mm is expected".to_owned())?;
    if (1e-3..=100.0).contains(&step) { Ok(step) } else { Err("the grid must lie between 0.001 and 100 mm".to_owned()) }
}

impl Arguments {
    /// The name of the build: that of its part, or of the first of several.
    fn name(&self) -> String {
        let first = self.model.part();
        match self.several.with.len() {
            0 => first,
            1 => format!("{first}_and_1_more"),
            more => format!("{first}_and_{more}_more"),
        }
    }

    /// What is built.
    pub(crate) fn build(&self, profile: &Profile, task: &Task) -> anyhow::Result<Build> {
        anyhow::ensure!(
            !profile.layers.charts().any(Chart::has_wedges) && profile.layers.bodies.is_empty()
                || self.several.with.is_empty(),
            "--with: a guide (layers.chart) and bodies (layers.bodies) belong to one part"
        );
        if let Some(base) = &self.onto {
            let (import, base) = self.model.placed_onto(base, profile, task)?;
            return Ok(Build {
                whole: Part::Mesh(import),
                base: Some(base),
                places: Vec::new(),
                lowest_first: Vec::new(),
            });
        }
        self.several.stand(&self.model, |model| {
            let use_as = if self.preform { model::Use::Preform } else { model::Use::AsDrawn };
            let part = model.part_placed(profile, use_as, self.height, task)?;
            let part = match self.from_z {
                Some(_) if !profile.layers.are_level() => {
                    anyhow::bail!("--from-z cuts level layers: leave layers.chart out, or cut the model")
                }
                Some(z) => part.above(z).with_context(|| format!("--from-z {z}"))?,
                None => part,
            };
            if self.preform { preform::of_part(part, profile, task) } else { Ok(part) }
        })
    }

    /// The profile of that name, changed as the arguments say.
    pub(crate) fn profile(&self, name: &str) -> anyhow::Result<Profile> {
        let mut profile = profile::load(name, &self.settings())?;
        if let Some(path) = &self.bodies {
            let text = file::text(path)?;
            profile.layers.bodies = Body::read(&text).with_context(|| path.display().to_string())?;
        }
        if !self.post.is_empty() {
            profile.posts.clone_from(&self.post);
        }
        Ok(profile)
    }

    /// The programs of a part next to others of this height, mm.
    pub(crate) fn programs(
        &self,
        name: &str,
        profile: &Profile,
        part: &str,
        standing: f64,
    ) -> anyhow::Result<Programs> {
        let base = if self.post.is_empty() { profile::folder(name) } else { PathBuf::new() };
        let programs = if self.dry_run { profile.clone().dry_run() } else { profile.clone() };
        let mut job = programs.job(part);
        job.weld.standing = standing;
        profile::programs(&profile.posts, &base, &job)
    }

    /// Changes to the profile that the arguments ask for.
    fn settings(&self) -> Vec<String> {
        let strategy = self.strategy.iter().map(|s| format!("fill.strategy=\"{s}\""));
        let literal = self.literal.then(|| "hybrid.literal=true".to_owned());
        let surface = self.surface.iter().map(|surface| format!("slice.surface=\"{surface}\""));
        let curves = self.curves.iter().map(|curves| format!("wall.curves=\"{curves}\""));
        let chart = self.chart.iter().map(|chart| format!("layers.chart=\"{chart}\""));
        self.set.iter().cloned().chain(chart).chain(strategy).chain(surface).chain(curves).chain(literal).collect()
    }
}

/// Sets the threads, and checks whether the arguments go together.
pub(crate) fn prepare(arguments: &Arguments) -> anyhow::Result<()> {
    if let Some(threads) = arguments.threads {
        rayon::ThreadPoolBuilder::new().num_threads(threads.into()).build_global()?;
    }
    arguments.several.check()
}

pub(crate) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let mut profile = arguments.profile(&arguments.profile)?;
    let part = arguments.name();
    // A fault of the profile is reported before anything is read.
    arguments.programs(&arguments.profile, &profile, &part, 0.0)?;

    let (task, bar) = progress::task()?;
    let Build { whole: model, base, places, lowest_first } = arguments.build(&profile, &task)?;
    profile.layers.base = base.as_ref().map(|base| [base.bounds().0, base.bounds().1].map(|corner| corner.to_array()));
    if let Part::Mesh(import) = &model {
        say::size(&import.mesh, &profile)?;
    }
    let kept = arguments.strategy.is_some();
    let mut divided = None;
    if arguments.directions.is_some() {
        let (bodies, sentence) = directions::bodies(&part, &model, (&profile, kept), &task)?;
        (profile.layers.bodies, divided) = (bodies, Some(sentence));
    }
    let Choice { profile, note } = choice::choose(&model, &profile, kept, &task)?;
    let programs = arguments.programs(&arguments.profile, &profile, &part, 0.0)?;
    let settings = deposit_settings(arguments.grid, &profile, model.bounds())?;
    let selection = Selection {
        layers: arguments.layers.clone().flatten(),
        from: arguments.from_layer as usize - 1,
        pass: arguments.from_pass as usize - 1,
    };
    let judge = (!arguments.no_deposit).then(|| Judge::new(settings).with_pictures(MAP_PIXELS).without_patches());
    let files = Files::new(&arguments.output, programs, &profile)?.judged(judge);
    let mut files = Files { selection: selection.clone(), pictures: &arguments.picture, ..files };
    let planned = match arguments.several.order {
        Order::Layers => {
            let solid = beadwright::model::PartRef::from(&model);
            let solid = base.as_ref().map_or(solid, |base| solid.onto(base));
            plan::plan_into(&part, solid, &profile, &task, &mut files)
        }
        Order::Parts => {
            let solids: Vec<_> = lowest_first.iter().map(|(name, import)| (name.clone(), import.into())).collect();
            plan::parts_into(&part, &solids, &profile, &task, &mut files)
        }
    };
    bar.finish_and_clear();
    let mut summary = planned.map_err(|error| refused(error, &arguments.model.model))?;
    selection_exists(&selection, summary.metrics.layers)?;
    if let Some(missing) = arguments.picture.iter().find(|number| **number == 0 || **number > summary.metrics.layers) {
        anyhow::bail!("--picture {missing}: the part has the layers 1 to {}", summary.metrics.layers);
    }
    if !summary.forbidden.is_empty() && !arguments.allow_findings {
        let words = remedy::words(&profile);
        let report = files.refuse(&summary, &model.repair(), words, &arguments.output)?;
        let mut reasons = remedy::reasons(&summary, words);
        let hangs = |w: &WarningSummary| w.kind == WarningKind::InTheAir;
        let hangs = summary.warnings.summaries().any(hangs) && !arguments.preform && profile.layers.are_level();
        if let Some(mesh) = model.mesh().filter(|_| hangs) {
            reasons.extend(preform::remedy(mesh, &profile, &task)?);
        }
        return Err(Refused { reasons, report }.into());
    }
    let faults = check::rehearse(&profile).into_iter();
    let faults =
        faults.map(|(post, fault)| format!("{post}, {}: {fault} Remedy: {}.", fault.kind.name, fault.kind.remedy));
    let own = model.notes().iter().cloned();
    summary.notes.splice(0..0, own.chain(divided).chain(faults).chain(note));
    summary.notes.extend(files.notes());
    let found =
        remedy::findings(&summary, &model.repair().sentences(), files.check(&summary, &task)?, remedy::words(&profile));
    let (figures, totals, built) = (files.figures(), files.totals(), files.built());
    let written = files.finish(&summary, &model.repair())?;

    if arguments.json {
        let mut json = summary.json(figures.as_ref());
        json["findings"] = serde_json::json!(found);
        json["built"] = serde_json::json!(built);
        if let Some(totals) = &totals {
            json["programs"] = serde_json::json!(totals);
        }
        writeln!(std::io::stdout(), "{}", serde_json::to_string_pretty(&json)?)?;
        return Ok(());
    }
    print_head(&mut say::done(false), &part, &profile, &model, &places)?;
    print_findings(&found)?;
    let mut out = say::done(false);
    if let Some(totals) = &totals {
        writeln!(out, "\nthe programs weld {} of {} layers:", totals.layers, summary.metrics.layers)?;
        print_rows(&mut out, rows::totals(totals))?;
        write!(out, "\nthe whole plan:")?;
    }
    Ok(print_summary(&mut out, &arguments.output, &summary, (figures.as_ref(), built.as_ref()), &written)?)
}

/// Fails where a plan has none of the layers that its programs should weld.
fn selection_exists(selection: &Selection, layers: usize) -> anyhow::Result<()> {
    let Selection { layers: chosen, from, .. } = selection;
    anyhow::ensure!(*from < layers, "--from-layer {} lies above the part, which has {layers} layers", from + 1);
    if let Some(beyond) = chosen.iter().flatten().find(|layer| **layer >= layers) {
        anyhow::bail!("--layers: layer {} lies above the part, which has {layers} layers", beyond + 1);
    }
    Ok(())
}

/// Why a model was not planned.
pub(crate) fn refused(error: PlanError<anyhow::Error>, model: &Path) -> anyhow::Error {
    match error {
        PlanError::Sink(error) => error,
        PlanError::Cancelled(_) => anyhow::anyhow!("cancelled; nothing was written"),
        other => {
            let remedy = remedy::of_plan(&other).map_or(String::new(), |remedy| format!(" {remedy}"));
            anyhow::anyhow!("{}: {other}{remedy}", model.display())
        }
    }
}

/// Programs that should not be started.
#[derive(Debug, thiserror::Error)]
#[error(
    "no program was written, since it should not be started:\n{}\n{}--allow-findings writes it anyway.",
    .reasons.join("\n"),
    .report.as_ref().map_or(String::new(), |report| format!("{} shows the places. ", report.display()))
)]
pub(crate) struct Refused {
    /// Sentences.
    pub(crate) reasons: Vec<String>,
    /// The report that was written anyway.
    pub(crate) report: Option<PathBuf>,
}

/// Where the layers go.
pub(crate) struct Files<'a> {
    folder: Folder,
    /// The programs until the plan begins, then all files.
    programs: Option<Programs>,
    files: Option<PlanFiles>,
    pictures: &'a [usize],
    profile: &'a Profile,
    judge: Option<Judge>,
    /// What the programs weld of the plan.
    selection: Selection,
}

impl<'a> Files<'a> {
    /// Files for a folder, of all layers and without judgement.
    pub(crate) fn new(folder: &Path, programs: Programs, profile: &'a Profile) -> anyhow::Result<Self> {
        let (folder, programs) = (Folder::new(folder)?, Some(programs));
        Ok(Self { folder, programs, files: None, pictures: &[], profile, judge: None, selection: Selection::default() })
    }

    /// The same, judged by the deposit model.
    pub(crate) fn judged(self, judge: Option<Judge>) -> Self {
        Self { judge, ..self }
    }

    /// What the deposit model says about all layers.
    pub(crate) fn figures(&self) -> Option<Figures> {
        self.judge.as_ref().map(|judge| *judge.total())
    }

    /// Totals of what the programs weld, where that is not the whole plan.
    fn totals(&self) -> Option<Metrics> {
        self.files.as_ref().and_then(PlanFiles::totals).cloned()
    }

    /// How the built part ends relative to the plan, once checked.
    pub(crate) fn built(&self) -> Option<Growth> {
        self.files.as_ref().and_then(PlanFiles::built).copied()
    }

    /// What users must know about the programs, as sentences.
    pub(crate) fn notes(&self) -> Vec<String> {
        self.files.iter().flat_map(PlanFiles::notes).collect()
    }

    /// What the checks find in the plan.
    pub(crate) fn check(&mut self, summary: &Summary, task: &Task) -> anyhow::Result<&[Finding]> {
        let Some(files) = &mut self.files else { return Ok(&[]) };
        Ok(files.check(summary.grown.as_ref(), task)?)
    }

    /// Writes only the report, which shows the places at fault; returns its path.
    fn refuse(
        self,
        summary: &Summary,
        repair: &RepairReport,
        words: Words,
        output: &Path,
    ) -> anyhow::Result<Option<PathBuf>> {
        let Some(files) = self.files else { return Ok(None) };
        drop(self.folder);
        let mut folder = Folder::new(output)?;
        folder.extend([files.refused(summary, repair, words)])?;
        folder.commit()?;
        Ok(Some(output.join(REFUSED)))
    }

    /// Writes what comes last, and moves everything into place.
    pub(crate) fn finish(mut self, summary: &Summary, repair: &RepairReport) -> anyhow::Result<Written> {
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
        let (files, chunks) = PlanFiles::begin(header, self.profile, programs, self.selection.clone())?;
        self.files = Some(files);
        Ok(self.folder.extend(chunks)?)
    }

    fn layer(&mut self, layer: Layer) -> anyhow::Result<()> {
        if self.pictures.contains(&(layer.index + 1)) {
            let title = format!("Layer {}, z {:.2} mm", layer.index + 1, layer.z);
            let drawn = plan::drawn(&layer, self.profile);
            self.folder.append(&format!("layer-{:03}.svg", layer.index + 1), report::svg::layer(&drawn, &title))?;
        }
        let Selection { from: index, pass, .. } = self.selection;
        anyhow::ensure!(
            layer.index != index || pass == 0 || pass < layer.passes.len(),
            "--from-pass {}: the passes of layer {} are numbered 1 to {}",
            pass + 1,
            index + 1,
            layer.passes.len()
        );
        let welded = plan::welded_alone(&layer, self.profile);
        let judgement = self.judge.as_mut().map(|judge| judge.layer(&welded));
        if let Some(files) = &mut self.files {
            self.folder.extend(files.layer(&layer, judgement.as_ref()))?;
        }
        Ok(())
    }

    fn asks_how_it_grows(&self) -> bool {
        self.judge.is_some()
    }
}

/// How the layers of a part are judged: the grid as asked for, or one that fits the part.
pub(crate) fn deposit_settings(
    grid: Option<f64>,
    profile: &Profile,
    part: (DVec3, DVec3),
) -> anyhow::Result<DepositSettings> {
    let (bounds, layers) = plan::grid_over(profile, part);
    let settings = read_back::with_grid(grid, plan::deposit_settings(profile), &bounds, layers);
    settings.with_context(|| format!("--grid {}", grid.unwrap_or_default()))
}

/// Name and size, and where each of several parts is placed.
pub(crate) fn print_head(
    out: &mut impl Write,
    part: &str,
    profile: &Profile,
    model: &Part,
    places: &[Place],
) -> std::io::Result<()> {
    let (low, high) = model.bounds();
    let size = high - low;
    let of = match model {
        Part::Mesh(import) => format!("{} triangles", import.repair.triangles),
        Part::Curves { curves, .. } => format!("{} centre-lines", curves.count()),
    };
    writeln!(out, "{part}  {:.1} × {:.1} × {:.1} mm, {of}", size.x, size.y, size.z)?;
    for (name, Bounds { min, max }) in places {
        writeln!(out, "  {name:<22} x {:.1} to {:.1}, y {:.1} to {:.1} mm", min.x, max.x, min.y, max.y)?;
    }
    writeln!(out, "profile {}, strategy {}", profile.name, profile.fill.strategy)
}

/// What is printed even with `--quiet`: one line per finding, the worst first.
pub(crate) fn print_findings(findings: &[Finding]) -> std::io::Result<()> {
    let mut out = say::warnings();
    for finding in findings {
        let (word, sentence) = (finding.severity.word(), finding.sentence());
        // The sentences of checks lack their subject.
        match check::by_name(finding.kind) {
            Some(check) => writeln!(out, "{word}: {}: {sentence}", check.name)?,
            None => writeln!(out, "{word}: {sentence}")?,
        }
    }
    Ok(())
}

pub(crate) fn print_summary(
    out: &mut impl Write,
    folder: &Path,
    summary: &Summary,
    (figures, built): (Option<&Figures>, Option<&Growth>),
    written: &Written,
) -> std::io::Result<()> {
    writeln!(out)?;
    let judged = figures.map(rows::deposit).into_iter().flatten().chain(built.map(rows::built));
    print_rows(out, rows::totals(&summary.metrics).into_iter().chain(judged))?;
    writeln!(out)?;
    let Written { files, removed } = written;
    if !removed.is_empty() {
        writeln!(out, "{} files of an earlier plan removed: {}", removed.len(), shorten(removed))?;
    }
    writeln!(out, "{} files in {}: {}", files.len(), folder.display(), shorten(files))
}

fn print_rows(out: &mut impl Write, rows: impl IntoIterator<Item = (&'static str, String)>) -> std::io::Result<()> {
    rows.into_iter().try_for_each(|(name, value)| writeln!(out, "  {name:<22} {value}"))
}

/// All names, or the first and the last of many.
pub(crate) fn shorten(files: &[String]) -> String {
    const SHOWN: usize = 8;
    match files {
        [first @ .., last] if files.len() > SHOWN => format!("{}, …, {last}", first[..SHOWN - 2].join(", ")),
        _ => files.join(", "),
    }
}
