//! Cost in the totals, added up by hand.

use crate::common;

use beadwright::process::LayerProcess;
use beadwright::{Metrics, Profile};
use common::{planned, profile_by};

#[test]
fn the_cost_is_that_of_time_wire_and_gas() {
    let mut profile = profile_by("cmt-al2319-kuka", "contour");
    let plan = planned("cross", &profile);
    let totals = |profile: &Profile| {
        let mut metrics = Metrics::new(profile);
        plan.layers.iter().for_each(|layer| metrics.add(layer));
        metrics
    };
    assert_eq!(totals(&profile).cost, None, "nothing is said without prices");
    (profile.cost.hour, profile.cost.wire_kg, profile.cost.gas_m3) = (80.0, 22.0, 9.0);
    let m = totals(&profile);
    let cost = m.total_time_s / 3600.0 * 80.0 + m.wire_mass_kg * 22.0 + m.gas_m3 * 9.0;
    assert!((m.cost.unwrap() - cost).abs() < 1e-9, "{cost}");
    // 15 L/min while the arc burns, and 0.5 + 1.2 + 0.5 + 1.0 s a pass.
    let gas = 15.0 / 60_000.0 * (m.arc_time_s + 3.2 * m.passes as f64);
    assert!((m.gas_m3 / gas - 1.0).abs() < 1e-9, "{gas}");
}

#[test]
fn emissions_and_energy_are_those_of_wire_gas_and_electricity() {
    let mut profile = profile_by("cmt-al2319-kuka", "contour");
    let plan = planned("star", &profile);
    let totals = |profile: &Profile| {
        let mut metrics = Metrics::new(profile);
        plan.layers.iter().for_each(|layer| metrics.add(layer));
        metrics
    };
    (profile.process.current, profile.process.voltage) = (None, None);
    (profile.cost.co2_wire_kg, profile.cost.co2_gas_m3) = (8.0, 0.5);
    let m = totals(&profile);
    let matter = m.wire_mass_kg * 8.0 + m.gas_m3 * 0.5;
    assert!((m.co2_kg.unwrap() - matter).abs() < 1e-9 && m.energy_kwh.is_none() && m.cost.is_none());
    profile.cost.co2_kwh = 0.4;
    let checked = |profile: &Profile| Profile::from_json(&serde_json::to_value(profile).unwrap());
    let refused = checked(&profile).unwrap_err().to_string();
    assert!(refused.contains("cost.co2_kwh") && refused.contains("process.voltage"), "{refused}");
    assert_eq!(totals(&profile).co2_kg, None, "a sum without its energy would be too small");
    // 120 A × 15 V = 1.8 kW of arc from a source that loses a fifth, in a cell that draws 2 kW all the time.
    (profile.process.current, profile.process.voltage) = (Some(120.0), Some(15.0));
    (profile.cost.mains_efficiency, profile.cost.idle_kw, profile.cost.energy_kwh) = (0.8, 2.0, 0.3);
    checked(&profile).unwrap();
    let m = totals(&profile);
    let kwh = 1.8 / 0.8 * m.arc_time_s / 3600.0 + 2.0 * m.total_time_s / 3600.0;
    assert!((m.energy_kwh.unwrap() - kwh).abs() < 1e-9, "{kwh}");
    assert!((m.co2_kg.unwrap() - matter - 0.4 * kwh).abs() < 1e-9);
    assert!((m.cost.unwrap() - 0.3 * kwh).abs() < 1e-9);
    // Other layers, another current; without that of the profile, it must be known of all layers that are welded.
    let row = |from, to, current| LayerProcess {
        from,
        to,
        deposition_speed: profile.process.deposition_speed,
        current: Some(current),
        job: None,
    };
    let rows = vec![row(1, 2, 240.0), row(3, 1000, 120.0)];
    profile.process.layers = rows.clone();
    let mut first = Metrics::new(&profile);
    plan.layers.iter().filter(|layer| layer.index < 2).for_each(|layer| first.add(layer));
    let more = kwh + 1.8 / 0.8 * first.arc_time_s / 3600.0;
    assert!((totals(&profile).energy_kwh.unwrap() - more).abs() < 1e-3 * more, "{more}");
    profile.process.current = None;
    assert!((totals(&profile).energy_kwh.unwrap() - more).abs() < 1e-3 * more);
    profile.process.layers.pop();
    assert_eq!(totals(&profile).energy_kwh, None);
}
