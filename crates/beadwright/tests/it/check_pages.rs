//! The page of all checks and warnings, `docs/book/checks.md`, is made from the code, so none is missing.
//! `BEADWRIGHT_GOLDEN=write cargo test -p beadwright --test it check_pages::` writes it anew.

use crate::common;

use beadwright::check::CHECKS;
use beadwright::dialect::reading::{FAULTS, FaultKind};
use beadwright::warning::WarningKind;
use std::collections::BTreeSet;

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

fn faults() -> String {
    let row = |fault: &&FaultKind| {
        let [what, why, remedy] = [fault.what, fault.why, fault.remedy].map(|text| sentence(text).replace('|', "\\|"));
        format!("| `{}` | {what} | {why} | {remedy} |\n", fault.name)
    };
    let rows: String = FAULTS.iter().map(row).collect();
    format!("| check | looks for | why | remedy |\n| --- | --- | --- | --- |\n{rows}\n")
}

#[test]
fn the_page_names_every_check_and_warning() {
    for (part, made) in [("checks", checks()), ("checks of programs", faults()), ("warnings", warnings())] {
        common::page_shows("book/checks.md", part, &made);
    }
}

/// The kinds of the list are those of the source, with the names that `metrics.json` has.
#[test]
fn no_kind_of_warning_is_missing() {
    let source = include_str!("../../../part/src/warning.rs");
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
