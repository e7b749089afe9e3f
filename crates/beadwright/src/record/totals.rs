//! Hours, wire, gas, energy, cost and CO₂e of a part, planned and recorded.

use super::{Part, Quantity};
use crate::bead::wire_area;
use crate::metrics::Metrics;
use crate::process::Spent;
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
    /// Energy from the mains, kWh; `None` where the current or voltage of a welded pass was not measured or planned.
    pub energy_kwh: Option<f64>,
    /// Emissions by the factors of the profile, kg CO₂e; `None` without factors.
    pub co2_kg: Option<f64>,
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
            energy_kwh: metrics.energy_kwh,
            co2_kg: metrics.co2_kg,
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
        let joules = |row: &super::PassRow| {
            let mean = |quantity| row.measured(quantity).map(|measured| measured.mean);
            Some(mean(Quantity::Current)? * mean(Quantity::Voltage)? * row.burned)
        };
        let arc_kwh = passes().map(joules).sum::<Option<f64>>().map(|joules| joules / 3.6e6);
        let (factors, spent) = (&part.profile.cost, wire_kg.map(|wire_kg| Spent { hours, wire_kg, gas_m3, arc_kwh }));
        Self {
            arc_hours: burned / 3600.0,
            hours,
            wire_kg,
            gas_m3,
            cost: spent.and_then(|spent| factors.of(&spent)),
            energy_kwh: factors.mains_kwh(&Spent { hours, arc_kwh, ..Spent::default() }),
            co2_kg: spent.and_then(|spent| factors.co2_kg(&spent)),
        }
    }
}
