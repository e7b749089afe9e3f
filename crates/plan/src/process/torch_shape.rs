//! The section `[torch]`: how much room the torch takes.

use crate::limit::{Limit, limits};
use serde::{Deserialize, Serialize};

/// The room that torch and hand take above the wire's tip: a cone that widens upward from the nozzle's end.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct TorchShape {
    /// Radius of the nozzle at its end, mm.
    pub nozzle_radius: f64,
    /// From the wire's tip up to the nozzle's end, mm.
    pub stick_out: f64,
    /// Angle between the wire and the side of a cone that begins at the nozzle's end and holds torch and hand, °.
    pub cone: f64,
}

impl TorchShape {
    /// The limits of the numbers.
    pub fn limits(&self) -> Vec<Limit> {
        limits! {
            "torch.nozzle_radius": self.nozzle_radius, 0.1, 200.0, "mm", "gas nozzles are 8 to 20 mm wide";
            "torch.stick_out": self.stick_out, 0.0, 100.0, "mm", "longer wires do not point where they should";
            "torch.cone": self.cone, 0.0, 85.0, "°", "a wider cone would lie on the part";
        }
    }

    /// Radius of the cone, mm, this far above the wire's tip, mm; `None` below the nozzle, where there is only the
    /// wire.
    pub fn radius(&self, above: f64) -> Option<f64> {
        let along = above - self.stick_out;
        (along >= 0.0).then(|| self.nozzle_radius + along * self.cone.to_radians().tan())
    }
}
