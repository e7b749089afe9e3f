//! A plan as input of the distortion model: beads with their heat on a plate, and the settings that suit a profile; and a part bent
//! beforehand ([`compensate`]); its [`page`](mod@page).

pub mod compensate;
pub mod page;
mod setup;

pub use setup::{Clamps, Material, Setup};

use crate::heat::{self, HeatError, Moment};
use crate::layer::Layer;
use crate::pass::Pass;
use crate::process::Process;
use crate::profile::Profile;
use crate::task::Task;
use distort::{Bead, DVec3, DistortError, Eccentricity, Plate, Settings};
use std::borrow::Borrow;

/// Voxels are made larger if the lattice around plate and part would have more than this.
const WANTED_VOXELS: f64 = 400_000.0;
/// Times at which the thermal eccentricity of a plan is computed.
const MOMENTS: f64 = 500.0;
/// From this density on, g/cm³, a wire counts as steel, and up to this one as aluminium.
const STEEL: f64 = 7.0;
const ALUMINIUM: f64 = 3.5;

/// Why the distortion of a plan cannot be computed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DistortionError {
    /// The profile lacks thermal values.
    #[error("The distortion cannot be computed: the profile has no {}. Add it; docs/heat.md names usual values.", .0.0)]
    Lacks(#[from] HeatError),
    /// Layers are not level.
    #[error("The layers of this plan are not level: only parts on a flat plate can be computed so far.")]
    NotLevel,
    /// There is nothing to weld.
    #[error("The plan has no passes.")]
    NoPasses,
    /// Neither steel nor aluminium.
    #[error(
        "A wire of {0} g/cm³ is neither steel nor aluminium, whose elastic values are known here. Choose the material \
         whose values come closest."
    )]
    Material(f64),
    /// The model refuses.
    #[error(transparent)]
    Model(#[from] DistortError),
}

/// A plan as the distortion model sees it.
#[derive(Debug, Clone, PartialEq)]
pub struct Welding {
    /// The plate of the profile's `[substrate]`, below the first layer.
    pub plate: Plate,
    /// The passes in the order of welding. Times leave out travels, but not the waits of passes.
    pub beads: Vec<Bead>,
}

impl Welding {
    /// The passes of layers, with the heat that the profile's arc puts into them.
    ///
    /// # Errors
    /// The profile lacks thermal values, layers are not level, or there are no passes.
    pub fn of<L: Borrow<Layer>>(layers: &[L], profile: &Profile) -> Result<Self, DistortionError> {
        let (heat, weld) = (profile.heat_settings()?, profile.weld_settings());
        if !weld.is_level() || weld.charts.len() > 1 {
            return Err(DistortionError::NotLevel);
        }
        let (mut beads, mut now) = (Vec::new(), 0.0);
        for layer in layers.iter().map(Borrow::borrow) {
            let process = weld.process.at_layer(layer.index);
            for pass in &layer.passes {
                now += pass.wait;
                let bead = bead(pass, layer, &process, heat.heat.arc_efficiency, now);
                now += pass.seconds(&process);
                beads.extend(bead);
            }
        }
        let points = || beads.iter().flat_map(|bead| &bead.points).copied();
        let (Some(low), Some(high)) = (points().reduce(DVec3::min), points().reduce(DVec3::max)) else {
            return Err(DistortionError::NoPasses);
        };
        let floor = layers.first().map(Borrow::borrow).map_or(0.0, |layer| layer.z - layer.height);
        let around = heat.substrate.margin + 0.5 * heat.bead_width;
        let plate = Plate {
            low: (low - around).with_z(floor - heat.substrate.thickness),
            high: (high + around).with_z(floor),
            stiffness: 1.0,
        };
        Ok(Self { plate, beads })
    }

    /// Settings for the metal of the profile's wire: voxels half a bead wide and a layer high, larger where there would be
    /// too many.
    ///
    /// # Errors
    /// [`DistortionError::Material`] for a wire that is neither steel nor aluminium.
    pub fn settings(&self, profile: &Profile) -> Result<Settings, DistortionError> {
        let density = profile.wire.density;
        let material = match density {
            _ if density >= STEEL => Settings::steel(),
            _ if density <= ALUMINIUM => Settings::aluminium(),
            _ => return Err(DistortionError::Material(density)),
        };
        Ok(self.with_voxels(material, profile))
    }

    /// The same for given values of a material.
    pub fn with_voxels(&self, material: Settings, profile: &Profile) -> Settings {
        let (wide, high) = (0.5 * profile.bead.width, profile.bead.height);
        let top = self.beads.iter().flat_map(|bead| &bead.points).map(|p| p.z).fold(self.plate.high.z, f64::max);
        let room = self.plate.size().truncate().extend(top - self.plate.low.z);
        let voxels = room.x * room.y * room.z / (wide * wide * high);
        let larger = (voxels / WANTED_VOXELS).cbrt().max(1.0);
        Settings { voxel: larger * wide, voxel_height: larger * high, ..material }
    }
}

/// The thermal eccentricity of a plan over its time, at about 500 times, by the heat model: from the middle of all metal, plate
/// included, to that of the heat above the temperature of the surroundings.
///
/// # Errors
/// The profile lacks thermal values, or the task was cancelled.
pub fn eccentricity(layers: &[Layer], profile: &Profile, task: &Task) -> Result<Vec<Eccentricity>, DistortionError> {
    let (settings, weld) = (profile.heat_settings()?, profile.weld_settings());
    let of_layer = |layer: &Layer| -> f64 {
        let process = weld.process.at_layer(layer.index);
        layer.passes.iter().map(|pass| pass.wait + pass.seconds(&process)).sum()
    };
    let every = layers.iter().map(of_layer).sum::<f64>() / MOMENTS;
    let course = heat::course(layers, &settings, &weld, every, task).map_err(|_| DistortError::Cancelled)?;
    let offset = |m: &Moment| Eccentricity { time: m.time, heat: m.heat, offset: m.hot - m.middle };
    Ok(course.iter().map(offset).collect())
}

/// A pass as a bead; `None` for one without length, such as a dot.
fn bead(pass: &Pass, layer: &Layer, process: &Process, efficiency: f64, start: f64) -> Option<Bead> {
    let again = pass.closed.then(|| pass.points.first()).flatten();
    let points: Vec<DVec3> = pass.points.iter().chain(again).copied().collect();
    let length = pass.length();
    if length <= 0.0 {
        return None;
    }
    // Width and heat may change along a pass; the model has their means.
    let mean = |value: &dyn Fn(f64, f64) -> f64| {
        pass.segments().map(|segment| segment.length() * value(segment.width, segment.pace)).sum::<f64>() / length
    };
    let width = mean(&|width, _| width);
    let heat = efficiency * mean(&|_, pace| process.heat_at(pace).unwrap_or_default());
    let end = start + pass.seconds(process);
    Some(Bead { points, width, height: layer.height, heat, start, end, up: DVec3::Z })
}
