//! Data goes down the table of the design only: a module uses none that is below it, and no two use each other.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// Modules of the crates below the command, from the top of the table to its bottom; those in one row do not know each other.
/// Between crates Cargo keeps the arrows: `planar`, `part`, `plan`, `program`, `robot`, `distort`, `record`, `listen`,
/// `beadwright`, `papers`.
const CRATES: &[(&str, &[&[&str]])] = &[
    (
        "part",
        &[
            &["finding", "task", "text"],
            &["warning"],
            // Pure geometry; a file of curves is read by the model.
            &["curve"],
            &["model"],
            &["chart"],
            &["cladding", "deviation", "example", "slice"],
            &["middle_line"],
            &["damage", "directions"],
        ],
    ),
    (
        "plan",
        &[
            &["limit", "random"],
            &["bead", "motion", "process"],
            &["pass"],
            &["layer"],
            &["trial", "wedge"],
            &["deposit"],
            &["fill"],
            &["preform"],
            &["order"],
            &["weld"],
            &["heat"],
        ],
    ),
    // A dialect writes and reads programs without knowing who planned them.
    ("program", &[&["number", "template"], &["program"], &["dialect"]]),
    (
        "robot",
        &[
            &["arm", "calibrate"],
            &["body", "chain", "opw", "track"],
            &["arm_table", "finding", "home", "metal", "turn"],
            &["urdf"],
            &["error"],
            &["arm_keys"],
            &["cell"],
            &["room", "suggest"],
            &["linear_axis", "table", "walk"],
            &["external", "trajectory"],
        ],
    ),
    (
        "distort",
        &[
            &["element", "envelope", "grid", "real", "rigid"],
            &["error", "mesh", "vector"],
            &["eccentricity", "input", "level"],
            &["multigrid"],
            &["system"],
            &["body"],
            &["settings"],
            &["metal"],
            &["figures", "zone"],
            &["bending", "build", "surface"],
        ],
    ),
    (
        "record",
        &[
            &["chain", "error", "quantity", "time"],
            &["planned", "settings", "source"],
            &["arc"],
            &["sequence"],
            &["clock"],
            &["aligned"],
            &["welded"],
            &["figures", "finding"],
            &["record"],
            &["height", "judge"],
            &["join"],
        ],
    ),
    ("listen", &[&["error", "watch"], &["source"], &["log", "payload"], &["hearing"], &["mqtt", "opcua"]]),
    (
        "beadwright",
        &[
            // The profile holds the settings of all stages of the crates below, which can be used without it.
            &["palette", "profile"],
            &["metrics"],
            &["plan"],
            &["plan_file", "check"],
            &["report"],
            &["as_built", "directions", "distortion", "export", "files", "simulate"],
            &["adapt"],
            &["build", "record", "trial"],
            &["compare"],
            &["read_back"],
        ],
    ),
    ("papers", &[&["goal"], &["a_skeleton_hybrid", "b_fdm_order", "c_compound", "d_thin_wall"]]),
];

#[test]
fn no_arrow_runs_up() {
    for (name, rows) in CRATES {
        let rank: BTreeMap<&str, usize> =
            rows.iter().enumerate().flat_map(|(i, row)| row.iter().map(move |name| (*name, i))).collect();
        let used = used_modules(name);
        let known: BTreeSet<&str> = rank.keys().copied().collect();
        let found = used.keys().map(String::as_str).collect::<BTreeSet<_>>();
        assert_eq!(found, known, "every module of {name} is in one row");
        for (module, others) in &used {
            for other in others {
                assert!(rank[other.as_str()] < rank[module.as_str()], "{name}: {module} uses {other}");
            }
        }
    }
}

#[test]
fn no_modules_use_each_other_in_a_circle() {
    let others = ["planar", "beadwright-cli", "beadwright-py", "beadwright-studio"];
    for name in CRATES.iter().map(|(name, _)| *name).chain(others) {
        let mut left = used_modules(name);
        assert!(left.len() > 2, "{name} has modules");
        // Takes away what uses nothing that is left, until nothing is left.
        while !left.is_empty() {
            let names: BTreeSet<String> = left.keys().cloned().collect();
            left.retain(|_, others| !others.is_disjoint(&names));
            assert!(left.len() < names.len(), "a circle in {name}: {left:?}");
        }
    }
}

/// A profile becomes settings once; only what is called from outside takes it, and these files: they make the settings, of
/// bodies too, or write programs that are only looked at.
const SEE_PROFILES: [&str; 3] = ["plan/settings.rs", "plan/bodies.rs", "check/rehearsal.rs"];

