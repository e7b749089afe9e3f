//! The [palette] as pages read it: properties for styles, a constant for scripts.

use crate::palette::{self, Rgb, hex};
use serde_json::json;

/// What has a colour of its own in styles, with its name there.
fn named(dark: bool) -> Vec<(&'static str, Rgb)> {
    let kinds = palette::KINDS.map(|kind| (kind.name(), palette::kind(kind)));
    let marks = [
        ("start", palette::START),
        ("end", palette::END),
        ("void", palette::VOID),
        ("chosen", palette::CHOSEN),
        ("wait", palette::WAIT),
        ("mark", palette::mark(dark)),
        ("good", palette::good(dark)),
        ("bad", palette::bad(dark)),
    ];
    kinds.into_iter().chain(marks).collect()
}

/// The properties, on bright and on dark pages.
pub(super) fn css() -> String {
    let list =
        |dark| named(dark).iter().map(|(name, colour)| format!(" --{name}: {};", hex(*colour))).collect::<String>();
    let [bright, dark] = [false, true].map(list);
    format!(":root {{{bright} }}\n@media screen and (prefers-color-scheme: dark) {{ :root {{{dark} }} }}\n")
}

/// The constant `INKS`: kinds in the order of their numbers, and maps of values.
pub(super) fn js() -> String {
    let inks = json!({
        "kinds": palette::KINDS.map(|kind| (kind.name(), palette::kind(kind))),
        "void": palette::VOID,
        "rising": palette::RISING,
        "warmth": palette::WARMTH,
        "heights": palette::HEIGHTS,
    });
    format!("const INKS = {inks};\n")
}
