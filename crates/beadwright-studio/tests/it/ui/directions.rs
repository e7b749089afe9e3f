//! Divisions of the part into bodies: found as by the command, listed with what they cost or why they cannot be welded, used.

use crate::window::{Window, click, press, sees, studio, wait};
use beadwright::directions::{Found, Outcome, Settings, Tried, tried};
use beadwright::model::solid::Solid;
use beadwright::model::stl;
use beadwright::planar::{Polygon, Ring};
use beadwright::profile::{Body, Profile};
use beadwright::task::Task;
use beadwright_studio::actions::Action;
use beadwright_studio::view::{Mode, Side};
use eframe::egui::{Key, Modifiers};
use egui_kittest::kittest::{NodeT, Queryable};
use glam::{DVec2, DVec3};
use std::path::Path;
use tempfile::TempDir;

/// A post with an arm on each side, and a bridge on two posts, which no planes divide: outlines in x and z, mm.
const ARMS: [[f64; 2]; 12] = [
    [-20.0, 0.0],
    [20.0, 0.0],
    [20.0, 60.0],
    [90.0, 60.0],
    [90.0, 90.0],
    [20.0, 90.0],
    [0.0, 90.0],
    [-20.0, 90.0],
    [-20.0, 65.0],
    [-80.0, 65.0],
    [-80.0, 40.0],
    [-20.0, 40.0],
];
const BRIDGE: [[f64; 2]; 8] =
    [[-60.0, 0.0], [-30.0, 0.0], [-30.0, 60.0], [30.0, 60.0], [30.0, 0.0], [60.0, 0.0], [60.0, 90.0], [-60.0, 90.0]];

/// A window with a sheet of this outline, 24 mm thick.
fn opened(outline: &[[f64; 2]]) -> (TempDir, Window) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("post.stl");
    let outline = Polygon::simple(Ring::new(outline.iter().copied().map(DVec2::from).collect()));
    let Solid { vertices, triangles } = Solid::extrude(&outline, 0.0, 24.0);
    let upright = |p: DVec3| DVec3::new(p.x, -p.z, p.y);
    let corners = triangles.iter().map(|triangle| triangle.map(|corner| upright(vertices[corner as usize])));
    std::fs::write(&path, stl::write("post", corners)).unwrap();
    let mut harness = studio(&folder.path().join("store"));
    harness.state_mut().act(Action::SetProfile(Profile::built_in_text("cmt-steel-abb").unwrap()));
    harness.state_mut().set_value("cost.wire_kg", "20.0");
    harness.state_mut().open(&path);
    wait(&mut harness);
    (folder, harness)
}

/// The same with its divisions found, by the button beside those that turn the part.
fn divided(outline: &[[f64; 2]]) -> (TempDir, Window) {
    let (folder, mut harness) = opened(outline);
    click(&mut harness, "Placement");
    click(&mut harness, "Find directions");
    assert_eq!(harness.state_mut().view().side, Side::Directions);
    wait(&mut harness);
    (folder, harness)
}

/// What the command finds of the part in the window, in its order.
fn found(harness: &Window) -> (f64, Vec<Tried>) {
    let (profile, part) = (profile(harness), harness.state().plan().part.clone().unwrap());
    let settings = Settings::usual(profile.bead.width);
    let found: Found = tried("post", &part, &profile, false, settings, &Task::new()).unwrap();
    (found.level, found.offered().cloned().collect())
}

fn profile(harness: &Window) -> Profile {
    Profile::parse(&harness.state().project().profile).unwrap()
}

fn says(harness: &Window, text: &str) -> bool {
    harness.query_by_label_contains(text).is_some()
}

#[test]
fn divisions_are_listed_with_what_the_command_says_of_them() {
    let (_folder, harness) = divided(&ARMS);
    let (level, offered) = found(&harness);
    assert!(sees(&harness, &format!("Overhang in level layers: {:.1} cm²", level / 100.0)));
    assert!(offered[0].is_planned() && offered[0].bodies.len() == 3);
    let planned = offered.iter().filter(|tried| tried.is_planned()).take(3);
    let refused = offered.iter().filter(|tried| !tried.is_planned());
    for (tried, number) in planned.chain(refused).zip(1..) {
        assert!(sees(&harness, &format!("{number}. {} bodies", tried.bodies.len())), "{number}");
        let overhang = format!("{:.1} cm²", tried.division.hanging / 100.0);
        match &tried.outcome {
            Outcome::Planned(metrics) => {
                let price = format!("{:.0} {}", metrics.cost.unwrap(), metrics.currency);
                let figures = [format!("{:.2} kg", metrics.wire_mass_kg), price, overhang];
                let hours = format!("{:.2} h", metrics.total_time_s / 3600.0);
                assert!(figures.iter().chain([&hours]).all(|figure| sees(&harness, figure)), "{figures:?} {hours}");
            }
            Outcome::Refused { .. } => {
                let refusal = tried.refusal().unwrap();
                assert!(sees(&harness, &refusal), "{refusal}");
            }
            Outcome::Untried => panic!("{number} is not tried"),
        }
    }
}

