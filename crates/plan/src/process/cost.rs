//! The section `[cost]`: what an hour, the wire, the gas and the energy cost, and how much CO₂e they cause.

use crate::limit::section;

section! {
    /// Prices and emissions, for the cost and the CO₂e in the totals; every key has a default, and with the defaults neither is given.
    Cost "cost" {
        /// Currency, such as `EUR`, which is also the default.
        currency: String = "EUR".to_owned();
        /// An hour of the cell with its people, in the currency; default 0.
        hour: f64 = 0.0, 0.0, 1e6, "per hour", "no cell costs more";
        /// A kilogram of wire, in the currency; default 0.
        wire_kg: f64 = 0.0, 0.0, 1e6, "per kg", "even gold wire costs less";
        /// A cubic metre of gas, in the currency; default 0.
        gas_m3: f64 = 0.0, 0.0, 1e5, "per m³", "no shielding gas costs more";
        /// A kilowatt-hour of electricity, in the currency; default 0. Needs `process.current` and `process.voltage`.
        energy_kwh: f64 = 0.0, 0.0, 1e4, "per kWh", "no electricity costs more";
        /// Fraction of the mains' energy that the power source hands to the arc; default 1: its losses are left out.
        mains_efficiency: f64 = 1.0, 0.1, 1.0, "", "a power source loses less than nine tenths, and gains nothing";
        /// Power that the cell draws all the time (robot, cooler, extraction, power source at rest), kW; default 0.
        idle_kw: f64 = 0.0, 0.0, 1e3, "kW", "a cell at rest draws less";
        /// Emissions of a kilogram of wire, from its maker's declaration, kg CO₂e; default 0.
        co2_wire_kg: f64 = 0.0, 0.0, 1e4, "kg per kg", "no wire causes more";
        /// Emissions of a cubic metre of gas, kg CO₂e; default 0.
        co2_gas_m3: f64 = 0.0, 0.0, 1e4, "kg per m³", "no shielding gas causes more";
        /// Emissions of a kilowatt-hour, from your supplier, kg CO₂e; default 0. Needs `process.current` and `process.voltage`.
        co2_kwh: f64 = 0.0, 0.0, 10.0, "kg per kWh", "no power station emits more";
    }
}

/// What a part takes.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Spent {
    /// Hours of the cell.
    pub hours: f64,
    /// Wire, kg.
    pub wire_kg: f64,
    /// Shielding gas, m³.
    pub gas_m3: f64,
    /// Energy of the arc, kWh; `None` if its current or voltage is not known.
    pub arc_kwh: Option<f64>,
}

impl Cost {
    /// What a part costs; `None` without prices, and where energy has one but is not known.
    ///
    /// ```
    /// use bead_plan::process::{Cost, Spent};
    ///
    /// let prices = Cost { hour: 60.0, wire_kg: 20.0, ..Cost::default() };
    /// let spent = Spent { hours: 2.0, wire_kg: 1.5, gas_m3: 0.3, arc_kwh: None };
    /// assert_eq!(prices.of(&spent), Some(2.0 * 60.0 + 1.5 * 20.0));
    /// assert_eq!(Cost::default().of(&spent), None);
    /// ```
    pub fn of(&self, spent: &Spent) -> Option<f64> {
        let rest = self.sum(spent, [self.wire_kg, self.gas_m3, self.energy_kwh], self.hour > 0.0);
        rest.map(|rest| rest + spent.hours * self.hour)
    }

    /// The emissions of a part, kg CO₂e; `None` without factors, and where energy has one but is not known.
    pub fn co2_kg(&self, spent: &Spent) -> Option<f64> {
        self.sum(spent, [self.co2_wire_kg, self.co2_gas_m3, self.co2_kwh], false)
    }

    /// Energy from the mains, kWh; `None` if that of the arc is not known.
    pub fn mains_kwh(&self, spent: &Spent) -> Option<f64> {
        Some(spent.arc_kwh? / self.mains_efficiency + self.idle_kw * spent.hours)
    }

    /// Wire, gas and energy times their factors, if any is known.
    fn sum(&self, spent: &Spent, [wire, gas, energy]: [f64; 3], known: bool) -> Option<f64> {
        let mains = if energy > 0.0 { energy * self.mains_kwh(spent)? } else { 0.0 };
        let known = known || wire > 0.0 || gas > 0.0 || energy > 0.0;
        known.then_some(spent.wire_kg * wire + spent.gas_m3 * gas + mains)
    }
}
