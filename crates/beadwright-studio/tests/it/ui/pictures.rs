//! What is drawn, by numbers; skipped where there is nothing to draw with.

use crate::window::{click, click_at, example, has_adapter, press, slide, wait};
use beadwright_studio::view2d::heat;
use eframe::egui::{Key, Rect};
use egui_kittest::kittest::Queryable;

/// Pixels of a picture in a part of the window that have a colour of some kind.
fn count(picture: &image::RgbaImage, rect: Rect, is: impl Fn([i16; 3]) -> bool) -> f64 {
    let inside = |x: u32, y: u32| rect.contains([x as f32 + 0.5, y as f32 + 0.5].into());
    let rgb = |p: &image::Rgba<u8>| [0, 1, 2].map(|i| i16::from(p.0[i]));
    picture.enumerate_pixels().filter(|(x, y, p)| inside(*x, *y) && is(rgb(p))).count() as f64
}

#[test]
fn the_heights_of_a_layer_have_the_colours_of_the_report() {
    if !has_adapter() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let mut harness = example(folder.path(), "cross");
    // A strategy that leaves voids.
    harness.state_mut().set_value("fill.strategy", "contour");
    wait(&mut harness);
    press(&mut harness, Key::F3);
    for hidden in ["Path", "Travels", "Starts and ends"] {
        click(&mut harness, hidden);
    }
    harness.remove_cursor();
    harness.run_steps(2);
    let rect = harness.get_by_label("Layer view").rect();
    let scale = f64::from(rect.width().min(rect.height())) / 115.0;
    // Two arms of 36 × 100 mm, crossed.
    let area = (2.0 * 36.0 * 100.0 - 36.0 * 36.0) * scale * scale;
    // Beads lie over the background as a haze of their hue: contours blue, infill orange.
    let picture = harness.render().unwrap();
    let coloured = count(&picture, rect, |[r, g, b]| (r - b).abs() > 25 || (r - g).abs() > 25);
    assert!((0.85..1.1).contains(&(coloured / area)), "beads cover {:.2} of the cross", coloured / area);

    click(&mut harness, "Heights and voids");
    harness.remove_cursor();
    harness.run_steps(2);
    let picture = harness.render().unwrap();
    let ramp: Vec<[i16; 3]> =
        (0..=200).map(|i| heat(f64::from(i) / 100.0)).map(|c| [c.r(), c.g(), c.b()].map(i16::from)).collect();
    let on_ramp = |c: [i16; 3]| ramp.iter().any(|r| (0..3).all(|i| (r[i] - c[i]).abs() <= 4));
    let heights = count(&picture, rect, on_ramp);
    assert!((0.8..1.1).contains(&(heights / area)), "heights cover {:.2} of the cross", heights / area);
    // Contours leave voids in the corners and along the middle; rings mark them too.
    let voids = count(&picture, rect, |[r, g, b]| r > 200 && g < 60 && (100..200).contains(&b)) / area;
    assert!((0.005..0.1).contains(&voids), "voids cover {:.3} of the cross", voids);
    // Most of the layer is about as high as it should be: the colour of 1 is nearly white.
    let level = count(&picture, rect, |c| c.iter().all(|v| *v > 190));
    assert!(level / area > 0.3, "{:.2} of the cross is level", level / area);
}

#[test]
fn a_click_in_the_3d_view_picks_the_bead_that_is_seen() {
    if !has_adapter() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let mut harness = example(folder.path(), "cross");
    harness.key_press(Key::Num7);
    harness.run_steps(5);
    let rect = harness.get_by_label("3-D view").rect();
    // From above the middle of the view is the axis of the cross, and its uppermost bead is hit.
    click_at(&mut harness, rect.center());
    let top = harness.state().plan().layers.len() - 1;
    let (layer, pass, piece) = harness.state_mut().view().chosen.expect("nothing is picked");
    assert_eq!(layer, top);
    let found = harness.state().plan().layers[layer].passes[pass].clone();
    let segment = found.segments().nth(piece).unwrap();
    let (a, b) = (segment.from.truncate(), segment.to.truncate());
    let along = (-a.dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
    let beside = a.lerp(b, along).length();
    assert!(beside <= segment.width / 2.0 + 0.1, "the bead lies {beside:.1} mm beside the click");
    assert!(crate::window::sees(&harness, &format!("{:.2} mm", found.length())));
    // Fewer layers: the one that is then uppermost.
    slide(&mut harness, "Last layer", 5.0);
    click_at(&mut harness, rect.center());
    assert_eq!(harness.state_mut().view().chosen.map(|chosen| chosen.0), Some(4));
    // Beside the part there is nothing.
    click_at(&mut harness, rect.left_top() + eframe::egui::vec2(8.0, 8.0));
    assert_eq!(harness.state_mut().view().chosen, None);
}
