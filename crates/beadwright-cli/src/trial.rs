//! `beadwright bead trial`: programs for trial beads, and the sheet for the measurements.

use crate::{file, profile, program, progress, scanned};
use anyhow::Context;
use beadwright::Layer;
use beadwright::files::{Folder, PLAN, write_file};
use beadwright::number::fixed;
use beadwright::pass::Pass;
use beadwright::program::Weave;
use beadwright::trial::{
    self, BeadSize, Design, Factor, Layout, More, Parameter, Plate, PlatePlan, Series, Shape, Slope, Sought,
};
use glam::DVec2;
use std::io::Write;
use std::path::{Path, PathBuf};

#[derive(clap::Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    wanted: profile::Wanted,
    /// What is varied: deposition_speed (mm/s), wire_feed_speed (m/min), job (values one by one: job=11,12,15); how beads begin and end:
    /// lead_in_length, lead_out_length (mm), lead_in_power, lead_out_power, crater_fill_time (s), crater_power; weave_length,
    /// weave_amplitude (mm), weave_dwell (s), weave_file; and for some shapes stepover, dwell (s) or angle (°). May be given several
    /// times.
    #[arg(long, required = true, value_name = "NAME=MIN..MAX")]
    vary: Vec<Factor>,
    /// What is welded with each combination.
    #[arg(long, value_enum, default_value_t = Welded::Bead)]
    shape: Welded,
    /// Which combinations are welded.
    #[arg(long, value_enum, default_value_t = Chosen::Factorial)]
    design: Chosen,
    /// Values of each factor in a factorial design.
    #[arg(long, default_value_t = 3, value_parser = clap::value_parser!(u16).range(2..=20), value_name = "N")]
    levels: u16,
    /// Number of combinations in a Latin hypercube.
    #[arg(long, default_value_t = 12, value_parser = clap::value_parser!(u16).range(2..=500), value_name = "N")]
    combinations: u16,
    /// How often each combination is welded; each time in another random order.
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=20), value_name = "N")]
    repeats: u16,
    /// Beads side by side of an overlap.
    #[arg(long, default_value_t = 3, value_parser = clap::value_parser!(u16).range(2..=20), value_name = "N")]
    beads: u16,
    /// Layers of a wall.
    #[arg(long, default_value_t = 20, value_parser = clap::value_parser!(u16).range(2..=500), value_name = "N")]
    layers: u16,
    /// Length of a bead, mm.
    #[arg(long, default_value_t = 100.0, value_parser = parse_length, value_name = "MM")]
    length: f64,
    /// Size of the plate, mm.
    #[arg(long, default_value = "400x250", value_parser = parse_size, value_name = "LENGTHxWIDTH")]
    plate: (f64, f64),
    /// Width of the edges of the plate where nothing is welded, mm.
    #[arg(long, default_value_t = 20.0, value_name = "MM")]
    margin: f64,
    /// Least distance between trials, mm.
    #[arg(long, default_value_t = 12.0, value_name = "MM")]
    gap: f64,
    /// Time the torch waits before each trial so that the plate cools, s.
    #[arg(long, default_value_t = 60.0, value_name = "S")]
    wait: f64,
    /// Do not number the trials in weld metal.
    #[arg(long)]
    no_numbers: bool,
    /// Seed of the random order: the same seed gives the same plates.
    #[arg(long, default_value_t = 1, value_name = "N")]
    seed: u64,
    /// Languages of the programs; those of the profile if left out.
    #[arg(long, value_delimiter = ',', value_name = "POST,…")]
    post: Vec<String>,
    /// Folder to write to.
    #[arg(short, long, default_value = "trial", value_name = "FOLDER")]
    output: PathBuf,
}

