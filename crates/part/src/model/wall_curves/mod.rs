//! Walls given by curves instead of a solid: the centre-lines of one layer, or of several heights between which the
//! wall is lofted.
//!
//! | file | what it does |
//! | --- | --- |
//! | `sides` | the middle between curves that are the two sides of a wall |
//! | `edges` | the surface between two edges that are not level |

mod edges;
mod sides;

pub(super) use edges::ruled;
pub use sides::{CurvesAre, Sides};

use super::iges::IgesFile;
use crate::curve::Nurbs;
use glam::{DAffine3, DVec2};
use planar::Bounds;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// A curve may rise by this over its length and still count as level, mm.
const LEVEL_MM: f64 = 0.05;

/// Curves whose heights differ by no more than this belong to one height, mm.
const SAME_HEIGHT_MM: f64 = 0.1;

/// Number of corresponding points on curves of neighbouring heights, for leaning walls.
const PAIRS: usize = 64;

/// The centre-lines of a wall.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct WallCurves {
    /// Heights, ascending, and the curves there; the same number at every height.
    levels: Vec<(f64, Vec<Curve>)>,
}

/// One centre-line: a sequence of curves.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Curve {
    parts: Vec<Nurbs>,
    closed: bool,
}

/// A centre-line at one height.
#[derive(Debug, Clone, PartialEq)]
pub struct Section {
    /// Its points, mm.
    pub points: Vec<DVec2>,
    /// Whether it ends where it began; the first point is then not repeated.
    pub closed: bool,
}

/// Why curves do not make a wall.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum WallCurvesError {
    /// No curve is independent.
    #[error(
        "the file holds no independent curve ({curves} belong to surfaces or other entities). A wall needs \
         its centre-lines; export the surface as a mesh (STL) instead."
    )]
    None {
        /// Number of curves that belong to others.
        curves: usize,
    },
    /// A curve is not level.
    #[error(
        "the curve of directory entry {entry} is not level: it runs from z {low:.2} to z {high:.2} mm. The centre-lines \
         of a wall must be level, one set for each height. Only two curves, without any other, may be its edges and need not \
         be level."
    )]
    NotLevel {
        /// Number of the directory entry.
        entry: u32,
        /// Lowest z, mm.
        low: f64,
        /// Highest z, mm.
        high: f64,
    },
    /// Heights with different numbers of curves.
    #[error(
        "there are {lower} curves at z {z:.2} mm but {upper} at z {next:.2} mm. To loft the wall, every height needs the same \
         number of curves in the same order."
    )]
    Uneven {
        /// Height, mm.
        z: f64,
        /// Curves there.
        lower: usize,
        /// The next height, mm.
        next: f64,
        /// Curves there.
        upper: usize,
    },
}

impl WallCurves {
    /// The visible, independent curves of a drawing, turned and scaled by `place`; the lowest height
    /// becomes z = 0.
    ///
    /// # Errors
    /// [`WallCurvesError`], with the directory entry or the height.
    pub fn of_iges(file: &IgesFile, place: &DAffine3) -> Result<Self, WallCurvesError> {
        let mut found = Vec::new();
        for curve in file.independent_curves() {
            let parts: Vec<Nurbs> = curve.parts.iter().map(|part| part.transformed(place)).collect();
            found.push((level(curve.entry, &parts)?, Curve::new(parts)));
        }
        Self::new(found).ok_or(WallCurvesError::None { curves: file.curves.len() })?
    }

    /// Groups curves by height; `None` without any.
    fn new(mut curves: Vec<(f64, Curve)>) -> Option<Result<Self, WallCurvesError>> {
        // The sort is stable: the order within a height is kept.
        curves.sort_by(|a, b| a.0.total_cmp(&b.0));
        let floor = curves.first()?.0;
        let mut levels: Vec<(f64, Vec<Curve>)> = Vec::new();
        for (z, curve) in curves {
            match levels.last_mut().filter(|level| z - floor - level.0 <= SAME_HEIGHT_MM) {
                Some(level) => level.1.push(curve),
                None => levels.push((z - floor, vec![curve])),
            }
        }
        let uneven = levels.windows(2).find(|w| w[0].1.len() != w[1].1.len());
        Some(match uneven {
            Some([a, b]) => Err(WallCurvesError::Uneven { z: a.0, lower: a.1.len(), next: b.0, upper: b.1.len() }),
            _ => Ok(Self { levels }),
        })
    }

