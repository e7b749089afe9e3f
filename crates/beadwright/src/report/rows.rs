//! Totals as people read them, row by row: name and value with its unit.

use crate::deposit::{Figures, stack::Growth};
use crate::metrics::Metrics;
use crate::number::hours;

/// The totals as people read them.
pub fn totals(m: &Metrics) -> Vec<(&'static str, String)> {
    let part = m.mesh_volume_mm3.unwrap_or(m.part_volume_mm3);
    let mut rows = vec![
        ("layers", format!("{}", m.layers)),
        ("passes (arc starts)", format!("{}", m.passes)),
        ("deposited length", format!("{:.2} m", m.deposited_length_mm / 1000.0)),
        ("travel length", format!("{:.2} m", m.travel_length_mm / 1000.0)),
        ("arc time", hours(m.arc_time_s)),
        ("total time", hours(m.total_time_s)),
        ("wire", format!("{:.2} m, {:.3} kg", m.wire_length_m, m.wire_mass_kg)),
        ("deposited / part", format!("{:.1} / {:.1} cm³", m.deposited_volume_mm3 / 1e3, part / 1e3)),
        ("covered / slice area", format!("{:.2} %", 100.0 * m.coverage())),
    ];
    rows.extend(m.milled_part_volume_mm3.map(|part| {
        let off = (m.deposited_volume_mm3 - part).max(0.0);
        ("part / milled off", format!("{:.1} / {:.1} cm³", part / 1e3, off / 1e3))
    }));
    if m.dwell_time_s > 0.0 {
        rows.insert(5, ("waits", hours(m.dwell_time_s)));
    }
    rows.extend(m.cost.map(|cost| ("cost", format!("{cost:.2} {}", m.currency))));
    rows.extend(m.co2_kg.map(|kg| ("CO₂e", format!("{kg:.2} kg"))));
    rows.extend(m.heat_input_j_per_mm.map(|heat| ("heat input", format!("{heat:.0} J/mm"))));
    rows
}

/// How high the built part ends compared with the plan, bead laid on bead.
pub fn built(built: &Growth) -> (&'static str, String) {
    let Growth { within, mean, hollow, peak, .. } = built;
    let percent = 100.0 * within;
    ("built / planned top", format!("{percent:.1} % within a layer, mean {mean:+.2} mm (-{hollow:.2} to +{peak:.2})"))
}

/// What the deposit model says, as people read it.
pub fn deposit(f: &Figures) -> [(&'static str, String); 2] {
    [
        ("void / low area", format!("{:.2} / {:.2} %", f.void_percent(), f.low_percent())),
        ("overfill / outside", format!("{:.2} / {:.2} %", f.overfill_percent(), f.outside_percent())),
    ]
}
