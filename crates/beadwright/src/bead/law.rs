//! The bead law: how a bead's height follows its width when the wire feed stays and the speed changes.
//!
//! The mass balance ties area and speed: area × speed = nominal area × nominal speed. How the metal spreads is the law's.
//! A constant ratio λ = width/height is what single beads show (λ = 2.5 to 3 is good, Li et al.): width and height both
//! grow with √area. A window of widths from a to b times the nominal then takes speeds from 1/b² to 1/a² of the nominal
//! one, at constant height only from 1/b to 1/a: 0.59 to 1.56, or 0.77 to 1.25, for a window of 0.8 to 1.3. At constant
//! height λ itself leaves its good range with the width; at constant ratio it does not.

use super::Bead;
use serde::{Deserialize, Serialize};

/// How a bead's height follows its width.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Law {
    /// The height stays: a bead twice as wide is laid at half the speed.
    #[default]
    ConstantHeight,
    /// Width and height keep their ratio: a bead twice as wide is laid at a quarter of the speed.
    ConstantRatio,
    /// Beads measured at the nominal wire feed, as [width, height] in mm, the narrowest first; straight lines between them.
    Library(
        /// Width and height of each bead, mm.
        Vec<[f64; 2]>,
    ),
}

impl Law {
    /// The bead of that width (mm), given the nominal one.
    pub fn bead(&self, nominal: &Bead, width: f64) -> Bead {
        let height = match self {
            Self::ConstantHeight => nominal.height,
            Self::ConstantRatio => nominal.height * width / nominal.width,
            Self::Library(beads) => interpolated(beads, width).unwrap_or(nominal.height),
        };
        Bead { width, height, section: nominal.section }
    }

    /// The speed at which the nominal wire feed lays a bead of that width (mm), as a part of the nominal speed.
    pub fn pace(&self, nominal: &Bead, width: f64) -> f64 {
        nominal.area() / self.bead(nominal, width).area()
    }

    /// Width, mm, of the bead with that area, mm²: the inverse of [`Self::bead`].
    pub fn width_of_area(&self, nominal: &Bead, area: f64) -> f64 {
        match self {
            Self::ConstantHeight => return nominal.section.width_of(nominal.height, area),
            Self::ConstantRatio => return nominal.width * (area / nominal.area()).sqrt(),
            Self::Library(_) => {}
        }
        // Areas grow with the width.
        let (mut low, mut high) = (0.0, nominal.width);
        while self.bead(nominal, high).area() < area && high < 1e3 * nominal.width {
            high *= 2.0;
        }
        for _ in 0..40 {
            let middle = (low + high) / 2.0;
            *(if self.bead(nominal, middle).area() < area { &mut low } else { &mut high }) = middle;
        }
        high
    }
}

/// The height on the straight line between the beads beside; beyond the measured ones the ratio of the last stays.
fn interpolated(beads: &[[f64; 2]], width: f64) -> Option<f64> {
    let behind = beads.partition_point(|bead| bead[0] < width);
    match (behind.checked_sub(1).and_then(|i| beads.get(i)), beads.get(behind)) {
        (Some(&[w0, h0]), Some(&[w1, h1])) => Some(h0 + (h1 - h0) * (width - w0) / (w1 - w0)),
        (None, Some(&[w, h])) | (Some(&[w, h]), None) => Some(h * width / w),
        (None, None) => None,
    }
}
