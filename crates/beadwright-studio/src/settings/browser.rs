//! Settings in the browser's local storage. Projects are not kept there: their models could not be read again.

use super::Settings;
use crate::project::Project;
use web_sys::Storage;

/// The name under which the settings are stored.
const KEY: &str = "beadwright-studio";

/// The local storage of this page's address; nothing is kept if the browser provides none.
#[derive(Debug, Default)]
pub struct Store;

impl Store {
    /// The store of this page.
    pub fn of_user() -> Self {
        Self
    }

    fn storage() -> Option<Storage> {
        web_sys::window()?.local_storage().ok()?
    }

    /// The settings; the defaults if there are none or they cannot be read. Files of earlier visits cannot be opened again.
    pub fn settings(&self) -> Settings {
        let text = Self::storage().and_then(|storage| storage.get_item(KEY).ok()?);
        let settings: Settings = text.and_then(|text| toml::from_str(&text).ok()).unwrap_or_default();
        Settings { recent: Vec::new(), ..settings }
    }

    /// Saves the settings. A failure is ignored, since no work is lost.
    pub fn keep_settings(&self, settings: &Settings) {
        if let (Some(storage), Ok(text)) = (Self::storage(), toml::to_string_pretty(settings)) {
            let _ = storage.set_item(KEY, &text);
        }
    }

    /// Keeps nothing: the browser asks before it leaves a page with unsaved changes.
    ///
    /// # Errors
    /// None.
    pub fn keep_project(&self, _: &Project) -> Result<(), String> {
        Ok(())
    }

    /// None is kept.
    pub fn lost_project(&self) -> Option<Project> {
        None
    }

    /// There is none to forget.
    pub fn forget_project(&self) {}
}
