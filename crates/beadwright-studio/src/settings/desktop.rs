//! Settings and the project as files in a folder.

use super::Settings;
use crate::project::Project;
use beadwright::files::{FolderError, write_file};
use std::fs::File;
use std::path::PathBuf;

/// The folder that holds them; `None` for a run that leaves no trace. Windows open at the same time share the settings,
/// but each autosaves its own project: the window that holds the lock of a slot owns the project there.
#[derive(Debug, Default)]
pub struct Store {
    folder: Option<PathBuf>,
    /// Number of the slot in which the project is autosaved.
    place: usize,
    /// Open and locked for as long as this run lasts, however it ends.
    _lock: Option<File>,
}

/// Maximum number of windows that can autosave their projects at the same time.
const PLACES: usize = 16;

impl Store {
    /// The store in this system's folder for application data.
    pub fn of_user() -> Self {
        dirs::data_dir().map_or_else(Self::default, |folder| Self::at(folder.join("beadwright-studio")))
    }

    /// A store in the given folder.
    pub fn at(folder: PathBuf) -> Self {
        let lock = |place: &usize| {
            let file = File::create(folder.join(format!("autosave-{place}.lock"))).ok()?;
            file.try_lock().ok().map(|()| (*place, file))
        };
        let left = |place: &usize| folder.join(format!("autosave-{place}.bwp")).is_file();
        // A folder that cannot be created is reported later, when something is to be saved there.
        let _ = std::fs::create_dir_all(&folder);
        // First choice: a slot in which a crashed run has left its project.
        let (with, without): (Vec<usize>, Vec<usize>) = (0..PLACES).partition(left);
        let found = with.iter().chain(&without).find_map(lock);
        let (place, lock) = found.map_or((0, None), |(place, lock)| (place, Some(lock)));
        Self { folder: Some(folder), place, _lock: lock }
    }

    /// The settings; the defaults if there are none or they cannot be read.
    pub fn settings(&self) -> Settings {
        let text = self.file("settings.toml").and_then(|path| std::fs::read_to_string(path).ok());
        text.and_then(|text| toml::from_str(&text).ok()).unwrap_or_default()
    }

    /// Saves the settings. A failure is ignored, since no work is lost.
    pub fn keep_settings(&self, settings: &Settings) {
        if let Ok(text) = toml::to_string_pretty(settings) {
            let _ = self.keep("settings.toml", &text);
        }
    }

    /// Autosaves the project, so that it can be restored after a crash.
    ///
    /// # Errors
    /// A sentence for the window.
    pub fn keep_project(&self, project: &Project) -> Result<(), String> {
        let text = project.write(None)?;
        self.keep(&self.project_file(), &text).map_err(|error| format!("The project cannot be autosaved: {error}."))
    }

    /// The project of a run that crashed.
    pub fn lost_project(&self) -> Option<Project> {
        let text = std::fs::read_to_string(self.file(&self.project_file())?).ok()?;
        Project::read(&text, None).ok().filter(|project| project.source.is_some())
    }

    /// The run ends normally: there is nothing to restore.
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
        // A folder that cannot be created is reported with the file below.
        let _ = std::fs::create_dir_all(folder);
        write_file(&path, text.as_bytes())
    }
}
