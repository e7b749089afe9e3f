//! `beadwright build`: a plan welded in the height model, with errors and feedback.

use crate::{adapt, model, profile, program, progress};
use anyhow::Context;
use beadwright::adapt::Feedback;
use beadwright::build::{self, Built, Errors, Heat, Settings, page};
use beadwright::files::write_file;
use beadwright::heat::plate;
use beadwright::layer::Layer;
use beadwright::plan::{self, choice};
use beadwright::profile::Profile;
use beadwright::task::Task;
use clap::ValueEnum;
use std::io::Write;
use std::path::{Path, PathBuf};

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// plan.json, or a model that is planned first.
    file: PathBuf,
    #[command(flatten)]
    wanted: profile::Wanted,
    #[command(flatten)]
    noise: Noise,
    /// How the scan after each layer is used; may be given several times; if left out, all three side by side.
    #[arg(long, value_enum, value_name = "KIND")]
    feedback: Vec<Kind>,
    #[command(flatten)]
    limits: adapt::Limits,
    /// Make walls rise less on warm metal, as `bead.by_heat` says, even though the plan was made without it.
    #[arg(long)]
    heat: bool,
    /// Seed of the random numbers.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Number of builds, with this seed and the ones that follow it; the page shows the first.
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    seeds: u32,
    /// HTML page to write.
    #[arg(long, short, default_value = "build.html", value_name = "FILE")]
    output: PathBuf,
    /// Print machine-readable JSON.
    #[arg(long)]
    json: bool,
}

/// Errors, as fractions of the metal: 0.1 is ±10 %.
#[derive(clap::Args)]
struct Noise {
    /// Standard deviation of the metal from pass to pass.
    #[arg(long, default_value_t = 0.1, value_parser = parse_part)]
    noise: f64,
    /// Standard deviation of the metal along a pass.
    #[arg(long, default_value_t = 0.1, value_parser = parse_part)]
    along: f64,
    /// Distance along a pass over which the correlation of its error falls to 1/e, mm.
    #[arg(long, default_value_t = 20.0, value_name = "MM", value_parser = parse_correlation)]
    correlation: f64,
    /// Growth of the metal from the first to the last layer.
    #[arg(long, default_value_t = 0.03, allow_hyphen_values = true, value_parser = parse_part)]
    drift: f64,
    /// Pass whose arc fails to burn, counted from 1 through the whole build.
    #[arg(long, value_name = "PASS", value_parser = clap::value_parser!(u32).range(1..))]
    lost_pass: Option<u32>,
    /// Standard deviation of a point of a scan, mm.
    #[arg(long, default_value_t = 0.0, value_name = "MM", value_parser = parse_scan)]
    scan_noise: f64,
}

#[derive(Clone, Copy, ValueEnum)]
enum Kind {
    /// Nothing: the plan is welded as it is.
    None,
    /// Number, height and metal of the layers follow the mean height.
    Mean,
    /// Each place gets the metal that it lacks.
    Place,
}

fn between(text: &str, [least, most]: [f64; 2], unit: &str) -> Result<f64, String> {
    let value: f64 = text.parse().map_err(|_| "a number is expected".to_owned())?;
    if (least..=most).contains(&value) {
        Ok(value)
    } else {
        Err(format!("it must lie between {least} and {most}{unit}"))
    }
}

fn parse_part(text: &str) -> Result<f64, String> {
    between(text, [-0.5, 0.5], " (0.1 is 10 %)")
}

fn parse_correlation(text: &str) -> Result<f64, String> {
    between(text, [1.0, 1e4], " mm")
}

fn parse_scan(text: &str) -> Result<f64, String> {
    between(text, [0.0, 10.0], " mm")
}

impl Noise {
    fn errors(&self, seed: u64) -> Errors {
        Errors {
            pass: self.noise,
            along: self.along,
            correlation: self.correlation,
            drift: self.drift,
            lost: self.lost_pass.map(|pass| pass as usize),
            scan: self.scan_noise,
            seed,
        }
    }
}

pub(crate) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let (task, bar) = progress::task()?;
    let (part, layers, profile) = layers(arguments, &task)?;
    let heat = arguments.heat.then(|| heat(&layers, &profile)).transpose()?;
    let nominal = plan::deposit_settings(&profile).nominal;
    let rules = arguments.limits.rules(&profile);
    let settings = |seed: u64| Settings { nominal, errors: arguments.noise.errors(seed), rules, heat: heat.clone() };
    let mut runs = Vec::new();
    for seed in (0..u64::from(arguments.seeds)).map(|k| arguments.seed.wrapping_add(k)) {
        let mut builds = Vec::new();
        for by in arguments.kinds() {
            let built = build::build(&layers, by, &settings(seed), &task)?;
            builds.push(built.ok_or_else(|| anyhow::anyhow!("{}: its layers do not rise.", arguments.file.display()))?);
        }
        runs.push(builds);
    }
    bar.finish_and_clear();
    if let Some(first) = runs.first() {
        write_file(&arguments.output, page::page(&part, first, &settings(arguments.seed)).html().as_bytes())?;
    }
    print(arguments, &part, &layers, &runs)
}

impl Arguments {
    fn kinds(&self) -> Vec<Feedback> {
        let kind = |kind: &Kind| match kind {
            Kind::None => Feedback::None,
            Kind::Mean => Feedback::Mean,
            Kind::Place => Feedback::Place,
        };
        let all = [Kind::None, Kind::Mean, Kind::Place];
        if self.feedback.is_empty() { &all } else { &self.feedback[..] }.iter().map(kind).collect()
    }
}

