//! Parameters: typed, refused, undone.

use crate::window::{Window, example, press, search, sees, type_number, wait};
use beadwright::model::Model;
use beadwright::plan;
use beadwright::profile::Profile;
use beadwright::task::Task;
use eframe::egui::{Key, Modifiers, Role};
use egui_kittest::kittest::Queryable;

/// Deposited length of the cross, as the library plans it with a layer height.
fn length(height: f64) -> (usize, f64) {
    let mut profile = Profile::built_in("cmt-al2319-kuka").unwrap();
    profile.layers.height = height;
    let model = Model::read(&beadwright::example::find("cross").unwrap().stl(), &Task::new()).unwrap();
    let part = model.place(&Default::default(), None, profile.bead.width).unwrap();
    let metrics = plan::plan("cross", part.mesh().unwrap(), &profile, &Task::new()).unwrap().summary.metrics;
    (metrics.layers, metrics.deposited_length_mm)
}

fn planned(harness: &Window) -> (usize, f64) {
    let metrics = &harness.state().plan().summary.as_ref().unwrap().metrics;
    assert_eq!(harness.state().plan().layers.len(), metrics.layers);
    (metrics.layers, metrics.deposited_length_mm)
}

fn shortcut(harness: &mut Window, modifiers: Modifiers, key: Key) {
    harness.key_press_modifiers(modifiers, key);
    wait(harness);
}

#[test]
fn a_typed_value_changes_the_plan_and_is_undone_by_keys() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = example(folder.path(), "cross");
    let (before, after) = (length(2.0), length(2.5));
    assert_eq!((before.0, after.0), (10, 8));
    assert_eq!(planned(&harness), before);
    search(&mut harness, "layers.height");
    type_number(&mut harness, "height", "2.5");
    wait(&mut harness);
    assert_eq!(planned(&harness), after);
    shortcut(&mut harness, Modifiers::COMMAND, Key::Z);
    assert_eq!(planned(&harness), before);
    assert!(harness.get_by_role_and_label(Role::SpinButton, "height").value().unwrap().starts_with('2'));
    shortcut(&mut harness, Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    assert_eq!(planned(&harness), after);
    // Both steps are gone: the part itself was opened by a step.
    shortcut(&mut harness, Modifiers::COMMAND, Key::Z);
    assert_eq!(planned(&harness), before);
}

#[test]
fn an_impossible_value_is_refused_at_its_field_and_changes_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = example(folder.path(), "cross");
    let (project, plan) = (harness.state().project().clone(), planned(&harness));
    search(&mut harness, "layers.height");
    type_number(&mut harness, "height", "1000");
    let refused = |harness: &Window| harness.query_by_label_contains("it must lie between 0.01 and 50 mm").is_some();
    assert!(refused(&harness), "nothing is said about 1000 mm");
    wait(&mut harness);
    assert_eq!((harness.state().project(), planned(&harness)), (&project, plan));
    // A value that only its neighbours forbid.
    harness.state_mut().set_value("fill.overlap", "\"free\"");
    harness.run_steps(2);
    assert_eq!(harness.state().project(), &project);
    type_number(&mut harness, "height", "2.5");
    wait(&mut harness);
    assert!(!refused(&harness) && planned(&harness).0 == 8);
}

#[test]
fn escape_leaves_a_field_as_it_was() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = example(folder.path(), "cross");
    let project = harness.state().project().clone();
    search(&mut harness, "layers.height");
    harness.get_by_role_and_label(Role::SpinButton, "height").click();
    harness.run_steps(2);
    harness.get_by_role_and_label(Role::SpinButton, "height").type_text("5");
    harness.run_steps(2);
    press(&mut harness, Key::Escape);
    let height = |text: &str| Profile::parse(text).unwrap().layers.height;
    assert_eq!(height(&harness.state().project().profile), 2.0);
    assert_eq!(harness.state().project(), &project);
    assert!(sees(&harness, "Done"), "Escape stops nothing while it leaves a field");
}
