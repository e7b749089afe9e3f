//! Findings in Chinese: their names, why they matter, what to do and what they say, from one table (`findings.toml`). The library
//! says all of it in English.

use serde::Deserialize;
use std::collections::HashMap;
use std::sync::OnceLock;

/// A kind of findings in Chinese.
#[derive(Debug, Deserialize)]
pub struct Chinese {
    /// Its name.
    pub name: String,
    /// Why it matters.
    pub why: String,
    /// What to do.
    pub remedy: String,
    /// Its sentences, in English and in Chinese.
    says: Vec<[String; 2]>,
}

/// A kind of findings by its English name; `None` if the table lacks it.
pub fn of(kind: &str) -> Option<&'static Chinese> {
    table().get(kind)
}

/// The kinds by their English names.
pub fn table() -> &'static HashMap<String, Chinese> {
    static TABLE: OnceLock<HashMap<String, Chinese>> = OnceLock::new();
    TABLE.get_or_init(|| toml::from_str(include_str!("findings.toml")).unwrap_or_default())
}

impl Chinese {
    /// A sentence of the library in Chinese, with the place that stands before it; `None` if the table lacks it.
    pub fn say(&self, text: &str) -> Option<String> {
        let placed =
            text.split_once(": ").filter(|(place, _)| place.starts_with("layer") || place.starts_with("Layer"));
        let (place, text) = placed.map_or((None, text), |(place, text)| (Some(place), text));
        let said = self.says.iter().find_map(|[english, chinese]| Some(filled(chinese, &parts(english, text)?)))?;
        Some(place.map_or(said.clone(), |place| format!("{}：{said}", place_in_chinese(place))))
    }
}

/// What stands at each `{}` of a pattern in a text that it fits; what stands at a `*` is left out.
fn parts<'a>(pattern: &str, text: &'a str) -> Option<Vec<&'a str>> {
    let (mut found, mut rest, mut pattern) = (Vec::new(), text, pattern);
    loop {
        let Some(at) = pattern.find(['{', '*']) else { return (rest == pattern).then_some(found) };
        rest = rest.strip_prefix(&pattern[..at])?;
        let kept = pattern[at..].starts_with('{');
        pattern = &pattern[at + if kept { "{}".len() } else { "*".len() }..];
        // Up to what follows next; at the end of the pattern, to what ends the text.
        let end = match pattern.find(['{', '*']) {
            Some(next) => rest.find(&pattern[..next])?,
            None => rest.strip_suffix(pattern)?.len(),
        };
        if kept {
            found.push(&rest[..end]);
        }
        rest = &rest[end..];
    }
}

/// A text with its `{}` replaced one after another.
fn filled(text: &str, parts: &[&str]) -> String {
    parts.iter().fold(text.to_owned(), |text, part| text.replacen("{}", part, 1))
}

/// Layers, pass and coordinates.
fn place_in_chinese(place: &str) -> String {
    if let Some(layers) = place.strip_prefix("Layers ").or_else(|| place.strip_prefix("Layer ")) {
        return format!("第 {layers} 层");
    }
    let word = |word: &str| match word.split_once(' ') {
        Some(("layer", number)) => format!("第 {number} 层"),
        Some(("pass", number)) => format!("第 {number} 道"),
        _ => word.to_owned(),
    };
    place.split(", ").map(word).collect::<Vec<_>>().join("，")
}
