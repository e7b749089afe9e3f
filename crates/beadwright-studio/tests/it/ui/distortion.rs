//! The bent shape is computed when it is asked for, and shown with its figures.

use crate::window::{Window, click, example, has_adapter, open_list, sees, slide, studio, wait};
use beadwright::distort::Distortion;
use beadwright::distortion::{Clamps, Setup, Welding};
use beadwright::layer::Layer;
use beadwright::profile::Profile;
use beadwright::task::Task;
use beadwright_studio::actions::Action;
use eframe::egui::Role;
use egui_kittest::kittest::{NodeT, Queryable};
use std::path::Path;

/// What the command computes of the plan in the window.
fn built(harness: &Window, clamps: Clamps) -> Distortion {
    let plan = harness.state().plan();
    let profile = plan.profile.as_ref().unwrap();
    let layers: Vec<Layer> = plan.layers.iter().map(|layer| (**layer).clone()).collect();
    let welding = Welding::of(&layers, profile).unwrap();
    Setup { clamps, ..Setup::default() }.build(&welding, profile, &Task::new()).unwrap()
}

/// The lift of the plate as it is shown.
fn lift(built: &Distortion) -> String {
    let [clamped, released] = [&built.clamped, &built.released].map(|shape| shape.lift.range);
    format!("Lift of the plate: clamped {clamped:.2} mm, released {released:.2} mm")
}

#[test]
fn the_bent_shape_is_shown_with_the_figures_of_the_command() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = example(folder.path(), "cross");
    click(&mut harness, "Bent shape");
    wait(&mut harness);
    let corners = built(&harness, Clamps::Corners);
    assert!(sees(&harness, &lift(&corners)), "{}", lift(&corners));
    let [clamped, released] = [&corners.clamped, &corners.released].map(|shape| shape.deviation.largest);
    assert!(sees(&harness, &format!("Deviation of the part: clamped {clamped:.2} mm, released {released:.2} mm")));
    // Without clamps nothing springs.
    open_list(&mut harness, "Clamps");
    click(&mut harness, "none");
    wait(&mut harness);
    assert_eq!(harness.state_mut().view().bend.times, None, "nobody has chosen the exaggeration");
    assert!(!sees(&harness, "released"), "nothing is released");
    let free = built(&harness, Clamps::None);
    assert!(sees(&harness, &lift(&free)) && lift(&free) != lift(&corners), "{}", lift(&free));
    // Another plan has another shape.
    harness.state_mut().set_value("layers.height", "2.5");
    wait(&mut harness);
    let thinner = built(&harness, Clamps::None);
    assert!(sees(&harness, &lift(&thinner)) && lift(&thinner) != lift(&free), "{}", lift(&thinner));
    click(&mut harness, "Bent shape");
    assert!(!sees(&harness, &lift(&thinner)));
}

#[test]
fn the_slider_exaggerates_what_is_seen() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = example(folder.path(), "cross");
    let place = |harness: &Window| harness.state().plan().scene.drawn_layer(0).unwrap().beads()[0].from().as_dvec3();
    let planned = place(&harness);
    let torch = |harness: &Window| {
        let scene = &harness.state().plan().scene;
        scene.at_time(0.4 * scene.total_seconds())
    };
    let at = torch(&harness);
    click(&mut harness, "Bent shape");
    wait(&mut harness);
    let slider = harness.get_by_role_and_label(Role::Slider, "Exaggeration");
    assert!(slider.accesskit_node().numeric_value().unwrap() >= 1.0);
    let moved = [0.0, 1.0, 100.0].map(|times| {
        slide(&mut harness, "Exaggeration", times);
        harness.run_steps(2);
        place(&harness) - planned
    });
    let [zero, one, hundred] = moved;
    assert!(zero.length() == 0.0 && one.length() > 0.0 && one.length() < 5.0, "{moved:?}");
    assert!(hundred.abs_diff_eq(100.0 * one, 0.01), "{moved:?}");
    // Program and arm follow the plan, not what is exaggerated.
    assert_eq!(torch(&harness), at);
    let layer = |i| harness.state().plan().scene.layer(i).unwrap().len();
    let drawn = |i| harness.state().plan().scene.drawn_layer(i).unwrap().len();
    for shown in [0, 1, layer(2) / 2, layer(2)] {
        let segments = harness.state().plan().scene.drawn_segments(2, shown);
        assert!(segments >= shown && segments <= drawn(2), "{segments} for {shown}");
        assert_eq!(segments == drawn(2), shown == layer(2));
    }
    if has_adapter() {
        slide(&mut harness, "Exaggeration", 20.0);
        harness.key_press(eframe::egui::Key::F);
        harness.run_steps(4);
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("bent.png");
        harness.render().unwrap().save(path).unwrap();
    }
    // A single layer is shown as planned.
    click(&mut harness, "Layer");
    harness.run_steps(2);
    assert_eq!(place(&harness), planned);
}

#[test]
fn computing_can_be_given_up() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = example(folder.path(), "cross");
    for giving_up in [Action::StopDistortion, Action::Stop] {
        // No frame takes the result in between.
        harness.state_mut().view().bend.shown = true;
        harness.state_mut().act(Action::Distort);
        assert!(!harness.state().is_idle());
        harness.state_mut().act(giving_up);
        assert!(harness.state().is_idle() && !harness.state_mut().view().bend.shown);
        harness.run_steps(2);
        assert!(!sees(&harness, "Clamps"));
    }
}

#[test]
fn a_profile_without_a_plate_says_what_to_add() {
    let folder = tempfile::tempdir().unwrap();
    let text = Profile::built_in_text("cmt-al2319-kuka").unwrap();
    let (before, rest) = text.split_once("[substrate]").unwrap();
    let (_, after) = rest.split_once("# No pass begins").unwrap();
    let mut harness = studio(folder.path());
    harness.state_mut().act(Action::SetProfile(format!("{before}# {after}").leak()));
    harness.state_mut().open_example("cross");
    wait(&mut harness);
    click(&mut harness, "Bent shape");
    wait(&mut harness);
    let sentence = "The distortion cannot be computed: the profile has no section [substrate]. Add it";
    assert!(harness.query_by_label_contains(sentence).is_some());
}
