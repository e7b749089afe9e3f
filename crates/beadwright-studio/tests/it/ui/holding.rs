//! A positioner in the window: the part turns as it plays, its axes are shown, and beads are coloured by how far they lean.

use crate::window::{Window, click, click_at, has_adapter, open_list, press, sees, shows, slide, studio, wait};
use beadwright::example;
use beadwright::robot::Frame;
use beadwright_studio::view::Side;
use beadwright_studio::view3d::{Camera, Colour, Section, Style, pick};
use eframe::egui::{Key, vec2};
use egui_kittest::kittest::Queryable;
use glam::{DVec2, DVec3};
use std::ops::Range;
use std::path::{Path, PathBuf};

const TILTING: &str = r#"{ turning = "follow", axes = [{ direction = [1, 0, 0], through = [0, 0, -150], limits = [-95, 95], speed = 60 }, { direction = [0, 0, 1], limits = [-7200, 7200], speed = 120 }] }"#;

/// The elbow with the arm that welds it, on a positioner or not.
fn elbow(store: &Path, positioner: bool) -> Window {
    let mut harness = studio(store);
    harness.state_mut().set_value("layers.chart", example::find("elbow").unwrap().chart.unwrap());
    if positioner {
        harness.state_mut().set_value("program.positioner", TILTING);
    }
    harness.state_mut().open_example("elbow");
    wait(&mut harness);
    harness.state_mut().view().robot = true;
    press(&mut harness, Key::F2);
    wait(&mut harness);
    harness
}

/// Whether a text that has this in it is to be seen.
fn reads(harness: &Window, part: &str) -> bool {
    harness.query_all_by_label_contains(part).next().is_some()
}

#[test]
fn the_part_turns_on_its_positioner() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = elbow(folder.path(), true);
    for axis in ["Positioner 1 ", "(-95 … 95°)", "Positioner 2 ", "(-7200 … 7200°)"] {
        assert!(reads(&harness, axis), "{axis}");
    }
    harness.state_mut().view().side = Side::Plots;
    harness.run_steps(4);
    assert!(sees(&harness, "Positioner angles, °") && sees(&harness, "Positioner 1: -95 … 95°"));
    plays(&mut harness);
    if has_adapter() {
        picks(&mut harness);
    }
    leans(&mut harness, 0.9..1.1);
    // Without the arm the part lies as it is planned.
    harness.state_mut().view().robot = false;
    harness.state_mut().view().side = Side::Totals;
    harness.run_steps(2);
    assert_eq!(harness.state().camera().held, Frame::IDENTITY);
    assert!(!reads(&harness, "Positioner 1 "));
}

#[test]
fn nothing_is_turned_without_a_positioner() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = elbow(folder.path(), false);
    slide(&mut harness, "Last layer", 30.0);
    assert_eq!(harness.state().camera().held, Frame::IDENTITY);
    assert!(!reads(&harness, "Positioner 1 "));
    leans(&mut harness, 85.0..91.0);
}

/// As it plays, the eye stays where it is in the cell, and the layer under the torch is level.
fn plays(harness: &mut Window) {
    slide(harness, "Last layer", 30.0);
    harness.key_press(Key::Space);
    harness.run_steps(4);
    let before = harness.state().camera();
    for _ in 0..10 {
        harness.run_steps(1);
        let now = harness.state().camera();
        assert_eq!(now, Camera { held: now.held, ..before }, "the eye moves");
    }
    harness.key_press(Key::Space);
    harness.run_steps(4);
    let torch = harness.state_mut().view().torch.unwrap();
    let held = harness.state().camera().held;
    assert!(torch.up.angle_between(DVec3::Z) > 0.2, "{torch:?}");
    assert!((held.rotation * torch.up).angle_between(DVec3::Z) < 0.05, "the layer leans in the cell");
}

/// A click picks the bead under the pointer, and the part is then held as it is when this bead is laid.
fn picks(harness: &mut Window) {
    slide(harness, "Last layer", 25.0);
    assert_ne!(harness.state().camera().held, Frame::IDENTITY);
    let rect = harness.get_by_label("3-D view").rect();
    let size = DVec2::new(f64::from(rect.width()), f64::from(rect.height()));
    let (camera, scene) = (harness.state().camera(), &harness.state().plan().scene);
    let at = camera.project(scene.layer(20).unwrap().beads()[0].torch(0.5).at, size).unwrap();
    let style = Style { layers: 0..=24, ..Style::default() };
    let found = pick(scene, &style, &camera, size, at).unwrap();
    let seen = scene.layer(found.layer).unwrap().beads()[found.segment];
    let ends = [0.0, 1.0].map(|part| camera.project(seen.torch(part).at, size).unwrap());
    let off = ends.map(|end| end.distance(at)).into_iter().fold(f64::INFINITY, f64::min);
    assert!(off < 30.0, "{off} points beside the pointer");
    click_at(harness, rect.min + vec2(at.x as f32, at.y as f32));
    let (layer, pass, _) = harness.state_mut().view().chosen.expect("nothing is picked");
    assert_eq!((layer, pass), (found.layer, found.pass));
    let held = harness.state().camera().held;
    assert!((held.rotation * seen.up().as_dvec3()).angle_between(DVec3::Z).to_degrees() < 0.2);
}

/// Beads are coloured by how far their layer leans, at most as far as this.
fn leans(harness: &mut Window, most: Range<f64>) {
    open_list(harness, "Colour");
    click(harness, "lean from level");
    wait(harness);
    let (low, high) = harness.state().plan().scene.value_range(Colour::OffLevel).unwrap();
    assert!(low == 0.0 && most.contains(&high), "{low} to {high}");
    shows(harness, [low, high], "°");
}

/// Pictures to look at: `cargo test -p beadwright-studio --test it -- ui::holding::pictures --ignored`.
#[test]
#[ignore = "for looking"]
fn pictures() {
    let folder = tempfile::tempdir().unwrap();
    for positioner in [false, true] {
        let mut harness = elbow(folder.path(), positioner);
        let save = |harness: &mut Window, what: &str| {
            harness.run_steps(4);
            let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("ui-holding-{positioner}-{what}.png"));
            harness.render().unwrap().save(&path).unwrap();
            println!("{}", path.display());
        };
        slide(&mut harness, "Last layer", 40.0);
        save(&mut harness, "arm");
        harness.state_mut().view().colour = Colour::OffLevel;
        harness.run_steps(2);
        wait(&mut harness);
        save(&mut harness, "lean");
        harness.state_mut().view().side = Side::Plots;
        harness.run_steps(3);
        let last = if positioner { "Positioner angles, °" } else { "Joint angles, °" };
        harness.get_by_label(last).scroll_to_me();
        harness.run_steps(8);
        save(&mut harness, "plots");
        harness.state_mut().view().section = Some(Section { axis: 1, at: 0.0, lower: true });
        save(&mut harness, "cut");
    }
}
