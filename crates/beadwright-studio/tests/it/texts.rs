//! Words: both languages whole, none without use, none missing.

use beadwright::Finding;
use beadwright::check::CHECKS;
use beadwright::warning::{Warning, WarningKind, Warnings};
use beadwright_studio::chinese;
use beadwright_studio::text::{Language, table};
use glam::DVec2;
use std::fs;
use std::path::Path;

fn sources(folder: &Path) -> String {
    let entries = fs::read_dir(folder).unwrap().map(|e| e.unwrap().path());
    let text = |path: std::path::PathBuf| match path.extension() {
        _ if path.is_dir() => sources(&path),
        Some(extension) if extension == "rs" => fs::read_to_string(path).unwrap(),
        _ => String::new(),
    };
    entries.map(text).collect()
}

#[test]
fn every_text_is_there_in_both_languages() {
    assert!(table().len() > 100, "the table is not read");
    for (key, texts) in table() {
        assert!(texts.iter().all(|text| !text.trim().is_empty()), "{key}");
    }
    // Words of a kind are the same; sentences must not be.
    let alike = table().iter().filter(|(_, [en, zh])| en == zh).count();
    assert_eq!(alike, 0);
}

#[test]
fn every_key_is_used_and_every_used_key_is_there() {
    let code = sources(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"));
    let plain = |key: &&String| {
        ["total ", "section ", "name ", "kind ", "hint ", "fdm ", "basic ", "why "]
            .iter()
            .all(|kind| !key.starts_with(kind))
    };
    for key in table().keys().filter(plain) {
        assert!(code.contains(&format!("\"{key}\"")), "{key} is used nowhere");
    }
    for part in code.split(".t(\"").skip(1).chain(code.split(".text(\"").skip(1)) {
        let key = part.split('"').next().unwrap();
        assert!(Language::English.find(key).is_some(), "{key} is in no table");
    }
    for entry in &beadwright_studio::actions::ENTRIES {
        assert!(Language::English.find(entry.text).is_some(), "{}", entry.text);
    }
}

#[test]
fn every_key_of_the_profile_has_a_name_in_both_languages() {
    for section in beadwright_studio::form::sections() {
        let key = format!("section {}", section.key);
        assert!(section.key.is_empty() || Language::Chinese.find(&key).is_some(), "{key}");
        for field in &section.fields {
            let key = format!("name {}", field.name);
            assert!(Language::Chinese.find(&key).is_some(), "{key}");
        }
    }
}

#[test]
fn every_basic_parameter_is_one_of_the_profile_and_says_why() {
    for key in beadwright_studio::form::BASIC {
        assert!(beadwright_studio::form::field(key).is_some(), "{key} is no key of a profile");
        for text in [format!("basic {key}"), format!("why {key}")] {
            assert!(Language::Chinese.find(&text).is_some(), "{text} is in no table");
        }
    }
}

/// Words that stay English: keys of profiles, units, coordinates, commands.
fn is_plain(word: &str) -> bool {
    const KEPT: [&str; 12] =
        ["mm", "cm", "mm²", "x", "y", "z", "s", "J", "beadwright", "adapt", "deposition_speed", "at"];
    let key = word.contains(['.', '_', '=', '°', '/']);
    key || KEPT.contains(&word) || !word.contains(|c: char| c.is_ascii_alphabetic())
}

#[test]
fn every_finding_has_words_in_chinese() {
    let mut kinds: Vec<&str> = CHECKS.iter().map(|check| check.name).collect();
    kinds.extend(WarningKind::ALL.map(|kind| kind.about().name));
    kinds.push("lost-geometry");
    for kind in &kinds {
        let words = chinese::of(kind).unwrap_or_else(|| panic!("{kind} has no words"));
        assert!(
            [&words.name, &words.why, &words.remedy].iter().all(|text| text.chars().any(|c| c > '\u{3000}')),
            "{kind}"
        );
    }
    assert!(chinese::table().keys().all(|key| kinds.contains(&&**key)), "a kind of findings is not one of the library");
    let mut sentences: Vec<(&str, String)> =
        CHECKS.iter().map(|check| (check.name, check.example.to_owned())).collect();
    for kind in WarningKind::ALL {
        for count in [1, 3] {
            let mut warnings = Warnings::default();
            (0..count).for_each(|i| {
                warnings.add(Warning { kind, layer: 2 * i, place: DVec2::new(1.5, -2.0), size: 12.25 }, 4.5)
            });
            sentences.extend(warnings.summaries().map(|summary| (kind.about().name, Finding::from(summary).text)));
        }
    }
    for (kind, sentence) in sentences {
        let said = chinese::of(kind).unwrap().say(&sentence).unwrap_or_else(|| panic!("{kind}: {sentence}"));
        let numbers = |text: &str| text.chars().filter(char::is_ascii_digit).count();
        assert_eq!(numbers(&said), numbers(&sentence), "{said} of {sentence}");
        let breaks = |c: char| c.is_whitespace() || (c > '\u{3000}') || "(),:".contains(c);
        let english: Vec<&str> = said.split(breaks).filter(|word| !is_plain(word)).collect();
        assert!(english.is_empty(), "{english:?} in {said}");
    }
    assert_eq!(chinese::of("void").unwrap().say("Layer 3: something else."), None);
}

#[test]
fn no_key_of_the_keyboard_has_two_meanings() {
    let keys: Vec<_> = beadwright_studio::actions::ENTRIES.iter().filter_map(|entry| entry.key).collect();
    for (i, key) in keys.iter().enumerate() {
        assert!(!keys[..i].contains(key), "{key:?}");
    }
}
