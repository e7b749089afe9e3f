//! What colours and marks say: the range of the colours is chosen, one for both plans that are compared, and limits are shown.

use crate::window::{Window, click, colour_range, example, has_adapter, open_list, sees, type_number, wait};
use beadwright::fill::StrategyName;
use beadwright_studio::view::Mode;
use beadwright_studio::view3d::Colour;
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
    let of_plan = [format!("{low:.1} mm/s"), format!("{high:.1} mm/s")];
    assert_eq!(colour_range(&harness), of_plan);
    let seen = |harness: &mut Window| has_adapter().then(|| harness.render().unwrap().into_raw());
    let before = seen(&mut harness);
    type_number(&mut harness, HIGH, "30");
    assert_eq!(colour_range(&harness), [of_plan[0].clone(), "30.0 mm/s".to_owned()]);
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
    let (low, _) = harness.state().plan().scene.value_range(Colour::Width).unwrap();
    assert_eq!(colour_range(&harness)[0], format!("{low:.1} mm"));
    open_list(&mut harness, "Colour");
    click(&mut harness, "speed");
    assert_eq!(colour_range(&harness)[1], "30.0 mm/s");
    harness.state_mut().open_example("cross");
    wait(&mut harness);
    assert_eq!(colour_range(&harness), of_plan);
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
    while harness.state().other_plan().unwrap().is_cold() {
        wait(&mut harness);
    }
    let [own, other] = [harness.state().plan(), harness.state().other_plan().unwrap()]
        .map(|plan| plan.scene.value_range(Colour::Temperature).unwrap());
    assert_ne!(own, other);
    let (low, high) = (own.0.min(other.0), own.1.max(other.1));
    assert_eq!(colour_range(&harness), [low, high].map(|end| format!("{end:.1} °C")));
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
    click(&mut harness, "Plots");
    assert!(harness.query_by_label_contains("limit 0.01 %").is_some());
}
