//! Programs and plans read back: files, their modules, and the part they were made for.

use crate::profile::{self, Wanted};
use crate::{file, model};
use anyhow::Context;
use beadwright::compare::Totals;
use beadwright::deposit::{self, DepositSettings};
use beadwright::dialect::reading::{self, ArcCodes, Fault, Metal};
use beadwright::export::toolpath;
use beadwright::layer::{self, Extent, Layer};
use beadwright::metrics::Metrics;
use beadwright::model::Import;
use beadwright::plan;
use beadwright::plan_file::{self, PlanFile};
use beadwright::planar::Bounds;
use beadwright::process::Follow;
use beadwright::profile::{BUILT_IN, Profile};
use beadwright::simulate;
use beadwright::task::Task;
use beadwright::text;
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};

/// How a program is read.
#[derive(clap::Args, Default)]
pub(crate) struct Reading {
    /// Words that strike the arc, instead of those of the profile and of M3 and M4 in G-code, such as --arc-on "M64 P1".
    #[arg(long, value_name = "CODE")]
    arc_on: Vec<String>,
    /// Words that end the arc, instead of those of the profile and of M5 in G-code.
    #[arg(long, value_name = "CODE")]
    arc_off: Vec<String>,
    /// Bead width, mm, instead of the one from the program or the profile.
    #[arg(long, value_name = "MM")]
    bead_width: Option<f64>,
}

/// A program or a plan that has been opened.
pub(crate) struct Source {
    path: PathBuf,
    name: String,
    content: Content,
}

enum Content {
    Plan(Box<PlanFile>),
    Program(String),
}

/// A program or plan as layers.
pub(crate) struct Loaded {
    pub(crate) name: String,
    pub(crate) language: &'static str,
    pub(crate) layers: Vec<Layer>,
    pub(crate) totals: Totals,
    pub(crate) settings: DepositSettings,
    /// What the grid is fitted to: the box around all layers, and their number; of a plan, as when it was made.
    pub(crate) over: Option<(Bounds, usize)>,
    pub(crate) notes: Vec<String>,
    /// Dangerous lines of a program.
    pub(crate) faults: Vec<Fault>,
}

impl Loaded {
    /// How the layers are judged: with the grid asked for, or one that fits them.
    pub(crate) fn deposit_settings(&self, grid: Option<f64>) -> anyhow::Result<DepositSettings> {
        match &self.over {
            Some((bounds, layers)) => fitted(grid, self.settings, bounds, *layers),
            None => Ok(self.settings),
        }
    }
}

/// Settings with the grid asked for, or with one that fits.
pub(crate) fn fitted(
    grid: Option<f64>,
    settings: DepositSettings,
    bounds: &Bounds,
    layers: usize,
) -> anyhow::Result<DepositSettings> {
    let Some(step) = grid else { return Ok(settings.fitted_to(bounds, layers)) };
    let (settings, size) = (DepositSettings { step, ..settings }, bounds.size());
    let points = size.x * size.y / (step * step);
    anyhow::ensure!(
        points <= deposit::MANY_POINTS,
        "--grid {step}: over {:.0} × {:.0} mm that are {points:.0e} points; at most {:.0e} are computed. Take --grid {:.3} \
         or more.",
        size.x,
        size.y,
        deposit::MANY_POINTS,
        ((size.x * size.y / deposit::MANY_POINTS).sqrt() * 1e3).ceil() / 1e3
    );
    Ok(settings)
}

impl Source {
    pub(crate) fn open(path: &Path) -> anyhow::Result<Self> {
        let context = || format!("{}", path.display());
        let name = path.file_name().map_or_else(String::new, |n| n.to_string_lossy().into_owned());
        let bytes = file::read(path)?;
        if toolpath::is_toolpath(&bytes) {
            let content = Content::Plan(Box::new(toolpath::read(&bytes).with_context(context)?));
            return Ok(Self { path: path.to_owned(), name, content });
        }
        let text = text::of(&bytes).with_context(context)?;
        let content = if text.trim_start().starts_with('{') {
            Content::Plan(Box::new(plan_file::read(&text).with_context(context)?))
        } else {
            Content::Program(text)
        };
        Ok(Self { path: path.to_owned(), name, content })
    }

