//! What shrinks, how much, and how finely it is computed.

use crate::body::check_elastic;
use crate::element::Elastic;
use crate::error::{DistortError, within};
use serde::{Deserialize, Serialize};

/// The values of a material and of the computation.
///
/// A bead pulls along its line with the tendon force `tendon` · heat input per length. It does so by the stress-free strain
/// of a zone: the bead's section and the metal beneath, as large as the force needs if it shrinks by `zone_strain`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Settings {
    /// Elastic values of plate and part, at room temperature.
    pub elastic: Elastic,
    /// Tendon force per heat input per length, N/(J/mm): 200 for steel (White 1977), or [`okerblom`].
    pub tendon: f64,
    /// Strain by which the zone of a bead shrinks along it. The zone has yielded, so this is about yield strength over
    /// Young's modulus.
    pub zone_strain: f64,
    /// No place shrinks by more than this multiple of `zone_strain` along a bead, however often it is welded over: hot
    /// metal forgets what it had shrunk before.
    pub saturation: f64,
    /// Strain across the bead as a fraction of that along it; our own default.
    pub across: f64,
    /// Strain along the bead's normal as a fraction of that along it; our own default.
    pub up: f64,
    /// Factor of all shrinkage, from one measured plate ([`crate::Distortion::calibrated`]).
    pub calibration: f64,
    /// Length and width of voxels, mm; changed a little so that the plate has a whole number of them.
    pub voxel: f64,
    /// Height of voxels, mm; changed a little so that the plate has a whole number of them.
    pub voxel_height: f64,
    /// Most steps of a build. Beads are laid in as many groups of about the same volume; if there are fewer beads, each
    /// is a step. With two layers of a wall at a time, the plate bends less by some 4 %.
    pub most_steps: usize,
    /// Force out of balance after each step but the last, as a fraction of what the step brought. It is not lost, but
    /// carried to the next step.
    pub tolerance: f64,
}

impl Settings {
    /// Carbon steel such as ER70S-6: E 210 GPa, ν 0.3, 200 N/(J/mm), yield strength 420 MPa; voxels of 3 × 3 × 2 mm.
    pub fn steel() -> Self {
        Self {
            elastic: Elastic { young: 210e3, poisson: 0.3 },
            tendon: 200.0,
            zone_strain: 0.002,
            saturation: 1.25,
            across: 0.35,
            up: 0.0,
            calibration: 1.0,
            voxel: 3.0,
            voxel_height: 2.0,
            most_steps: 80,
            tolerance: 1e-2,
        }
    }

    /// Aluminium such as ER2319 or ER5356 as deposited: E 70 GPa, ν 0.33, yield strength 125 MPa, and Okerblom's tendon
    /// with 23.5 · 10⁻⁶/K and 2.5 · 10⁻³ J/(mm³·K): 220 N/(J/mm).
    pub fn aluminium() -> Self {
        let elastic = Elastic { young: 70e3, poisson: 0.33 };
        let tendon = okerblom(23.5e-6, 2.5e-3, elastic.young);
        Self { elastic, tendon, zone_strain: 0.0018, ..Self::steel() }
    }

    /// An error unless all numbers are in their ranges.
    pub fn check(&self) -> Result<(), DistortError> {
        check_elastic(&self.elastic)?;
        within("tendon force per heat input", self.tendon, [0.0, 1e4], "N/(J/mm)")?;
        within("strain of the zone", self.zone_strain, [1e-6, 0.05], "(no unit)")?;
        within("saturation", self.saturation, [1.0, 100.0], "(of the strain of the zone)")?;
        within("strain across", self.across, [-2.0, 5.0], "(of the strain along)")?;
        within("strain up", self.up, [-5.0, 5.0], "(of the strain along)")?;
        within("calibration", self.calibration, [0.0, 100.0], "(factor)")?;
        within("voxel", self.voxel, [0.05, 1000.0], "mm")?;
        within("voxel height", self.voxel_height, [0.05, 1000.0], "mm")?;
        within("steps", self.most_steps as f64, [1.0, 1e6], "(number)")?;
        within("tolerance", self.tolerance, [1e-13, 0.1], "(of the load)")
    }
}

/// Tendon force per heat input per length, N/(J/mm): 0.335 α E / ρc, as it is quoted from Okerblom (1958), with expansion
/// α, 1/K, heat capacity of the volume ρc, J/(mm³·K), and Young's modulus E, MPa.
///
/// ```
/// // 12 · 10⁻⁶/K and 4.5 · 10⁻³ J/(mm³·K): close to the 200 in common use.
/// let steel = distort::okerblom(12e-6, 4.5e-3, 210e3);
/// assert!((steel - 187.6).abs() < 0.1);
/// ```
pub fn okerblom(expansion: f64, heat_capacity: f64, young: f64) -> f64 {
    0.335 * expansion / heat_capacity * young
}
