//! Programs and plans read back: files, their modules, and the part they were made for.

use crate::profile::{self, Wanted};
use crate::{file, model};
use anyhow::Context;
use beadwright::dialect::{self, reading};
use beadwright::export::toolpath;
use beadwright::model::Import;
use beadwright::plan_file::{self, PlanFile};
use beadwright::profile::Profile;
use beadwright::read_back::{self, ReadBack};
use beadwright::task::Task;
use beadwright::text;
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};

/// How a program is read.
#[derive(clap::Args, Clone, Default)]
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

    /// The profile that was asked for; if none was, that of the plan or the one that the program names.
    ///
    /// How the layers of a plan lie in space is always as in the plan.
    pub(crate) fn profile(&self, wanted: &Wanted) -> anyhow::Result<Profile> {
        if let Some(name) = &wanted.profile {
            let mut profile = profile::load(name, &wanted.set)?;
            if let Some(own) = self.plan().and_then(|plan| plan.profile.as_ref()) {
                profile.layers.chart = own.layers.chart.clone();
                profile.layers.bodies.clone_from(&own.layers.bodies);
            }
            return Ok(profile);
        }
        let plan = match &self.content {
            Content::Plan(plan) => plan,
            Content::Program(text) => {
                return profile::load(read_back::named_profile(text).unwrap_or(profile::USUAL), &wanted.set);
            }
        };
        let Some(profile) = &plan.profile else {
            let name = &plan.header.profile;
            anyhow::bail!(
                "{}: this plan does not carry its profile{}, as neither plan.json version 1 nor toolpaths of other \
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
    ) -> anyhow::Result<ReadBack> {
        let Self { path, name, content } = self;
        let text = match content {
            Content::Plan(plan) => return Ok(ReadBack::plan(&name, *plan, profile)),
            Content::Program(text) => text,
        };
        let folder = path.parent().map_or_else(PathBuf::new, Path::to_owned);
        let main =
            Main { folder, extension: path.extension().map(|e| e.to_ascii_lowercase()), dialect: recognised(&text) };
        let mut module = |name: &str| main.module(name);
        let reading = reading.with(wanted.profile.is_some());
        let mesh = part.map(|part| &part.mesh);
        ReadBack::program(&name, &text, &mut module, profile, &reading, mesh, task)
            .with_context(|| format!("{}", path.display()))
    }
}

impl Reading {
    /// For the library; `profile_chosen` says whether a profile was asked for.
    fn with(&self, profile_chosen: bool) -> read_back::Reading {
        let Self { arc_on, arc_off, bead_width } = self.clone();
        read_back::Reading { arc_on, arc_off, bead_width, profile_chosen }
    }
}

/// The main file of a program, whose modules are next to it.
struct Main {
    folder: PathBuf,
    /// Its extension, in lower case.
    extension: Option<OsString>,
    dialect: Option<&'static str>,
}

impl Main {
    /// A module by name, whatever its case and extension. A folder may hold the same part in several languages: a module in
    /// another language than the main file's is not part of it, and the main file's extension comes first.
    fn module(&self, name: &str) -> Option<String> {
        let folder = if self.folder.as_os_str().is_empty() { Path::new(".") } else { &self.folder };
        let fits =
            |path: &PathBuf| path.file_name().is_some_and(|file| dialect::may_be_module(&file.to_string_lossy(), name));
        let mut files: Vec<PathBuf> =
            fs::read_dir(folder).ok()?.filter_map(|e| Some(e.ok()?.path())).filter(fits).collect();
        let other = |path: &Path| path.extension().map(|e| e.to_ascii_lowercase()) != self.extension;
        files.sort_by_cached_key(|path| (other(path), path.clone()));
        let text = |path: PathBuf| text::of(&file::read(&path).ok()?).ok();
        let own = |text: &String| recognised(text).is_none_or(|dialect| self.dialect.is_none_or(|own| own == dialect));
        files.into_iter().filter_map(text).find(own)
    }
}

/// The language of a program, if one of its lines shows it.
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
        model.placed(profile, model::Use::AsDrawn, task)
    };
    path.map(place).transpose()
}
