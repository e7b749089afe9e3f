//! `beadwright adapt`: from a scan of a build to the programs of the layers that follow.

use crate::{file, profile, program, progress};
use anyhow::Context;
use beadwright::adapt::scan::{self, Scan};
use beadwright::adapt::{self, Align, Aligned, Followed, Rules, Seen, Spread};
use beadwright::files::{Folder, PlanFiles, Programs, Selection, Written};
use beadwright::layer::{Extent, Layer};
use beadwright::metrics::Metrics;
use beadwright::model::RepairReport;
use beadwright::plan::{self, Header, Summary};
use beadwright::plan_file::PlanFile;
use beadwright::profile::Profile;
use beadwright::warning::Warnings;
use clap::ValueEnum;
use std::io::Write;
use std::path::PathBuf;

#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// plan.json of the build.
    plan: PathBuf,
    /// Scan: PLY, lines of x, y, z in mm (CSV, XYZ, or a few touched points), or a height map.
    #[arg(long, value_name = "FILE")]
    scan: PathBuf,
    /// Layer after which the scan was taken, counted from 1.
    #[arg(long, value_name = "LAYER", value_parser = clap::value_parser!(u32).range(1..))]
    after_layer: u32,
    /// Alignment of the scan with the part.
    #[arg(long, value_enum, default_value_t = How::AsIs)]
    align: How,
    #[command(flatten)]
    limits: Limits,
    #[command(flatten)]
    wanted: profile::Wanted,
    /// Dialect instead of the profile's; may be given several times.
    #[arg(long, value_name = "NAME|DIR")]
    post: Vec<String>,
    /// Folder for the files that are written.
    #[arg(long, short, default_value = "beadwright-adapted", value_name = "DIR")]
    output: PathBuf,
    /// Print machine-readable JSON.
    #[arg(long)]
    json: bool,
}

/// How far corrections may go.
#[derive(clap::Args)]
pub(crate) struct Limits {
    /// Least and greatest metal per length, as multiples of what was planned.
    #[arg(long, value_name = "LEAST..MOST", default_value = "0.7..1.3", value_parser = parse_window)]
    window: (f64, f64),
    /// Distance between the points at which metal and height change, mm; a bead width if left out.
    #[arg(long, value_name = "MM", value_parser = parse_spacing)]
    spacing: Option<f64>,
}

impl Limits {
    pub(crate) fn rules(&self, profile: &Profile) -> Rules {
        Rules { window: self.window, spacing: self.spacing.unwrap_or(profile.bead.width) }
    }
}

#[derive(Clone, Copy, ValueEnum)]
enum How {
    /// Not moved: its coordinates are those of the part.
    AsIs,
    /// The plate in the scan is z = 0.
    Plate,
    /// The plate gives the height; the outline of the part gives x, y and the turn about z.
    Fit,
}

fn parse_window(text: &str) -> Result<(f64, f64), String> {
    let ends = text.split_once("..").and_then(|(least, most)| Some((least.parse().ok()?, most.parse().ok()?)));
    match ends {
        Some((least, most)) if (0.1..=1.0).contains(&least) && (1.0..=5.0).contains(&most) => Ok((least, most)),
        _ => Err("two numbers are expected, 0.1 to 1 and 1 to 5, such as 0.7..1.3".to_owned()),
    }
}

fn parse_spacing(text: &str) -> Result<f64, String> {
    let spacing: f64 = text.parse().map_err(|_| "a length in mm is expected".to_owned())?;
    if (0.1..=1000.0).contains(&spacing) { Ok(spacing) } else { Err("it must lie between 0.1 and 1000 mm".to_owned()) }
}

pub(crate) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let source = program::Source::open(&arguments.plan)?;
    let context = || format!("{}: plans are adapted; give the plan.json of the build", arguments.plan.display());
    let plan = source.plan().with_context(context)?;
    let profile = source.profile(&arguments.wanted)?;
    anyhow::ensure!(
        profile.layers.are_level(),
        "{}: scans are compared with level layers only, and these are not level (layers.chart)",
        arguments.plan.display()
    );
    let (task, bar) = progress::task()?;
    let context = || format!("{}", arguments.scan.display());
    let scan = scan::read(&file::read(&arguments.scan)?, &task).with_context(context)?;
    let number = arguments.after_layer as usize;
    let built = plan.layers.get(..number).unwrap_or(&plan.layers);
    let how = match arguments.align {
        How::AsIs => Align::AsIs,
        How::Plate => Align::Plate,
        How::Fit => Align::Fit,
    };
    let Scan { points, format, without_height, .. } = scan;
    let read = points.len();
    let aligned = adapt::align(points, built, profile.bead.width, how).with_context(context)?;
    let nominal = plan::deposit_settings(&profile).nominal;
    let seen = adapt::see(&plan.layers, number, &aligned.points, nominal).with_context(context)?;
    let rules = arguments.limits.rules(&profile);
    let followed = adapt::follow(&plan.layers, number, &seen, profile.bead.width, &rules);
    bar.finish_and_clear();
    let missing = if without_height > 0 { format!(", {without_height} more without a height") } else { String::new() };
    let scanned = format!("{format} of {read} points{missing}");
    let sentences = sentences(&scanned, how, &aligned, &seen, &followed, &rules);
    let adapted = Adapted { plan, number, seen: &seen, followed: &followed, profile: &profile, sentences: &sentences };
    let written = adapted.write(arguments)?;
    let mut out = std::io::stdout().lock();
    if arguments.json {
        return Ok(writeln!(out, "{:#}", adapted.json(&aligned))?);
    }
    sentences.iter().try_for_each(|sentence| writeln!(out, "{sentence}"))?;
    writeln!(
        out,
        "\n{} files in {}: {}",
        written.files.len(),
        arguments.output.display(),
        crate::plan::shorten(&written.files)
    )?;
    Ok(())
}

