//! The bead: its parabolic cross-section, the distance between neighbours, and the balance of wire and bead.
//!
//! | file | what it holds |
//! | --- | --- |
//! | [`wall`] | how high walls of one bead a layer grow |
//! | [`library`] | width and height fitted to measured beads, and the parameters for a wanted bead |

pub mod library;
pub mod wall;

use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// A single bead with the cross-section of a parabola.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bead {
    /// Width at the foot, mm.
    pub width: f64,
    /// Height at the crown, mm.
    pub height: f64,
}

impl Bead {
    /// Area of the cross-section, mm²: two thirds of the box around a parabola.
    pub fn area(&self) -> f64 {
        2.0 / 3.0 * self.width * self.height
    }

    /// Height of a closed layer of such beads `stepover` (mm) apart, mm: the area is spread over the stepover.
    pub fn rise(&self, stepover: f64) -> f64 {
        self.area() / stepover
    }

    /// The bead of `width` whose layer at `stepover` rises by `layer_height` (all mm).
    pub fn for_rise(width: f64, stepover: f64, layer_height: f64) -> Self {
        Self { width, height: 1.5 * stepover * layer_height / width }
    }
}

/// How far apart neighbouring beads lie.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Overlap {
    /// Tangent overlap, 0.738 w (Ding et al. 2015; used by Liu et al. 2022).
    Tangent,
    /// Inclined flat top, 0.715 w (Fang et al.; Zhao et al. 2023, table 1).
    InclinedFlatTop,
    /// The stepover is given in mm.
    Free,
}

impl Overlap {
    /// Stepover as a multiple of the bead width; `None` where it is given in mm.
    pub fn ratio(self) -> Option<f64> {
        match self {
            Self::Tangent => Some(0.738),
            Self::InclinedFlatTop => Some(0.715),
            Self::Free => None,
        }
    }
}

/// Metal in against metal laid, per second.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MassBalance {
    /// Metal from the wire, mm³/s.
    pub wire: f64,
    /// Metal in the bead, mm³/s.
    pub bead: f64,
    /// Deposition speed at which both agree, mm/s.
    pub fitting_speed: f64,
}

impl MassBalance {
    /// Difference from which the balance counts as broken.
    pub const TOLERANCE: f64 = 0.05;

    /// wire feed × wire area × efficiency against deposition speed × bead area. The wire feed is in m/min, the
    /// diameter in mm, the deposition speed in mm/s.
    pub fn new(bead: Bead, wire_feed: f64, wire_diameter: f64, efficiency: f64, deposition_speed: f64) -> Self {
        let wire = wire_feed * 1000.0 / 60.0 * wire_area(wire_diameter) * efficiency;
        Self { wire, bead: deposition_speed * bead.area(), fitting_speed: wire / bead.area() }
    }

    /// Metal of the wire over metal of the bead.
    pub fn ratio(&self) -> f64 {
        self.wire / self.bead
    }

    /// A sentence that names the speed that would fit, when the two differ by more than 5 %.
    pub fn warning(&self) -> Option<String> {
        ((self.ratio() - 1.0).abs() > Self::TOLERANCE).then(|| {
            format!(
                "The wire brings {:.1} mm³/s, but the bead takes {:.1} mm³/s at this deposition speed ({:+.0} %). \
                 A deposition_speed of {:.2} mm/s would fit.",
                self.wire,
                self.bead,
                (self.ratio() - 1.0) * 100.0,
                self.fitting_speed
            )
        })
    }
}

/// Cross-section of a wire, mm².
pub fn wire_area(diameter: f64) -> f64 {
    PI * diameter * diameter / 4.0
}
