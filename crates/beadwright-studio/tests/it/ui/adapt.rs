//! A scan of the unfinished build: compared with the plan, followed by the layers above, undone, exported.

use crate::window::{Window, click, example, press, run, says, sees, type_number, wait};
use beadwright::adapt::scan::read;
use beadwright::adapt::{Adapted, Align, Rules, Unfinished};
use beadwright::layer::Layer;
use beadwright::plan_file;
use beadwright::planar::Region;
use beadwright::task::Task;
use beadwright_studio::actions::Action;
use beadwright_studio::adaptation::Adaptation;
use beadwright_studio::export::Export;
use beadwright_studio::project::Project;
use beadwright_studio::view::Side;
use eframe::egui::{Key, Modifiers};
use egui_kittest::kittest::{NodeT, Queryable};
use glam::DVec2;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The layer after which the build is scanned, from 1.
const AFTER: usize = 4;

/// A scan after that layer whose top lies `by(x, y)` mm off, and which shows the plate.
fn scan(folder: &Path, layers: &[Layer], by: fn(f64, f64) -> f64) -> PathBuf {
    let layer = &layers[AFTER - 1];
    let outline = Region::from_normalised(layer.islands.clone());
    let lattice = (-60..=60).flat_map(|x| (-60..=60).map(move |y| DVec2::new(f64::from(x), f64::from(y))));
    let height = |p: DVec2| if outline.contains(p) { layer.z + by(p.x, p.y) } else { 0.0 };
    let lines: String = lattice.map(|p| format!("{},{},{}\n", p.x, p.y, height(p))).collect();
    let path = folder.join("after 4.csv");
    std::fs::write(&path, lines).unwrap();
    path
}

fn layers(harness: &Window) -> Vec<Layer> {
    harness.state().plan().layers.iter().map(|layer| (**layer).clone()).collect()
}

/// The cross, planned, and a scan of it that lies too low on one side.
fn scanned(folder: &Path) -> (Window, Vec<Layer>, PathBuf) {
    let harness = example(&folder.join("store"), "cross");
    let planned = layers(&harness);
    let path = scan(folder, &planned, |x, _| if x < 0.0 { -0.4 } else { -0.1 });
    (harness, planned, path)
}

/// Chooses the scan, and the layer after which it was taken.
fn choose(harness: &mut Window, path: &Path) {
    harness.state_mut().open_build_scan(path);
    harness.run_steps(2);
    type_number(harness, "Scanned after layer", &AFTER.to_string());
    wait(harness);
}

/// What the library makes of the scan, and the layers of `plan.json`.
fn adapted(harness: &Window, planned: &[Layer], path: &Path) -> (Adapted, Vec<Layer>) {
    let plan = harness.state().plan();
    let (header, profile) = (plan.header.as_ref().unwrap(), plan.profile.as_ref().unwrap());
    let text: String = planned.iter().map(|layer| plan_file::layer(layer, None)).collect();
    let written = plan_file::read(&(plan_file::head(header, profile) + &text + plan_file::tail())).unwrap().layers;
    let build = Unfinished { header, layers: &written, profile, number: AFTER };
    let scan = read(&std::fs::read(path).unwrap(), &Task::new()).unwrap();
    let rules = Rules { window: (0.7, 1.3), spacing: profile.bead.width };
    (Adapted::of(build, scan, Align::AsIs, rules).unwrap(), written)
}

#[test]
fn what_is_left_follows_a_scan_in_one_step_that_can_be_undone() {
    let folder = tempfile::tempdir().unwrap();
    let (mut harness, planned, path) = scanned(folder.path());
    let before = harness.state().project().clone();
    choose(&mut harness, &path);
    assert_eq!(harness.state_mut().view().side, Side::Adapt);
    let (wanted, written) = adapted(&harness, &planned, &path);
    for sentence in wanted.sentences() {
        assert!(sees(&harness, &sentence), "{sentence}");
    }
    assert!(says(&harness, "Measured minus predicted: -0.2"), "it lies 0.25 mm too low on average");
    assert!(
        ["Measured minus predicted", "Measured, above the planned top"].into_iter().all(|name| sees(&harness, name))
    );
    assert_eq!(layers(&harness), planned, "looking changes nothing");
    if crate::window::has_adapter() {
        let picture = Path::new(env!("CARGO_TARGET_TMPDIR")).join("adapt.png");
        harness.render().unwrap().save(picture).unwrap();
    }

    click(&mut harness, "Adapt what is left");
    wait(&mut harness);
    let followed = [&written[..AFTER], &wanted.followed.layers].concat();
    assert_eq!(layers(&harness), followed);
    let plan = harness.state().plan();
    assert_eq!(plan.scene.layers().len(), followed.len());
    let metrics = &plan.summary.as_ref().unwrap().metrics;
    assert_eq!(metrics.layers, followed.len());
    assert!(metrics.deposited_volume_mm3 > 0.0 && plan.is_of_last_request());
    assert!(sees(&harness, "The layers above follow a scan. Close the scan, and the plan comes back."));
    assert!(
        harness.get_by_role_and_label(eframe::egui::Role::SpinButton, "Least metal").accesskit_node().is_disabled()
    );

    click(&mut harness, "Edit");
    assert!(says(&harness, "Undo: layers after a scan"));
    press(&mut harness, Key::Escape);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    wait(&mut harness);
    assert_eq!(*harness.state().project(), before);
    assert_eq!(layers(&harness), planned);
    assert_eq!(harness.state_mut().view().adapt.as_ref().unwrap().after_layer, AFTER, "kept while it is planned again");
    // Closing the scan brings the plan back, too.
    harness.state_mut().act(Action::Adapt);
    wait(&mut harness);
    assert_eq!(layers(&harness), followed);
    click(&mut harness, "Close the scan");
    wait(&mut harness);
    assert_eq!(*harness.state().project(), before);
    assert_eq!(layers(&harness), planned);
}