/// What is reported of a scan and of the layers that follow.
fn sentences(
    scanned: &str,
    how: Align,
    aligned: &Aligned,
    seen: &Seen,
    followed: &Followed,
    rules: &Rules,
) -> Vec<String> {
    let Spread { mean, rms, low, high } = seen.error;
    let mut sentences = vec![
        format!(
            "Scan: {scanned}; {} of them lie over the layer and cover {:.0} % of it.",
            seen.points,
            100.0 * seen.covered
        ),
        format!("Measured minus predicted: {mean:+.2} mm on average, {low:+.2} to {high:+.2} mm, RMS {rms:.2} mm."),
    ];
    let (shift, turn) = (aligned.shift, aligned.turn.to_degrees());
    if how != Align::AsIs {
        let height = if aligned.plate { "the plate gave z" } else { "no plate was seen, so z was kept" };
        sentences.push(format!(
            "Aligned: moved by x {:+.2} y {:+.2} z {:+.2} mm, turned by {turn:+.2}°; {height}.",
            shift.x, shift.y, shift.z
        ));
    }
    let (layers, planned) = (followed.layers.len(), followed.planned);
    if layers == 0 {
        sentences.push(format!("The part has reached its height: no layer follows; {planned} were planned."));
        return sentences;
    }
    let z = followed.layers.first().map_or(0.0, |layer| layer.z);
    let (least, most) = (100.0 * followed.metal.0, 100.0 * followed.metal.1);
    sentences.push(format!(
        "{layers} layers follow ({planned} were planned); the next ends at z {z:.2} mm with {least:.0} to {most:.0} % of the \
         planned metal."
    ));
    if followed.clipped > 0 {
        sentences.push(format!(
            "{} of {} pieces need more or less than the window of {} to {} times the planned metal (--window): the layers \
             above them make up for it.",
            followed.clipped, followed.pieces, rules.window.0, rules.window.1
        ));
    }
    let end = followed.end;
    sentences
        .push(format!("Expected at the end: {:+.2} mm on average, {:+.2} to {:+.2} mm.", end.mean, end.low, end.high));
    sentences
}

/// A build with the layers that follow.
struct Adapted<'a> {
    plan: &'a PlanFile,
    /// Number of layers that are built.
    number: usize,
    seen: &'a Seen,
    followed: &'a Followed,
    profile: &'a Profile,
    sentences: &'a [String],
}

impl Adapted<'_> {
    /// Writes the programs of the layers that follow, the whole plan with them, and the page.
    fn write(&self, arguments: &Arguments) -> anyhow::Result<Written> {
        let extent = Extent { layers: self.layers().count(), ..self.plan.header.extent };
        let header = Header { extent, ..self.plan.header.clone() };
        let z = self.plan.layers[self.number - 1].z;
        let page = adapt::page::page(&header.part, self.number, z, self.seen, self.sentences);
        let mut folder = Folder::new(&arguments.output)?;
        folder.append("adapt.html", page.html())?;
        if self.followed.layers.is_empty() {
            return Ok(folder.commit()?);
        }
        let (mut files, chunks) = PlanFiles::begin(
            &header,
            self.profile,
            self.programs(arguments)?,
            Selection { from: self.number, ..Selection::default() },
        )?;
        folder.extend(chunks)?;
        let mut metrics = Metrics::new(self.profile);
        for layer in self.layers() {
            metrics.add(layer);
            folder.extend(files.layer(layer, None))?;
        }
        let notes = self.sentences.iter().cloned().chain(files.notes()).collect();
        let summary = Summary { metrics, warnings: Warnings::default(), notes, forbidden: self.profile.forbidden() };
        folder.extend(files.end(&summary, &RepairReport::default(), None)?)?;
        Ok(folder.commit()?)
    }

    fn programs(&self, arguments: &Arguments) -> anyhow::Result<Programs> {
        let posts = if arguments.post.is_empty() { &self.profile.posts } else { &arguments.post };
        let base = arguments.wanted.profile.as_deref().map(profile::folder).filter(|_| arguments.post.is_empty());
        profile::programs(posts, &base.unwrap_or_default(), &self.profile.job(&self.plan.header.part))
    }

    /// The layers that are built, as they were planned, and those that follow.
    fn layers(&self) -> impl Iterator<Item = &Layer> {
        self.plan.layers[..self.number].iter().chain(&self.followed.layers)
    }

    fn json(&self, aligned: &Aligned) -> serde_json::Value {
        let Followed { layers, planned, pieces, clipped, metal, end } = self.followed;
        serde_json::json!({
            "after_layer": self.number,
            "error": self.seen.error,
            "points": self.seen.points,
            "covered": self.seen.covered,
            "align": { "shift": aligned.shift, "turn": aligned.turn.to_degrees(), "astray": aligned.astray, "plate": aligned.plate },
            "layers": layers.len(),
            "planned_layers": planned,
            "metal": [metal.0, metal.1],
            "pieces": pieces,
            "clipped": clipped,
            "end": end,
        })
    }
}