    /// Height of the highest curves above the lowest, mm; 0 for the curves of one height, whose wall goes straight up.
    pub fn height(&self) -> f64 {
        self.levels.last().map_or(0.0, |level| level.0)
    }

    /// Number of curves at each height.
    pub fn count(&self) -> usize {
        self.levels.first().map_or(0, |level| level.1.len())
    }

    /// Bounds of the curves from the ground up to `height`, mm; `None` without curves.
    pub fn bounds(&self, height: f64) -> Option<Bounds> {
        let sections = [0.0, height].into_iter().flat_map(|z| self.at(z, 1.0));
        Bounds::of(sections.flat_map(|section| section.points))
    }

    /// The centre-lines at height `z` (mm), their chords within `error` (mm): those given there, or, between two
    /// heights, straight interpolation between corresponding points. Below and above all heights they continue
    /// vertically.
    pub fn at(&self, z: f64, error: f64) -> Vec<Section> {
        match self.between(z) {
            Between::One(curves) => curves.iter().map(|c| c.section(error)).collect(),
            Between::Two(lower, upper, share) => {
                lower.iter().zip(upper).map(|(a, b)| lofted(a, b, share, error)).collect()
            }
        }
    }

    /// How the wall leans between two heights, at corresponding points of its centre-lines: positions at mid-height,
    /// mm, and the angle from the build direction there, radians. A point that only slides along its line does not
    /// lean.
    pub fn leans(&self, low: f64, high: f64) -> Vec<(DVec2, f64)> {
        let (lower, upper) = (self.paired(low), self.paired(high));
        let lean = |(lower, upper): (&Vec<DVec2>, &Vec<DVec2>)| -> Vec<(DVec2, f64)> {
            let closed = lower.first() == lower.last();
            let lean = |(i, (a, b)): (usize, (&DVec2, &DVec2))| {
                let sideways = tangent(lower, i, closed).perp_dot(*b - *a).abs();
                (a.midpoint(*b), sideways.atan2(high - low))
            };
            lower.iter().zip(upper).enumerate().map(lean).collect()
        };
        lower.iter().zip(&upper).flat_map(lean).collect()
    }

    /// Corresponding points of every centre-line at height `z`.
    fn paired(&self, z: f64) -> Vec<Vec<DVec2>> {
        match self.between(z) {
            Between::One(curves) => curves.iter().map(|c| c.evenly(PAIRS)).collect(),
            Between::Two(lower, upper, share) => {
                lower.iter().zip(upper).map(|(a, b)| mixed(&a.evenly(PAIRS), &b.turned_to(a, PAIRS), share)).collect()
            }
        }
    }

    fn between(&self, z: f64) -> Between<'_> {
        let above = self.levels.partition_point(|level| level.0 < z);
        match (above.checked_sub(1).and_then(|i| self.levels.get(i)), self.levels.get(above)) {
            (Some(lower), Some(upper)) => Between::Two(&lower.1, &upper.1, (z - lower.0) / (upper.0 - lower.0)),
            (Some(level), None) | (None, Some(level)) => Between::One(&level.1),
            (None, None) => Between::One(&[]),
        }
    }
}

/// The curves that define a height.
enum Between<'a> {
    One(&'a [Curve]),
    Two(&'a [Curve], &'a [Curve], f64),
}

/// Height of a level curve, mm.
fn level(entry: u32, parts: &[Nurbs]) -> Result<f64, WallCurvesError> {
    let zs = parts.iter().flat_map(|part| part.points_by_chord(LEVEL_MM)).map(|p| p.z);
    let (low, high) = zs.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), z| (low.min(z), high.max(z)));
    if high - low > LEVEL_MM {
        return Err(WallCurvesError::NotLevel { entry, low, high });
    }
    Ok((low + high) / 2.0)
}

