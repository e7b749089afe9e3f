//! Growing and shrinking a region by a distance.
//!
//! The result is simplified by [`SIMPLIFY_MM`] before it is returned: round joins multiply vertices, and
//! chained offsets would otherwise become slower with every step.

use crate::grid::{GRID_MM, region_from_grid, region_to_grid};
use crate::{Polygon, Region};
use i_overlay::core::overlay::IntOverlayOptions;
use i_overlay::i_float::int::angle::Angle;
use i_overlay::mesh::int::arc::ArcOptions;
use i_overlay::mesh::int::outline::offset::IntOutlineOffset;
use i_overlay::mesh::int::style::{IntLineJoin, IntOutlineStyle};
use i_overlay::mesh::math::MathMode;

/// Offsets are simplified by this, mm.
pub const SIMPLIFY_MM: f64 = 0.003;

/// Default distance between an arc and its chords, mm.
pub const ARC_TOLERANCE_MM: f64 = 0.005;

/// Offset results smaller than this are dropped, mm².
const MIN_AREA_MM2: f64 = 1e-4;

/// How the gap opens at a corner that turns away from the offset.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Join {
    /// An arc about the corner, its chords within the tolerance (mm): the exact set of points at a distance.
    Round(f64),
    /// The two lines prolonged, cut off where the tip would reach farther than this multiple of the distance.
    Miter(f64),
}

impl Join {
    /// A round join within [`ARC_TOLERANCE_MM`].
    pub const ROUND: Self = Self::Round(ARC_TOLERANCE_MM);

    pub(crate) fn to_style(self, distance: f64) -> IntLineJoin {
        let angle = |radians: f64| Angle::from_radians(radians).unwrap_or(Angle::from_bits(0));
        match self {
            Self::Round(tolerance) => {
                let step = 2.0 * (1.0 - tolerance / distance.abs().max(tolerance)).acos();
                IntLineJoin::Round(ArcOptions {
                    max_step: angle(step.min(std::f64::consts::FRAC_PI_4)),
                    ..ArcOptions::default()
                })
            }
            Self::Miter(limit) => IntLineJoin::Miter(angle(2.0 * (1.0 / limit.max(1.0)).asin())),
        }
    }
}

impl Region {
    /// All points within `distance` (mm) of the region when positive; when negative, all points of it that lie
    /// at least that far from its boundary. Empty when nothing is left.
    pub fn offset(&self, distance: f64, join: Join) -> Self {
        if self.is_empty() || distance == 0.0 {
            return self.clone();
        }
        let steps = (distance / GRID_MM).round() as i32;
        let style = IntOutlineStyle::new(steps).line_join(join.to_style(distance)).math(MathMode::Float);
        let options = IntOverlayOptions {
            min_output_area: (MIN_AREA_MM2 / (GRID_MM * GRID_MM)) as u64,
            ..IntOverlayOptions::default()
        };
        let shapes = region_to_grid(self).outline_custom(&style, options).unwrap_or_default();
        region_from_grid(shapes).simplified(SIMPLIFY_MM)
    }
}

impl Polygon {
    /// [`Region::offset`] of this polygon alone.
    pub fn offset(&self, distance: f64, join: Join) -> Region {
        Region::from(self.clone()).offset(distance, join)
    }
}
