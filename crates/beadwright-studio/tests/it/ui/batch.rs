//! Several models, planned one after another: a table with what comes of each.

use super::files::Dropped;
use crate::window::{Window, click, says, sees, studio, wait};
use beadwright::example;
use beadwright_studio::actions::Action;
use beadwright_studio::jobs::Ask;
use beadwright_studio::project::Source;
use egui_kittest::kittest::Queryable;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A folder with two models, one that is none, and a text.
fn models(at: &Path) -> PathBuf {
    let folder = at.join("models");
    std::fs::create_dir(&folder).unwrap();
    for name in ["cross", "hub"] {
        std::fs::write(folder.join(format!("{name}.stl")), example::find(name).unwrap().stl()).unwrap();
    }
    std::fs::write(folder.join("letter.STL"), "not a model").unwrap();
    std::fs::write(folder.join("notes.txt"), "not a model either").unwrap();
    folder
}

/// The window, with the folder chosen.
fn chosen(at: &Path, folder: &Path) -> Window {
    let mut harness = studio(&at.join("store"));
    harness.state_mut().ask_in_words(Ask::BatchFolder);
    harness.state_mut().act(Action::Answer(Some(folder.to_owned())));
    harness.run_steps(2);
    harness
}

#[test]
fn a_folder_of_models_is_planned_into_a_table() {
    let at = tempfile::tempdir().unwrap();
    let folder = models(at.path());
    let mut harness = chosen(at.path(), &folder);
    assert!(sees(&harness, "Cancel") && sees(&harness, "letter.STL") && !sees(&harness, "notes.txt"));
    wait(&mut harness);
    assert!(says(&harness, "3 / 3"));
    assert!(sees(&harness, "cannot be planned") && says(&harness, "this is not an STL file"));
    // A hub whose blades overhang has findings, a cross has none.
    assert!(sees(&harness, "nothing found"));
    if crate::window::has_adapter() {
        let picture = Path::new(env!("CARGO_TARGET_TMPDIR")).join("batch.png");
        harness.render().unwrap().save(picture).unwrap();
    }
    // A click opens a part, and its plan has the same figures.
    for name in ["cross", "hub"] {
        let path = folder.join(format!("{name}.stl"));
        harness.get_by_label(&format!("{name}.stl")).click();
        harness.run_steps(3);
        wait(&mut harness);
        assert_eq!(harness.state().project().source, Some(Source::File(path)));
        let plan = harness.state().plan();
        let summary = plan.summary.as_ref().unwrap();
        let metrics = &summary.metrics;
        let figures = [
            format!("{:.2} kg", metrics.wire_mass_kg),
            format!("{:.2} h", metrics.total_time_s / 3600.0),
            metrics.arc_starts.to_string(),
        ];
        assert!(figures.iter().all(|figure| sees(&harness, figure)), "{name}: {figures:?}");
        let worst = summary.forbidden.first().or(plan.reported.first().map(|finding| &finding.text));
        assert_eq!(plan.found() > 0, name == "hub", "{worst:?}");
        let begin = |text: &String| text.chars().skip(1).take(59).collect::<String>();
        assert!(name == "cross" || says(&harness, &begin(worst.unwrap())), "{worst:?}");
    }
}

#[test]
fn a_batch_can_be_given_up_and_begun_again() {
    let at = tempfile::tempdir().unwrap();
    let folder = models(at.path());
    let mut harness = chosen(at.path(), &folder);
    click(&mut harness, "Cancel");
    assert!(harness.state().is_idle() && sees(&harness, "Stopped"));
    click(&mut harness, "Plan again");
    wait(&mut harness);
    assert!(says(&harness, "3 / 3") && !sees(&harness, "Stopped"));
}

#[test]
fn a_folder_without_models_says_so() {
    let at = tempfile::tempdir().unwrap();
    let harness = chosen(at.path(), at.path());
    assert!(harness.state().messages().iter().any(|message| message.error && message.text.contains("no model here")));
    assert!(!sees(&harness, "Cancel"));
}

#[test]
fn several_dropped_models_are_planned_into_the_table() {
    let at = tempfile::tempdir().unwrap();
    let folder = models(at.path());
    let mut harness = studio(&at.path().join("store"));
    let dropped = ["letter.STL", "cross.stl"].map(|name| folder.join(name));
    for path in &dropped {
        harness.input_mut().dropped_files.push(Arc::new(Dropped(path.clone())));
    }
    harness.run_steps(2);
    wait(&mut harness);
    assert!(says(&harness, "2 / 2") && sees(&harness, "letter.STL") && sees(&harness, "cross.stl"));
    assert_eq!(harness.state().project().source, None, "none is opened");
}
