//! The basic parameters, and all of them.

use crate::window::{Window, click, example, search, sees, type_number, wait};
use beadwright::profile::Profile;
use beadwright_studio::form::BASIC;
use beadwright_studio::text::Language;

#[test]
fn ten_parameters_come_first_and_a_switch_shows_all() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = example(folder.path(), "cross");
    for key in BASIC {
        for text in [Language::English.word("basic", key), Language::English.word("why", key)] {
            assert!(sees(&harness, &text), "{text} is not on the screen");
        }
    }
    assert!(!sees(&harness, "Start and stop"));
    click(&mut harness, "all parameters");
    assert!(sees(&harness, "Start and stop") && !sees(&harness, "Layer height"));
    // It is remembered.
    drop(harness);
    let mut harness = example(folder.path(), "cross");
    assert!(sees(&harness, "Start and stop"));
    click(&mut harness, "all parameters");
    assert!(!sees(&harness, "Start and stop") && sees(&harness, "Layer height"));
}

#[test]
fn a_basic_parameter_is_that_of_the_profile() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = example(folder.path(), "cross");
    type_number(&mut harness, "Layer height", "2.5");
    wait(&mut harness);
    assert_eq!(Profile::parse(&harness.state().project().profile).unwrap().layers.height, 2.5);
    assert_eq!(harness.state().plan().layers.len(), 8);
    // An impossible value is refused at its field.
    type_number(&mut harness, "Layer height", "-1");
    assert_eq!(harness.state().plan().layers.len(), 8);
    assert!(harness_says(&harness, "This value is not allowed:"));
}

fn harness_says(harness: &Window, words: &str) -> bool {
    use egui_kittest::kittest::Queryable;
    harness.query_all_by_label_contains(words).next().is_some()
}

#[test]
fn a_search_looks_at_all_parameters() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = example(folder.path(), "cross");
    search(&mut harness, "gas flow");
    assert!(sees(&harness, "gas flow") && !sees(&harness, "Layer height"));
}
