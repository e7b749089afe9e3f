//! The part is moved and turned by handles, from any side, and by arrow keys.

use crate::window::{Window, bounds, button, click, drag, has_adapter, planned, pull, sees, wait};
use beadwright_studio::view3d::Camera;
use eframe::egui::{Key, Modifiers, Pos2, Rect, Role, vec2};
use egui_kittest::kittest::Queryable;
use glam::{DVec2, DVec3};
use tempfile::TempDir;

/// Where a pinhole camera with 35° from top to bottom shows a place, mm.
fn seen(camera: &Camera, rect: Rect, place: DVec3) -> Pos2 {
    let (sin, cos) = camera.pitch.sin_cos();
    let back = DVec3::new(cos * camera.yaw.cos(), cos * camera.yaw.sin(), sin);
    let eye = camera.target + back * camera.distance;
    let right = DVec3::Z.cross(back).try_normalize().unwrap_or(DVec3::new(-camera.yaw.sin(), camera.yaw.cos(), 0.0));
    let (from_eye, up) = (place - eye, back.cross(right));
    let depth = if camera.orthographic { camera.distance } else { -from_eye.dot(back) };
    let scale = f64::from(rect.height()) / 2.0 / (17.5_f64.to_radians().tan() * depth);
    rect.center() + vec2((from_eye.dot(right) * scale) as f32, (-from_eye.dot(up) * scale) as f32)
}

/// Middle of the part on its plate.
fn foot(harness: &Window) -> DVec2 {
    let (low, high) = bounds(harness);
    ((low + high) / 2.0).truncate()
}

fn handle(harness: &Window, name: &str) -> Pos2 {
    harness.get_by_role_and_label(Role::Button, name).rect().center()
}

/// The cross with its handles.
fn placing() -> (TempDir, Window) {
    let (folder, mut harness) = planned("cross");
    click(&mut harness, "Place");
    assert!(sees(&harness, "Drag the arrows or the ring. Arrow keys move by 1 mm, with Shift by 10 mm."));
    (folder, harness)
}

#[test]
fn an_arrow_that_is_dragged_moves_the_part_by_what_is_seen() {
    if !has_adapter() {
        return;
    }
    let (_folder, mut harness) = placing();
    let beads = |harness: &Window| harness.state().plan().layers[0].passes[0].points[0];
    let (first, bead) = (foot(&harness), beads(&harness));
    let mut wanted = first;
    // From above, from a corner, turned by hand, and as a parallel projection.
    let views: [(Option<Key>, [f32; 2]); 4] =
        [(Some(Key::Num7), [0.0, 0.0]), (Some(Key::Num0), [0.0, 0.0]), (None, [170.0, 35.0]), (None, [-310.0, -20.0])];
    for (number, (key, turned)) in views.into_iter().enumerate() {
        harness.state_mut().view().parallel = number == 3;
        key.into_iter().for_each(|key| harness.key_press(key));
        harness.run_steps(3);
        if key.is_none() {
            let free = harness.get_by_label("3-D view").rect().left_top() + vec2(320.0, 20.0);
            drag(&mut harness, free, free + vec2(turned[0], turned[1]));
            assert_eq!(foot(&harness), wanted, "a drag beside the handles moved the part");
        }
        for (name, way, by) in [("Move along x", DVec2::X, 25.0), ("Move along y", DVec2::Y, -12.0)] {
            let (camera, rect) = (harness.state().camera(), harness.get_by_label("3-D view").rect());
            let (low, high) = bounds(&harness);
            let reach = 1.15 * (high - low).truncate().length() / 2.0;
            let tip = (wanted + way * reach).extend(low.z);
            let from = handle(&harness, name);
            assert!(from.distance(seen(&camera, rect, tip)) < 0.01, "{name} is not where its place is seen");
            let to = seen(&camera, rect, tip + (way * by).extend(0.0));
            drag(&mut harness, from, to);
            wanted += way * by;
            let found = foot(&harness);
            assert!(found.distance(wanted) < 0.051, "view {number}: {name} by {by} leads to {found}, not {wanted}");
            wanted = found;
        }
    }
    // The beads have gone there too, and come back.
    let moved = beads(&harness) - bead;
    assert!(moved.truncate().distance(wanted - first) < 1e-3 && moved.z.abs() < 1e-9, "beads were moved by {moved}");
    for _ in 0..8 {
        harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
        wait(&mut harness);
    }
    assert_eq!((foot(&harness), beads(&harness)), (first, bead));
}

#[test]
fn the_ring_turns_the_part_about_its_middle() {
    if !has_adapter() {
        return;
    }
    let (_folder, mut harness) = placing();
    let (camera, rect) = (harness.state().camera(), harness.get_by_label("3-D view").rect());
    let (low, high) = bounds(&harness);
    let (middle, reach) = (foot(&harness), 1.15 * (high - low).truncate().length() / 2.0);
    let on_ring = |angle: f64| (middle + DVec2::from_angle(angle.to_radians()) * reach).extend(low.z);
    let from = handle(&harness, "Turn about z");
    assert!(from.distance(seen(&camera, rect, on_ring(-135.0))) < 0.01);
    let to = seen(&camera, rect, on_ring(-105.0));
    pull(&mut harness, from, to);
    assert!(sees(&harness, "Turn about z +30.0°"), "the figure is not shown");
    assert_eq!(foot(&harness), middle, "it moves before the handle is let go");
    button(&mut harness, to, false);
    wait(&mut harness);
    assert!((harness.state().project().placement.turn.z - 30.0).abs() < 1e-9);
    // A cross with arms 36 mm wide and 100 mm long, turned by 30°: as wide as one arm's turned rectangle.
    let across = 100.0 * 30.0_f64.to_radians().cos() + 36.0 * 30.0_f64.to_radians().sin();
    let (low, high) = bounds(&harness);
    assert!(((high - low).truncate() - DVec2::splat(across)).length() < 1e-3, "{}", high - low);
    assert!(foot(&harness).distance(middle) < 1e-3);
}

#[test]
fn arrow_keys_move_the_part_the_way_it_is_seen() {
    let (_folder, mut harness) = placing();
    let shift = |harness: &Window| harness.state().project().placement.shift;
    let press = |harness: &mut Window, modifiers: Modifiers, key: Key| {
        harness.key_press_modifiers(modifiers, key);
        harness.run_steps(2);
    };
    press(&mut harness, Modifiers::NONE, Key::Num7);
    press(&mut harness, Modifiers::NONE, Key::ArrowRight);
    press(&mut harness, Modifiers::SHIFT, Key::ArrowUp);
    assert_eq!(shift(&harness), DVec2::new(1.0, 10.0));
    // From the right, y goes to the right, and away is −x.
    press(&mut harness, Modifiers::NONE, Key::Num3);
    press(&mut harness, Modifiers::NONE, Key::ArrowRight);
    press(&mut harness, Modifiers::SHIFT, Key::ArrowUp);
    assert_eq!(shift(&harness), DVec2::new(-9.0, 11.0));
    press(&mut harness, Modifiers::SHIFT, Key::ArrowLeft);
    press(&mut harness, Modifiers::NONE, Key::ArrowDown);
    assert_eq!(shift(&harness), DVec2::new(-8.0, 1.0));
    wait(&mut harness);
    assert!(foot(&harness).distance(DVec2::new(-8.0, 1.0)) < 1e-9);
    // Without the tool they do nothing.
    press(&mut harness, Modifiers::NONE, Key::M);
    press(&mut harness, Modifiers::NONE, Key::ArrowRight);
    assert_eq!(shift(&harness), DVec2::new(-8.0, 1.0));
}
