//! Panels: they keep their width, and everything in them is within reach, with large text too.

use crate::window::{Window, click, example, press, search, sees, studio_of_size, wait};
use beadwright_studio::settings::Store;
use beadwright_studio::view::Side;
use eframe::egui::{Key, Rect, Role, pos2};
use egui_kittest::kittest::{NodeT, Queryable};

/// What is between the panels.
fn centre(harness: &Window) -> Rect {
    harness.get_by_label("Layer view").rect()
}

#[test]
fn typing_in_the_search_leaves_panels_as_wide_as_they_are() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = example(folder.path(), "cross");
    press(&mut harness, Key::F3);
    let before = centre(&harness);
    // Lists of lines, long words, nearly all there is.
    for text in ["arc_on", "header", "e", "no such parameter at all"] {
        search(&mut harness, text);
        harness.run_steps(30);
        assert_eq!(centre(&harness), before, "{text}");
        for _ in text.chars() {
            harness.key_press(Key::Backspace);
        }
        harness.run_steps(3);
    }
    click(&mut harness, "all parameters");
    harness.run_steps(30);
    assert_eq!(centre(&harness), before, "all parameters");
}

#[test]
fn the_size_of_the_text_is_in_the_menu_and_is_remembered() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = example(folder.path(), "cross");
    click(&mut harness, "View");
    harness.get_by_label_contains("Text size").click();
    harness.run_steps(5);
    click(&mut harness, "150 %");
    harness.run_steps(3);
    assert_eq!(harness.ctx.zoom_factor(), 1.5);
    assert_eq!(Store::at(folder.path().to_owned()).settings().text_percent, 150);
}

/// What a person acts upon.
const CONTROLS: [Role; 6] =
    [Role::Button, Role::CheckBox, Role::ComboBox, Role::Slider, Role::SpinButton, Role::TextInput];

/// Scrolls to every control in turn and fails if it cannot be seen whole then.
fn all_within_reach(harness: &mut Window, window: Rect, view: &str) {
    let nodes = harness.query_all_by(|node| CONTROLS.contains(&node.role()) && !node.is_disabled());
    let all: Vec<_> = nodes.map(|node| node.accesskit_node().id()).collect();
    assert!(all.len() > 20, "{view}: only {} controls", all.len());
    for id in all {
        let Some(node) = harness.query_by(|node| node.id() == id) else { continue };
        node.scroll_to_me();
        harness.run_steps(6);
        let Some(node) = harness.query_by(|node| node.id() == id) else { continue };
        let (rect, inner) = (node.rect(), node.accesskit_node());
        let middle = window.contains(rect.center());
        let wide = rect.width() > window.width() || rect.left() >= window.left() && rect.right() <= window.right();
        assert!(middle && wide, "{view}: {:?} {:?} at {rect}", inner.role(), inner.label().or_else(|| inner.value()));
    }
}

#[test]
fn text_at_150_percent_keeps_every_control_within_reach() {
    let folder = tempfile::tempdir().unwrap();
    // A window of 1280 × 800 points, as wide as it is for text half as large again.
    let size = [1280.0 / 1.5, 800.0 / 1.5];
    let window = Rect::from_min_max(pos2(0.0, 0.0), size.into());
    let mut harness = studio_of_size(folder.path(), size);
    harness.state_mut().open_example("cross");
    wait(&mut harness);
    for (key, view) in [(Key::F2, "3-D"), (Key::F3, "layer"), (Key::F4, "compare")] {
        press(&mut harness, key);
        all_within_reach(&mut harness, window, view);
    }
    press(&mut harness, Key::F3);
    for side in [Side::Findings, Side::Plots, Side::Export] {
        harness.state_mut().view().side = side;
        harness.run_steps(4);
        all_within_reach(&mut harness, window, &format!("{side:?}"));
    }
}

#[test]
fn a_better_place_for_the_part_is_suggested_and_forgotten_with_the_plan() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = example(folder.path(), "cross");
    click(&mut harness, "Plots");
    let press = |harness: &mut Window, label: &str| {
        harness.get_by_label(label).scroll_to_me();
        harness.run_steps(5);
        click(harness, label);
        wait(harness);
    };
    press(&mut harness, "Check reach");
    let shown = |harness: &Window| harness.query_by_label_contains("The part's origin at").is_some();
    assert!(!shown(&harness));
    press(&mut harness, "Find a better place");
    assert!(shown(&harness));
    harness.state_mut().set_value("process.deposition_speed", "10");
    wait(&mut harness);
    assert!(!shown(&harness));
}

#[test]
fn help_has_first_steps_and_says_what_this_is() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = example(folder.path(), "cross");
    for (entry, text) in [("First steps", "run it without arc"), ("About Beadwright", env!("CARGO_PKG_VERSION"))] {
        assert!(harness.query_by_label_contains(text).is_none(), "{text}");
        click(&mut harness, "Help");
        assert!(sees(&harness, "The book"));
        click(&mut harness, entry);
        assert!(harness.query_by_label_contains(text).is_some(), "{text}");
    }
}
