//! The shape of a bead's cross-section.

use serde::{Deserialize, Serialize};
use std::f64::consts::FRAC_PI_4;

/// A stadium's area is less than that of the box around it by this fraction of its squared height.
const CORNERS: f64 = 1.0 - FRAC_PI_4;

/// The shape of a bead's cross-section.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Section {
    /// A parabola: 2/3 of the box around it (Ding et al. 2015).
    #[default]
    Parabola,
    /// Half an ellipse: π/4 of the box around it.
    Ellipse,
    /// Flat with round sides, as left by a nozzle: the box less (1 − π/4) h².
    Stadium,
}

impl Section {
    /// Area of a bead of this width and height, mm².
    ///
    /// ```
    /// use bead_plan::bead::Section;
    /// use std::f64::consts::PI;
    ///
    /// // A stadium is a rectangle between two half discs.
    /// let (width, height) = (0.5, 0.2);
    /// let area = (width - height) * height + PI * height * height / 4.0;
    /// assert!((Section::Stadium.area(width, height) - area).abs() < 1e-12);
    /// assert!((Section::Stadium.height_of(width, area) - height).abs() < 1e-12);
    /// ```
    pub fn area(self, width: f64, height: f64) -> f64 {
        match self {
            Self::Parabola => 2.0 / 3.0 * width * height,
            Self::Ellipse => FRAC_PI_4 * width * height,
            // One that is higher than wide is a circle squeezed from the sides: its area never becomes negative.
            Self::Stadium => height * (width - CORNERS * height.min(width)),
        }
    }

    /// Height of a bead of this width and area, mm: the inverse of [`Self::area`].
    pub fn height_of(self, width: f64, area: f64) -> f64 {
        match self {
            Self::Parabola => 1.5 * area / width,
            Self::Ellipse => area / (FRAC_PI_4 * width),
            Self::Stadium => {
                // h w − c h² = A, up to h = w; higher ones are w (1 − c) wide on average.
                let most = FRAC_PI_4 * width * width;
                if area >= most {
                    return area / (FRAC_PI_4 * width);
                }
                (width - (width * width - 4.0 * CORNERS * area).max(0.0).sqrt()) / (2.0 * CORNERS)
            }
        }
    }

    /// Width of a bead of this height and area, mm: the other inverse of [`Self::area`].
    pub fn width_of(self, height: f64, area: f64) -> f64 {
        match self {
            Self::Parabola => 1.5 * area / height,
            Self::Ellipse => area / (FRAC_PI_4 * height),
            Self::Stadium if area >= FRAC_PI_4 * height * height => area / height + CORNERS * height,
            Self::Stadium => area / (FRAC_PI_4 * height),
        }
    }

    /// The width that a bead's metal covers in the deposit model, mm: a stadium counts as flat, and as wide as its
    /// area over its height.
    pub fn footprint(self, width: f64, height: f64) -> f64 {
        match self {
            Self::Parabola | Self::Ellipse => width,
            Self::Stadium => width - CORNERS * height.min(width),
        }
    }
}
