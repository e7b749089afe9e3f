//! Files that come and go: dropped, recent, kept aside; and which file a project belongs to.

use crate::window::{Window, click, example, sees, studio, wait};
use beadwright_studio::project::{Project, Source};
use eframe::egui::{DroppedFile, Key, Modifiers};
use egui_kittest::kittest::Queryable;
use std::path::{Path, PathBuf};
use std::sync::Arc;

#[derive(Debug)]
pub(super) struct Dropped(pub(super) PathBuf);

impl DroppedFile for Dropped {
    fn path(&self) -> &Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        std::fs::read(&self.0).map_err(|error| error.to_string())
    }
}

fn cross(folder: &Path) -> PathBuf {
    let path = folder.join("my part.stl");
    std::fs::write(&path, beadwright::example::find("cross").unwrap().stl()).unwrap();
    path
}

/// A project file of an example.
fn project(folder: &Path, name: &str) -> PathBuf {
    let project = Project { source: Some(Source::Example(name.to_owned())), ..Project::default() };
    let path = folder.join(format!("{name}.bwp"));
    std::fs::write(&path, project.write(None).unwrap()).unwrap();
    path
}

fn press(harness: &mut Window, modifiers: Modifiers, key: Key) {
    harness.key_press_modifiers(modifiers, key);
    harness.run_steps(3);
}

#[test]
fn a_dropped_file_is_planned_and_is_recent_in_the_next_run() {
    let folder = tempfile::tempdir().unwrap();
    let (path, store) = (cross(folder.path()), folder.path().join("store"));
    let mut harness = studio(&store);
    assert!(sees(&harness, "Drop a part here"));
    harness.input_mut().dropped_files.push(Arc::new(Dropped(path.clone())));
    harness.run_steps(1);
    wait(&mut harness);
    assert_eq!(harness.state().project().source, Some(Source::File(path.clone())));
    assert!(harness.state().plan().is_complete() && sees(&harness, "my part.stl") && sees(&harness, "Done"));
    // As `beadwright example cross` says.
    assert!(sees(&harness, "Size: 100.0 × 100.0 × 20.0 mm"));
    eframe::App::on_exit(harness.state_mut());
    drop(harness);

    let mut harness = studio(&store);
    click(&mut harness, "File");
    harness.get_by_label_contains("Recent files").click();
    harness.run_steps(5);
    // Listed before a part is open, too; the menu lies over that.
    harness.query_all_by_label("my part.stl").last().unwrap().click();
    harness.run_steps(3);
    wait(&mut harness);
    assert_eq!(harness.state().project().source, Some(Source::File(path)));
    assert!(harness.state().plan().is_complete());
}

#[test]
fn a_project_is_kept_aside_until_the_end() {
    let folder = tempfile::tempdir().unwrap();
    let store = folder.path().join("store");
    let mut harness = example(&store, "cross");
    harness.state_mut().set_value("layers.height", "2.5");
    harness.run_steps(2);
    let kept = harness.state().project().clone();
    // As a crash ends it.
    drop(harness);

    let begin = || {
        let mut harness = studio(&store);
        harness.state_mut().offer_lost();
        harness.run_steps(3);
        harness
    };
    let mut undecided = begin();
    assert!(sees(&undecided, "Restore"));
    eframe::App::on_exit(undecided.state_mut());
    drop(undecided);
    let mut harness = begin();
    click(&mut harness, "Restore");
    wait(&mut harness);
    assert_eq!(harness.state().project(), &kept);
    assert_eq!(harness.state().plan().layers.len(), 8);
    assert!(!sees(&harness, "Restore"));
    drop(harness);

    let mut harness = begin();
    click(&mut harness, "Discard");
    assert!(harness.state().project().source.is_none());
    drop(harness);
    let mut harness = begin();
    assert!(!sees(&harness, "Restore"));
    harness.state_mut().open_example("cross");
    wait(&mut harness);
    eframe::App::on_exit(harness.state_mut());
    drop(harness);
    assert!(!sees(&begin(), "Restore"), "nothing is lost after an end in peace");
}

