//! Two strategies side by side, and findings that lead to their place.

use super::window::{click, example, sees, wait};
use beadwright::plan;
use beadwright::profile::Profile;
use beadwright::report::rows;
use beadwright::task::Task;
use beadwright_studio::view::Mode;
use eframe::egui::{Key, Role};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;

/// Length and passes of the cross under a strategy, as the library plans it.
fn totals(strategy: &str) -> Vec<(&'static str, String)> {
    let mut profile = Profile::built_in("cmt-al2319-kuka").unwrap();
    strategy.clone_into(&mut profile.fill.strategy);
    let mesh = beadwright::example::find("cross").unwrap().mesh();
    rows::totals(&plan::plan("cross", &mesh, &profile, &Task::new()).unwrap().summary.metrics)
}

#[test]
fn two_strategies_are_compared() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = example(folder.path(), "cross");
    harness.key_press(Key::F4);
    harness.run_steps(3);
    assert_eq!(harness.state_mut().view().mode, Mode::Compare);
    harness.get_by_role_and_label(Role::ComboBox, "Other strategy").click();
    harness.run_steps(3);
    click(&mut harness, "hybrid");
    wait(&mut harness);
    let (own, other) = (totals("loop"), totals("hybrid"));
    let mut different = 0;
    for ((name, value), (_, theirs)) in own.iter().zip(&other) {
        assert!(sees(&harness, value) && sees(&harness, theirs), "{name}: {value}, {theirs}");
        different += usize::from(value != theirs);
    }
    assert!(different > 3, "the strategies do the same");
    assert!(sees(&harness, "Layer view") && sees(&harness, "Layer view, other strategy"));
    // The project keeps its own strategy.
    assert!(harness.state().project().profile.contains("strategy = \"loop\""));
}

#[test]
fn a_strategy_that_cannot_be_compared_says_why() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = example(folder.path(), "cross");
    harness.key_press(Key::F4);
    harness.run_steps(3);
    harness.state_mut().compare_with(Some("no-such-strategy"));
    wait(&mut harness);
    assert!(harness.query_by_label_contains("the strategies are loop").is_some(), "no sentence");
}

#[test]
fn a_finding_leads_to_its_bead() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = example(folder.path(), "cross");
    harness.state_mut().set_value("check.max_speed", "1.0");
    wait(&mut harness);
    let findings = harness.state().plan().findings.clone().unwrap();
    let finding = findings.iter().filter(|f| f.pass.is_some() && f.layer > Some(0)).nth(2).unwrap();
    let (layer, pass) = (finding.layer.unwrap(), finding.pass.unwrap());
    click(&mut harness, &format!("Findings ({})", findings.len()));
    // All that say the same are one line, which opens.
    let same: Vec<_> = findings.iter().filter(|f| f.check == finding.check).collect();
    let ends = [same[0], same[same.len() - 1]].map(|f| f.layer.unwrap() + 1);
    click(&mut harness, &format!("{} × {}–{}", same.len(), ends[0], ends[1]));
    harness.run_steps(20);
    // A sentence begins with a capital letter.
    click(&mut harness, &finding.sentence().replacen("layer", "Layer", 1));
    let view = harness.state_mut().view();
    assert_eq!((view.mode, view.last), (Mode::Layer, layer));
    assert_eq!(view.chosen.map(|(l, p, _)| (l, p)), Some((layer, pass)));
    click(&mut harness, "Totals");
    let length = harness.state().plan().layers[layer].passes[pass].length();
    assert!(sees(&harness, &format!("{length:.2} mm")));
}

#[test]
fn two_strategies_are_seen_in_3d_with_one_camera() {
    if !super::window::has_adapter() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let mut harness = example(folder.path(), "cross");
    harness.state_mut().compare_with(Some("zigzag"));
    wait(&mut harness);
    harness.key_press(Key::F4);
    harness.run_steps(2);
    click(&mut harness, "In 3-D");
    harness.remove_cursor();
    harness.run_steps(4);
    let views = ["3-D view", "3-D view, other strategy"];
    let picture = |harness: &mut Harness<'static, beadwright_studio::Studio>, view: &str| {
        let rect = harness.get_by_label(view).rect();
        let whole = harness.render().unwrap();
        let (x, y) = (rect.left().ceil() as u32, rect.top().ceil() as u32);
        let size = [rect.width() as u32 - 2, rect.height() as u32 - 2];
        image::imageops::crop_imm(&whole, x, y, size[0], size[1]).to_image()
    };
    // The plate is the same, at the same place; the beads are others.
    let alike = |harness: &mut Harness<'static, beadwright_studio::Studio>| {
        let [own, other] = views.map(|view| picture(harness, view));
        let same = own.pixels().zip(other.pixels()).filter(|(a, b)| a == b).count();
        same as f64 / f64::from(own.width() * own.height())
    };
    let before = alike(&mut harness);
    assert!((0.4..0.98).contains(&before), "{before:.2} of the pixels are the same");
    // When either is turned, the other follows.
    for view in views {
        let (middle, was) = (harness.get_by_label(view).rect().center(), picture(&mut harness, views[0]));
        harness.drag_at(middle);
        harness.run_steps(1);
        harness.hover_at(middle + eframe::egui::vec2(60.0, 10.0));
        harness.run_steps(2);
        harness.drop_at(middle + eframe::egui::vec2(60.0, 10.0));
        harness.remove_cursor();
        harness.run_steps(6);
        let now = alike(&mut harness);
        assert!((0.4..0.98).contains(&now), "{view} turned: {now:.2} of the pixels are the same");
        assert!(picture(&mut harness, views[0]) != was, "{view} was not turned");
    }
}
