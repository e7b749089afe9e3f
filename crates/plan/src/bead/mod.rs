//! The bead: its cross-section, the distance between neighbours, and the balance of wire and bead.
//!
//! | file | what it holds |
//! | --- | --- |
//! | [`law`] | how the height of a bead follows its width at a constant wire feed |
//! | [`pace`] | the speed at which the wire lays the metal of a bead |
//! | [`section`] | the shape of its cross-section |
//! | [`wall`] | how high walls with one bead per layer grow |
//! | [`by_heat`] | how it changes with the temperature of the metal below |
//! | [`library`] | width and height fitted to measured beads, and the parameters for a wanted bead |

pub mod by_heat;
pub mod law;
pub mod library;
pub mod pace;
pub mod section;
pub mod wall;

pub use by_heat::BeadByHeat;
pub use law::Law;
pub use section::Section;

use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// A single bead.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bead {
    /// Width at the foot, mm.
    pub width: f64,
    /// Height at the crown, mm.
    pub height: f64,
    /// Shape of the cross-section.
    pub section: Section,
}

impl Bead {
    /// A bead with the cross-section of a parabola.
    pub fn parabola(width: f64, height: f64) -> Self {
        Self { width, height, section: Section::Parabola }
    }

    /// Area of the cross-section, mm².
    pub fn area(&self) -> f64 {
        self.section.area(self.width, self.height)
    }

    /// Height of a closed layer of such beads `stepover` (mm) apart, mm: the area is spread over the stepover.
    ///
    /// ```
    /// use bead_plan::bead::Bead;
    ///
    /// let bead = Bead::parabola(6.0, 2.0);
    /// assert!((bead.area() - 2.0 / 3.0 * 6.0 * 2.0).abs() < 1e-12);
    /// // 8 mm² over 4 mm.
    /// assert!((bead.rise(4.0) - 2.0).abs() < 1e-12);
    /// ```
    pub fn rise(&self, stepover: f64) -> f64 {
        self.area() / stepover
    }

    /// The bead of this width and section whose closed layer at `stepover` has the height `layer_height` (all mm).
    ///
    /// ```
    /// use bead_plan::bead::Bead;
    ///
    /// let bead = Bead::parabola(6.0, 2.0).for_rise(4.0, 2.5);
    /// assert_eq!(bead.width, 6.0);
    /// assert!((bead.area() - 4.0 * 2.5).abs() < 1e-12);
    /// ```
    #[must_use]
    pub fn for_rise(self, stepover: f64, layer_height: f64) -> Self {
        let area = stepover * layer_height;
        Self { height: self.section.height_of(self.width, area), ..self }
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

/// Metal fed by the wire compared with metal in the bead, per second.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MassBalance {
    /// Metal from the wire, mm³/s.
    pub wire: f64,
    /// Metal in the bead, mm³/s.
    pub bead: f64,
    /// Deposition speed at which the two agree, mm/s.
    pub fitting_speed: f64,
}

impl MassBalance {
    /// Relative difference above which the balance counts as broken.
    pub const TOLERANCE: f64 = 0.05;

    /// Compares wire feed × wire area × efficiency with deposition speed × bead area. The wire feed is in m/min, the
    /// diameter in mm, the deposition speed in mm/s.
    ///
    /// ```
    /// use bead_plan::bead::{Bead, MassBalance};
    ///
    /// // 6 m/min of 1.2 mm wire are 113 mm³/s, far more than 8 mm² at 8 mm/s take.
    /// let bead = Bead::parabola(6.0, 2.0);
    /// let balance = MassBalance::new(bead, 6.0, 1.2, 1.0, 8.0);
    /// assert!(balance.warning().is_some());
    /// let balance = MassBalance::new(bead, 6.0, 1.2, 1.0, balance.fitting_speed);
    /// assert!((balance.ratio() - 1.0).abs() < 1e-12 && balance.warning().is_none());
    /// ```
    pub fn new(bead: Bead, wire_feed: f64, wire_diameter: f64, efficiency: f64, deposition_speed: f64) -> Self {
        let wire = wire_feed * 1000.0 / 60.0 * wire_area(wire_diameter) * efficiency;
        Self { wire, bead: deposition_speed * bead.area(), fitting_speed: wire / bead.area() }
    }

    /// Metal from the wire divided by metal in the bead.
    pub fn ratio(&self) -> f64 {
        self.wire / self.bead
    }

    /// A sentence that names the speed that would fit, when the two differ by more than 5 %.
    pub fn warning(&self) -> Option<String> {
        ((self.ratio() - 1.0).abs() > Self::TOLERANCE).then(|| {
            format!(
                "The wire supplies {:.1} mm³/s, but the bead needs {:.1} mm³/s at this deposition speed ({:+.0} %). \
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
