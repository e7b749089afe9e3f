//! Every control has a name and is reached by Tab.

use crate::window::{Window, example, press, studio, wait};
use beadwright::fill::StrategyName;
use eframe::egui::{Key, Role};
use egui_kittest::kittest::{NodeT, Queryable};
use glam::DVec2;
use std::collections::BTreeSet;

/// What a person acts upon.
const CONTROLS: [Role; 9] = [
    Role::Button,
    Role::CheckBox,
    Role::RadioButton,
    Role::ComboBox,
    Role::Slider,
    Role::SpinButton,
    Role::TextInput,
    Role::Link,
    Role::Image,
];

/// The controls of the window that are not switched off: their role, name and place.
fn controls(harness: &Window) -> BTreeSet<String> {
    let nodes = harness.query_all_by(|node| CONTROLS.contains(&node.role()) && !node.is_disabled());
    nodes.map(|node| described(&node)).collect()
}

fn described(node: &egui_kittest::Node<'_>) -> String {
    let (inner, rect) = (node.accesskit_node(), node.rect());
    let name = inner.label().or_else(|| inner.value()).unwrap_or_default();
    assert!(!name.trim().is_empty(), "a {:?} at {rect} has no name", inner.role());
    format!("{:?} {name:?} at {:.0} {:.0}", inner.role(), rect.left(), rect.top())
}

fn focused(harness: &Window) -> Option<String> {
    let mut nodes = harness.query_all_by(|node| node.is_focused());
    let found = nodes.find(|node| CONTROLS.contains(&node.accesskit_node().role()));
    found.map(|node| described(&node))
}

/// Goes round with Tab and fails if a control is left out.
fn go_round(harness: &mut Window, view: &str) {
    let all = controls(harness);
    assert!(all.len() > 15, "{view}: only {} controls", all.len());
    let mut reached = BTreeSet::new();
    for _ in 0..2 * all.len() + 20 {
        harness.key_press(Key::Tab);
        harness.run_steps(1);
        reached.extend(focused(harness));
    }
    let missed: Vec<_> = all.difference(&reached).collect();
    assert!(missed.is_empty(), "{view}: Tab does not reach {missed:#?}");
}

#[test]
fn tab_reaches_every_control() {
    let folder = tempfile::tempdir().unwrap();
    go_round(&mut studio(&folder.path().join("new")), "start");
    let mut harness = example(folder.path(), "cross");
    go_round(&mut harness, "3-D");
    press(&mut harness, Key::Escape);
    press(&mut harness, Key::M);
    go_round(&mut harness, "3-D with handles");
    // Arrow keys belong to the handle that Tab has reached.
    let shift = |harness: &Window| harness.state().project().placement.shift;
    for (handle, moved) in [("Move along x", DVec2::new(1.0, 0.0)), ("Move along y", DVec2::new(1.0, 1.0))] {
        while !harness.query_all_by(|node| node.is_focused()).any(|node| described(&node).contains(handle)) {
            harness.key_press(Key::Tab);
            harness.run_steps(1);
        }
        press(&mut harness, Key::ArrowUp);
        assert_eq!(shift(&harness), moved, "{handle}");
    }
    wait(&mut harness);
    harness.state_mut().compare_with(Some(StrategyName::Hybrid));
    wait(&mut harness);
    for (key, view) in [(Key::F3, "layer"), (Key::F4, "compare")] {
        press(&mut harness, Key::Escape);
        press(&mut harness, key);
        go_round(&mut harness, view);
    }
}
