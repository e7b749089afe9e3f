//! The sections of a profile that the heat model needs.

use crate::limit::{Limit, limits};
use crate::process::Process;
use planar::Bounds;
use serde::{Deserialize, Serialize};

/// Thermal values of the part, assumed constant. Means between room and interpass temperature serve best, since that is
/// where a part spends its time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Material {
    /// Thermal conductivity, W/(m·K).
    pub conductivity: f64,
    /// Specific heat, J/(kg·K).
    pub specific_heat: f64,
}

/// The plate on which the part is built. It lies below the part and reaches beyond it on all sides.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Substrate {
    /// Thickness, mm.
    pub thickness: f64,
    /// How far it reaches beyond the part on each side, mm.
    pub margin: f64,
    /// Heat that passes from it to the table below, W/(m²·K): about 10 on pins, 100 to 500 clamped on a table, 5000 cooled
    /// by water.
    pub contact: f64,
    /// Temperature before the first pass, °C; default that of the surroundings.
    pub preheat: Option<f64>,
    /// Thermal conductivity, W/(m·K); default that of the part.
    pub conductivity: Option<f64>,
    /// Specific heat, J/(kg·K); default that of the part.
    pub specific_heat: Option<f64>,
    /// Density, g/cm³; default that of the wire.
    pub density: Option<f64>,
}

/// What the arc gives and the surroundings take.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct HeatSection {
    /// Fraction of the arc's power that reaches the part: 0.8 to 0.9 for CMT, 0.75 to 0.85 for other gas metal arcs.
    pub arc_efficiency: f64,
    /// Temperature of the surroundings and of the table, °C.
    pub ambient: f64,
    /// Heat that the air takes from bare faces, W/(m²·K): 5 to 10 still, 20 to 50 with a fan.
    pub convection: f64,
    /// Emissivity of bare faces, 0 to 1.
    pub emissivity: f64,
    /// Size of the voxels seen from above, mm; default the width of the bead.
    pub voxel: Option<f64>,
}

/// How warm the metal below may be where a pass begins.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Interpass {
    /// No pass begins on metal that is hotter, °C: the torch waits until it has cooled.
    pub max_temperature: f64,
    /// Passes that begin on colder metal are reported, °C; default none is too cold.
    pub min_temperature: Option<f64>,
    /// Whether passes of other islands come first, and passes begin at their cooler end, where that saves waiting; default
    /// true.
    #[serde(default = "yes")]
    pub reorder: bool,
    /// Whether the limit also holds along a pass: where the metal ahead of the torch would be hotter, the pass ends, the torch
    /// waits, and another arc start continues it; default false, and such passes are only reported.
    #[serde(default)]
    pub along: bool,
}

fn yes() -> bool {
    true
}

impl Material {
    /// The limits of its numbers.
    pub fn limits(&self) -> Vec<Limit> {
        limits! {
            "material.conductivity": self.conductivity, 0.05, 500.0, "W/(m·K)", "plastics have about 0.2, copper has 400";
            "material.specific_heat": self.specific_heat, 50.0, 5000.0, "J/(kg·K)", "metals have 130 to 1000, plastics up to 2500";
        }
    }
}

impl Substrate {
    /// The limits of its numbers.
    pub fn limits(&self) -> Vec<Limit> {
        limits! {
            "substrate.thickness": self.thickness, 0.5, 500.0, "mm", "parts are built on plates";
            "substrate.margin": self.margin, 0.0, 2000.0, "mm", "the plate must fit on a table";
            "substrate.contact": self.contact, 0.0, 1e5, "W/(m²·K)", "no cooling removes more";
            "substrate.preheat": self.preheat.unwrap_or(20.0), -50.0, 1000.0, "°C", "plates are not heated further";
            "substrate.conductivity": self.conductivity.unwrap_or(40.0), 0.05, 500.0, "W/(m·K)", "copper has 400";
            "substrate.specific_heat": self.specific_heat.unwrap_or(500.0), 50.0, 5000.0, "J/(kg·K)", "metals have 130 to 1000";
            "substrate.density": self.density.unwrap_or(7.8), 0.5, 25.0, "g/cm³", "aluminium has 2.7, tungsten 19";
        }
    }
}