#[test]
fn undo_beyond_the_opening_lets_go_of_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let [a, b] = ["cross", "plate"].map(|name| project(folder.path(), name));
    let mut harness = studio(&folder.path().join("store"));
    harness.state_mut().open(&a);
    harness.state_mut().open(&b);
    harness.state_mut().set_value("layers.height", "2.5");
    wait(&mut harness);
    assert_eq!(harness.state().file(), Some(&*b));
    press(&mut harness, Modifiers::COMMAND, Key::Z);
    assert_eq!(harness.state().file(), Some(&*b));
    press(&mut harness, Modifiers::COMMAND, Key::Z);
    click(&mut harness, "Close the part");
    wait(&mut harness);
    assert_eq!(harness.state().project().source, Some(Source::Example("cross".to_owned())));
    assert_eq!(harness.state().file(), None, "saving would write the cross into plate.bwp");
}

#[test]
fn undo_leads_back_to_the_empty_window() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = example(&folder.path().join("store"), "cross");
    for answer in ["Cancel", "Close the part"] {
        assert!(harness.state().plan().is_complete(), "the part is closed unasked");
        press(&mut harness, Modifiers::COMMAND, Key::Z);
        click(&mut harness, answer);
        assert!(!sees(&harness, "Close this part?"));
    }
    wait(&mut harness);
    assert!(sees(&harness, "Drop a part here"));
    let plan = harness.state().plan();
    assert!(plan.part.is_none() && plan.layers.is_empty() && plan.scene.segments() == 0);
    press(&mut harness, Modifiers::COMMAND | Modifiers::SHIFT, Key::Z);
    wait(&mut harness);
    assert!(harness.state().plan().is_complete());
}

#[test]
fn what_goes_wrong_again_is_said_once() {
    let folder = tempfile::tempdir().unwrap();
    // The store cannot be made: a file lies in its place.
    let store = folder.path().join("store");
    std::fs::write(&store, "").unwrap();
    let mut harness = studio(&store);
    harness.state_mut().open_example("cross");
    for height in ["2.1", "2.2", "2.3"] {
        harness.state_mut().set_value("layers.height", height);
        harness.run_steps(2);
    }
    let texts: Vec<_> = harness.state().messages().iter().map(|message| &message.text).collect();
    assert!(texts.len() == 1 && texts[0].starts_with("The project cannot be autosaved"), "{texts:?}");
}

#[test]
fn a_path_is_kept_whole() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = studio(&folder.path().join("store"));
    harness.state_mut().open(Path::new("nowhere/part.stl"));
    wait(&mut harness);
    let Some(Source::File(path)) = &harness.state().project().source else { panic!("no file") };
    assert_eq!(path, &std::env::current_dir().unwrap().join("nowhere/part.stl"));
}

#[test]
fn changes_are_asked_about_before_they_are_lost() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = studio(folder.path());
    harness.state_mut().open_example("cross");
    wait(&mut harness);
    assert!(!harness.state().is_changed(), "an example that was only looked at");
    harness.state_mut().set_value("fill.strategy", "contour");
    assert!(harness.state().is_changed());
    let close = |harness: &mut Window| {
        let viewport = harness.input_mut().viewports.entry(eframe::egui::ViewportId::ROOT).or_default();
        viewport.events.push(eframe::egui::ViewportEvent::Close);
        harness.run_steps(1);
        harness.run_steps(2);
    };
    close(&mut harness);
    assert!(harness.query_by_label("They are lost if you do not save.").is_some());
    click(&mut harness, "Keep working");
    assert!(harness.query_by_label("They are lost if you do not save.").is_none());
    harness.state_mut().save_to(&folder.path().join("a.bwp"));
    close(&mut harness);
    assert!(harness.query_by_label("They are lost if you do not save.").is_none());
}
