//! Walls given by their two sides: the middle line between them, and the thickness (Li et al., section 2.1).

use super::{Curve, WallCurves};
use crate::curve::Nurbs;
use glam::{DVec2, DVec3};
use planar::polyline;
use serde::{Deserialize, Serialize};

/// What the curves of a wall represent.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum CurvesAre {
    /// Its centre-lines: one bead is laid along each.
    Centre,
    /// Its sides: one bead is laid midway between two of them.
    Sides,
}

/// Two curves that run side by side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sides {
    /// A place on one of them, mm.
    pub place: DVec3,
    /// Least and greatest distance between them, mm.
    pub thickness: (f64, f64),
}

/// Greatest ratio of the largest to the least distance between two sides, measured from one of them; at a corner of the
/// outer side the distance is √2 times as great.
const EVEN: f64 = 1.35;
/// The same limit, in `within`, from the other side, where corners increase it.
const AT_CORNERS: f64 = 1.5;
/// Spacing of the points at which the distance of two curves is measured, in distances of sides.
const STEP: f64 = 0.25;
/// Accuracy of middle lines, mm.
const ERROR_MM: f64 = 0.005;

impl WallCurves {
    /// Curves at one height that run side by side and are nowhere farther apart than `within` (mm), so that two beads
    /// would hardly fit between them. A curve may be paired with several others.
    ///
    /// ```
    /// use bead_part::curve::Nurbs;
    /// use bead_part::model::iges::{self, WriteOptions};
    /// use bead_part::model::wall_curves::WallCurves;
    /// use glam::{DAffine3, DVec3};
    ///
    /// // The two sides of a straight wall 3.5 mm thick.
    /// let side = |y| Nurbs::line(DVec3::new(0.0, y, 0.0), DVec3::new(90.0, y, 0.0));
    /// let (one, other) = (side(0.0)?, side(3.5)?);
    /// let text = iges::write(&[("a", &one), ("b", &other)], &WriteOptions::default());
    /// let curves = WallCurves::of_iges(&iges::read(text.as_bytes())?, &DAffine3::IDENTITY)?;
    /// assert!(curves.sides(3.0).is_empty());
    /// assert_eq!(curves.sides(7.0).len(), 1);
    /// let middle = curves.between_sides(7.0).ok_or("no pairs")?;
    /// assert_eq!(middle.count(), 1);
    /// assert!(middle.at(0.0, 0.01)[0].points.iter().all(|p| (p.y - 1.75).abs() < 1e-6));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn sides(&self, within: f64) -> Vec<Sides> {
        let of_level = |(z, curves): &(f64, Vec<Curve>)| {
            let paths = paths(curves);
            let sides = |(one, _, thickness): (usize, usize, (f64, f64))| {
                let near = paths[one].first().copied().unwrap_or_default();
                Sides { place: near.extend(*z), thickness }
            };
            pairs(curves, &paths, within).into_iter().map(sides).collect::<Vec<_>>()
        };
        self.levels.iter().flat_map(of_level).collect()
    }

    /// The middle lines between curves that run side by side within `within` (mm), at every height. `None` if a curve
    /// has no partner, or several.
    pub fn between_sides(&self, within: f64) -> Option<Self> {
        let of_level = |(z, curves): &(f64, Vec<Curve>)| {
            let paths = paths(curves);
            let pairs = pairs(curves, &paths, within);
            let has_one_partner = |k| pairs.iter().filter(|(one, other, _)| [one, other].contains(&&k)).count() == 1;
            if !(0..curves.len()).all(has_one_partner) {
                return None;
            }
            let middle = |&(one, other, _): &(usize, usize, _)| {
                let points = middle(&paths[one], &paths[other], within).into_iter().map(|p| p.extend(*z));
                Nurbs::polyline(points.collect()).ok().map(|line| Curve::new(vec![line]))
            };
            Some((*z, pairs.iter().map(middle).collect::<Option<Vec<_>>>()?))
        };
        let levels: Vec<(f64, Vec<Curve>)> = self.levels.iter().map(of_level).collect::<Option<_>>()?;
        let even = levels.windows(2).all(|pair| pair[0].1.len() == pair[1].1.len());
        even.then_some(Self { levels })
    }
}

fn paths(curves: &[Curve]) -> Vec<Vec<DVec2>> {
    curves.iter().map(|curve| curve.path(ERROR_MM)).collect()
}

/// Pairs of curves that run side by side, the lower index first, with the least and the greatest distance between them,
/// mm.
fn pairs(curves: &[Curve], paths: &[Vec<DVec2>], within: f64) -> Vec<(usize, usize, (f64, f64))> {
    let mut pairs = Vec::new();
    for one in 0..curves.len() {
        for other in one + 1..curves.len() {
            if curves[one].closed != curves[other].closed {
                continue;
            }
            let (there, back) =
                (distances(&paths[one], &paths[other], within), distances(&paths[other], &paths[one], within));
            let is_even = |(least, greatest): (f64, f64)| greatest <= within && greatest <= EVEN * least;
            let is_near = |(_, greatest): (f64, f64)| greatest <= AT_CORNERS * within;
            let thickness = [there, back].into_iter().find(|found| is_even(*found));
            pairs.extend(thickness.filter(|_| is_near(there) && is_near(back)).map(|found| (one, other, found)));
        }
    }
    pairs
}

/// Least and greatest distance of a line from another, mm; measuring stops once they cannot be sides.
fn distances(line: &[DVec2], other: &[DVec2], within: f64) -> (f64, f64) {
    let (mut least, mut greatest) = (f64::INFINITY, 0.0_f64);
    for place in places(line, STEP * within) {
        let distance = place.distance(nearest(place, other));
        (least, greatest) = (least.min(distance), greatest.max(distance));
        if greatest > AT_CORNERS * within {
            break;
        }
    }
    (least, greatest)
}

/// The points of a line, and points between them at most `apart` (mm) from each other.
fn places(line: &[DVec2], apart: f64) -> impl Iterator<Item = DVec2> + '_ {
    let pieces = line.windows(2).flat_map(move |ends| {
        let count = (ends[0].distance(ends[1]) / apart).ceil().max(1.0);
        (0..count as usize).map(move |k| ends[0].lerp(ends[1], k as f64 / count))
    });
    pieces.chain(line.last().copied())
}

fn nearest(place: DVec2, line: &[DVec2]) -> DVec2 {
    let on_pieces = line.windows(2).map(|ends| polyline::closest_on_segment(place, ends[0], ends[1]));
    on_pieces.min_by(|a, b| place.distance_squared(*a).total_cmp(&place.distance_squared(*b))).unwrap_or(place)
}

/// The middle between two lines, measured along the one from which the distance varies less, since corners of the outer
/// side are farther away.
fn middle(one: &[DVec2], other: &[DVec2], within: f64) -> Vec<DVec2> {
    let spread = |(least, greatest): (f64, f64)| greatest - least;
    let (from, to) = if spread(distances(one, other, within)) <= spread(distances(other, one, within)) {
        (one, other)
    } else {
        (other, one)
    };
    let middle: Vec<DVec2> = places(from, STEP * within).map(|place| place.midpoint(nearest(place, to))).collect();
    polyline::simplify(&middle, ERROR_MM)
}
