//! What colours and marks say: the range of the colours is chosen, one for both plans that are compared, and limits are shown.

use crate::window::{Window, click, colour_range, example, has_adapter, open_list, sees, shows, type_number, wait};
use beadwright::fill::StrategyName;
use beadwright_studio::view::Mode;
use beadwright_studio::view3d::Colour;
use eframe::egui::{Key, Role};
use egui_kittest::kittest::Queryable;
use std::path::Path;

const LOW: &str = "Lowest value of the colours";
const HIGH: &str = "Highest value of the colours";

#[test]
fn the_range_of_the_colours_is_chosen_and_given_back() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = example(folder.path(), "cross");
    open_list(&mut harness, "Colour");
    click(&mut harness, "speed");
    let (low, high) = harness.state().plan().scene.value_range(Colour::Speed).unwrap();
    shows(&harness, [low, high], " mm/s");
    let seen = |harness: &mut Window| has_adapter().then(|| harness.render().unwrap().into_raw());
    let before = seen(&mut harness);
    type_number(&mut harness, HIGH, "30");
    shows(&harness, [low, 30.0], " mm/s");
    assert_eq!(harness.state_mut().view().range, Some((Colour::Speed, [low, 30.0])));
    if let Some((before, after)) = before.zip(seen(&mut harness)) {
        let changed = before.iter().zip(&after).filter(|(a, b)| a.abs_diff(**b) > 20).count();
        assert!(changed > before.len() / 100, "{changed} of {} bytes", before.len());
    }
    // Ends cannot change places.
    type_number(&mut harness, LOW, "50");
    let (_, [lowest, highest]) = harness.state_mut().view().range.unwrap();
    assert!(lowest < highest, "{lowest} to {highest}");
    // Other colours have their own range.
    open_list(&mut harness, "Colour");
    click(&mut harness, "width");
    let (narrowest, widest) = harness.state().plan().scene.value_range(Colour::Width).unwrap();
    shows(&harness, [narrowest, widest], " mm");
    open_list(&mut harness, "Colour");
    click(&mut harness, "speed");
    shows(&harness, [lowest, highest], " mm/s");
    harness.state_mut().open_example("cross");
    wait(&mut harness);
    shows(&harness, [low, high], " mm/s");
}

#[test]
fn the_range_of_the_colours_changes_only_by_hand() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = example(folder.path(), "cross");
    for colour in [Colour::Order, Colour::Time, Colour::Speed, Colour::Width, Colour::HeightError] {
        harness.state_mut().view().colour = colour;
        harness.run_steps(4);
        assert_eq!(harness.state_mut().view().range, None, "{colour:?}");
        // A field is entered and left as it was.
        if harness.query_by_role_and_label(Role::SpinButton, HIGH).is_some() {
            harness.get_by_role_and_label(Role::SpinButton, HIGH).click();
            harness.run_steps(2);
            harness.key_press(Key::Tab);
            harness.run_steps(3);
            assert_eq!(harness.state_mut().view().range, None, "{colour:?} after Tab");
        }
    }
    // Where all values are the same there are no ends to change.
    let uniform = Some((Colour::Width, [5.0, 5.0]));
    harness.state_mut().view().colour = Colour::Width;
    harness.state_mut().view().range = uniform;
    harness.run_steps(4);
    assert_eq!(harness.state_mut().view().range, uniform);
    assert!(sees(&harness, "5.0 mm"));
}

#[test]
fn strategies_compared_in_3d_have_one_legend_for_both() {
    if !has_adapter() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let mut harness = example(folder.path(), "cross");
    harness.state_mut().compare_with(Some(StrategyName::Wall));
    harness.state_mut().view().colour = Colour::Order;
    wait(&mut harness);
    let alone: f64 = colour_range(&harness)[1].parse().unwrap();
    harness.state_mut().view().mode = Mode::Compare;
    harness.state_mut().view().compare_solid = true;
    harness.run_steps(4);
    let both: f64 = colour_range(&harness)[1].parse().unwrap();
    assert!(both >= alone, "{both}, {alone} alone");
    // Temperatures are those of each plan.
    harness.state_mut().view().colour = Colour::Temperature;
    harness.run_steps(2);
    // First those of the one, then those of the other.
    for _ in 0..3 {
        wait(&mut harness);
    }
    assert!(!harness.state().other_plan().unwrap().is_cold(), "the other plan has no temperatures");
    let [own, other] = [harness.state().plan(), harness.state().other_plan().unwrap()]
        .map(|plan| plan.scene.value_range(Colour::Temperature).unwrap());
    assert_ne!(own, other);
    shows(&harness, [own.0.min(other.0), own.1.max(other.1)], " °C");
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("compare.png");
    harness.render().unwrap().save(path).unwrap();
}

#[test]
fn totals_and_curves_say_whether_limits_are_kept() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = example(folder.path(), "cross");
    let void = |harness: &Window| {
        let figures = harness.state().plan().total.unwrap();
        format!("{:.2} / {:.2} %", figures.void_percent(), figures.low_percent())
    };
    assert!(sees(&harness, &format!("✔ {}", void(&harness))));
    harness.state_mut().set_value("check.max_void", "0.01");
    wait(&mut harness);
    assert!(sees(&harness, &format!("✖ {}", void(&harness))));
    // The mean of all layers keeps this limit, the worst of them does not.
    let plan = harness.state().plan();
    let mean = plan.total.unwrap().void_percent();
    let worst = plan.judgements.iter().map(|layer| layer.figures.void_percent()).fold(0.0, f64::max);
    assert!(worst > mean);
    harness.state_mut().set_value("check.max_void", &(0.5 * (mean + worst)).to_string());
    wait(&mut harness);
    assert!(sees(&harness, &format!("✖ {}", void(&harness))));
    harness.state_mut().set_value("check.max_void", "0.01");
    wait(&mut harness);
    click(&mut harness, "Plots");
    assert!(harness.query_by_label_contains("limit 0.01 %").is_some());
}