impl HeatSection {
    /// The limits of its numbers.
    pub fn limits(&self) -> Vec<Limit> {
        limits! {
            "heat.arc_efficiency": self.arc_efficiency, 0.05, 1.0, "(fraction of the power)",
            "the part receives no more heat than the arc has";
            "heat.ambient": self.ambient, -50.0, 100.0, "°C", "people work there";
            "heat.convection": self.convection, 0.0, 1000.0, "W/(m²·K)", "only liquids remove more";
            "heat.emissivity": self.emissivity, 0.0, 1.0, "(fraction of a black body)", "no body radiates more than a black one";
            "heat.voxel": self.voxel.unwrap_or(5.0), 0.2, 100.0, "mm", "smaller ones take days, larger ones are coarser than most parts";
        }
    }
}

impl Interpass {
    /// The limits of its numbers.
    pub fn limits(&self) -> Vec<Limit> {
        limits! {
            "interpass.max_temperature": self.max_temperature, 30.0, 1500.0, "°C", "a part never gets below 30 °C in a warm shop";
            "interpass.min_temperature": self.min_temperature.unwrap_or(20.0), -50.0, 1000.0, "°C", "no steel is preheated further";
        }
    }
}

/// Everything that the heat model knows about a process.
#[derive(Debug, Clone, PartialEq)]
pub struct HeatSettings {
    /// The part.
    pub material: Material,
    /// Density of the part, g/cm³.
    pub density: f64,
    /// The plate.
    pub substrate: Substrate,
    /// Arc and surroundings.
    pub heat: HeatSection,
    /// Limits; `None` where no pass waits.
    pub interpass: Option<Interpass>,
    /// Cross-section of the metal laid at the nominal speed, mm².
    pub bead_area: f64,
    /// Width of the nominal bead, mm.
    pub bead_width: f64,
    /// For each body, whether it begins on metal that is not welded; the first always does, and level ones stand on a
    /// plate.
    pub on_stock: Vec<bool>,
    /// The box around the part seen from above, where voxels begin; `None` takes that of the slices, which may differ
    /// slightly.
    pub over: Option<Bounds>,
}

/// What a profile lacks for the heat model.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("the profile has no {0}: the temperatures cannot be computed without it. docs/heat.md names usual values.")]
pub struct HeatError(pub &'static str);

impl HeatSettings {
    /// Volumetric heat capacity of part and plate, J/(mm³·K).
    pub(super) fn capacities(&self) -> [f64; 2] {
        let plate = &self.substrate;
        let of = |density: f64, specific_heat: f64| density * specific_heat * 1e-6;
        let plate_heat = plate.specific_heat.unwrap_or(self.material.specific_heat);
        [of(self.density, self.material.specific_heat), of(plate.density.unwrap_or(self.density), plate_heat)]
    }

    /// Conductivity of part and plate, W/(mm·K).
    pub(super) fn conductivities(&self) -> [f64; 2] {
        let part = self.material.conductivity;
        [part * 1e-3, self.substrate.conductivity.unwrap_or(part) * 1e-3]
    }

    /// Temperature of the plate before the first pass, °C.
    pub(super) fn preheat(&self) -> f64 {
        self.substrate.preheat.unwrap_or(self.heat.ambient)
    }

    /// Size of voxels seen from above, mm.
    pub fn voxel(&self) -> f64 {
        self.heat.voxel.unwrap_or(self.bead_width)
    }

    /// Power of the arc that reaches the part at a pace (mm/s), W. The current follows the wire feed.
    pub(super) fn power_at(&self, process: &Process, pace: f64) -> f64 {
        let heat = process.heat_at(pace).unwrap_or_default();
        self.heat.arc_efficiency * heat * process.speed_at(pace)
    }
}
