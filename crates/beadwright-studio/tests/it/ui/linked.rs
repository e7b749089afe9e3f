//! A bead chosen in one view is chosen in the others.

use crate::window::{Window, click, click_at, colour_range, example, has_adapter, open_list, press, sees, slide, wait};
use eframe::egui::{Key, Role};
use egui_kittest::kittest::{NodeT, Queryable};

#[test]
fn a_bead_clicked_in_3d_is_the_one_of_the_layer_view_and_back() {
    if !has_adapter() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let mut harness = example(folder.path(), "cross");
    let top = harness.state().plan().layers.len() - 1;
    press(&mut harness, Key::Num7);
    slide(&mut harness, "Last layer", 5.0);
    let middle = harness.get_by_label("3-D view").rect().center();
    click_at(&mut harness, middle);
    let chosen = harness.state_mut().view().chosen.unwrap();
    assert_eq!(chosen.0, 4);
    let (layer, pass, piece) = chosen;
    let plan = harness.state().plan();
    let found = &plan.layers[layer].passes[pass];
    let width = found.segments().nth(piece).unwrap().width;
    let beads = plan.scene.layer(layer).unwrap();
    let seconds =
        plan.scene.seconds_before(layer) + beads.times(beads.passes()[pass].segments.start + piece).unwrap().0;
    let whole = seconds.round() as u64;
    let figures = [
        "Layer 5".to_owned(),
        format!("Pass {} / {}", pass + 1, plan.layers[layer].passes.len()),
        format!("Width {width:.2} mm"),
        format!("after {}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60),
        found.kind.name().to_owned(),
    ];
    slide(&mut harness, "Last layer", top as f64 + 1.0);
    assert!(figures.iter().all(|figure| sees(&harness, figure)), "{figures:?}");
    // The layer view goes to its layer, and shows the same values.
    press(&mut harness, Key::F3);
    assert_eq!((harness.state_mut().view().last, harness.state_mut().view().chosen), (4, Some(chosen)));
    assert!(figures.iter().all(|figure| sees(&harness, figure)), "{figures:?}");
    // Back in 3-D there are all layers again.
    press(&mut harness, Key::F2);
    assert_eq!((harness.state_mut().view().last, harness.state_mut().view().chosen), (top, Some(chosen)));
    // Another bead of the layer view is the one of 3-D.
    press(&mut harness, Key::F3);
    let middle = harness.get_by_label("Layer view").rect().center();
    click_at(&mut harness, middle);
    let other = harness.state_mut().view().chosen.unwrap();
    press(&mut harness, Key::F2);
    assert_eq!(harness.state_mut().view().chosen, Some(other));
    assert!(sees(&harness, &format!("Layer {}", other.0 + 1)));
}

#[test]
fn a_slider_goes_from_pass_to_pass() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = example(folder.path(), "cross");
    harness.state_mut().set_value("fill.strategy", "contour");
    wait(&mut harness);
    let passes = harness.state().plan().scene.layer(2).unwrap().passes().to_vec();
    assert!(passes.len() > 3);
    slide(&mut harness, "Last layer", 3.0);
    let segments = passes.last().unwrap().segments.end as f64;
    for (i, pass) in passes.iter().enumerate() {
        slide(&mut harness, "Last pass", i as f64 + 1.0);
        let shown = harness.state_mut().view().progress * segments;
        assert!((shown - pass.segments.end as f64).abs() < 1e-6, "{shown} of {segments} pieces");
    }
}

#[test]
fn the_section_is_chosen_moved_and_turned() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = example(folder.path(), "cross");
    assert!(harness.state_mut().view().section.is_none());
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        open_list(&mut harness, "Section");
        harness.get_by_role_and_label(Role::Button, name).click();
        harness.run_steps(3);
        let section = harness.state_mut().view().section.unwrap();
        // The view from a corner: right, in front, above. What is nearer is cut away.
        assert_eq!((section.axis, section.lower), (axis, axis == 1));
    }
    harness.get_by_role_and_label(Role::Slider, "at").set_value_accesskit(7.5);
    click(&mut harness, "other side");
    let section = harness.state_mut().view().section.unwrap();
    assert!((section.at - 7.5).abs() < 1e-9 && section.lower);
    open_list(&mut harness, "Section");
    harness.get_by_role_and_label(Role::Button, "off").click();
    harness.run_steps(3);
    assert!(harness.state_mut().view().section.is_none());
}

#[test]
fn the_arm_reaches_the_chosen_bead_and_shows_its_joints() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = example(folder.path(), "cross");
    harness.state_mut().view().chosen = Some((3, 0, 0));
    click(&mut harness, "Robot");
    wait(&mut harness);
    let joints = |harness: &Window| -> Vec<String> {
        let labels = harness.query_all_by_label_contains("J");
        labels
            .filter_map(|node| node.accesskit_node().label().or(node.accesskit_node().value()))
            .filter(|label| label.ends_with('°'))
            .collect()
    };
    let first = joints(&harness);
    assert_eq!(first.len(), 6, "{first:?}");
    assert!(harness.query_all_by_label_contains("margin: ").next().is_some());
    // Another bead, other angles; another arm, others again.
    harness.state_mut().view().chosen = Some((9, 0, 40));
    harness.run_steps(2);
    let second = joints(&harness);
    assert_ne!(first, second);
    open_list(&mut harness, "Robot cell");
    click(&mut harness, "abb-irb2600-12-165");
    wait(&mut harness);
    let third = joints(&harness);
    assert!(third.len() == 6 && third != second, "{third:?}");
}

#[test]
fn temperatures_are_computed_when_they_are_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = example(folder.path(), "cross");
    open_list(&mut harness, "Colour");
    click(&mut harness, "temperature");
    wait(&mut harness);
    let plan = harness.state().plan();
    let hottest = plan.scene.temperature(plan.layers.len() - 1, 0).unwrap();
    // Warmer than the first bead on the cold plate, colder than liquid aluminium.
    let first = plan.scene.temperature(0, 0).unwrap();
    assert!(first < 30.0 && hottest > first + 20.0 && hottest < 640.0, "{first} to {hottest} °C");
    assert!(colour_range(&harness)[1].ends_with(" °C"));
}
