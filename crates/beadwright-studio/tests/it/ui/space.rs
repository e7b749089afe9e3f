//! Layers that are not level in the window: the 3-D view shows them in space, the view of a layer unrolled.

use crate::window::{click_at, example, has_adapter, press, sees, wait};
use eframe::egui::{Key, vec2};
use egui_kittest::kittest::Queryable;
use glam::DVec2;

#[test]
fn a_click_on_a_blade_picks_its_bead_on_the_unrolled_layer() {
    if !has_adapter() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let mut harness = example(folder.path(), "hub");
    harness.state_mut().set_value("layers.chart", "cylinder:axis=z,radius=40");
    wait(&mut harness);
    press(&mut harness, Key::F2);
    harness.run_steps(4);
    let rect = harness.get_by_label("3-D view").rect();
    let size = DVec2::new(f64::from(rect.width()), f64::from(rect.height()));
    let (camera, scene) = (harness.state().camera(), &harness.state().plan().scene);
    // The bead of the last layer that is nearest to the viewer.
    let top = scene.layers().len() - 1;
    let beads = scene.layer(top).unwrap().clone();
    let near = |i: &usize| beads.beads()[*i].torch(0.5).at.dot(camera.back());
    let segment = (0..beads.len()).max_by(|a, b| near(a).total_cmp(&near(b))).unwrap();
    let bead = beads.beads()[segment];
    assert!(bead.up().z.abs() < 1e-3 && bead.torch(0.5).at.truncate().length() > 100.0);
    let at = camera.project(bead.torch(0.5).at, size).unwrap();
    click_at(&mut harness, rect.min + vec2(at.x as f32, at.y as f32));
    let (layer, pass, piece) = harness.state_mut().view().chosen.expect("nothing is picked");
    assert_eq!((layer, pass), (top, beads.pass_of(segment)));
    let found = harness.state().plan().layers[layer].passes[pass].clone();
    let length = found.segments().nth(piece).expect("there is no such piece").length();
    assert!(length > 0.0 && sees(&harness, &format!("{:.2} mm", found.length())));
    // What is seen of the view of the layer is all of it.
    press(&mut harness, Key::F3);
    assert_eq!(harness.state_mut().view().chosen, Some((layer, pass, piece)));
    harness.run_steps(2);
}
