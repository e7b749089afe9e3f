//! The bead law: how a bead's height follows its width when the wire feed is constant and the speed changes.
//!
//! The mass balance fixes area × speed = nominal area × nominal speed; the law says how that area splits into width and
//! height. Single beads show a constant ratio λ = width/height (2.5 to 3 is good, Li et al.): width and height both
//! grow with √area. For widths from a to b times the nominal width, the speed then ranges from 1/b² to 1/a² times the
//! nominal speed, at constant height only from 1/b to 1/a: for a = 0.8 and b = 1.3 that is 0.59 to 1.56, or 0.77 to
//! 1.25. At constant height λ leaves its good range as the width changes; at constant ratio it does not.

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
    /// The bead of `width` (mm), derived from the nominal bead.
    pub fn bead(&self, nominal: &Bead, width: f64) -> Bead {
        let height = match self {
            Self::ConstantHeight => nominal.height,
            Self::ConstantRatio => nominal.height * width / nominal.width,
            Self::Library(beads) => interpolated(beads, width).unwrap_or(nominal.height),
        };
        Bead { width, height, section: nominal.section }
    }

    /// The pace of a bead of `width` (mm): the speed at which the nominal wire feed lays it, relative to the nominal
    /// speed.
    ///
    /// ```
    /// use bead_plan::bead::{Bead, Law};
    ///
    /// // A bead twice as wide holds twice the metal, or four times as much where it is twice as high too.
    /// let nominal = Bead::parabola(6.0, 2.0);
    /// assert!((Law::ConstantHeight.pace(&nominal, 12.0) - 0.5).abs() < 1e-12);
    /// assert!((Law::ConstantRatio.pace(&nominal, 12.0) - 0.25).abs() < 1e-12);
    /// ```
    pub fn pace(&self, nominal: &Bead, width: f64) -> f64 {
        nominal.area() / self.bead(nominal, width).area()
    }

    /// Width, mm, of the bead with this area, mm²: the inverse of [`Self::bead`].
    pub fn width_of_area(&self, nominal: &Bead, area: f64) -> f64 {
        match self {
            Self::ConstantHeight => return nominal.section.width_of(nominal.height, area),
            Self::ConstantRatio => return nominal.width * (area / nominal.area()).sqrt(),
            Self::Library(_) => {}
        }
        // The area increases with the width.
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

/// Height interpolated between the two neighbouring measured beads. Below the narrowest and above the widest, the bead
/// keeps the width/height ratio measured there.
fn interpolated(beads: &[[f64; 2]], width: f64) -> Option<f64> {
    let behind = beads.partition_point(|bead| bead[0] < width);
    match (behind.checked_sub(1).and_then(|i| beads.get(i)), beads.get(behind)) {
        (Some(&[w0, h0]), Some(&[w1, h1])) => Some(h0 + (h1 - h0) * (width - w0) / (w1 - w0)),
        (None, Some(&[w, h])) | (Some(&[w, h]), None) => Some(h * width / w),
        (None, None) => None,
    }
}