#[derive(clap::Args)]
pub(crate) struct Measure {
    /// Sheet that `bead trial` wrote, in the same folder as the plates.
    sheet: PathBuf,
    /// Scan of the plate in the coordinates of its program: STL, PLY or points, mm.
    scan: PathBuf,
    #[command(flatten)]
    scanner: scanned::Scanner,
    /// Number of the plate.
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..), value_name = "N")]
    plate: u16,
    /// Sheet to write; the same one if left out.
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

#[derive(Debug, Clone, Copy, clap::ValueEnum)]
enum Welded {
    /// Single beads, for width and height.
    Bead,
    /// Single beads, for the hump where they begin and the crater where they end.
    Ends,
    /// Beads side by side, for the stepover.
    Overlap,
    /// Walls of one bead a layer, for how they grow with the waits between layers.
    Wall,
    /// Two legs that meet at an angle.
    Corner,
}

#[derive(Debug, Clone, Copy, clap::ValueEnum)]
enum Chosen {
    /// Every combination of --levels values of each factor.
    Factorial,
    /// Middles of the edges of the range, and its middle three times; three to five factors.
    BoxBehnken,
    /// --combinations points that fill the range evenly.
    LatinHypercube,
}

/// How far from its planned middle a bead is sought, in planned widths.
const REACH: f64 = 1.3;
/// Longest series that makes sense.
const MOST: usize = 2000;

pub(crate) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let name = arguments.wanted.profile.as_deref().unwrap_or(profile::USUAL);
    let own = profile::load(name, &arguments.wanted.set)?;
    let plate = Plate { length: arguments.plate.0, width: arguments.plate.1, margin: arguments.margin };
    anyhow::ensure!(
        [arguments.margin, arguments.gap, arguments.wait].iter().all(|value| (0.0..=10_000.0).contains(value)),
        "--margin, --gap and --wait lie between 0 and 10000."
    );
    let series = series(arguments, &own, plate)?;
    let posts = if arguments.post.is_empty() { &own.posts } else { &arguments.post };
    let by_file = arguments.vary.iter().any(|factor| factor.parameter == Parameter::WeaveFile);
    anyhow::ensure!(
        !by_file || posts.iter().all(|post| post == "inform"),
        "--vary weave_file: only Yaskawa controllers (inform) weave by files. Vary weave_length, weave_amplitude and weave_dwell for \
         others, or leave them out (--post inform)."
    );
    let title = format!("Trials with {}", own.name);
    let folder = if arguments.post.is_empty() { profile::folder(name) } else { PathBuf::new() };
    let stale = arguments.output.join(PlatePlan::name(series.plates()));
    anyhow::ensure!(
        !stale.exists(),
        "{} is a plate of an earlier series and would be taken for one of this. Remove it, or write to another folder (-o).",
        stale.display()
    );
    let plans: Vec<PlatePlan> = (0..series.plates()).map(|index| PlatePlan::new(&series, index, &own)).collect();
    let mut plates = Vec::new();
    for plan in &plans {
        let programs = profile::programs(posts, &folder, &plan.profile.job(&plan.name))?;
        let mut folder = Folder::new(&arguments.output.join(&plan.name))?;
        folder.extend(plan.files(programs)?)?;
        plates.push(folder);
    }
    for folder in plates {
        folder.commit()?;
    }
    let sheet = trial::csv(&title, &series);
    write_file(&arguments.output.join("sheet.csv"), sheet.as_bytes())?;
    write_file(&arguments.output.join("sheet.html"), trial::page(&title, &series, plate).html().as_bytes())?;
    say(arguments, &series, &plans)
}

