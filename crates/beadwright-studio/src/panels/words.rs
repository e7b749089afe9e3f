//! What the words of the figures mean: a hint on each, with the page of the book that says more.

use crate::known::Known;
use eframe::egui::Response;

/// Words with a special meaning here.
const WORDS: [&str; 4] = ["void", "low", "overfill", "outside"];

/// The page on figures and findings.
const PAGE: &str = concat!(env!("CARGO_PKG_REPOSITORY"), "/blob/main/docs/book/checks.md");

/// Explains what an English text names: the row of that name, or each of its words.
pub(super) fn explained(known: Known<'_>, response: Response, text: &str) -> Response {
    let hints = hints(known, text);
    if hints.is_empty() {
        return response;
    }
    let more = known.t("more-in-book");
    response.on_hover_ui(|ui| {
        ui.set_max_width(360.0);
        hints.iter().for_each(|hint| drop(ui.label(*hint)));
        ui.hyperlink_to(more, PAGE);
    })
}

fn hints(known: Known<'_>, text: &str) -> Vec<&'static str> {
    let hint = |word: &str| known.language().find(&format!("hint {word}"));
    if let Some(whole) = hint(text) {
        return vec![whole];
    }
    let lower = text.to_lowercase();
    let named = |word: &str| lower.split(|letter: char| !letter.is_alphabetic()).any(|part| part == word);
    WORDS.into_iter().filter(|word| named(word)).filter_map(hint).collect()
}
