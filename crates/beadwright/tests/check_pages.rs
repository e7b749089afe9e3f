//! The page of all checks and warnings, `docs/book/checks.md`, is made from the code, so none is missing.
//! `BEADWRIGHT_GOLDEN=write cargo test -p beadwright --test check_pages` writes it anew.
#![allow(clippy::unwrap_used)]

use beadwright::check::CHECKS;
use beadwright::warning::WarningKind;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

fn page() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/book/checks.md")
}

/// What stands between the two marks of a part of the page.
fn marks(part: &str) -> (String, String) {
    (format!("<!-- {part}: written by tests/check_pages.rs -->\n\n"), format!("<!-- end of {part} -->\n"))
}

/// A sentence of parts of sentences.
fn sentence(part: &str) -> String {
    let mut letters = part.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect::<String>() + ".")
}

fn checks() -> String {
    let check = |check: &beadwright::check::Check| {
        format!(
            "### {}\n\nLooks for {}.\n\n- **Why**: {}.\n- **Reads like**: {}\n- **Remedy**: {}\n\n",
            check.name,
            check.what,
            check.why,
            check.example,
            sentence(check.remedy)
        )
    };
    CHECKS.iter().map(check).collect()
}

fn warnings() -> String {
    let row = |kind: WarningKind| {
        let about = kind.about();
        let stops = if kind.forbids() { " **(no program)**" } else { "" };
        format!("| `{}`{stops} | {} | {} |\n", about.name, sentence(about.cause), sentence(about.remedy))
    };
    let rows: String = WarningKind::ALL.into_iter().map(row).collect();
    format!("| warning | cause | remedy |\n| --- | --- | --- |\n{rows}\n")
}

#[test]
fn the_page_tells_every_check_and_warning() {
    let text = std::fs::read_to_string(page()).unwrap();
    let mut now = text.clone();
    for (part, made) in [("checks", checks()), ("warnings", warnings())] {
        let (begin, end) = marks(part);
        let (head, rest) = now.split_once(&begin).unwrap();
        let (_, tail) = rest.split_once(&end).unwrap();
        now = format!("{head}{begin}{made}{end}{tail}");
    }
    if std::env::var("BEADWRIGHT_GOLDEN").is_ok_and(|v| v == "write") {
        std::fs::write(page(), &now).unwrap();
    } else {
        assert!(now == text, "docs/book/checks.md is stale. BEADWRIGHT_GOLDEN=write writes it anew.");
    }
}

/// The kinds of the list are those of the source, with the names that `metrics.json` has.
#[test]
fn no_kind_of_warning_is_missing() {
    let source = include_str!("../src/warning.rs");
    let variants = source.split_once("pub enum WarningKind {\n").unwrap().1.split_once("\n}").unwrap().0;
    let variants: BTreeSet<String> = variants
        .lines()
        .map(str::trim)
        .filter(|line| !line.starts_with("//"))
        .map(|line| line.trim_end_matches(',').to_owned())
        .collect();
    let listed: BTreeSet<String> = WarningKind::ALL.iter().map(|kind| format!("{kind:?}")).collect();
    assert_eq!(listed, variants);
    for kind in WarningKind::ALL {
        assert_eq!(serde_json::json!(kind), kind.about().name);
    }
}
