//! Every word of the window, in English and Chinese, from one table (`texts.toml`).

use serde::{Deserialize, Serialize};
use std::collections::HashMap;
use std::sync::OnceLock;

/// A language of the window. Messages of the library are English; [`crate::chinese`] says findings in Chinese, errors and notes stay.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum Language {
    /// English.
    #[default]
    #[serde(rename = "en")]
    English,
    /// Chinese.
    #[serde(rename = "zh")]
    Chinese,
}

impl Language {
    /// All languages, each with its own name for itself.
    pub const ALL: [(Self, &'static str); 2] = [(Self::English, "English"), (Self::Chinese, "中文")];

    /// The text of a key; the key itself if it is missing from the table (a test makes sure that none is).
    pub fn text(self, key: &'static str) -> &'static str {
        self.find(key).unwrap_or(key)
    }

    /// The text of a key composed of a kind and a word, such as `name` and `raster_angle`; if the table
    /// lacks it, the word itself with blanks.
    pub fn word(self, kind: &str, word: &str) -> String {
        let found = self.find(&format!("{kind} {word}"));
        found.map_or_else(|| word.replace(['_', '.'], " "), str::to_owned)
    }

    /// The text of a key, if the table has it.
    pub fn find(self, key: &str) -> Option<&'static str> {
        table().get(key).map(|texts| texts[self as usize].as_str())
    }
}

/// The table: key, English, Chinese.
pub fn table() -> &'static HashMap<String, [String; 2]> {
    static TABLE: OnceLock<HashMap<String, [String; 2]>> = OnceLock::new();
    TABLE.get_or_init(|| toml::from_str(include_str!("texts.toml")).unwrap_or_default())
}
