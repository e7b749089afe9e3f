//! Other speeds for some layers: `[[process.layers]]`.

use super::Process;
use crate::limit::{Broken, no_layers};
use serde::{Deserialize, Serialize};
use std::ops::RangeInclusive;

/// Another speed for some layers, such as the first ones on a cold plate. The wire feed changes by the same factor, so the
/// bead stays the same.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct LayerProcess {
    /// First layer, from 1.
    pub from: usize,
    /// Last layer.
    pub to: usize,
    /// Speed of the torch while the arc burns, mm/s.
    pub deposition_speed: f64,
    /// Arc current, A, for the heat input; default that of the process.
    pub current: Option<f64>,
    /// Job of the power source, `{{job}}` in templates; default that of the process.
    pub job: Option<u32>,
}

impl LayerProcess {
    /// Speeds and wire feeds over the nominal ones that a row may have.
    pub const RATES: RangeInclusive<f64> = 0.2..=5.0;
}

impl Process {
    /// The process in the layer with this index: the first row that includes the layer applies.
    pub fn at_layer(&self, index: usize) -> Self {
        let mut process = self.clone();
        if let Some(row) = self.layers.iter().find(|row| (row.from..=row.to).contains(&(index + 1))) {
            process.rate = row.deposition_speed / self.deposition_speed;
            process.current = row.current.or(self.current);
            process.job = row.job.unwrap_or(self.job);
        }
        process
    }

    /// Whether some layers have another wire feed than nominal.
    pub fn feeds_by_layer(&self) -> bool {
        self.layers.iter().any(|row| row.deposition_speed != self.deposition_speed)
    }

    /// The first invalid row of layers.
    pub fn broken(&self) -> Option<Broken> {
        let [least, most] =
            [LayerProcess::RATES.start(), LayerProcess::RATES.end()].map(|rate| rate * self.deposition_speed);
        self.layers.iter().find_map(|row| {
            let LayerProcess { from, to, deposition_speed: speed, current, .. } = *row;
            let reason = if let Some(reason) = no_layers(from, to) {
                reason
            } else if !(least..=most).contains(&speed) {
                "its deposition_speed must lie between a fifth and five times that of the process: the wire feed changes by \
                 the same factor."
                    .to_owned()
            } else if !current.is_none_or(|current| (1e-3..=2000.0).contains(&current)) {
                "its current must lie between 0.001 and 2000 A.".to_owned()
            } else {
                return None;
            };
            let value = format!("{{ from = {from}, to = {to}, deposition_speed = {speed} }}");
            Some(Broken { key: "process.layers".to_owned(), value, reason })
        })
    }
}
