//! The section `[spot]`: a dot, welded with the torch standing still, for islands with no room for a bead.
//!
//! The volume of a dot is that of the bead laid in the time for which the arc burns. It is a dome, half an ellipsoid of
//! height h and radius a: V = 2/3 π a² h. A dot that is welded longer has more volume at the same height, so its
//! diameter grows with the square root of the time.

use crate::limit::{Limit, limits};
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;
use std::ops::RangeInclusive;

/// A dot as it was welded in a trial.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Spot {
    /// How long the arc burned, s, without the time that it takes to start.
    pub time: f64,
    /// How high the dot is, mm.
    pub height: f64,
}

impl Spot {
    /// The limits of the numbers.
    pub fn limits(&self) -> Vec<Limit> {
        limits! {
            "spot.time": self.time, 0.05, 10.0, "s", "a dot takes about as long as a bead takes for its width";
            "spot.height": self.height, 0.2, 30.0, "mm", "a dot is about as high as a bead";
        }
    }

    /// The dot of a process that lays `rate` mm³ of metal per second.
    ///
    /// ```
    /// use bead_plan::process::Spot;
    /// use std::f64::consts::PI;
    ///
    /// // 60 mm³ in a second: a dome of 2/3 π a² h.
    /// let dot = Spot { time: 1.0, height: 3.0 }.dot(60.0);
    /// let radius = dot.diameter_of(60.0).ok_or("not tried")? / 2.0;
    /// assert!((2.0 / 3.0 * PI * radius * radius * 3.0 - 60.0).abs() < 1e-9);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn dot(&self, rate: f64) -> Dot {
        let metal = rate * self.time;
        Dot { time: self.time, metal, diameter: 2.0 * (1.5 * metal / (PI * self.height)).sqrt() }
    }
}

/// A dot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dot {
    /// Time for which the arc burns, s.
    time: f64,
    /// Its volume, mm³.
    metal: f64,
    /// Diameter, mm.
    diameter: f64,
}

impl Dot {
    /// The torch moves this far while it welds a dot, mm: few languages can express a pass without length, and most
    /// round speeds to 0.1 mm/s.
    pub const LENGTH: f64 = 1.0;
    /// Least and greatest welding time of a dot, over that in the trial.
    const TIMES: RangeInclusive<f64> = 0.5..=2.0;

    /// Diameter, mm, of a dot of this volume, mm³; `None` if that is too far from what was tried.
    pub fn diameter_of(&self, metal: f64) -> Option<f64> {
        let times = metal / self.metal;
        Self::TIMES.contains(&times).then(|| self.diameter * times.sqrt())
    }

    /// Welding time of a dot of this diameter, mm, in s.
    pub fn seconds(&self, diameter: f64) -> f64 {
        self.time * (diameter / self.diameter).powi(2)
    }

    /// Pace, mm/s, at which the torch takes that time for [`Self::LENGTH`].
    pub fn pace(&self, diameter: f64) -> f64 {
        Self::LENGTH / self.seconds(diameter)
    }
}
