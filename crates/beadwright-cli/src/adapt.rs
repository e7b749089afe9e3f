//! `beadwright adapt`: from a scan of a build to the programs of the layers that follow.

use crate::{profile, program, progress, scanned};
use anyhow::Context;
use beadwright::adapt::{AdaptError, Adapted, Align, Rules, Unfinished};
use beadwright::files::{Folder, Programs};
use beadwright::plan_file::PlanFile;
use beadwright::profile::Profile;
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
    #[command(flatten)]
    scanner: scanned::Scanner,
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
        Some((least, most)) if Rules::allow([least, most]) => Ok((least, most)),
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
    let (task, bar) = progress::task()?;
    let scan = arguments.scanner.read(&arguments.scan, 1.0, &task)?;
    let how = match arguments.align {
        How::AsIs => Align::AsIs,
        How::Plate => Align::Plate,
        How::Fit => Align::Fit,
    };
    let PlanFile { header, layers, .. } = plan;
    let number = arguments.after_layer as usize;
    let build = Unfinished { header, layers, profile: &profile, number };
    let adapted = Adapted::of(build, scan, how, arguments.limits.rules(&profile)).map_err(|error| {
        // What lies inside names its remedy.
        let (error, place) = match error {
            AdaptError::Align(error) => (anyhow::Error::from(error), &arguments.scan),
            AdaptError::See(error) => (anyhow::Error::from(error), &arguments.scan),
            other => (anyhow::Error::from(other), &arguments.plan),
        };
        error.context(place.display().to_string())
    })?;
    bar.finish_and_clear();
    let mut folder = Folder::new(&arguments.output)?;
    adapted.files(build, arguments.programs(&header.part, &profile)?, |chunks| anyhow::Ok(folder.extend(chunks)?))?;
    let written = folder.commit()?;
    let mut out = std::io::stdout().lock();
    if arguments.json {
        return Ok(writeln!(out, "{:#}", adapted.json())?);
    }
    adapted.sentences().iter().try_for_each(|sentence| writeln!(out, "{sentence}"))?;
    if adapted.followed.clipped > 0 {
        writeln!(out, "--window allows more or less metal.")?;
    }
    writeln!(
        out,
        "\n{} files in {}: {}",
        written.files.len(),
        arguments.output.display(),
        crate::plan::shorten(&written.files)
    )?;
    Ok(())
}

impl Arguments {
    fn programs(&self, part: &str, profile: &Profile) -> anyhow::Result<Programs> {
        let posts = if self.post.is_empty() { &profile.posts } else { &self.post };
        let base = self.wanted.profile.as_deref().map(profile::folder).filter(|_| self.post.is_empty());
        profile::programs(posts, &base.unwrap_or_default(), &profile.job(part))
    }
}
