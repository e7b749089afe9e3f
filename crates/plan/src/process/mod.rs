//! The process: wire, arc, speed, gas, travels, and how passes begin and end; sections of a profile.

mod by_layer;
mod cost;
mod spot;
mod start_stop;
mod torch_shape;

pub use by_layer::LayerProcess;
pub use cost::{Cost, Spent};
pub use spot::{Dot, Spot};
pub use start_stop::{LayerEnds, StartStop};
pub use torch_shape::TorchShape;

use crate::limit::{Limit, TINY, limits};
use serde::{Deserialize, Serialize};

/// The wire.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Wire {
    /// Material, for the report.
    pub material: String,
    /// Diameter, mm.
    pub diameter: f64,
    /// Density, g/cm³.
    pub density: f64,
}

impl Wire {
    /// The limits of the numbers.
    pub fn limits(&self) -> Vec<Limit> {
        limits! {
            "wire.diameter": self.diameter, 0.1, 10.0, "mm",
                "wires of 0.6 to 4 mm are sold, and filament of up to 3 mm";
            "wire.density": self.density, 0.5, 25.0, "g/cm³", "plastics have about 1 g/cm³, tungsten 19";
        }
    }
}

/// Arc, wire feed, speed and gas.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Process {
    /// Wire feed speed, m/min.
    pub wire_feed_speed: f64,
    /// Speed of the torch while the arc burns, mm/s.
    pub deposition_speed: f64,
    /// What changes where a bead is wider, narrower or hotter than nominal: the `speed` of the torch or the
    /// `wire-feed`; default speed.
    #[serde(default)]
    pub follow: Follow,
    /// Fraction of the wire that ends up in the bead, 0 to 1.
    pub efficiency: f64,
    /// Arc current, A; optional, for the heat input.
    pub current: Option<f64>,
    /// Arc voltage, V; optional, for the heat input.
    pub voltage: Option<f64>,
    /// Time the torch waits after the arc is switched on before it moves, s.
    pub arc_start_delay: f64,
    /// Time the torch waits after the arc is switched off before it leaves, s.
    pub arc_end_delay: f64,
    /// Shielding gas, for the report.
    pub gas: String,
    /// Gas flow, L/min.
    pub gas_flow: f64,
    /// Time for which gas flows before the arc is switched on, s.
    pub gas_preflow: f64,
    /// Time for which gas flows after the arc is switched off, s.
    pub gas_postflow: f64,
    /// Contact tip to work distance, mm.
    pub ctwd: f64,
    /// Job of the power source, `{{job}}` in templates; default 1.
    #[serde(default = "first")]
    pub job: u32,
    /// Other speeds for some layers; default none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub layers: Vec<LayerProcess>,
    /// Speed and wire feed of the current layer as a multiple of the nominal ones.
    #[serde(skip, default = "nominal")]
    rate: f64,
}

fn first() -> u32 {
    1
}

fn nominal() -> f64 {
    1.0
}

impl Process {
    /// The limits of the numbers.
    pub fn limits(&self) -> Vec<Limit> {
        limits! {
            "process.wire_feed_speed": self.wire_feed_speed, TINY, 100.0, "m/min",
                "wire feeders reach about 30 m/min at most";
            "process.deposition_speed": self.deposition_speed, TINY, 2000.0, "mm/s",
                "without speed there is no bead; printers reach a few hundred mm/s";
            "process.efficiency": self.efficiency, 0.01, 1.0, "(fraction of the wire)",
                "no more metal can be laid than is fed as wire";
            "process.arc_start_delay": self.arc_start_delay, 0.0, 60.0, "s",
                "standing still longer with the arc on burns through";
            "process.arc_end_delay": self.arc_end_delay, 0.0, 60.0, "s",
                "standing still longer with the arc on burns through";
            "process.gas_flow": self.gas_flow, 0.0, 200.0, "L/min",
                "above 25 L/min the flow becomes turbulent and draws air in";
            "process.gas_preflow": self.gas_preflow, 0.0, 60.0, "s",
                "a minute covers the coldest start; more only costs gas";
            "process.gas_postflow": self.gas_postflow, 0.0, 60.0, "s",
                "a minute covers the coldest start; more only costs gas";
            "process.ctwd": self.ctwd, 0.0, 100.0, "mm", "beyond 30 mm the gas no longer covers the arc";
            "process.current": self.current.unwrap_or(1.0), TINY, 2000.0, "A",
                "no power source on the market delivers more";
            "process.voltage": self.voltage.unwrap_or(1.0), TINY, 500.0, "V",
                "no power source on the market delivers more";
        }
    }
}

impl Process {
    /// Speed of the torch at a given pace, mm/s.
    pub fn speed_at(&self, pace: f64) -> f64 {
        match self.follow {
            Follow::Speed => pace * self.rate,
            Follow::WireFeed => self.deposition_speed * self.rate,
        }
    }

    /// The nominal wire feed of the current layer, as a multiple of that of the process.
    pub fn rate(&self) -> f64 {
        self.rate
    }

    /// Wire feed at a given pace (mm/s), as a multiple of the nominal wire feed.
    pub fn feed_at(&self, pace: f64) -> f64 {
        match self.follow {
            Follow::Speed => self.rate,
            Follow::WireFeed => self.rate * self.deposition_speed / pace,
        }
    }

    /// Heat per length of bead at a given pace, J/mm: current × voltage / pace. It is proportional to the metal whether
    /// the speed or the wire feed changes, since the current follows the wire feed in the arcs used here (synergic
    /// lines, CMT). `None` if current or voltage is not given.
    pub fn heat_at(&self, pace: f64) -> Option<f64> {
        Some(self.current? * self.voltage? / (pace * self.rate))
    }
}

/// What keeps the metal of a bead in balance where it differs from the nominal bead.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Follow {
    /// The torch moves slower or faster; the wire is fed at its nominal speed.
    #[default]
    Speed,
    /// The wire is fed faster or slower; the torch moves at its nominal speed.
    WireFeed,
}

/// Moves with the arc off.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Travel {
    /// Speed of the moves, mm/s.
    pub speed: f64,
    /// Height of the moves above the layer, mm.
    pub clearance: f64,
}

impl Travel {
    /// The limits of the numbers.
    pub fn limits(&self) -> Vec<Limit> {
        limits! {
            "travel.speed": self.speed, TINY, 3000.0, "mm/s", "robots reach 2 to 3 m/s at most";
            "travel.clearance": self.clearance, 0.0, 1000.0, "mm", "below 0 the torch would run into the part";
        }
    }
}
