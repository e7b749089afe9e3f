//! The section `[cost]`: what an hour, the wire and the gas cost.

use crate::limit::section;

section! {
    /// Prices, for the cost in the totals; every key has a default, and with the defaults no cost is given.
    Cost "cost" {
        /// Currency, such as `EUR`, which is also the default.
        currency: String = "EUR".to_owned();
        /// An hour of the cell with its people, in the currency; default 0.
        hour: f64 = 0.0, 0.0, 1e6, "per hour", "no cell costs more";
        /// A kilogram of wire, in the currency; default 0.
        wire_kg: f64 = 0.0, 0.0, 1e6, "per kg", "even gold wire costs less";
        /// A cubic metre of gas, in the currency; default 0.
        gas_m3: f64 = 0.0, 0.0, 1e5, "per m³", "no shielding gas costs more";
    }
}

impl Cost {
    /// What this many hours, kilograms of wire and cubic metres of gas cost; `None` without prices.
    ///
    /// ```
    /// use bead_plan::process::Cost;
    ///
    /// let prices = Cost { hour: 60.0, wire_kg: 20.0, ..Cost::default() };
    /// assert_eq!(prices.of(2.0, 1.5, 0.3), Some(2.0 * 60.0 + 1.5 * 20.0));
    /// assert_eq!(Cost::default().of(2.0, 1.5, 0.3), None);
    /// ```
    pub fn of(&self, hours: f64, wire_kg: f64, gas_m3: f64) -> Option<f64> {
        let known = self.hour > 0.0 || self.wire_kg > 0.0 || self.gas_m3 > 0.0;
        known.then_some(hours * self.hour + wire_kg * self.wire_kg + gas_m3 * self.gas_m3)
    }
}