#[test]
fn no_stage_below_the_front_door_sees_a_profile() {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut doors = 0;
    for file in ["plan", "check"].into_iter().flat_map(|folder| rust_files(&source.join(folder))) {
        if SEE_PROFILES.iter().any(|other| file.ends_with(other)) {
            continue;
        }
        let text = fs::read_to_string(&file).unwrap();
        let mut signature = "";
        for line in text.lines().filter(|line| !line.trim_start().starts_with("//")) {
            signature = if line.contains("fn ") { line.trim_start() } else { signature };
            let sees = line.contains(": &Profile") || line.contains("&'a Profile");
            assert!(!sees || signature.starts_with("pub fn "), "{}: {signature}", file.display());
            doors += usize::from(sees);
        }
    }
    assert!(doors > 10, "{doors}");
}

/// The modules of a crate, and which of its other modules each one uses.
fn used_modules(name: &str) -> BTreeMap<String, BTreeSet<String>> {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap().join(name).join("src");
    let mut used: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for file in rust_files(&source) {
        let relative = file.strip_prefix(&source).unwrap().with_extension("");
        let mut path: Vec<&str> = relative.iter().map(|part| part.to_str().unwrap()).collect();
        path.pop_if(|last| *last == "mod");
        if matches!(path[..], ["lib" | "main"]) {
            continue;
        }
        let others = used.entry(path[0].to_owned()).or_default();
        others.extend(first_segments(&fs::read_to_string(&file).unwrap(), path.len()));
        others.remove(path[0]);
    }
    let modules: BTreeSet<String> = used.keys().cloned().collect();
    used.values_mut().for_each(|others| others.retain(|other| modules.contains(other)));
    used
}

/// Some libraries are not built a second time for tests in their files: those files are compiled with `tests/it/inside.rs`.
#[test]
fn no_test_lies_in_a_file_where_it_would_never_run() {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let mut without = 0;
    for folder in fs::read_dir(crates).unwrap().map(|entry| entry.unwrap().path()) {
        let manifest = fs::read_to_string(folder.join("Cargo.toml")).unwrap_or_default();
        let library = manifest.split("\n[").find(|section| section.starts_with("lib]"));
        if !library.is_some_and(|section| section.lines().any(|line| line == "test = false")) {
            continue;
        }
        without += 1;
        let inside = fs::read_to_string(folder.join("tests/it/inside.rs")).unwrap_or_default();
        for file in rust_files(&folder.join("src")) {
            let named = file.strip_prefix(&folder).unwrap().display().to_string();
            let tests = fs::read_to_string(&file).unwrap().contains("#[test]");
            assert!(
                !tests || inside.contains(&format!("\"../../{named}\"")),
                "{}: add it to tests/it/inside.rs",
                file.display()
            );
        }
    }
    assert!(without >= 4, "{without}");
}

fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap().map(|e| e.unwrap().path());
    let files = entries.flat_map(|path| if path.is_dir() { rust_files(&path) } else { vec![path] });
    files.filter(|path| path.extension().is_some_and(|e| e == "rs")).collect()
}

/// First segments of the paths that begin at the root of the crate: after `crate::`, and after as many `super::` as lead
/// there from a module so deep. Tests at the end of a file may use anything.
fn first_segments(text: &str, depth: usize) -> Vec<String> {
    let code: Vec<&str> = text.lines().filter(|line| !line.trim_start().starts_with("//")).collect();
    let code = code.join("\n");
    let code = code.split("#[cfg(test)]").next().unwrap();
    let up = "super::".repeat(depth);
    let mut rests: Vec<&str> = code.split("crate::").skip(1).collect();
    let deeper = |before: &str| before.ends_with("super::");
    rests.extend(code.match_indices(&up).filter(|(at, _)| !deeper(&code[..*at])).map(|(at, _)| &code[at + up.len()..]));
    rests.into_iter().flat_map(names).collect()
}

/// The names that a path goes on with: one, or those between its braces.
fn names(rest: &str) -> Vec<String> {
    let word = |text: &str| text.trim().chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect::<String>();
    let Some(list) = rest.strip_prefix('{') else { return vec![word(rest)] };
    let (mut depth, mut begins, mut names) = (1, true, Vec::new());
    for (at, c) in list.char_indices() {
        if begins && !c.is_whitespace() {
            names.push(word(&list[at..]));
            begins = false;
        }
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            ',' if depth == 1 => begins = true,
            _ => {}
        }
        if depth == 0 {
            break;
        }
    }
    names
}
