//! What the program remembers for the user: language, theme, recent files, and the project in case of a crash.

#[cfg(target_arch = "wasm32")]
#[path = "settings/browser.rs"]
mod place;
#[cfg(not(target_arch = "wasm32"))]
#[path = "settings/desktop.rs"]
mod place;

pub use place::Store;

use crate::text::Language;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// Number of recent files that are remembered.
const RECENT: usize = 10;

/// What is remembered between two runs.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct Settings {
    /// Language of the window.
    pub language: Language,
    /// Whether the window is light; dark otherwise.
    pub light: bool,
    /// Whether all parameters are listed, not only the basic ones.
    pub all_parameters: bool,
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
