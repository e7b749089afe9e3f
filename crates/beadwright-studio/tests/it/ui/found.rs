//! What was found: said at once, counted whole, asked about before export, and shown where it is.

use crate::window::{Window, click, example, has_adapter, search, sees, studio, studio_of_size, wait};
use beadwright_studio::actions::Action;
use beadwright_studio::export::Export;
use beadwright_studio::view::{Mode, Side};
use egui_kittest::kittest::Queryable;
use glam::DVec2;
use std::path::Path;

const QUESTION: &str = "Serious findings: export the program?";

/// The cross with travels so low that the torch would run into its humps: serious, but not forbidden.
fn humps(store: &Path) -> Window {
    let mut harness = example(store, "cross");
    harness.state_mut().set_value("travel.clearance", "0.5");
    wait(&mut harness);
    let plan = harness.state().plan();
    assert!(plan.serious().any(|finding| finding.kind == "towers") && plan.forbidden().is_empty());
    harness
}

#[test]
fn a_plan_that_may_not_be_written_says_so_before_its_checks_have_run() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = studio(folder.path());
    harness.state_mut().set_value("travel.clearance", "0.0");
    harness.state_mut().open_example("cross");
    while harness.state().plan().summary.is_none() {
        harness.run_steps(1);
    }
    harness.run_steps(1);
    assert!(sees(&harness, "This program should not be started"));
    wait(&mut harness);
    harness.state_mut().act(Action::ExportProgram);
    harness.run_steps(3);
    // Neither a folder nor anything else is asked for.
    let message = harness.state().messages().last().expect("it is not explained").clone();
    assert!(message.error && message.text.contains("should not be started"), "{}", message.text);
    assert!(message.text.contains("travel.clearance = 0") && !message.text.contains("--"), "{}", message.text);
    assert!(!sees(&harness, QUESTION) && harness.state_mut().view().side == Side::Findings);
}

#[test]
fn serious_findings_ask_before_a_program_is_exported() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = humps(&folder.path().join("store"));
    let out = folder.path().join("out");
    out.to_str().unwrap().clone_into(&mut harness.state_mut().view().folder);
    for (answer, written) in [("Cancel", false), ("Show findings", false), ("Export all the same", true)] {
        harness.state_mut().act(Action::Export(Export::All));
        harness.run_steps(3);
        assert!(sees(&harness, QUESTION) && sees(&harness, "Serious: 1") && !out.exists());
        click(&mut harness, answer);
        assert!(!sees(&harness, QUESTION));
        assert_eq!(out.exists(), written, "{answer}");
    }
    assert_eq!(harness.state_mut().view().side, Side::Findings);
    // The plan alone is no program.
    harness.state_mut().act(Action::Export(Export::default()));
    harness.run_steps(3);
    assert!(!sees(&harness, QUESTION));
}

#[test]
fn metal_that_is_missing_is_counted() {
    let folder = tempfile::tempdir().unwrap();
    let harness = example(folder.path(), "star");
    let plan = harness.state().plan();
    let missing = plan.summary.as_ref().unwrap().warnings.summaries().map(|warning| warning.count).sum::<usize>();
    let found = plan.found();
    assert!(missing > 0 && found >= missing, "{missing} of {found}");
    assert!(sees(&harness, &format!("Findings: {found}")) && sees(&harness, &format!("Findings ({found})")));
}

#[test]
fn a_tower_is_framed_and_marked_in_3d() {
    if !has_adapter() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let mut harness = humps(folder.path());
    harness.state_mut().view().side = Side::Findings;
    harness.state_mut().view().mode = Mode::Layer;
    harness.run_steps(20);
    let findings = harness.state().plan().findings.clone().unwrap();
    let tower = findings.iter().find(|finding| finding.kind == "towers").unwrap();
    click(&mut harness, &tower.text.replacen("layer", "Layer", 1));
    let view = harness.state_mut().view();
    let pin = view.pin.clone().expect("the place is not marked");
    assert_eq!((view.mode, view.last, pin.layer), (Mode::Solid, tower.layer.unwrap(), tower.layer.unwrap()));
    assert!(pin.at.distance(tower.place.unwrap()) < 1e-9);
    let rect = harness.get_by_label("3-D view").rect();
    let size = DVec2::new(f64::from(rect.width()), f64::from(rect.height()));
    let camera = harness.state().camera();
    let seen = camera.project(pin.at, size).unwrap();
    assert!(seen.distance(size / 2.0) < 1.0, "{seen} in a picture of {size}");
    assert!(camera.height() < 200.0, "{} mm high", camera.height());
    // The mark stays until something else is planned.
    harness.run_steps(5);
    assert!(harness.state_mut().view().pin.is_some());
    harness.state_mut().set_value("travel.clearance", "20.0");
    assert!(harness.state_mut().view().pin.is_none());
}

#[test]
fn a_number_out_of_any_sense_is_marked() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = example(folder.path(), "cross");
    let marked = |harness: &Window| harness.query_all_by_label_contains("Usual: ").count();
    assert_eq!(marked(&harness), 0);
    harness.state_mut().set_value("process.wire_feed_speed", "99.0");
    harness.run_steps(3);
    assert_eq!(marked(&harness), 1);
    assert!(sees(&harness, "Usual: 0.3 to 25 m/min"));
}

/// Pictures to look at: `cargo test -p beadwright-studio --test it -- ui::found::pictures --ignored`.
#[test]
#[ignore = "for looking"]
fn pictures() {
    let folder = tempfile::tempdir().unwrap();
    let save = |harness: &mut Window, what: &str| {
        harness.run_steps(20);
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("ui-found-{what}.png"));
        harness.render().unwrap().save(&path).unwrap();
        println!("{}", path.display());
    };
    let mut harness = humps(&folder.path().join("store"));
    harness.state_mut().view().side = Side::Findings;
    harness.run_steps(20);
    let findings = harness.state().plan().findings.clone().unwrap();
    let tower = findings.iter().find(|finding| finding.kind == "towers").unwrap();
    click(&mut harness, &tower.text.replacen("layer", "Layer", 1));
    save(&mut harness, "tower");
    harness.state_mut().act(Action::Export(Export::All));
    save(&mut harness, "question");
    click(&mut harness, "Cancel");
    harness.state_mut().set_value("travel.clearance", "0.0");
    harness.state_mut().set_value("process.wire_feed_speed", "99.0");
    wait(&mut harness);
    harness.state_mut().act(Action::ExportProgram);
    save(&mut harness, "forbidden");
    let mut harness = studio_of_size(&folder.path().join("large"), [1280.0 / 1.5, 800.0 / 1.5]);
    harness.state_mut().open_example("star");
    wait(&mut harness);
    harness.state_mut().view().side = Side::Findings;
    save(&mut harness, "large-text");
    search(&mut harness, "e");
    save(&mut harness, "search");
}
