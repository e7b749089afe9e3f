//! Growing and shrinking a region by a distance.
//!
//! The result is simplified by [`SIMPLIFY_MM`] before it is returned: round joins multiply vertices, and
//! chained offsets would otherwise become slower with every step.

use crate::grid::{GRID_MM, region_from_grid, region_to_grid};
use crate::{Polygon, Region, Ring};
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
        self.unsimplified_offset(distance, join).simplified(SIMPLIFY_MM)
    }

    fn unsimplified_offset(&self, distance: f64, join: Join) -> Self {
        let steps = (distance / GRID_MM).round() as i32;
        let style = IntOutlineStyle::new(steps).line_join(join.to_style(distance)).math(MathMode::Float);
        let options = IntOverlayOptions {
            min_output_area: (MIN_AREA_MM2 / (GRID_MM * GRID_MM)) as u64,
            ..IntOverlayOptions::default()
        };
        region_from_grid(region_to_grid(self).outline_custom(&style, options).unwrap_or_default())
    }
}

impl Polygon {
    /// [`Region::offset`] of this polygon alone.
    pub fn offset(&self, distance: f64, join: Join) -> Region {
        Region::from(self.clone()).offset(distance, join)
    }

    /// Area (mm²) that a disc of a radius (mm) reaches without leaving the polygon, given where its centre may lie: area +
    /// radius · perimeter + π radius² · euler of that region (Steiner). `None` where the region is connected in another way
    /// than the polygon: then parts of it may reach the same points.
    pub fn reached_by_disc(&self, radius: f64, centre: &Region) -> Option<f64> {
        let [part] = centre.polygons() else { return None };
        let round = std::f64::consts::PI * radius * radius * centre.euler() as f64;
        (part.holes.len() == self.holes.len()).then(|| centre.area() + radius * centre.perimeter() + round)
    }

    /// Whether a disc of a radius (mm) that rolls through the polygon leaves nowhere more than `smallest` (mm²) empty in one
    /// place. Corners between long edges may be left as empty as they must be; "no" may be wrong, where many other corners
    /// together are left emptier.
    pub fn is_roomy_for_disc(&self, radius: f64, smallest: f64, join: Join) -> bool {
        let centre = Region::from(self.clone()).unsimplified_offset(-radius, join);
        let corners: f64 = self.rings().map(|ring| emptied_corners(ring, radius, smallest)).sum();
        self.reached_by_disc(radius, &centre).is_some_and(|reached| self.area() - reached - corners <= smallest)
    }
}

/// Area (mm²) that a disc leaves empty in the convex corners of a ring; only corners from whose edges it touches less than
/// half, and that are left less empty than `smallest` (mm²).
fn emptied_corners(ring: &Ring, radius: f64, smallest: f64) -> f64 {
    let points = ring.points();
    let n = points.len();
    let corner = |i: usize| {
        let (into, out) = (points[i] - points[(i + n - 1) % n], points[(i + 1) % n] - points[i]);
        let turn = into.angle_to(out);
        let tangent = radius * (turn / 2.0).tan();
        let area = radius * (tangent - radius * turn / 2.0);
        let alone = 2.0 * tangent <= into.length().min(out.length());
        if turn > 0.0 && alone && area <= smallest { area } else { 0.0 }
    };
    (0..n).map(corner).sum()
}