fn series(arguments: &Arguments, profile: &beadwright::Profile, plate: Plate) -> anyhow::Result<Series> {
    let factors = arguments.vary.clone();
    if let Some(twice) = factors
        .iter()
        .enumerate()
        .find(|(k, factor)| factors[..*k].iter().any(|other| other.parameter == factor.parameter))
    {
        anyhow::bail!("--vary {}: it is given twice.", twice.1.parameter);
    }
    let shape = match arguments.shape {
        Welded::Bead => Shape::Bead,
        Welded::Ends => Shape::Ends,
        Welded::Overlap => Shape::Overlap(arguments.beads.into()),
        Welded::Wall => Shape::Wall(arguments.layers.into()),
        Welded::Corner => Shape::Corner,
    };
    let design = match arguments.design {
        Chosen::Factorial => Design::Factorial(arguments.levels.into()),
        Chosen::BoxBehnken => Design::BoxBehnken,
        Chosen::LatinHypercube => Design::LatinHypercube(arguments.combinations.into()),
    };
    let combinations = trial::points(design, &factors, arguments.seed).with_context(|| {
        format!(
            "--design box-behnken needs three to five factors, and {} are given. Use another design.",
            factors.len()
        )
    })?;
    let count = combinations.len() * usize::from(arguments.repeats);
    anyhow::ensure!(
        count <= MOST,
        "{count} trials are more than the {MOST} that can be numbered: use fewer --levels, or --design latin-hypercube."
    );
    let layout = Layout {
        plate,
        repeats: arguments.repeats.into(),
        seed: arguments.seed,
        length: arguments.length,
        gap: arguments.gap,
        wait: arguments.wait,
        numbers: !arguments.no_numbers,
    };
    Ok(Series::new(factors, &combinations, shape, layout, trial::nominal(profile))?)
}

fn say(arguments: &Arguments, series: &Series, plans: &[PlatePlan]) -> anyhow::Result<()> {
    let mut out = std::io::stdout().lock();
    let (plates, folder) = (plans.len(), arguments.output.display());
    writeln!(
        out,
        "{} trials in random order (seed {}) on {plates} {} of {} × {} mm\n",
        series.trials.len(),
        arguments.seed,
        if plates == 1 { "plate" } else { "plates" },
        arguments.plate.0,
        arguments.plate.1,
    )?;
    for (k, plan) in plans.iter().enumerate() {
        let own: Vec<usize> = series.trials.iter().filter(|trial| trial.plate == k).map(|trial| trial.number).collect();
        let (first, last) = (own.first().copied().unwrap_or(0), own.last().copied().unwrap_or(0));
        let metrics = plan.metrics();
        writeln!(
            out,
            "  {folder}/{}: trials {first} to {last}, {} arc starts, {} min of arc, {} min in all",
            plan.name,
            metrics.arc_starts,
            fixed(metrics.arc_time_s / 60.0, 1),
            fixed(metrics.total_time_s / 60.0, 0),
        )?;
    }
    let fit = match series.shape {
        Shape::Bead => format!("Fill in {folder}/sheet.csv, then: beadwright bead fit {folder}/sheet.csv"),
        Shape::Wall(_) => {
            format!("Fill in {folder}/sheet.csv, then: beadwright bead walls {folder}/sheet.csv -p PROFILE")
        }
        Shape::Ends | Shape::Overlap(_) => format!(
            "Fill in {folder}/sheet.csv, then: beadwright bead fit {folder}/sheet.csv -p PROFILE --to FILE.toml"
        ),
        Shape::Corner => format!("Fill in {folder}/sheet.csv, then: beadwright bead fit {folder}/sheet.csv"),
    };
    Ok(writeln!(out, "\n{folder}/sheet.html shows what lies where. {fit}")?)
}

fn parse_size(text: &str) -> Result<(f64, f64), String> {
    let sides = text.split_once(['x', '×']).and_then(|(a, b)| Some((a.trim().parse().ok()?, b.trim().parse().ok()?)));
    match sides {
        Some((length, width)) if [length, width].iter().all(|side| (20.0..=10_000.0).contains(side)) => {
            Ok((length, width))
        }
        _ => Err("two lengths of 20 to 10000 mm are expected, such as 400x250".to_owned()),
    }
}