    /// The plan, if it is one.
    pub(crate) fn plan(&self) -> Option<&PlanFile> {
        match &self.content {
            Content::Plan(plan) => Some(plan),
            Content::Program(_) => None,
        }
    }

    /// The profile that is asked for; if none is, that of the plan or the one that the program names.
    pub(crate) fn profile(&self, wanted: &Wanted) -> anyhow::Result<Profile> {
        if let Some(name) = &wanted.profile {
            return profile::load(name, &wanted.set);
        }
        let plan = match &self.content {
            Content::Plan(plan) => plan,
            Content::Program(text) => return profile::load(told_profile(text).unwrap_or(profile::USUAL), &wanted.set),
        };
        let Some(profile) = &plan.profile else {
            let name = &plan.header.profile;
            anyhow::bail!(
                "{}: this plan does not carry its profile{}, as neither plan.json of version 1 nor toolpaths of other \
                 programs do. Give it with --profile, or make the plan again.",
                self.path.display(),
                if name.is_empty() { String::new() } else { format!(" (\"{name}\")") }
            );
        };
        if wanted.set.is_empty() {
            Ok(profile.clone())
        } else {
            profile::with_settings(profile.toml_text()?, Path::new(""), &wanted.set)
        }
    }

    /// The layers. With a part, its slices become the islands of a program's layers.
    pub(crate) fn load(
        self,
        reading: &Reading,
        wanted: &Wanted,
        profile: &Profile,
        part: Option<&Import>,
        task: &Task,
    ) -> anyhow::Result<Loaded> {
        let Self { path, name, content } = self;
        let text = match content {
            Content::Plan(plan) => return Ok(layers_of(name, *plan, profile)),
            Content::Program(text) => text,
        };
        let folder = path.parent().map_or_else(PathBuf::new, Path::to_owned);
        let main =
            Main { folder, extension: path.extension().map(|e| e.to_ascii_lowercase()), dialect: recognised(&text) };
        let mut module = |name: &str| main.module(name);
        let dialect = reading::recognise(&text).map(|dialect| dialect.name);
        let options = profile.reading_options(Some(&name), dialect);
        let options = reading::Options { arc: reading.codes(options.arc), ..options };
        let mut program = reading::read(&text, &mut module, &options).with_context(|| format!("{}", path.display()))?;
        let (told, printer) = (told_profile(&text), program.moves.iter().any(|m| matches!(m.metal, Metal::Volume(_))));
        anyhow::ensure!(
            !printer || told.is_some() || wanted.profile.is_some(),
            "{}: this is a printer's program, and it names no built-in profile: give the one of its bead with --profile, \
             such as fdm-abs-0.4, or your own.",
            path.display()
        );
        let settings = plan::deposit_settings(profile);
        let mut layers = simulate::layers(&program, &settings, &profile.bead.law, &profile.process, reading.bead_width);
        let mut notes = program.notes.clone();
        if wanted.profile.is_none() {
            let source = if told.is_some() { "the program names it" } else { "--profile tells another" };
            notes.insert(0, format!("Read with the profile {} ({source}).", profile.name));
        }
        if profile.process.follow == Follow::WireFeed && !printer {
            notes.push(
                "The profile changes the wire feed along a pass (process.follow), and programs' wire feeds are not read: all \
                 beads are judged with the nominal one. Simulate plan.json for their true widths."
                    .to_owned(),
            );
        }
        let (rapids, length) = program.take_rapids_at(profile.travel.speed);
        if rapids > 0 {
            notes.push(format!(
                "Rapid and joint moves tell no speed: {rapids} of them, {:.2} m, were timed at the profile's travel.speed, {} \
                 mm/s.",
                length / 1e3,
                profile.travel.speed
            ));
        }
        if let Some(part) = part {
            if let Some(by) = simulate::shift(&layers, &part.mesh, &settings) {
                simulate::translate(&mut layers, by);
                notes.push(format!(
                    "The program was moved by x {:.2} y {:.2} mm, so that its middle is the part's.",
                    by.x, by.y
                ));
            }
            simulate::outline(&mut layers, &part.mesh, profile.slice_options(), task)?;
        }
        let language = program.language;
        let mut totals = Totals::of_program(&program.totals(), &layers, profile);
        if let Some(motion) = &profile.motion {
            totals.total_time_s = program.seconds(motion);
        }
        let faults = program.faults;
        let over = layer::bounds(&layers).map(|bounds| (bounds, layers.len()));
        Ok(Loaded { name, language, layers, totals, settings, over, notes, faults })
    }
}

