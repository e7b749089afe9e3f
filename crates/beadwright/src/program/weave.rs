//! The section `[weave]` of a profile.

use crate::limit::{Limit, limits};
use serde::{Deserialize, Serialize};

/// How the torch swings from side to side along a pass, by the controller's own weaving. The bead of `[bead]` is then the
/// woven one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Weave {
    /// Way along the pass in which the torch swings to both sides once, mm.
    pub length: f64,
    /// How far it swings to each side, mm.
    pub amplitude: f64,
    /// How long it stays at each side, s; default 0.
    #[serde(default)]
    pub dwell: f64,
    /// Number of the weaving file that has these values, on Yaskawa controllers; default 1.
    #[serde(default = "one")]
    pub file: u32,
}

fn one() -> u32 {
    1
}

impl Weave {
    pub(crate) fn limits(&self) -> Vec<Limit> {
        limits! {
            "weave.length": self.length, 0.5, 50.0, "mm", "controllers weave neither finer nor coarser";
            "weave.amplitude": self.amplitude, 0.1, 25.0, "mm", "controllers weave neither finer nor coarser";
            "weave.dwell": self.dwell, 0.0, 5.0, "s", "standing still longer with the arc on burns through";
            "weave.file": self.file.into(), 1.0, 255.0, "(weaving file)", "controllers have files 1 to 255";
        }
    }
}
