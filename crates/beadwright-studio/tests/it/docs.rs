//! What `docs/studio.md` says is so: keys, options, the project file, pictures.

use beadwright_studio::actions::ENTRIES;
use beadwright_studio::project::{FIRST_PROFILE, Project, Source};
use beadwright_studio::text::Language;
use eframe::egui::ModifierNames;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs")
}

fn text() -> String {
    std::fs::read_to_string(folder().join("studio.md")).unwrap()
}

/// The text between two marks.
fn between<'a>(text: &'a str, from: &str, to: &str) -> &'a str {
    let rest = text.split_once(from).unwrap_or_else(|| panic!("{from} is missing")).1;
    rest.split_once(to).unwrap_or_else(|| panic!("{to} is missing")).0
}

/// The rows of the table in a section, without its head.
fn rows<'a>(text: &'a str, section: &str) -> Vec<&'a str> {
    let section = between(text, &format!("\n## {section}\n"), "\n## ");
    section.lines().filter(|line| line.starts_with('|')).skip(2).collect()
}

#[test]
fn the_keys_are_those_of_the_program() {
    let row = |entry: &beadwright_studio::actions::Entry| {
        let key = entry.key.unwrap().format(&ModifierNames::NAMES, false);
        format!("| {} | `{key}` |", Language::English.text(entry.text))
    };
    let table: Vec<String> = ENTRIES.iter().map(row).collect();
    assert_eq!(rows(&text(), "Keys"), table, "the table should be:\n{}", table.join("\n"));
}

#[test]
fn the_options_are_those_of_the_program() {
    let output = Command::new(env!("CARGO_BIN_EXE_beadwright-studio")).arg("--help").output().unwrap();
    let help = String::from_utf8(output.stdout).unwrap();
    let options = |text: &str| -> BTreeSet<String> {
        let words = text.split(|c: char| !c.is_ascii_alphanumeric() && c != '-');
        words.filter(|word| word.starts_with("--") && word.len() > 3).map(str::to_owned).collect()
    };
    let mut known = options(&help);
    for usual in ["--help", "--version"] {
        assert!(known.remove(usual), "{help}");
    }
    assert_eq!(options(&rows(&text(), "Start").concat()), known);
}

#[test]
fn the_project_file_is_read() {
    let text = text();
    let file = between(&text, "```toml\n", "```");
    let profile = beadwright::profile::Profile::built_in_text(FIRST_PROFILE).unwrap();
    let file = file.replacen("'''\n'''", &format!("'''\n{profile}'''"), 1);
    let project = Project::read(&file, Some(Path::new("/parts"))).unwrap();
    assert_eq!(project.source, Some(Source::File(PathBuf::from("/parts/bracket.stl"))));
    assert_eq!((project.height, project.profile.as_str()), (Some(50.0), profile));
    // Nothing is left out: what is written has no key that the example lacks.
    let keys = |text: &str| -> BTreeSet<String> {
        let table: toml::Table = toml::from_str(text).unwrap();
        let placement = table["placement"].as_table().unwrap().keys().map(|key| format!("placement.{key}"));
        table.keys().cloned().chain(placement).collect()
    };
    assert_eq!(keys(&project.write(None).unwrap()), keys(&file));
}

/// The picture that a line of the script makes, all of the window or a part of it.
fn made_by(line: &str) -> Option<&str> {
    let (part, rest) = line.split_once("picture ")?;
    rest.split(' ').next().filter(|_| part.is_empty() || part.starts_with("CROP=") || part.starts_with("PRESS="))
}

#[test]
fn the_pictures_are_there_and_made_by_the_script() {
    let text = text();
    let readme = std::fs::read_to_string(folder().join("../README.md")).unwrap();
    let pictures = text.split("](pictures/").skip(1).chain(readme.split("](docs/pictures/").skip(1));
    let shown: BTreeSet<&str> = pictures.map(|rest| rest.split('.').next().unwrap()).collect();
    let script = std::fs::read_to_string(folder().join("pictures.sh")).unwrap();
    let made: BTreeSet<&str> = script.lines().filter_map(|line| made_by(line)).collect();
    assert_eq!(shown, made);
    for name in shown {
        assert!(folder().join("pictures").join(format!("{name}.png")).is_file(), "{name}");
    }
}