/// The built-in profile that a program of ours names in its first comments, after the part: `; cross, fdm-abs-0.4`.
fn told_profile(text: &str) -> Option<&'static str> {
    const HEAD: usize = 40;
    let told = |line: &str| {
        let line = line.trim_end_matches(|c: char| !c.is_ascii_alphanumeric()).to_ascii_lowercase();
        BUILT_IN.iter().map(|(name, _)| *name).find(|name| line.strip_suffix(name).is_some_and(|l| l.ends_with(", ")))
    };
    text.lines().take(HEAD).find_map(told)
}

impl Reading {
    /// What switches the arc: the words given, or those of the profile.
    fn codes(&self, templates: ArcCodes) -> ArcCodes {
        let given = |words: &[String], templates| if words.is_empty() { templates } else { words.to_vec() };
        let alone = !self.arc_on.is_empty() || !self.arc_off.is_empty();
        ArcCodes { on: given(&self.arc_on, templates.on), off: given(&self.arc_off, templates.off), alone }
    }
}

fn layers_of(name: String, plan: PlanFile, profile: &Profile) -> Loaded {
    // A plan that carries its profile is judged by it, or by the one that is asked for.
    let own = plan.settings.filter(|_| plan.profile.is_none());
    let settings = own.unwrap_or_else(|| plan::deposit_settings(profile));
    let mut metrics = Metrics::new(profile);
    plan.layers.iter().for_each(|layer| metrics.add(layer));
    let (totals, notes) = (Totals::of_plan(&metrics), Vec::new());
    let Extent { low, high, .. } = plan.header.extent;
    let over = Some(plan::grid_over(profile, (low, high)));
    Loaded { name, language: "plan", layers: plan.layers, totals, settings, over, notes, faults: Vec::new() }
}

/// The main file of a program, whose modules lie beside it.
struct Main {
    folder: PathBuf,
    /// Its extension, in lower case.
    extension: Option<OsString>,
    dialect: Option<&'static str>,
}

impl Main {
    /// A module by name, whatever its case and extension. A folder may hold the same part in several languages: a
    /// module in another language than the main file's is none of it, and the main file's extension comes first.
    fn module(&self, name: &str) -> Option<String> {
        let folder = if self.folder.as_os_str().is_empty() { Path::new(".") } else { &self.folder };
        let wanted = name.to_ascii_lowercase();
        let fits = |path: &PathBuf| {
            let file = path.file_name().map(|f| f.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
            file == wanted || ["src", "mod", "sub", "ls", "jbi"].iter().any(|ext| file == format!("{wanted}.{ext}"))
        };
        let mut files: Vec<PathBuf> =
            fs::read_dir(folder).ok()?.filter_map(|e| Some(e.ok()?.path())).filter(fits).collect();
        let other = |path: &Path| path.extension().map(|e| e.to_ascii_lowercase()) != self.extension;
        files.sort_by_cached_key(|path| (other(path), path.clone()));
        let text = |path: PathBuf| text::of(&file::read(&path).ok()?).ok();
        let own = |text: &String| recognised(text).is_none_or(|dialect| self.dialect.is_none_or(|own| own == dialect));
        files.into_iter().filter_map(text).find(own)
    }
}

/// The language of a program, if a line of it tells.
fn recognised(text: &str) -> Option<&'static str> {
    reading::recognise(text).map(|dialect| dialect.language)
}

/// The profile of a plan or program, and the part it was made for.
pub(crate) fn part(
    path: Option<&Path>,
    units: Option<beadwright::model::Units>,
    profile: &Profile,
    task: &Task,
) -> anyhow::Result<Option<Import>> {
    let place = |path: &Path| {
        let mut model = model::Model::of(path);
        model.placing.units = units;
        model.placed(profile.bead.width, task)
    };
    path.map(place).transpose()
}