#[test]
fn what_is_exported_after_a_scan_is_what_the_command_writes() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let (mut harness, _, path) = scanned(folder.path());
    harness.state_mut().export(&Export::All, &at("plan"));
    choose(&mut harness, &path);
    harness.state_mut().act(Action::Adapt);
    wait(&mut harness);
    harness.state_mut().export(&Export::All, &at("ours"));
    let text = |path: PathBuf| path.to_str().unwrap().to_owned();
    let (plan, theirs, scan) = (text(at("plan").join("plan.json")), text(at("theirs")), text(path));
    run(&["adapt", &plan, "--scan", &scan, "--after-layer", &AFTER.to_string(), "-o", &theirs]);
    let files = |folder: PathBuf| -> BTreeMap<String, Vec<u8>> {
        let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
        let named = |path: PathBuf| (path.file_name().unwrap().to_str().unwrap().to_owned(), path);
        entries.map(named).map(|(name, path)| (name, std::fs::read(path).unwrap())).collect()
    };
    let (ours, theirs) = (files(at("ours")), files(at("theirs")));
    assert_eq!(ours.keys().collect::<Vec<_>>(), theirs.keys().collect::<Vec<_>>());
    for (name, bytes) in &theirs {
        assert!(ours[name] == *bytes, "{name} differs");
    }
    assert!(ours.contains_key("adapt.html"));
    // The program alone begins with the layer after the scan.
    harness.state_mut().export(&Export::Program("krl".to_owned()), &at("program"));
    let program = files(at("program"));
    assert!(!program.is_empty() && program.iter().all(|(name, bytes)| ours[name] == *bytes), "{:?}", program.keys());
}

#[test]
fn another_change_gives_up_what_followed_the_scan() {
    let folder = tempfile::tempdir().unwrap();
    let (mut harness, planned, path) = scanned(folder.path());
    choose(&mut harness, &path);
    harness.state_mut().act(Action::Adapt);
    wait(&mut harness);
    harness.state_mut().set_value("travel.speed", "90.0");
    wait(&mut harness);
    assert_eq!(harness.state().project().adapted, None);
    assert_eq!(harness.state().plan().layers.len(), planned.len());
    assert!(harness.state().messages().iter().any(|message| message.text.starts_with("The layers no longer follow")));
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    wait(&mut harness);
    assert!(harness.state().project().adapted.is_some() && harness.state().plan().adapted.is_some());
}

#[test]
fn a_scan_of_something_else_says_so_and_changes_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let (mut harness, planned, path) = scanned(folder.path());
    std::fs::write(&path, "1000,1000,3\n1001,1000,3\n1000,1001,3\n").unwrap();
    choose(&mut harness, &path);
    assert!(!sees(&harness, "Adapt what is left"));
    assert!(says(&harness, "scan"), "a sentence says why");
    // A project whose scan is gone is planned, but nothing can be written.
    harness.state_mut().act(Action::Adapt);
    wait(&mut harness);
    assert_eq!(layers(&harness), planned);
    assert!(!harness.state().plan().is_of_last_request());
    assert!(Export::All.chunks(harness.state().plan()).is_err());
}

#[test]
fn the_project_keeps_the_scan() {
    let folder = tempfile::tempdir().unwrap();
    let adapted = Adaptation { align: Align::Fit, ..Adaptation::of(folder.path().join("scan.ply"), 7) };
    let project = Project { adapted: Some(adapted), ..Project::default() };
    let text = project.write(Some(folder.path())).unwrap();
    assert!(text.contains("scan = \"scan.ply\"") && text.contains("align = \"fit\""), "{text}");
    assert_eq!(Project::read(&text, Some(folder.path())).unwrap(), project);
}

#[test]
fn layers_that_are_not_level_are_not_offered() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = example(folder.path(), "cross");
    let enabled = |harness: &mut Window| {
        click(harness, "File");
        let disabled = harness.get_by_label("Adapt after a scan…").accesskit_node().is_disabled();
        press(harness, Key::Escape);
        !disabled
    };
    assert!(enabled(&mut harness));
    harness.state_mut().set_value("layers.chart", "plane:up=0/0.1/1,through=0/0/0");
    wait(&mut harness);
    assert!(!enabled(&mut harness));
}
