//! Growing and shrinking a region by a distance.
//!
//! The result is simplified by [`SIMPLIFY_MM`] before it is returned: round joins multiply vertices, and
//! chained offsets would otherwise become slower with every step.

use crate::edgewise::edgewise_offset;
use crate::grid::{GRID_MM, region_from_grid, region_to_grid};
use crate::{Polygon, Region, Ring};
use i_overlay::core::overlay::IntOverlayOptions;
use i_overlay::i_float::int::angle::Angle;
use i_overlay::mesh::int::arc::ArcOptions;
use i_overlay::mesh::int::outline::offset::IntOutlineOffset;
use i_overlay::mesh::int::style::{IntLineJoin, IntOutlineStyle};
use i_overlay::mesh::math::MathMode;

/// Tolerance by which offsets are simplified, mm.
pub const SIMPLIFY_MM: f64 = 0.003;

/// Default distance between an arc and its chords, mm.
pub const ARC_TOLERANCE_MM: f64 = 0.005;

/// Offset results smaller than this are dropped, mm².
const MIN_AREA_MM2: f64 = 1e-4;

/// How the gap is closed at a corner whose edges move apart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Join {
    /// An arc about the corner, its chords within this tolerance (mm): the exact set of points at a distance.
    Round(f64),
    /// The two lines prolonged, cut off where the tip would reach farther than this multiple of the distance.
    Miter(f64),
}

impl Join {
    /// A round join within [`ARC_TOLERANCE_MM`].
    pub const ROUND: Self = Self::Round(ARC_TOLERANCE_MM);

    /// The angle between the points of an arc whose chords stay within a tolerance (mm), radians.
    pub(crate) fn step(tolerance: f64, distance: f64) -> f64 {
        // The boolean takes no finer steps than 1024 per turn.
        const LEAST: f64 = std::f64::consts::TAU / 1024.0;
        (2.0 * (1.0 - tolerance / distance.abs().max(tolerance)).acos()).clamp(LEAST, std::f64::consts::FRAC_PI_4)
    }

    pub(crate) fn to_style(self, distance: f64) -> IntLineJoin {
        let angle = |radians: f64| Angle::from_radians(radians).unwrap_or(Angle::from_bits(0));
        match self {
            Self::Round(tolerance) => IntLineJoin::Round(ArcOptions {
                max_step: angle(Self::step(tolerance, distance)),
                ..ArcOptions::default()
            }),
            Self::Miter(limit) => IntLineJoin::Miter(angle(2.0 * (1.0 / limit.max(1.0)).asin())),
        }
    }
}

impl Region {
    /// All points within `distance` (mm) of the region when positive; when negative, all points of it that lie
    /// at least that far from its boundary. Empty when nothing is left.
    ///
    /// ```
    /// use planar::{DVec2, Join, Polygon, Region, Ring};
    /// use std::f64::consts::PI;
    ///
    /// let corners = [(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)].map(DVec2::from);
    /// let square = Region::from(Polygon::simple(Ring::new(corners.to_vec())));
    /// assert!((square.offset(1.0, Join::Miter(2.0)).area() - 12.0 * 12.0).abs() < 0.02);
    /// // Round corners: a quarter of a disc at each of the four.
    /// assert!((square.offset(1.0, Join::ROUND).area() - (100.0 + 4.0 * 10.0 + PI)).abs() < 0.2);
    /// assert!(square.offset(-6.0, Join::ROUND).is_empty());
    /// ```
    pub fn offset(&self, distance: f64, join: Join) -> Self {
        if self.is_empty() || distance == 0.0 {
            return self.clone();
        }
        self.unsimplified_offset(distance, join).simplified(SIMPLIFY_MM)
    }

    fn unsimplified_offset(&self, distance: f64, join: Join) -> Self {
        edgewise_offset(self, distance, join)
            .map_or_else(|| self.boolean_offset(distance, join), |region| region.without_specks(MIN_AREA_MM2))
    }

