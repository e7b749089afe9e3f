//! A person's work, headless: open an example, change the strategy, look through the layers, read the totals, export, reopen.

use crate::window;

use beadwright_studio::export::Export;
use beadwright_studio::project::Source;
use egui_kittest::kittest::Queryable;
use std::path::Path;
use window::{click, run, studio, wait};

/// What the command makes of the same part: metrics and the files of the program.
fn command(folder: &Path, example: &str, settings: &[&str]) -> String {
    let model = folder.join(format!("{example}.stl"));
    run(&["example", example, "-o", model.to_str().unwrap()]);
    let out = folder.join("cli");
    let plan = ["plan", model.to_str().unwrap(), "--json", "-o", out.to_str().unwrap()];
    run(&[&plan[..], settings].concat())
}

#[test]
fn an_example_is_planned_changed_looked_through_and_exported() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = studio(&folder.path().join("store"));
    click(&mut harness, "Examples");
    // In the menu, which lies over the examples of the start.
    harness.query_all_by_label("cross").last().unwrap().click();
    harness.run_steps(3);
    wait(&mut harness);
    let contour_passes = harness.state().plan().summary.as_ref().unwrap().metrics.passes;

    // In the bar, or among the basic parameters.
    harness.query_all_by_role_and_label(eframe::egui::Role::ComboBox, "Strategy").next().unwrap().click();
    harness.run_steps(3);
    click(&mut harness, "hybrid");
    wait(&mut harness);
    let json = {
        let plan = harness.state().plan();
        assert_ne!(plan.summary.as_ref().unwrap().metrics.passes, contour_passes);
        format!("{:#}\n", plan.summary.as_ref().unwrap().json(plan.total.as_ref()))
    };
    let theirs = command(folder.path(), "cross", &["--strategy", "hybrid"]);
    // But for what the checks find, which the window shows by itself.
    let mut totals: serde_json::Value = serde_json::from_str(&theirs).unwrap();
    ["findings", "built"].into_iter().for_each(|name| drop(totals.as_object_mut().unwrap().remove(name).unwrap()));
    assert_eq!(serde_json::from_str::<serde_json::Value>(&json).unwrap(), totals);
    // The window shows these totals.
    let theirs: serde_json::Value = serde_json::from_str(&theirs).unwrap();
    let length = format!("{:.2} m", theirs["deposited_length_mm"].as_f64().unwrap() / 1000.0);
    assert!(harness.query_by_label(&length).is_some(), "{length} is not on the screen");

    if window::has_adapter() {
        let picture = harness.render().unwrap();
        picture.save(Path::new(env!("CARGO_TARGET_TMPDIR")).join("studio.png")).unwrap();
    }
    let slider = harness.get_by_role_and_label(eframe::egui::Role::Slider, "Last layer");
    slider.set_value_accesskit(4.0);
    harness.run_steps(3);
    assert_eq!(harness.state_mut().view().last, 3);

    let out = folder.path().join("out");
    harness.state_mut().export(&Export::Program("krl".to_owned()), &out);
    for name in std::fs::read_dir(folder.path().join("cli")).unwrap().map(|e| e.unwrap().file_name()) {
        let name = name.into_string().unwrap();
        if name.ends_with(".src") || name.ends_with(".dat") {
            let read = |folder: &Path| std::fs::read(folder.join(&name)).unwrap();
            assert_eq!(read(&out), read(&folder.path().join("cli")), "{name}");
        }
    }

    let project = folder.path().join("cross.bwp");
    harness.state_mut().save_to(&project);
    let before = harness.state().project().clone();
    let mut again = studio(&folder.path().join("store-2"));
    again.state_mut().open(&project);
    wait(&mut again);
    assert_eq!(again.state().project(), &before);
    assert_eq!(again.state().project().source, Some(Source::Example("cross".to_owned())));
    let plan = again.state().plan();
    assert_eq!(format!("{:#}\n", plan.summary.as_ref().unwrap().json(plan.total.as_ref())), json);
}
