//! Words: both languages whole, none without use, none missing.

use beadwright_studio::text::{Language, table};
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

#[test]
fn no_key_of_the_keyboard_has_two_meanings() {
    let keys: Vec<_> = beadwright_studio::actions::ENTRIES.iter().filter_map(|entry| entry.key).collect();
    for (i, key) in keys.iter().enumerate() {
        assert!(!keys[..i].contains(key), "{key:?}");
    }
}