/// Name, layers and profile of a plan, or of a model that is planned.
fn layers(arguments: &Arguments, task: &Task) -> anyhow::Result<(String, Vec<Layer>, Profile)> {
    let (path, wanted): (&Path, _) = (&arguments.file, &arguments.wanted);
    let context = || path.display().to_string();
    if path.extension().is_some_and(|end| end.eq_ignore_ascii_case("json")) {
        let source = program::Source::open(path)?;
        let profile = source.profile(wanted)?;
        let plan = source.plan().ok_or_else(|| anyhow::anyhow!("{}: this is not a plan.json", path.display()))?;
        let known = source.profile(&profile::Wanted::default())?.bead.by_heat.is_some();
        anyhow::ensure!(
            !(known && arguments.heat),
            "{}: the plan was made with bead.by_heat, so its beads have the widths that heat gives them. Build it without \
             --heat.",
            path.display()
        );
        return Ok((plan.header.part.clone(), build::ready(&plan.layers, &profile).with_context(context)?, profile));
    }
    let profile = profile::load(wanted.profile.as_deref().unwrap_or(profile::USUAL), &wanted.set)?;
    let law = profile.bead.by_heat;
    let mut profile = profile;
    if arguments.heat {
        profile.bead.by_heat = None;
    }
    let model = model::Model::of(path);
    let part = model.part_placed(&profile, model::Use::AsDrawn, None, task)?;
    let mut profile = choice::choose(&part, &profile, false, task)?.profile;
    let plan = plan::plan(&model.part(), &part, &profile, task)?;
    profile.bead.by_heat = law;
    Ok((plan.header.part, build::ready(&plan.layers, &profile).with_context(context)?, profile))
}

/// The plate of a plan, and what heat does to its beads.
fn heat(layers: &[Layer], profile: &Profile) -> anyhow::Result<Heat> {
    let law = profile.bead.by_heat.ok_or_else(|| {
        anyhow::anyhow!(
            "--heat: the profile does not say how beads depend on heat (bead.by_heat). `beadwright bead walls` fits it to \
             measured walls."
        )
    })?;
    let plate = plate(layers, &profile.heat_settings()?, &profile.weld_settings());
    let plate = plate.ok_or_else(|| anyhow::anyhow!("the plan has no passes."))?;
    Ok(Heat { plate, law, rise: profile.single_wall()?.rise() })
}

/// The builds of all seeds by one kind of feedback.
struct Row<'a>(Vec<&'a Built>);

impl Row<'_> {
    /// Root mean square over all seeds, in layer heights.
    fn rms(&self) -> f64 {
        (self.0.iter().map(|built| built.rms().powi(2)).sum::<f64>() / self.0.len().max(1) as f64).sqrt()
    }

    fn worst(&self) -> f64 {
        self.0.iter().map(|built| built.rms()).fold(0.0, f64::max)
    }
}

fn print(arguments: &Arguments, part: &str, layers: &[Layer], runs: &[Vec<Built>]) -> anyhow::Result<()> {
    let mut out = std::io::stdout().lock();
    let kinds = arguments.kinds();
    let rows: Vec<Row> =
        (0..kinds.len()).map(|k| Row(runs.iter().filter_map(|builds| builds.get(k)).collect())).collect();
    if arguments.json {
        let end = |built: &&Built| serde_json::json!({ "layers": built.layers.len(), "clipped": built.clipped, "pieces": built.pieces, "end": built.end, "rms_layers": built.rms() });
        let row = |(by, row): (&Feedback, &Row)| serde_json::json!({ "feedback": by, "rms_layers": row.rms(), "worst": row.worst(), "builds": row.0.iter().map(end).collect::<Vec<_>>() });
        let rows: Vec<_> = kinds.iter().zip(&rows).map(row).collect();
        return Ok(writeln!(out, "{:#}", serde_json::json!({ "part": part, "rows": rows }))?);
    }
    let thickness = rows.iter().find_map(|row| row.0.first()).map_or(0.0, |built| built.layer_height);
    writeln!(
        out,
        "{part}: {} layers of {thickness:.2} mm, {} builds from seed {}\n",
        layers.len(),
        runs.len(),
        arguments.seed
    )?;
    writeln!(
        out,
        "  {:<14} {:>12} {:>8} {:>8} {:>10} {:>16}",
        "feedback", "RMS, layers", "worst", "layers", "mean, mm", "pieces clipped"
    )?;
    for (by, row) in kinds.iter().zip(&rows) {
        let Some(first) = row.0.first() else { continue };
        let (clipped, pieces) = row.0.iter().fold((0, 0), |sum, b| (sum.0 + b.clipped, sum.1 + b.pieces));
        writeln!(
            out,
            "  {:<14} {:>12.3} {:>8.3} {:>8} {:>+10.2} {:>15.2} %",
            page::name(*by),
            row.rms(),
            row.worst(),
            first.layers.len(),
            first.end.mean,
            100.0 * clipped as f64 / pieces.max(1) as f64
        )?;
    }
    writeln!(
        out,
        "\nRMS of the top against the end of the plan, in layer heights, over all builds; layers and mean are the first's."
    )?;
    writeln!(crate::say::done(false), "the first build layer by layer in {}", arguments.output.display())?;
    Ok(())
}