    fn boolean_offset(&self, distance: f64, join: Join) -> Self {
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

    /// Where the centre of a disc of this radius (mm) inside the polygon may lie: [`Self::offset`] inwards, but not
    /// simplified, so that areas are exact.
    pub fn centres_of_disc(&self, radius: f64, join: Join) -> Region {
        Region::from(self.clone()).unsimplified_offset(-radius, join)
    }

    /// Area (mm²) that a disc of this radius (mm) can reach inside the polygon, given where its centre may lie: area +
    /// radius · perimeter + π radius² · Euler characteristic of that region (Steiner's formula). `None` where that
    /// region is not one polygon with as many holes as this one: separate parts may then reach the same points.
    ///
    /// ```
    /// use planar::{DVec2, Join, Polygon, Ring};
    /// use std::f64::consts::FRAC_PI_4;
    ///
    /// // In a corner of a square, a disc leaves a square of its radius less a quarter of itself.
    /// let square = Polygon::simple(Ring::new([(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)].map(DVec2::from).to_vec()));
    /// let centre = square.centres_of_disc(1.0, Join::ROUND);
    /// let expected = 100.0 - 4.0 * (1.0 - FRAC_PI_4);
    /// assert!(square.reached_by_disc(1.0, &centre).is_some_and(|area| (area - expected).abs() < 0.01));
    /// ```
    pub fn reached_by_disc(&self, radius: f64, centre: &Region) -> Option<f64> {
        let [part] = centre.polygons() else { return None };
        let round = std::f64::consts::PI * radius * radius * centre.euler() as f64;
        (part.holes.len() == self.holes.len()).then(|| centre.area() + radius * centre.perimeter() + round)
    }

    /// Whether a disc of this radius (mm) rolling inside the polygon, its centre within `centre`, leaves no more than
    /// `smallest` (mm²) empty in any one place. The unavoidable rest in corners between long edges does not count if it
    /// is at most `smallest` each. "No" may be wrong where many other corners add up.
    pub fn is_roomy_for_disc(&self, radius: f64, centre: &Region, smallest: f64) -> bool {
        let corners: f64 = self.rings().map(|ring| emptied_corners(ring, radius, smallest)).sum();
        self.reached_by_disc(radius, centre).is_some_and(|reached| self.area() - reached - corners <= smallest)
    }
}

/// Area (mm²) that a disc leaves empty in the convex corners of a ring; counts only corners whose edges it touches
/// within half their length, and where no more than `smallest` (mm²) is left empty.
fn emptied_corners(ring: &Ring, radius: f64, smallest: f64) -> f64 {
    let points = ring.points();
    let n = points.len();
    let corner = |i: usize| {
        let (into, out) = (points[i] - points[(i + n - 1) % n], points[(i + 1) % n] - points[i]);
        let lengths = (into.length_squared(), out.length_squared());
        // Tangent of half the turn: the disc touches each edge this many radii from the corner.
        let tangent = into.perp_dot(out) / ((lengths.0 * lengths.1).sqrt() + into.dot(out));
        if tangent <= 0.0 || 4.0 * (radius * tangent).powi(2) > lengths.0.min(lengths.1) {
            return 0.0;
        }
        let area = radius * radius * (tangent - tangent.atan());
        if area <= smallest { area } else { 0.0 }
    };
    (0..n).map(corner).sum()
}

#[cfg(test)]
mod tests {
    use super::{Join, SIMPLIFY_MM};
    use crate::edgewise::edgewise_offset;
    use crate::{FillRule, Region, Ring};
    use glam::DVec2;

