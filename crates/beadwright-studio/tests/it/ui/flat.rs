//! The layer view: beads under the pointer, and the measure.

use crate::window::{Window, click, click_at, example, press, sees, slide, wait};
use eframe::egui::{Key, Pos2, vec2};
use egui_kittest::kittest::Queryable;

/// Where a point of the cross, mm, is in the layer view: its 100 mm square fills the view but for a margin of 15 %.
fn place(harness: &Window, x: f64, y: f64) -> Pos2 {
    let rect = harness.get_by_label("Layer view").rect();
    let scale = f64::from(rect.width().min(rect.height())) / 115.0;
    rect.center() + vec2((x * scale) as f32, (-y * scale) as f32)
}

fn layer_view(folder: &std::path::Path) -> Window {
    let mut harness = example(folder, "cross");
    press(&mut harness, Key::F3);
    harness
}

#[test]
fn a_click_on_a_bead_shows_its_values() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = layer_view(folder.path());
    let layers = harness.state().plan().layers.clone();
    let profile = harness.state().plan().profile.clone().unwrap();
    slide(&mut harness, "Layer", 4.0);
    for (number, pass) in layers[3].passes.iter().enumerate() {
        let longest = |(_, s): &(usize, beadwright::pass::Segment)| s.from.distance(s.to);
        let segments = pass.segments().enumerate();
        let (piece, segment) = segments.max_by(|a, b| longest(a).total_cmp(&longest(b))).unwrap();
        let middle = (segment.from + segment.to) / 2.0;
        let at = place(&harness, middle.x, middle.y);
        click_at(&mut harness, at);
        assert_eq!(harness.state_mut().view().chosen, Some((3, number, piece)));
        let wire = profile.process.wire_feed_speed / 60.0 * pass.seconds(&profile.process);
        for value in [
            format!("{:.2} mm", pass.length()),
            format!("{:.2} mm/s", segment.pace),
            format!("{:.2} mm", segment.width),
            format!("{wire:.2} m"),
            format!("{:.1} s", pass.seconds(&profile.process)),
            pass.kind.name().to_owned(),
        ] {
            assert!(sees(&harness, &value), "{value} is not on the screen");
        }
    }
    // Beside the part.
    let beside = place(&harness, 45.0, 45.0);
    click_at(&mut harness, beside);
    assert_eq!(harness.state_mut().view().chosen, None);
    assert!(sees(&harness, "Click a bead to see its values."));
}

#[test]
fn a_distance_is_measured() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = layer_view(folder.path());
    click(&mut harness, "Measure");
    let chosen = harness.state_mut().view().chosen;
    // 70² + 24² = 74².
    for (x, y) in [(-40.0, 0.0), (30.0, 24.0)] {
        let at = place(&harness, x, y);
        click_at(&mut harness, at);
    }
    assert!(sees(&harness, "74.00 mm"), "the distance is not on the screen");
    assert_eq!(harness.state_mut().view().chosen, chosen);
    // A third point begins anew.
    let at = place(&harness, 0.0, 0.0);
    click_at(&mut harness, at);
    assert!(!sees(&harness, "74.00 mm"));
}

#[test]
fn a_layer_without_regions_is_looked_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("two.stl");
    // One above the other, with air between.
    std::fs::write(&path, crate::window::crosses(&[|p| p, |p| p.with_z(p.z + 40.0)])).unwrap();
    let mut harness = crate::window::studio(&folder.path().join("store"));
    harness.state_mut().set_value("layers.level", "false");
    harness.state_mut().open(&path);
    wait(&mut harness);
    assert!(harness.state().plan().is_complete(), "{:?}", harness.state().plan().failure);
    let layers = &harness.state().plan().layers;
    assert!(layers.len() == 30 && layers[14].islands.is_empty());
    harness.state_mut().view().look_at(14);
    press(&mut harness, Key::F3);
    click(&mut harness, "Steps");
    wait(&mut harness);
    for _ in 0..20 {
        harness.run_steps(1);
        assert!(harness.state().is_idle(), "the regions are worked out again and again");
    }
}