fn parse_length(text: &str) -> Result<f64, String> {
    let length: f64 = text.parse().map_err(|_| "a length in mm is expected".to_owned())?;
    if (10.0..=10_000.0).contains(&length) { Ok(length) } else { Err("it must lie between 10 and 10000 mm".to_owned()) }
}

pub(crate) fn measure(arguments: &Measure) -> anyhow::Result<()> {
    let text = file::text(&arguments.sheet)?;
    let plate = usize::from(arguments.plate);
    let folder = arguments.sheet.parent().unwrap_or(Path::new("")).join(PlatePlan::name(plate - 1));
    let source = program::Source::open(&folder.join(PLAN))?;
    let plan = source.plan().with_context(|| format!("{} holds no plan.json", folder.display()))?;
    let named = || arguments.sheet.display().to_string();
    let numbers = trial::numbers_on(&text, plate).with_context(named)?;
    let trials = sought(&plan.layers, plan.profile.as_ref().and_then(|profile| profile.weave.as_ref())).context(
        "a scan is measured for straight beads, by themselves or side by side. Measure walls and corners by hand.",
    )?;
    let (task, bar) = progress::task()?;
    let scan = arguments.scanner.read(&arguments.scan, 1.0, &task)?;
    bar.finish_and_clear();
    let sizes = trial::measured(&scan.points, &trials).with_context(|| arguments.scan.display().to_string())?;
    let sheet = trial::filled(&text, plate, &sizes).with_context(named)?;
    let output = arguments.output.as_ref().unwrap_or(&arguments.sheet);
    write_file(output, sheet.as_bytes())?;
    let mut out = std::io::stdout().lock();
    for (number, size) in numbers.iter().zip(&sizes) {
        let unseen = || "not seen in the scan, or with too few points across it".to_owned();
        writeln!(out, "  {number:>3}  {}", size.as_ref().map_or_else(unseen, seen))?;
    }
    Ok(writeln!(out, "\nfilled in {}", output.display())?)
}

/// Where the trials of a plate are sought: a layer for each, and perhaps one with their numbers, whose strokes are shorter. `None` if
/// they are not straight beads on the plate.
fn sought(layers: &[Layer], weave: Option<&Weave>) -> Option<Vec<Sought>> {
    let line = |pass: &Pass| match pass.points[..] {
        [from, to] => Some([from.truncate(), to.truncate()]),
        _ => None,
    };
    let first = layers.first()?;
    let [from, to] = line(first.passes.first()?)?;
    let is_as_long = |[a, b]: &[DVec2; 2]| (a.distance(*b) - from.distance(to)).abs() < 0.01;
    let trial = |layer: &Layer| {
        let beads: Vec<_> = layer.passes.iter().map(line).collect::<Option<_>>()?;
        let wider = weave.map_or(0.0, |weave| weave.at_layer(layer.index).amplitude - weave.amplitude);
        let reach = REACH * layer.passes.first()?.width.max() + wider.max(0.0);
        beads.iter().all(is_as_long).then_some(Sought { beads, reach })
    };
    let trials: Vec<Sought> = layers.iter().map_while(trial).collect();
    layers[..trials.len()].iter().all(|layer| layer.z == first.z).then_some(trials)
}

/// What a scan says of a trial.
fn seen(BeadSize { width, height, more }: &BeadSize) -> String {
    match more {
        More::Beside { valley } => {
            format!("{width:.2} mm wide, {height:.2} mm high, deepest valley {valley:.2} mm")
        }
        More::One { width_varies, height_varies, hump, crater } => {
            let slope = |slope: &Option<Slope>| {
                let over = |length: Option<f64>| length.map_or(String::new(), |length| format!(" over {length:.0} mm"));
                slope.map_or("not seen".to_owned(), |own| format!("{:.2} mm{}", own.height, over(own.length)))
            };
            format!(
                "{width:.2} ± {width_varies:.2} mm wide, {height:.2} ± {height_varies:.2} mm high, hump {}, crater {}",
                slope(hump),
                slope(crater)
            )
        }
    }
}
