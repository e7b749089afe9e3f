//! Where the part is placed.

use crate::window::{Window, bounds, click, click_at, crosses, has_adapter, planned, sees, studio, type_number, wait};
use beadwright::model::Part;
use beadwright::preform::orient::Oriented;
use beadwright::task::Task;
use eframe::egui::{Key, Modifiers};
use egui_kittest::kittest::Queryable;
use glam::DVec3;

fn size(harness: &Window) -> DVec3 {
    let (low, high) = bounds(harness);
    assert!(low.z.abs() < 1e-6, "it does not stand on z = 0");
    high - low
}

fn near(a: DVec3, b: DVec3) -> bool {
    a.distance(b) < 1e-3
}

#[test]
fn a_part_is_laid_flat_scaled_and_turned() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("standing.stl");
    // Turned about x by 90°: it stands on an arm.
    std::fs::write(&path, crosses(&[|p| DVec3::new(p.x, -p.z, p.y)])).unwrap();
    let mut harness = studio(&folder.path().join("store"));
    harness.state_mut().view().mode = beadwright_studio::view::Mode::Layer;
    harness.state_mut().set_value("layers.level", "false");
    harness.state_mut().open(&path);
    wait(&mut harness);
    assert!(near(size(&harness), DVec3::new(100.0, 20.0, 100.0)), "{}", size(&harness));
    click(&mut harness, "Placement");
    harness.run_steps(5);
    click(&mut harness, "Lay flat");
    wait(&mut harness);
    assert!(near(size(&harness), DVec3::new(100.0, 100.0, 20.0)), "{}", size(&harness));
    assert_eq!(harness.state().plan().layers.len(), 10);
    type_number(&mut harness, "Scale", "0.5");
    wait(&mut harness);
    assert!(near(size(&harness), DVec3::new(50.0, 50.0, 10.0)), "{}", size(&harness));
    assert_eq!(harness.state().plan().layers.len(), 5);
    type_number(&mut harness, "Turn about z", "45");
    wait(&mut harness);
    // A cross with arms 18 mm wide and 50 mm long from end to end, on its corners.
    let across = (50.0 + 18.0) / 2.0_f64.sqrt();
    assert!(near(size(&harness), DVec3::new(across, across, 10.0)), "{}", size(&harness));
    click(&mut harness, "Reset");
    wait(&mut harness);
    assert!(near(size(&harness), DVec3::new(100.0, 20.0, 100.0)), "{}", size(&harness));
    // Standing on an arm, the other two overhang.
    click(&mut harness, "Least overhang");
    wait(&mut harness);
    assert!(near(size(&harness), DVec3::new(100.0, 100.0, 20.0)), "{}", size(&harness));
    // One step back undoes it.
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    wait(&mut harness);
    assert!(near(size(&harness), DVec3::new(100.0, 20.0, 100.0)), "{}", size(&harness));
}

#[test]
fn a_preform_is_turned_the_way_up_in_which_it_costs_least() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("leaning.stl");
    // It leans by 40°.
    std::fs::write(&path, crosses(&[|p| DVec3::new(p.x, 0.766 * p.y - 0.643 * p.z, 0.643 * p.y + 0.766 * p.z)]))
        .unwrap();
    let mut harness = studio(&folder.path().join("store"));
    harness.state_mut().view().mode = beadwright_studio::view::Mode::Layer;
    harness.state_mut().open(&path);
    wait(&mut harness);
    click(&mut harness, "Placement");
    click(&mut harness, "Preform");
    wait(&mut harness);
    let score = |harness: &Window| {
        let (plan, task) = (harness.state().plan(), Task::new());
        let (Some(Part::Mesh(import)), Some(profile)) = (plan.part.as_deref(), &plan.profile) else { unreachable!() };
        let (settings, rates) = (profile.preform_settings(), profile.preform_rates());
        let mesh = &import.milled.as_ref().unwrap().mesh;
        Oriented::of(mesh, DVec3::NEG_Z, &settings, &rates, &task).unwrap().figures.score()
    };
    let before = score(&harness);
    click(&mut harness, "Cheapest preform");
    wait(&mut harness);
    let after = score(&harness);
    assert!(after < 0.9 * before, "{after}, before {before}");
}

#[test]
fn the_part_is_laid_on_the_face_that_is_clicked() {
    if !has_adapter() {
        return;
    }
    let (_folder, mut harness) = planned("cross");
    click(&mut harness, "Placement");
    // Seen from the front, the end of an arm is in the middle: the cross stands on it. From above it is the upper side.
    for (key, wanted) in [(Key::Num1, DVec3::new(100.0, 20.0, 100.0)), (Key::Num7, DVec3::new(100.0, 100.0, 20.0))] {
        click(&mut harness, "Reset");
        wait(&mut harness);
        harness.key_press(key);
        harness.run_steps(3);
        click(&mut harness, "… by face");
        assert!(sees(&harness, "Click the face that the part should lie on."));
        let middle = harness.get_by_label("3-D view").rect().center();
        click_at(&mut harness, middle);
        wait(&mut harness);
        assert!(!sees(&harness, "Click the face that the part should lie on."));
        assert!(near(size(&harness), wanted), "{}", size(&harness));
    }
    // It lies upside down.
    let turn = harness.state().project().placement.turn;
    assert!(turn.abs().max_element() > 179.9, "{turn}");
}
