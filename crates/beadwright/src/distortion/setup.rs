//! How the distortion of a plan is computed: its clamps, and what is not as the profile says.

use super::{DistortionError, Welding};
use crate::profile::Profile;
use crate::task::{Stage, Task};
use distort::{Clamp, DVec3, Distortion, Settings};

/// Radius of a clamp, mm, and the distance of those along an edge, mm.
const CLAMP: (f64, f64) = (10.0, 60.0);

/// A metal whose elastic values and shrinkage are known.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Material {
    /// Structural steel.
    Steel,
    /// Aluminium.
    Aluminium,
}

/// Where clamps hold the plate until the build is done.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Clamps {
    /// One at each corner of the plate.
    #[default]
    Corners,
    /// All along its edge.
    Edge,
    /// It lies free.
    None,
}

/// How the distortion of a plan is computed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Setup {
    /// The metal, where it is not the one that the density of the wire suggests.
    pub material: Option<Material>,
    /// Where clamps hold the plate.
    pub clamps: Clamps,
    /// Stiffness of a clamp in each direction, N/mm.
    pub clamp_stiffness: f64,
    /// Factor of all shrinkage, found with a measured plate.
    pub calibration: f64,
    /// Length and width of voxels, mm, where they are not half a bead.
    pub voxel: Option<f64>,
    /// Height of voxels, mm, where it is not that of a layer.
    pub voxel_height: Option<f64>,
    /// Most steps: beads are laid in as many groups.
    pub most_steps: Option<usize>,
}

impl Default for Setup {
    fn default() -> Self {
        Self {
            material: None,
            clamps: Clamps::Corners,
            clamp_stiffness: Clamp::FIRM.x,
            calibration: 1.0,
            voxel: None,
            voxel_height: None,
            most_steps: None,
        }
    }
}

impl Setup {
    /// What becomes of plate and part.
    ///
    /// # Errors
    /// [`DistortionError`].
    pub fn build(&self, welding: &Welding, profile: &Profile, task: &Task) -> Result<Distortion, DistortionError> {
        let usual = match self.material {
            Some(Material::Steel) => welding.with_voxels(Settings::steel(), profile),
            Some(Material::Aluminium) => welding.with_voxels(Settings::aluminium(), profile),
            None => welding.settings(profile)?,
        };
        let settings = Settings {
            calibration: self.calibration,
            voxel: self.voxel.unwrap_or(usual.voxel),
            voxel_height: self.voxel_height.unwrap_or(usual.voxel_height),
            most_steps: self.most_steps.unwrap_or(usual.most_steps),
            ..usual
        };
        let (plate, stiffness, (radius, spacing)) = (&welding.plate, DVec3::splat(self.clamp_stiffness), CLAMP);
        let clamps = match self.clamps {
            Clamps::Corners => plate.clamped_at_corners(radius, stiffness),
            Clamps::Edge => plate.clamped_along_edge(spacing, radius, stiffness),
            Clamps::None => Vec::new(),
        };
        let mut go_on = |fraction| task.step(Stage::Distort, fraction).is_ok();
        Ok(distort::build(plate, &welding.beads, &clamps, &settings, &mut go_on)?)
    }
}
