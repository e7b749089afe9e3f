//! What the terms of the figures mean: a hint on each term, and a list at the end of a page.

use super::escape;
use crate::deposit::{LOW, OUTSIDE, OVERFILL, VOID};

/// A word, and what it means.
fn words() -> [(&'static str, String); 8] {
    let percent = |part: f64| format!("{:.0} %", 100.0 * part);
    [
        (
            "Void",
            format!(
                "A place inside the part, away from its edge, where the metal stays below {} of the bead height.",
                percent(VOID)
            ),
        ),
        (
            "Low",
            format!(
                "Metal from {} to {} of the bead height: more than a void, but not level.",
                percent(VOID),
                percent(LOW)
            ),
        ),
        (
            "Overfill",
            format!("Metal above {} of the bead height, mostly where passes meet or turn.", percent(OVERFILL)),
        ),
        (
            "Outside",
            format!("Metal beyond the outline and its allowance, higher than {} of the bead height.", percent(OUTSIDE)),
        ),
        ("Closeness", "The cause of a peak: one pass runs too close to itself.".to_owned()),
        ("Skeleton", "Passes that fill pockets between contours.".to_owned()),
        ("Travel", "A move without arc, from the end of a pass to the start of the next.".to_owned()),
        ("Stepover", "The distance from one bead to its neighbour, centre to centre.".to_owned()),
    ]
}

/// A word with its meaning as a hint; a word without a meaning as it is. `word` is markup already.
pub(super) fn hinted(word: &str) -> String {
    let known = words().into_iter().find(|(known, _)| known.eq_ignore_ascii_case(word));
    known.map_or(word.to_owned(), |(_, meaning)| format!("<abbr title=\"{}\">{word}</abbr>", escape(&meaning)))
}

/// The heading of a column, such as `void %`: a known word has its meaning as a hint.
pub(super) fn headed(text: &str) -> String {
    let (word, unit) = text.split_at(text.find(' ').unwrap_or(text.len()));
    hinted(&escape(word)) + &escape(unit)
}

/// All words as a list.
pub(super) fn list() -> String {
    let item = |(word, meaning): (&str, String)| {
        format!("<dt>{word}</dt><dd data-word=\"{}\">{}</dd>", word.to_lowercase(), escape(&meaning))
    };
    format!("<dl>\n{}\n</dl>", words().into_iter().map(item).collect::<Vec<_>>().join("\n"))
}
