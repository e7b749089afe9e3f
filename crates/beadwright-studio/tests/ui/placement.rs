//! Where the part stands.

use super::window::{click, crosses, studio, type_number, wait};
use beadwright_studio::Studio;
use egui_kittest::Harness;
use glam::DVec3;

fn size(harness: &Harness<'static, Studio>) -> DVec3 {
    let (low, high) = harness.state().plan().part.as_ref().unwrap().bounds();
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
}
