//! What the program remembers for the user: language, theme, size of the text, recent files, and the project in case of a crash.

#[cfg(target_arch = "wasm32")]
#[path = "settings/browser.rs"]
mod place;
#[cfg(not(target_arch = "wasm32"))]
#[path = "settings/desktop.rs"]
mod place;

pub use place::Store;

use crate::text::Language;
use eframe::egui::Context;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// Number of recent files that are remembered.
const RECENT: usize = 10;

/// The sizes of the text offered in the menu, % of the usual, which is the first.
pub const TEXT_PERCENT: [u32; 4] = [100, 125, 150, 200];

/// The size of the text now, %; keys change it too.
pub fn text_percent(ctx: &Context) -> u32 {
    (100.0 * ctx.zoom_factor()).round() as u32
}

/// What is remembered between two runs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Settings {
    /// Language of the window.
    pub language: Language,
    /// Whether the window is light; dark otherwise.
    pub light: bool,
    /// Size of the text and of all that goes with it, % of the usual.
    pub text_percent: u32,
    /// Whether all parameters are listed, not only the basic ones.
    pub all_parameters: bool,
    /// Files that were opened, the newest first.
    pub recent: Vec<PathBuf>,
}

impl Default for Settings {
    fn default() -> Self {
        let (language, recent) = (Language::default(), Vec::new());
        Self { language, light: false, text_percent: TEXT_PERCENT[0], all_parameters: false, recent }
    }
}

impl Settings {
    /// Puts a file first among the recent ones.
    pub fn remember(&mut self, path: &Path) {
        self.recent.retain(|known| known != path);
        self.recent.insert(0, path.to_owned());
        self.recent.truncate(RECENT);
    }
}
