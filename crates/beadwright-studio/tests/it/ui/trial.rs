//! A remedy is tried: what it changes is shown, and it is kept or taken back; steps have names.

use crate::window::{Window, click, example, has_adapter, sees, wait};
use beadwright::profile::{BUILT_IN, Profile};
use beadwright::{Finding, check, finding::Severity};
use beadwright_studio::actions::Action;
use beadwright_studio::remedy::Change;
use beadwright_studio::view::Side;
use beadwright_studio::{form, remedy};
use eframe::egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable;
use std::path::Path;

/// The cross with travels so low that the torch would run into its humps, and the text of what can be tried.
fn humps(store: &Path) -> (Window, String) {
    let mut harness = example(store, "cross");
    harness.state_mut().set_value("travel.clearance", "0.5");
    wait(&mut harness);
    click(&mut harness, "Findings (1)");
    let plan = harness.state().plan();
    let found = plan.serious().find(|finding| finding.kind == "towers").unwrap();
    let change = remedy::change(found, plan.profile.as_ref().unwrap()).unwrap();
    let text = format!("clearance 0.5 → {} mm", change.value);
    (harness, text)
}

fn clearance(harness: &Window) -> f64 {
    Profile::parse(&harness.state().project().profile).unwrap().travel.clearance
}

#[test]
fn a_remedy_is_tried_and_kept_or_taken_back() {
    let folder = tempfile::tempdir().unwrap();
    let (mut harness, text) = humps(folder.path());
    let serious = |harness: &Window| harness.state().plan().serious().count();
    let before = harness.state().project().clone();
    for (answer, left) in [("Take back", 1), ("Keep", 0)] {
        assert_eq!((serious(&harness), clearance(&harness)), (1, 0.5));
        click(&mut harness, &format!("Try: {text}"));
        wait(&mut harness);
        assert!(sees(&harness, &format!("Trying: {text}")));
        // Serious: 1 before, none after.
        assert!(sees(&harness, "before") && sees(&harness, "Serious") && serious(&harness) == 0);
        assert!(clearance(&harness) > 0.5);
        if has_adapter() && answer == "Keep" {
            let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("trial.png");
            harness.render().unwrap().save(path).unwrap();
        }
        click(&mut harness, answer);
        wait(&mut harness);
        assert!(!sees(&harness, &format!("Trying: {text}")));
        assert_eq!(serious(&harness), left, "{answer}");
    }
    // One step back takes back what was kept.
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    wait(&mut harness);
    assert_eq!(harness.state().project(), &before);
}

#[test]
fn what_is_tried_is_left_alone_once_something_else_is_changed() {
    let folder = tempfile::tempdir().unwrap();
    let (mut harness, text) = humps(folder.path());
    click(&mut harness, &format!("Try: {text}"));
    wait(&mut harness);
    harness.state_mut().set_value("layers.height", "2.5");
    wait(&mut harness);
    assert!(!sees(&harness, &format!("Trying: {text}")));
    let project = harness.state().project().clone();
    harness.state_mut().act(Action::EndTrial(false));
    assert_eq!(harness.state().project(), &project);
}

#[test]
fn figures_before_and_after_are_those_of_the_same_name() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = example(folder.path(), "cross");
    harness.state_mut().set_value("check.cooling_time", "600.0");
    wait(&mut harness);
    harness.state_mut().view().side = Side::Findings;
    let value = |harness: &Window, name: &str| {
        let totals = harness.state().plan().totals();
        totals.into_iter().find(|(other, _)| *other == name).map(|(_, value)| value)
    };
    let before = value(&harness, "total time").unwrap();
    assert_eq!(value(&harness, "waits"), None);
    harness.state_mut().act(tried("start_stop.min_layer_time", "600.0"));
    wait(&mut harness);
    let [after, waits] = ["total time", "waits"].map(|name| value(&harness, name).unwrap());
    assert!(before != after && ["–", &*before, &*after, &*waits].iter().all(|text| sees(&harness, text)));
    let same = ["wire", "deposited / part"].map(|name| value(&harness, name).unwrap());
    assert!(same.iter().all(|text| !sees(&harness, text)), "what is the same is shown");
}

fn tried(key: &'static str, value: &str) -> Action {
    Action::Try(Change { key, value: value.to_owned() })
}

#[test]
fn what_changes_nothing_is_not_tried() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = example(folder.path(), "cross");
    harness.state_mut().set_value("layers.height", "2.5");
    wait(&mut harness);
    let project = harness.state().project().clone();
    // The value that it has, and one that is refused.
    for value in ["2.5", "-1.0"] {
        harness.state_mut().act(tried("layers.height", value));
        harness.state_mut().act(Action::EndTrial(false));
        assert_eq!(harness.state().project(), &project, "{value}");
    }
    assert!(!harness.state().messages().is_empty(), "nothing is said about what is refused");
}

#[test]
fn what_is_taken_back_is_the_change_that_was_tried() {
    let folder = tempfile::tempdir().unwrap();
    let (mut harness, text) = humps(folder.path());
    let before = harness.state().project().clone();
    click(&mut harness, &format!("Try: {text}"));
    wait(&mut harness);
    let value = format!("{:?}", clearance(&harness));
    // Changed and changed back: the last step is not the one of the trial.
    for value in ["9.5", &*value] {
        harness.state_mut().set_value("travel.clearance", value);
        wait(&mut harness);
    }
    harness.state_mut().act(Action::EndTrial(false));
    wait(&mut harness);
    assert_eq!(clearance(&harness), 0.5);
    assert_eq!(harness.state().project().source, before.source);
}

#[test]
fn steps_have_names() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = example(folder.path(), "cross");
    let named = |harness: &mut Window, undo: &str, redo: &str| {
        click(harness, "Edit");
        let seen = |text: &str| harness.query_by_label_contains(text).is_some();
        assert!(seen(undo) && seen(redo), "neither {undo} nor {redo}");
        harness.key_press(Key::Escape);
        harness.run_steps(3);
    };
    named(&mut harness, "Undo: opening the part", "Redo");
    harness.state_mut().set_value("layers.height", "2.5");
    wait(&mut harness);
    named(&mut harness, "Undo: Layer height", "Redo");
    harness.state_mut().act(Action::Undo);
    wait(&mut harness);
    named(&mut harness, "Undo: opening the part", "Redo: Layer height");
}

#[test]
fn every_remedy_that_can_be_tried_is_a_value_that_the_profile_takes() {
    let mut offered = 0;
    for (name, text) in BUILT_IN {
        let profile = Profile::parse(text).unwrap();
        if profile.prints() {
            continue;
        }
        // A balanced profile has no such finding.
        let balanced = profile.mass_balance().warning().is_none();
        for check in check::CHECKS.iter().filter(|check| !(balanced && check.name == "wire-balance")) {
            let finding = Finding::new(check.name, Severity::Doubt, String::new()).sized(5.0);
            let Some(change) = remedy::change(&finding, &profile) else { continue };
            assert!(form::field(change.key).is_some(), "{} is no key of a profile", change.key);
            let tried = beadwright::profile::edit::with_value(text, change.key, &change.value).unwrap();
            let tried = Profile::parse(&tried).unwrap_or_else(|error| panic!("{name}: {error}"));
            assert!(tried != profile, "{name}: {change:?} changes nothing");
            if check.name == "short-arc" {
                let start = profile.process.arc_start_delay * profile.process.deposition_speed;
                let now = profile.fill.min_pass_length.max(start);
                assert!(tried.fill.min_pass_length > now, "{name}: passes are as short as before");
            }
            offered += 1;
        }
    }
    assert!(offered > 10, "{offered}");
}
