//! What is written is what the command writes, byte for byte.

use crate::window::{Window, has_adapter, run, studio, wait};
use beadwright::dialect;
use beadwright::files::{METRICS, PLAN, REPORT};
use beadwright_studio::export::Export;
use beadwright_studio::project::{Project, Source};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let named = |path: std::path::PathBuf| path.file_name().unwrap().to_string_lossy().into_owned();
    entries.map(|path| (named(path.clone()), std::fs::read(path).unwrap())).collect()
}

fn same(ours: &BTreeMap<String, Vec<u8>>, theirs: &BTreeMap<String, Vec<u8>>) {
    assert!(ours.keys().eq(theirs.keys()), "{:?} and {:?}", ours.keys(), theirs.keys());
    for (name, bytes) in ours {
        let differs = bytes.iter().zip(&theirs[name]).position(|(a, b)| a != b);
        assert!(*bytes == theirs[name], "{name} differs at byte {differs:?}");
    }
}

/// A project of the file at a scale with a profile, opened and planned.
fn opened(folder: &Path, model: &Path, profile: &str, scale: f64) -> Window {
    let mut project = Project { source: Some(Source::File(model.to_owned())), ..Project::default() };
    project.placement.scale = scale;
    beadwright::profile::Profile::built_in_text(profile).unwrap().clone_into(&mut project.profile);
    let path = folder.join(format!("{profile}.bwp"));
    std::fs::write(&path, project.write(None).unwrap()).unwrap();
    let mut harness = studio(&folder.join("store"));
    harness.state_mut().view().mode = beadwright_studio::view::Mode::Layer;
    harness.state_mut().open(&path);
    wait(&mut harness);
    assert!(harness.state().plan().is_complete(), "{:?}", harness.state().plan().failure);
    harness
}

#[test]
fn all_dialects_and_papers_are_those_of_the_command() {
    let folder = tempfile::tempdir().unwrap();
    let model = folder.path().join("cross.stl");
    let text = |path: &Path| path.to_str().unwrap().to_owned();
    run(&["example", "cross", "-o", &text(&model)]);
    let mut dialects = BTreeSet::new();
    // A tenth of the part for a nozzle of 0.4 mm.
    for (profile, scale, posts) in [
        ("cmt-al2319-kuka", 1.0, &["krl"][..]),
        ("cmt-steel-abb", 1.0, &["rapid"]),
        ("cmt-steel-robots", 1.0, &["fanuc", "inform", "urscript"]),
        ("plasma-304-cnc", 1.0, &["gcode"]),
        ("fdm-abs-0.4", 0.1, &["marlin", "gcode"]),
    ] {
        let mut harness = opened(folder.path(), &model, profile, scale);
        let whole = folder.path().join(format!("{profile}-all"));
        harness.state_mut().export(&Export::All, &whole);
        let theirs = folder.path().join(format!("{profile}-cli"));
        let scale = scale.to_string();
        let plan = ["plan", &text(&model), "--profile", profile, "--scale", &scale, "-o", &text(&theirs)];
        run(&plan);
        same(&files(&whole), &files(&theirs));
        for dialect in posts {
            let ours = folder.path().join(format!("{profile}-{dialect}"));
            harness.state_mut().export(&Export::Program((*dialect).to_owned()), &ours);
            let theirs = folder.path().join(format!("{profile}-{dialect}-cli"));
            let out = text(&theirs);
            let plan = [&plan[..6], &["-o", &out, "--post", dialect, "--no-deposit"]].concat();
            run(&plan);
            let mut theirs = files(&theirs);
            theirs.retain(|name, _| !["plan.json", "metrics.json", "report.html"].contains(&name.as_str()));
            same(&files(&ours), &theirs);
            dialects.insert(*dialect);
        }
        for message in harness.state().messages() {
            assert!(!message.error, "{}", message.text);
        }
    }
    assert_eq!(dialects, BTreeSet::from_iter(dialect::names()));
}

