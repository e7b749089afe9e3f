//! What the user works on: a model, its placement and a profile. A project file (`.bwp`, TOML) holds all of it.

use crate::adaptation::Adaptation;
use beadwright::model::Placement;
use beadwright::profile::{Profile, ProfileError};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// The profile that a new project has.
pub const FIRST_PROFILE: &str = "cmt-al2319-kuka";

/// Where the model comes from.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Source {
    /// A file.
    File(PathBuf),
    /// One of the built-in example parts, by name.
    Example(String),
}

impl Source {
    /// The name of the part, for files and headings.
    pub fn part(&self) -> String {
        match self {
            Self::File(path) => path.file_stem().map_or("part".to_owned(), |stem| stem.to_string_lossy().into_owned()),
            Self::Example(name) => name.clone(),
        }
    }

    /// The name shown to the user: a file name, or the name of the example.
    pub fn label(&self) -> String {
        match self {
            Self::File(path) => path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned()),
            Self::Example(name) => name.clone(),
        }
    }
}

/// A model, its placement and its profile.
#[derive(Debug, Clone, PartialEq)]
pub struct Project {
    /// The model; none before the first is opened.
    pub source: Option<Source>,
    /// How the model is placed.
    pub placement: Placement,
    /// Whether what a damaged model holds is used.
    pub accept_damaged: bool,
    /// Whether the preform of the model is planned: the part plus the stock that is milled off afterwards.
    pub preform: bool,
    /// Height of a wall given by curves at a single height, mm.
    pub height: Option<f64>,
    /// The profile, as the TOML text that people edit.
    pub profile: String,
    /// A scan of the unfinished build, which the layers above it follow.
    pub adapted: Option<Adaptation>,
}

impl Default for Project {
    fn default() -> Self {
        let profile = Profile::built_in_text(FIRST_PROFILE).unwrap_or_default().to_owned();
        let placement = Placement::default();
        Self { source: None, placement, accept_damaged: false, preform: false, height: None, profile, adapted: None }
    }
}

/// Why a project file was refused.
#[derive(Debug, thiserror::Error)]
pub enum ProjectError {
    /// Not the text of a project.
    #[error("this is not a Beadwright project: {0}. Open a .bwp file that this program has written.")]
    Text(String),
    /// Written by a later version.
    #[error("the project has version {0}; this program reads version {VERSION}. Use a newer Beadwright.")]
    Version(u32),
    /// It names both kinds of model, or an unknown model.
    #[error("the project names {0}")]
    Model(String),
    /// Its profile is invalid.
    #[error("the project's profile: {0}")]
    Profile(#[from] ProfileError),
}

const VERSION: u32 = 1;

/// The file, key for key.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    version: u32,
    #[serde(skip_serializing_if = "Option::is_none")]
    model: Option<PathBuf>,
    #[serde(skip_serializing_if = "Option::is_none")]
    example: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    height: Option<f64>,
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    accept_damaged: bool,
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    preform: bool,
    profile: String,
    #[serde(default)]
    placement: Placement,
    #[serde(skip_serializing_if = "Option::is_none")]
    adapted: Option<Adaptation>,
}

impl Project {
    /// The text of the project file. A model in `folder` or below it is named by its relative path, so that the folder
    /// can be moved.
    ///
    /// # Errors
    /// The error of the TOML writer, as a sentence.
    pub fn write(&self, folder: Option<&Path>) -> Result<String, String> {
        let relative = |path: &PathBuf| folder.and_then(|f| path.strip_prefix(f).ok()).unwrap_or(path).to_owned();
        let (model, example) = match &self.source {
            Some(Source::File(path)) => (Some(relative(path)), None),
            Some(Source::Example(name)) => (None, Some(name.clone())),
            None => (None, None),
        };
        let Self { placement, accept_damaged, preform, height, profile, adapted, .. } = self.clone();
        let adapted = adapted.map(|adapted| Adaptation { scan: relative(&adapted.scan), ..adapted });
        let version = VERSION;
        let file = File { version, model, example, height, accept_damaged, preform, profile, placement, adapted };
        toml::to_string_pretty(&file).map_err(|error| format!("the project cannot be written: {error}"))
    }

    /// Reads the text of a project file in `folder`.
    ///
    /// # Errors
    /// [`ProjectError`].
    pub fn read(text: &str, folder: Option<&Path>) -> Result<Self, ProjectError> {
        let file: File = toml::from_str(text).map_err(|error| ProjectError::Text(error.message().to_owned()))?;
        if file.version != VERSION {
            return Err(ProjectError::Version(file.version));
        }
        Profile::parse(&file.profile)?;
        if let Some(fault) = file.adapted.as_ref().and_then(Adaptation::fault) {
            return Err(ProjectError::Text(fault));
        }
        let absolute = |path: PathBuf| folder.map_or(path.clone(), |folder| folder.join(&path));
        let source = match (file.model, file.example) {
            (Some(_), Some(_)) => return Err(ProjectError::Model("both a model and an example.".to_owned())),
            (Some(path), None) => Some(Source::File(absolute(path))),
            (None, Some(name)) if beadwright::example::find(&name).is_none() => {
                return Err(ProjectError::Model(format!("the example \"{name}\", which does not exist.")));
            }
            (None, Some(name)) => Some(Source::Example(name)),
            (None, None) => None,
        };
        let File { placement, accept_damaged, preform, height, profile, adapted, .. } = file;
        let adapted = adapted.map(|adapted| Adaptation { scan: absolute(adapted.scan.clone()), ..adapted });
        Ok(Self { source, placement, accept_damaged, preform, height, profile, adapted })
    }

    /// The name of the part.
    pub fn part(&self) -> String {
        self.source.as_ref().map_or_else(|| "part".to_owned(), Source::part)
    }
}
