//! What the program remembers of a person: language, theme, recent files. And the project, in case of a crash.

use crate::project::Project;
use crate::text::Language;
use beadwright::files::{FolderError, write_file};
use serde::{Deserialize, Serialize};
use std::fs::File;
use std::path::{Path, PathBuf};

/// Recent files that are remembered.
const RECENT: usize = 10;

/// What is remembered between two runs.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Settings {
    /// Language of the window.
    pub language: Language,
    /// Whether the window is light; dark otherwise.
    pub light: bool,
    /// Files that were opened, the newest first.
    pub recent: Vec<PathBuf>,
}

impl Settings {
    /// Puts a file first among the recent ones.
    pub fn remember(&mut self, path: &Path) {
        self.recent.retain(|known| known != path);
        self.recent.insert(0, path.to_owned());
        self.recent.truncate(RECENT);
    }
}

/// The folder that holds them; none for a run that leaves no trace. Windows that are open at a time share the settings, and
/// each keeps its own project: whoever holds the lock of a place has the project there.
#[derive(Debug, Default)]
pub struct Store {
    folder: Option<PathBuf>,
    /// Number of the place for the project.
    place: usize,
    /// Open and locked for as long as this run lasts, however it ends.
    _lock: Option<File>,
}

/// No more windows keep their projects at a time.
const PLACES: usize = 16;

impl Store {
    /// The place where this system keeps such things.
    pub fn of_user() -> Self {
        dirs::data_dir().map_or_else(Self::default, |folder| Self::at(folder.join("beadwright-studio")))
    }

    /// In a folder of choice.
    pub fn at(folder: PathBuf) -> Self {
        let lock = |place: &usize| {
            let file = File::create(folder.join(format!("autosave-{place}.lock"))).ok()?;
            file.try_lock().ok().map(|()| (*place, file))
        };
        let left = |place: &usize| folder.join(format!("autosave-{place}.bwp")).is_file();
        // A folder that cannot be made is told of when something is to be kept there.
        let _ = std::fs::create_dir_all(&folder);
        // First where a run that did not end well has left something.
        let (with, without): (Vec<usize>, Vec<usize>) = (0..PLACES).partition(left);
        let found = with.iter().chain(&without).find_map(lock);
        let (place, lock) = found.map_or((0, None), |(place, lock)| (place, Some(lock)));
        Self { folder: Some(folder), place, _lock: lock }
    }

    /// The settings; those of a new user where there are none, or where they cannot be read.
    pub fn settings(&self) -> Settings {
        let text = self.file("settings.toml").and_then(|path| std::fs::read_to_string(path).ok());
        text.and_then(|text| toml::from_str(&text).ok()).unwrap_or_default()
    }

    /// Keeps the settings. What cannot be kept is lost in silence: no work is.
    pub fn keep_settings(&self, settings: &Settings) {
        if let Ok(text) = toml::to_string_pretty(settings) {
            let _ = self.keep("settings.toml", &text);
        }
    }

    /// Keeps the project, so that it comes back after a crash.
    ///
    /// # Errors
    /// A sentence for the window.
    pub fn keep_project(&self, project: &Project) -> Result<(), String> {
        let text = project.write(None)?;
        self.keep(&self.project_file(), &text).map_err(|error| format!("The project cannot be kept aside: {error}."))
    }

    /// The project of a run that did not end well.
    pub fn lost_project(&self) -> Option<Project> {
        let text = std::fs::read_to_string(self.file(&self.project_file())?).ok()?;
        Project::read(&text, None).ok().filter(|project| project.source.is_some())
    }

    /// The run ends well: nothing is to be brought back.
    pub fn forget_project(&self) {
        if let Some(path) = self.file(&self.project_file()) {
            let _ = std::fs::remove_file(path);
        }
    }

    fn project_file(&self) -> String {
        format!("autosave-{}.bwp", self.place)
    }

    fn file(&self, name: &str) -> Option<PathBuf> {
        self.folder.as_ref().map(|folder| folder.join(name))
    }

    fn keep(&self, name: &str, text: &str) -> Result<(), FolderError> {
        let (Some(folder), Some(path)) = (&self.folder, self.file(name)) else { return Ok(()) };
        // A folder that cannot be made is told of with the file.
        let _ = std::fs::create_dir_all(folder);
        write_file(&path, text.as_bytes())
    }
}
