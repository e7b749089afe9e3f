//! Hours, wire, gas and cost of a part, planned and recorded.

use super::{Part, Quantity};
use crate::bead::wire_area;
use crate::metrics::Metrics;
use serde::Serialize;

/// Totals of a part.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Totals {
    /// Time with the arc on, h.
    pub arc_hours: f64,
    /// Time from the first arc to the last, h; planned, with all moves and waits.
    pub hours: f64,
    /// Wire, kg; `None` where the feed of a welded pass was not measured.
    pub wire_kg: Option<f64>,
    /// Shielding gas, m³, by the flow of the profile.
    pub gas_m3: f64,
    /// Cost by the prices of the profile; `None` without prices.
    pub cost: Option<f64>,
}

impl Totals {
    /// As planned.
    pub(super) fn planned(part: &Part<'_>) -> Self {
        let mut metrics = Metrics::new(part.profile);
        part.layers.iter().for_each(|layer| metrics.add(layer));
        Self {
            arc_hours: part.planned.iter().map(super::PlannedPass::seconds).sum::<f64>() / 3600.0,
            hours: metrics.total_time_s / 3600.0,
            wire_kg: Some(metrics.wire_mass_kg),
            gas_m3: metrics.gas_m3,
            cost: metrics.cost,
        }
    }

    /// As recorded.
    pub(super) fn recorded(part: &Part<'_>) -> Self {
        let (process, wire) = (&part.profile.process, &part.profile.wire);
        let passes = || part.record.passes.iter().filter(|row| row.burned > 0.0);
        let burned: f64 = passes().map(|row| row.burned).sum();
        let times = || passes().filter_map(|row| row.time);
        let first = times().map(|[start, _]| start).fold(f64::INFINITY, f64::min);
        let hours = times().map(|[_, end]| (end - first) / 3600.0).fold(0.0, f64::max);
        let metres = |row: &super::PassRow| Some(row.measured(Quantity::Feed)?.mean * row.burned / 60.0);
        let metres: Option<f64> = passes().map(metres).sum();
        let wire_kg = metres.map(|metres| metres * wire_area(wire.diameter) * wire.density / 1000.0);
        let arcs: usize = passes().map(|row| row.arcs).sum();
        let idle = process.gas_preflow + process.arc_start_delay + process.arc_end_delay + process.gas_postflow;
        let gas_m3 = (burned + arcs as f64 * idle) * process.gas_flow / 60_000.0;
        let cost = wire_kg.and_then(|wire_kg| part.profile.cost.of(hours, wire_kg, gas_m3));
        Self { arc_hours: burned / 3600.0, hours, wire_kg, gas_m3, cost }
    }
}
