//! How far a part may differ from its plan before it is marked.

use crate::error::RecordError;
use crate::quantity::Quantity;

/// Limits of a record.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Settings {
    /// How far quantities may differ from the plan, in per cent of it. Those that are not listed are not judged.
    pub windows: Vec<(Quantity, f64)>,
    /// Shortest stretch out of its window that counts, s; values are averaged over this time.
    pub least: f64,
    /// Time after the arc is struck, and before it goes out, that is left out, s.
    pub settle: f64,
    /// Fraction of the arc's energy that reaches the metal, for the heat input.
    pub efficiency: f64,
    /// Temperature above which no pass should begin, °C.
    pub hottest: Option<f64>,
    /// Shortest stop that is reported, s more than planned.
    pub stop: f64,
    /// How far the top of a pass may be from its planned height, mm; without it, heights are not judged.
    pub height: Option<f64>,
}

impl Default for Settings {
    /// ±10 % over 0.3 s, without the first and last 0.5 s of an arc, for all planned quantities; our own choice.
    fn default() -> Self {
        Self {
            windows: Quantity::PLANNED.map(|quantity| (quantity, 10.0)).to_vec(),
            least: 0.3,
            settle: 0.5,
            efficiency: 1.0,
            hottest: None,
            stop: 60.0,
            height: None,
        }
    }
}

impl Settings {
    pub(crate) fn check(&self) -> Result<(), RecordError> {
        let window = self.windows.iter().map(|(quantity, percent)| (quantity.word(), *percent, 0.1, 1000.0, "%"));
        let rest = [
            ("the least stretch", self.least, 0.02, 60.0, "s"),
            ("the time to settle", self.settle, 0.0, 60.0, "s"),
            ("the efficiency of the arc", self.efficiency, 0.01, 1.0, "(fraction of the power)"),
            ("the hottest start", self.hottest.unwrap_or(100.0), 0.0, 3000.0, "°C"),
            ("the shortest stop", self.stop, 0.1, 1e6, "s"),
            ("the window of the height", self.height.unwrap_or(1.0), 0.001, 100.0, "mm"),
        ];
        match window.chain(rest).find(|(_, value, low, high, _)| !(*low..=*high).contains(value)) {
            Some((name, value, low, high, unit)) => Err(RecordError::OutOfRange { name, value, low, high, unit }),
            None => Ok(()),
        }
    }
}
