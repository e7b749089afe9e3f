//! Cost in the totals, added up by hand.

use crate::common;

use beadwright::Metrics;
use common::{planned, profile_by};

#[test]
fn the_cost_is_that_of_time_wire_and_gas() {
    let mut profile = profile_by("cmt-al2319-kuka", "contour");
    let plan = planned("cross", &profile);
    let totals = |profile: &beadwright::Profile| {
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
