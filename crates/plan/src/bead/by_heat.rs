//! How a bead changes with the temperature of the metal below: on warm metal the same wire gives a wider and lower one.

use crate::limit::{Limit, limits};
use serde::{Deserialize, Serialize};

/// Smallest and largest factor by which a bead's width or height is assumed to change: walls welded without any wait
/// change by 1.4 in width.
const CHANGES: (f64, f64) = (0.5, 2.0);

/// How a bead changes with the temperature of the metal just ahead of the torch, at the same wire feed and speed; linear,
/// as `beadwright bead walls` fits it to measured walls.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct BeadByHeat {
    /// Temperature of the metal ahead of the torch at which the bead has the width and height given in `bead`, °C.
    pub temperature: f64,
    /// Change of the bead's width, mm/K.
    pub width: f64,
    /// Change of the thickness of a layer of a wall with one bead per layer, mm/K; negative where warm metal spreads.
    pub rise: f64,
}

impl BeadByHeat {
    /// Width on metal at `temperature` (°C), as a multiple of the `nominal` one (mm).
    ///
    /// ```
    /// use bead_plan::bead::BeadByHeat;
    ///
    /// // 0.01 mm/K over 100 K: 1 mm more than the 5 mm at the law's own temperature.
    /// let law = BeadByHeat { temperature: 150.0, width: 0.01, rise: -0.002 };
    /// assert!((law.widening(5.0, 250.0) - 1.2).abs() < 1e-12);
    /// assert_eq!(law.widening(5.0, 150.0), 1.0);
    /// ```
    pub fn widening(&self, nominal: f64, temperature: f64) -> f64 {
        self.change(self.width / nominal, temperature)
    }

    /// Thickness of a wall's layer on metal at `temperature` (°C), as a multiple of the `nominal` one (mm).
    pub fn lift(&self, nominal: f64, temperature: f64) -> f64 {
        self.change(self.rise / nominal, temperature)
    }

    fn change(&self, slope: f64, temperature: f64) -> f64 {
        (1.0 + slope * (temperature - self.temperature)).clamp(CHANGES.0, CHANGES.1)
    }

    /// The limits of its numbers.
    pub fn limits(&self) -> Vec<Limit> {
        limits! {
            "bead.by_heat.temperature": self.temperature, -50.0, 1500.0, "°C", "hotter metal is liquid";
            "bead.by_heat.width": self.width, -0.1, 0.1, "mm/K", "no bead becomes 10 mm wider over 100 K";
            "bead.by_heat.rise": self.rise, -0.1, 0.1, "mm/K", "no layer becomes 10 mm thicker over 100 K";
        }
    }
}