#[test]
fn a_wall_given_by_curves_is_written_as_the_command_does() {
    let folder = tempfile::tempdir().unwrap();
    let model = folder.path().join("pot.igs");
    std::fs::write(&model, beadwright::example::find("pot").unwrap().iges().unwrap()).unwrap();
    let mut harness = opened(folder.path(), &model, "cmt-al2319-kuka", 1.0);
    let [ours, theirs] = ["ours", "theirs"].map(|name| folder.path().join(name));
    harness.state_mut().export(&Export::All, &ours);
    run(&["plan", model.to_str().unwrap(), "-o", theirs.to_str().unwrap()]);
    same(&files(&ours), &files(&theirs));
}

#[test]
fn papers_are_written_one_by_one() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = crate::window::example(folder.path(), "cross");
    let [all, one] = ["all", "one"].map(|name| folder.path().join(name));
    harness.state_mut().export(&Export::All, &all);
    for name in [PLAN, METRICS, REPORT] {
        harness.state_mut().export(&Export::File(name), &one);
    }
    let (all, one) = (files(&all), files(&one));
    assert!(one.keys().map(String::as_str).eq(["metrics.json", "plan.json", "report.html"]));
    assert!(one["plan.json"] == all["plan.json"], "the plans differ");
    // But for the names of the files that are written with them.
    let metrics = |files: &BTreeMap<String, Vec<u8>>| {
        let mut value: serde_json::Value = serde_json::from_slice(&files["metrics.json"]).unwrap();
        value.as_object_mut().unwrap().remove("files").unwrap();
        value
    };
    assert_eq!(metrics(&one), metrics(&all));
    // Alone it names no program that does not lie beside it.
    let report = String::from_utf8(one["report.html"].clone()).unwrap();
    assert!(!report.contains("CROSS.src") && String::from_utf8_lossy(&all["report.html"]).contains("CROSS.src"));
    // A dialect that the profile lacks is refused with a sentence.
    harness.state_mut().export(&Export::Program("rapid".to_owned()), &folder.path().join("none"));
    let message = harness.state().messages().last().unwrap();
    assert!(message.error && message.text.contains("rapid") && message.text.ends_with('.'), "{}", message.text);
}

#[test]
fn programs_that_nobody_should_start_are_not_exported() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = crate::window::example(folder.path(), "cross");
    harness.state_mut().set_value("travel.clearance", "0.0");
    wait(&mut harness);
    let out = folder.path().join("out");
    for export in [Export::All, Export::Program("krl".to_owned())] {
        harness.state_mut().export(&export, &out);
        let message = harness.state().messages().last().unwrap();
        assert!(message.error && message.text.contains("travel.clearance = 0") && !out.exists(), "{}", message.text);
    }
    // The plan itself may be looked at.
    harness.state_mut().export(&Export::File(PLAN), &out);
    assert!(out.join(PLAN).exists());
}

#[test]
fn a_picture_is_written() {
    if !has_adapter() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let mut harness = crate::window::example(folder.path(), "cross");
    harness.run_steps(2);
    // The name has no extension; the content is a PNG all the same.
    let path = folder.path().join("picture");
    harness.state_mut().save_picture(&path);
    assert!(!harness.state().messages().last().unwrap().error);
    let bytes = std::fs::read(&path).unwrap();
    assert!(bytes.starts_with(b"\x89PNG"));
    let picture = image::load_from_memory(&bytes).unwrap().into_rgba8();
    assert_eq!(picture.dimensions(), (1920, 1200));
    // Contours are blue: more blue than red, clearly.
    let blue = picture.pixels().filter(|p| p.0[2] > p.0[0].saturating_add(60)).count();
    assert!(blue > 20_000, "{blue} pixels are blue");
    harness.state_mut().save_picture(&folder.path().join("no/such/folder/a.png"));
    assert!(harness.state().messages().last().unwrap().text.contains("a.png"));
}