#[test]
fn what_cannot_be_welded_says_why() {
    let (_folder, harness) = divided(&BRIDGE);
    let (_, offered) = found(&harness);
    assert!(sees(&harness, "Cannot be welded:") && !sees(&harness, "Wire"), "nothing can be");
    for tried in offered {
        let refusal = tried.refusal().unwrap_or_else(|| panic!("{:?}", tried.bodies));
        assert!(sees(&harness, &refusal), "{refusal}");
    }
}

#[test]
fn a_division_is_used_in_one_step_that_can_be_undone() {
    let (_folder, mut harness) = divided(&ARMS);
    let before = harness.state().project().clone();
    let best = found(&harness).1.swap_remove(0);
    click(&mut harness, "1. 3 bodies");
    click(&mut harness, "Use this division");
    wait(&mut harness);
    let bodies = profile(&harness).layers.bodies;
    assert_eq!(bodies, Body::read(&Body::write(&best.bodies)).unwrap(), "as the command writes them");
    let Outcome::Planned(metrics) = &best.outcome else { panic!("{:?}", best.outcome) };
    let plan = harness.state().plan();
    assert_eq!(**metrics, plan.summary.as_ref().unwrap().metrics, "the plan follows");
    assert_eq!(plan.scene.layers().len(), metrics.layers);
    assert_eq!(harness.state_mut().view().division, None, "its beads are in view");
    // It stays listed, and is marked.
    click(&mut harness, "1. 3 bodies ✔");
    assert!(harness.get_by_label("Use this division").accesskit_node().is_disabled());
    click(&mut harness, "Edit");
    assert!(says(&harness, "Undo: division into bodies"));
    press(&mut harness, Key::Escape);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    wait(&mut harness);
    assert_eq!(*harness.state().project(), before);
    assert!(sees(&harness, "1. 3 bodies"), "what was found stays");
}

#[test]
fn the_bodies_of_the_chosen_division_are_seen_in_place_of_the_beads() {
    let (_folder, mut harness) = divided(&ARMS);
    let pieces = |harness: &Window| harness.state().plan().scene.pieces().is_some();
    click(&mut harness, "Layer");
    click(&mut harness, "1. 3 bodies");
    assert!(pieces(&harness) && harness.state_mut().view().mode == Mode::Solid);
    assert!(["trunk", "branch 1", "branch 2"].into_iter().all(|name| sees(&harness, name)));
    if crate::window::has_adapter() {
        harness.run_steps(4);
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("directions.png");
        harness.render().unwrap().save(path).unwrap();
    }
    click(&mut harness, "1. 3 bodies");
    assert!(!pieces(&harness) && !sees(&harness, "trunk"));
    click(&mut harness, "1. 3 bodies");
    press(&mut harness, Key::Escape);
    assert!(!pieces(&harness), "Escape brings the beads back");
}

#[test]
fn what_was_found_is_forgotten_with_another_part_or_profile() {
    let (_folder, mut harness) = divided(&ARMS);
    click(&mut harness, "1. 3 bodies");
    harness.state_mut().set_value("layers.height", "2.5");
    harness.run_steps(2);
    assert!(!sees(&harness, "1. 3 bodies") && harness.state_mut().view().division.is_none());
    wait(&mut harness);
    harness.state_mut().act(Action::FindDirections);
    wait(&mut harness);
    assert!(sees(&harness, "1. 3 bodies"));
    let placement = harness.state().project().placement;
    harness.state_mut().act(Action::Place(beadwright::Placement { scale: 0.9, ..placement }));
    wait(&mut harness);
    assert!(!sees(&harness, "1. 3 bodies"));
}

#[test]
fn the_search_can_be_given_up() {
    let (_folder, mut harness) = opened(&ARMS);
    harness.state_mut().view().side = Side::Directions;
    for giving_up in [Action::StopDirections, Action::Stop] {
        // It takes longer than a frame.
        harness.state_mut().act(Action::FindDirections);
        assert!(!harness.state().is_idle());
        harness.run_steps(1);
        assert!(sees(&harness, "Cancel"));
        harness.state_mut().act(giving_up);
        assert!(harness.state().is_idle());
        harness.run_steps(2);
        assert!(!sees(&harness, "Cancel") && !sees(&harness, "1. 3 bodies"));
    }
}

#[test]
fn what_cannot_be_divided_says_what_to_do() {
    let (_folder, mut harness) = opened(&ARMS);
    harness.state_mut().view().side = Side::Directions;
    harness.state_mut().set_value("layers.chart", "plane:up=0/1/1,through=0/0/0");
    wait(&mut harness);
    assert!(sees(&harness, "The profile already says how layers lie: remove layers.chart from it first."));
    harness.state_mut().act(Action::ResetValue("layers.chart".to_owned()));
    harness.state_mut().act(Action::Preform(true));
    wait(&mut harness);
    assert!(sees(&harness, "A preform is not divided: switch Preform off first."));
    assert!(harness.get_by_label("Find directions").accesskit_node().is_disabled());
    harness.state_mut().act(Action::Preform(false));
    wait(&mut harness);
    assert!(!harness.get_by_label("Find directions").accesskit_node().is_disabled());
}

#[test]
fn a_part_without_overhangs_has_nothing_to_divide() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = crate::window::example(folder.path(), "cross");
    harness.state_mut().view().side = Side::Directions;
    harness.state_mut().act(Action::FindDirections);
    wait(&mut harness);
    assert!(sees(&harness, "No other direction avoids much of it.") && sees(&harness, "1. level layers ✔"));
}
