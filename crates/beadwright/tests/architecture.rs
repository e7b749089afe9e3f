//! Data goes down the table of the design only: a module uses none that stands below it.
#![allow(clippy::unwrap_used)]

use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};

/// Modules from the top of the table to its bottom; those in one row do not know each other.
const ROWS: &[&[&str]] = &[
    &["task", "number", "template", "warning"],
    // Pure geometry; a file of curves is read by the model.
    &["curve"],
    &["model"],
    &["slice"],
    &["bead", "motion"],
    &["fill", "pass"],
    &["order"],
    // Reads text; the deposit model judges what it finds.
    &["readback"],
    &["deposit"],
    // A profile holds the settings of all stages above; its limits know the names of posts.
    &["profile"],
    &["weld"],
    &["metrics", "plan"],
    &["plan_file", "program"],
    &["check", "post"],
    &["report"],
    // Walks a program with an arm, and shows it.
    &["robot"],
    &["simulate"],
    &["example"],
    &["compare"],
    &["reproduce"],
];

/// Arrows that run within a row or up, on purpose.
const ALLOWED: &[(&str, &str, &str)] = &[
    ("fill", "pass", "a centre-line tells its width as a pass does"),
    ("pass", "fill", "a pass tells what it is for"),
    ("fill", "deposit", "beads are moved to where the deposit model would see a void"),
    ("metrics", "plan", "totals are taken from planned layers"),
    ("plan", "metrics", "a plan carries its totals"),
    ("profile", "post", "a profile names only posts that exist"),
];

#[test]
fn no_arrow_runs_up() {
    let rank: HashMap<&str, usize> =
        ROWS.iter().enumerate().flat_map(|(i, row)| row.iter().map(move |name| (*name, i))).collect();
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut wrong = Vec::new();
    for file in rust_files(&source) {
        let relative = file.strip_prefix(&source).unwrap();
        let module = relative.components().next().unwrap().as_os_str().to_str().unwrap().trim_end_matches(".rs");
        if module == "lib" {
            continue;
        }
        let own = *rank.get(module).unwrap_or_else(|| panic!("{module} stands in no row"));
        for used in used_modules(&fs::read_to_string(&file).unwrap()) {
            let Some(&other) = rank.get(used.as_str()) else { continue };
            let allowed = ALLOWED.iter().any(|(a, b, _)| *a == module && *b == used);
            if used != module && other >= own && !allowed {
                wrong.push(format!("{} uses crate::{used}", relative.display()));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap().map(|e| e.unwrap().path());
    let files = entries.flat_map(|path| if path.is_dir() { rust_files(&path) } else { vec![path] });
    files.filter(|path| path.extension().is_some_and(|e| e == "rs")).collect()
}

/// First segments after `crate::`, in `use` lines and in paths.
fn used_modules(text: &str) -> Vec<String> {
    let code = text.lines().filter(|line| !line.trim_start().starts_with("//"));
    let uses = code.flat_map(|line| line.split("crate::").skip(1).map(str::to_owned).collect::<Vec<_>>());
    uses.map(|rest| rest.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect()).collect()
}
