//! STL has no units. Millimetres are assumed, unless the part would then be smaller than a few beads.

use glam::DVec3;
use serde::{Deserialize, Serialize};

/// The unit of a model's coordinates.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Units {
    /// Millimetres.
    #[serde(rename = "mm")]
    Millimetre,
    /// Centimetres.
    #[serde(rename = "cm")]
    Centimetre,
    /// Metres.
    #[serde(rename = "m")]
    Metre,
    /// Inches.
    #[serde(rename = "in")]
    Inch,
}

/// The user must give the unit of a part narrower than this many beads.
const MIN_BEADS: f64 = 3.0;

impl Units {
    /// All units with the names that people type.
    pub const ALL: [(&'static str, Self); 4] =
        [("mm", Self::Millimetre), ("cm", Self::Centimetre), ("m", Self::Metre), ("in", Self::Inch)];

    /// The unit's name in the plural: `inches`.
    pub fn plural(self) -> &'static str {
        match self {
            Self::Millimetre => "millimetres",
            Self::Centimetre => "centimetres",
            Self::Metre => "metres",
            Self::Inch => "inches",
        }
    }

    /// Millimetres per unit.
    pub fn in_mm(self) -> f64 {
        match self {
            Self::Millimetre => 1.0,
            Self::Centimetre => 10.0,
            Self::Metre => 1000.0,
            Self::Inch => 25.4,
        }
    }
}

/// The part is so small for this bead that its unit is probably another one.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error(
    "the part measures {} in the file's units. As millimetres it would be smaller than {MIN_BEADS} beads of {bead_width} mm. \
     Say which unit is meant: inches make it {} mm, centimetres {} mm, metres {} mm.",
    size_text(*.size, 1.0), size_text(*.size, 25.4), size_text(*.size, 10.0), size_text(*.size, 1000.0)
)]
pub struct UnitsUnclear {
    /// Extent in file units.
    pub size: DVec3,
    /// Bead width, mm.
    pub bead_width: f64,
}

impl UnitsUnclear {
    /// The part's size by a unit, mm, as text.
    pub fn size_in(&self, units: Units) -> String {
        size_text(self.size, units.in_mm())
    }
}

fn size_text(size: DVec3, factor: f64) -> String {
    let s = size * factor;
    let digits = if s.max_element() < 10.0 { 2 } else { 0 };
    format!("{:.digits$} × {:.digits$} × {:.digits$}", s.x, s.y, s.z)
}

/// Returns millimetres, unless the part would then be narrower than three beads in x and y.
///
/// # Errors
/// [`UnitsUnclear`], whose text gives the sizes in the other units.
pub fn guess(size: DVec3, bead_width: f64) -> Result<Units, UnitsUnclear> {
    let widest = size.x.max(size.y);
    if widest < MIN_BEADS * bead_width { Err(UnitsUnclear { size, bead_width }) } else { Ok(Units::Millimetre) }
}