    /// Outlines with holes, notches and fine edges, from a fixed sequence.
    fn outlines() -> Vec<Region> {
        let mut state = 7_u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as f64 / f64::from(1 << 24)
        };
        let mut blob = |centre: DVec2, radius: f64, rough: f64, count: usize| {
            let waves: Vec<(f64, f64)> = (0..5).map(|_| (rough * next(), std::f64::consts::TAU * next())).collect();
            let noise: Vec<f64> =
                (0..count).map(|_| if count.is_multiple_of(2) { 0.1 * rough * next() } else { 0.0 }).collect();
            let at = |k: usize| {
                let angle = std::f64::consts::TAU * k as f64 / count as f64;
                let wave = |(i, (a, shift)): (usize, &(f64, f64))| a * (angle * (i + 2) as f64 + shift).sin();
                let waves = waves.iter().enumerate().map(wave).sum::<f64>();
                centre + DVec2::from_angle(angle) * radius * (1.0 + waves + noise[k])
            };
            Ring::new((0..count).map(at).collect())
        };
        (0..60)
            .map(|i| {
                let mut rings =
                    vec![blob(DVec2::new(3.0, 7.0), 40.0, 0.02 * f64::from(i % 12), 12 + 23 * i as usize % 400)];
                for k in 0..i % 4 {
                    let at = DVec2::new(3.0, 7.0) + 18.0 * DVec2::from_angle(f64::from(k) * 1.7);
                    rings.push(blob(at, 3.0 + f64::from(i % 5), 0.05, 8 + 5 * k as usize).reversed());
                }
                Region::from_rings(&rings, FillRule::NonZero)
            })
            .collect()
    }

    /// Offsets drawn edge by edge are those of the boolean.
    #[test]
    fn edgewise_offsets_are_offsets() {
        let (mut drawn_edgewise, mut all) = (0, 0);
        for region in outlines() {
            for distance in [-35.0, -20.0, -9.0, -4.0, -1.5, -0.4, -0.1, 0.1, 0.4, 1.5, 4.0, 9.0, 30.0] {
                for (join, tolerance) in
                    [(Join::Round(1e-4), 1e-4), (Join::Round(0.03), 0.03), (Join::Miter(2.0), 2e-3)]
                {
                    if matches!(join, Join::Miter(_)) && distance > 9.0 {
                        // The boolean cuts the flattest tips off, by more the longer they are.
                        continue;
                    }
                    all += 1;
                    let Some(drawn) = edgewise_offset(&region, distance, join) else { continue };
                    let drawn = drawn.without_specks(super::MIN_AREA_MM2);
                    drawn_edgewise += 1;
                    let exact = region.boolean_offset(distance, join);
                    let off = drawn.difference(&exact).area() + exact.difference(&drawn).area();
                    // Both round arcs within the tolerance, and corners to the grid.
                    assert!(off <= (4e-4 + tolerance) * exact.perimeter(), "{distance} {join:?}: {off} mm²");
                    assert_eq!(drawn.euler(), exact.euler());
                }
            }
        }
        println!("{drawn_edgewise} of {all} offsets are drawn edge by edge");
        assert!(drawn_edgewise > 4 * all / 5, "{drawn_edgewise} of {all}");
    }

    /// Rings that pass through each other without crossing in the end: nothing may be left of a thin wall.
    #[test]
    fn what_passes_through_itself_is_not_simple() {
        let circle =
            |radius: f64| Ring::new((0..90).map(|k| DVec2::from_angle(f64::from(k) * 0.0698) * radius).collect());
        let wall = Region::from_rings(&[circle(10.0), circle(9.0).reversed()], FillRule::NonZero);
        let island = Region::from_rings(&[circle(20.0), circle(9.0).reversed(), circle(8.0)], FillRule::NonZero);
        for join in [Join::ROUND, Join::Miter(2.0)] {
            assert!(wall.offset(-3.0, join).is_empty());
            assert!((island.offset(3.0, join).area() - std::f64::consts::PI * 23.0 * 23.0).abs() < 3.0);
        }
        assert_eq!(SIMPLIFY_MM, 0.003);
    }
}