impl Curve {
    fn new(parts: Vec<Nurbs>) -> Self {
        let end = |part: &Nurbs, last: bool| part.point(if last { part.domain().1 } else { part.domain().0 });
        let gap = parts.first().zip(parts.last()).map(|(a, b)| end(a, false).distance(end(b, true)));
        Self { closed: gap.is_some_and(|gap| gap < LEVEL_MM), parts }
    }

    fn path(&self, error: f64) -> Vec<DVec2> {
        let mut points: Vec<DVec2> =
            self.parts.iter().flat_map(|part| part.points_by_chord(error)).map(|p| p.truncate()).collect();
        points.dedup_by(|a, b| a.distance(*b) < 1e-6);
        points
    }

    fn section(&self, error: f64) -> Section {
        let mut points = self.path(error);
        if self.closed {
            points.pop();
        }
        Section { points, closed: self.closed }
    }

    /// `count` points at equal distances along the curve, both ends among them.
    fn evenly(&self, count: usize) -> Vec<DVec2> {
        let path = self.path(1e-3);
        let length = planar::polyline::length(&path);
        let place = |k: usize| planar::polyline::point_at(&path, length * k as f64 / (count - 1) as f64);
        (0..count).filter_map(place).collect()
    }

    /// The same points, with start and direction matched to another curve: a closed curve begins at the same bearing
    /// from its middle and runs the same way round.
    fn turned_to(&self, other: &Self, count: usize) -> Vec<DVec2> {
        let (mut own, theirs) = (self.evenly(count), other.evenly(count));
        if !(self.closed && other.closed) {
            let ends = |a: &[DVec2], b: &[DVec2]| a[0].distance(b[0]) + a[a.len() - 1].distance(b[b.len() - 1]);
            let mut backwards = own.clone();
            backwards.reverse();
            return if ends(&backwards, &theirs) < ends(&own, &theirs) { backwards } else { own };
        }
        let area = |points: &[DVec2]| planar::Ring::new(points.to_vec()).area();
        if area(&own).signum() != area(&theirs).signum() {
            own.reverse();
        }
        let middle = |points: &[DVec2]| points.iter().sum::<DVec2>() / points.len() as f64;
        let (here, there) = (middle(&own), middle(&theirs));
        let bearing = (theirs[0] - there).to_angle();
        let off = |p: &DVec2| ((*p - here).to_angle() - bearing + 3.0 * PI).rem_euclid(2.0 * PI) - PI;
        own.pop();
        let first = (0..own.len()).min_by(|&a, &b| off(&own[a]).abs().total_cmp(&off(&own[b]).abs())).unwrap_or(0);
        own.rotate_left(first);
        own.push(own[0]);
        own
    }
}

/// Direction of a line at one of its points; a closed line ends with its first point.
fn tangent(line: &[DVec2], i: usize, closed: bool) -> DVec2 {
    let last = line.len() - 1;
    let (before, behind) = match i {
        0 if closed => (last - 1, 1),
        i if i == last && closed => (last - 1, 1),
        _ => (i.saturating_sub(1), (i + 1).min(last)),
    };
    (line[behind] - line[before]).normalize_or_zero()
}

fn mixed(lower: &[DVec2], upper: &[DVec2], share: f64) -> Vec<DVec2> {
    lower.iter().zip(upper).map(|(a, b)| a.lerp(*b, share)).collect()
}

/// The centre-line between two others, at a fraction of the way up.
fn lofted(lower: &Curve, upper: &Curve, share: f64, error: f64) -> Section {
    // As many corresponding points as the finer curve needs.
    let count = (4 * lower.path(error).len().max(upper.path(error).len())).max(PAIRS);
    let points = mixed(&lower.evenly(count), &upper.turned_to(lower, count), share);
    let mut points = planar::polyline::simplify(&points, error / 2.0);
    let closed = lower.closed && upper.closed;
    if closed {
        points.pop();
    }
    Section { points, closed }
}
