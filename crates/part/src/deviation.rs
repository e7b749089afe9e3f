//! How far a scan of the built part lies from the part's surface.
//!
//! The distance of a point is that to the nearest triangle, found with an R-tree (rstar). Its sign comes from the
//! normals around the nearest point of the surface, each weighted by the angle of its triangle there, which tells
//! inside from outside even at an edge or a corner (Bærentzen and Aanæs 2005, *Signed distance computation using the
//! angle weighted pseudonormal*).

use crate::model::triangle::{SAME_MM, Triangle};
use crate::model::{Mesh, NO_NEIGHBOUR, Units};
use crate::task::{Cancelled, Task};
use glam::DVec3;
use rayon::prelude::*;
use rstar::RTree;
use serde::{Serialize, Serializer};
use std::ops::RangeInclusive;

/// A point this near to the surface counts as on it, mm: files are rounded.
const ON_SURFACE_MM: f64 = 1e-3;

/// A scan is taken to be in another unit if its size in that unit is this fraction of the part's: it need not show the
/// whole part.
const SEEN: RangeInclusive<f64> = 0.5..=1.05;

/// A scan is misplaced if half of its points are farther off than this fraction of the part's size.
const FAR: f64 = 0.1;

/// Points up to this height, and farther than the next distance from the part, show the plate, mm; nearer, metal and
/// plate cannot be told apart.
const PLATE_MM: f64 = 0.5;
const BESIDE_MM: f64 = 1.0;

/// Points between two checks for cancellation.
const BATCH: usize = 50_000;

/// A scan compared with the part.
#[derive(Debug, Clone, PartialEq)]
pub struct Deviation {
    /// Distance of each point from the surface, mm: positive outside the part, negative inside.
    pub distances: Vec<f64>,
    /// Summary of the distances, without the plate.
    pub figures: Figures,
    /// Number of points that show the plate on z = 0 next to a part that stands on it.
    pub plate: usize,
    /// Reasons to mistrust the comparison.
    pub doubts: Vec<Doubt>,
}

/// A summary of the distances of a scan's points; all points have equal weight.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Figures {
    /// Number of points.
    pub points: usize,
    /// Mean distance, mm.
    pub mean: f64,
    /// Standard deviation of the distances from their mean, mm.
    pub standard_deviation: f64,
    /// The point farthest outside.
    pub highest: Extreme,
    /// The point farthest inside.
    pub lowest: Extreme,
    /// Machining allowance, mm.
    pub allowance: f64,
    /// Fraction of the points that are on the surface or outside it by at most the allowance, 0 to 1.
    pub within: f64,
    /// Fraction of the points that are farther outside than the allowance, 0 to 1.
    pub above: f64,
    /// Fraction of the points that are inside the part's surface, where metal is missing, 0 to 1.
    pub below: f64,
}

/// A point of the scan and its distance.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Extreme {
    /// Signed distance from the surface, mm.
    pub distance: f64,
    /// The point, mm.
    pub at: DVec3,
}

/// A reason to mistrust the comparison of a scan with a part.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Doubt {
    /// The scan is smaller than the part, by about as much as if it were in this unit.
    #[error("the scan has about 1/{} the size of the part: its numbers seem to be {}, not mm.", .0.in_mm(), .0.plural())]
    ScanUnit(Units),
    /// The scan is larger than the part, by about as much as if the part were in this unit.
    #[error("the scan is about {} times as large as the part: the numbers of the part seem to be {}, not mm.", .0.in_mm(), .0.plural())]
    PartUnit(Units),
    /// Half of the scan lies farther than this from the part, mm.
    #[error(
        "half of the scan lies more than {0:.1} mm off the part's surface: bring the two into the same coordinates, those of \
         the part as it is planned, with z = 0 on the plate."
    )]
    Off(f64),
    /// The part's surface has holes, near which inside and outside cannot be told apart.
    #[error(
        "the part's surface is not closed ({0} open edges): near its holes, inside and outside cannot be distinguished."
    )]
    Open(usize),
}

impl Serialize for Doubt {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

/// Why a scan cannot be compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum DeviationError {
    /// The scan has no points.
    #[error("the scan holds no points, so there is nothing to compare.")]
    NoPoints,
    /// The part has no surface.
    #[error("the part has no triangle with an area, so there is no surface to compare the scan with.")]
    NoSurface,
    /// Cancelled by the caller.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Compares the points of a scan (mm) with the surface of a part in the same coordinates; `allowance` (mm) is the metal
/// that is still to be milled off.
///
/// ```
/// use bead_part::{deviation::deviation, example, task::Task};
/// use glam::DVec3;
///
/// // The sides of the wall are 2.25 mm from its middle: one point lies 1 mm outside, the other 0.25 mm inside.
/// let wall = example::find("wall").ok_or("no such example")?.mesh();
/// let scan = [DVec3::new(5.0, 3.25, 30.0), DVec3::new(5.0, 2.0, 30.0)];
/// let found = deviation(&wall, &scan, 0.5, &Task::new())?;
/// assert!((found.distances[0] - 1.0).abs() < 1e-9 && (found.distances[1] + 0.25).abs() < 1e-9);
/// assert_eq!((found.figures.above, found.figures.below), (0.5, 0.5));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`DeviationError`].
pub fn deviation(part: &Mesh, points: &[DVec3], allowance: f64, task: &Task) -> Result<Deviation, DeviationError> {
    let surface = Surface::of(part).ok_or(DeviationError::NoSurface)?;
    let mut distances = Vec::with_capacity(points.len());
    for batch in points.chunks(BATCH) {
        task.check()?;
        distances.par_extend(batch.par_iter().map(|point| surface.signed_distance(*point)));
    }
    let (shown, of_part) = without_plate(part, points, &distances);
    let figures = figures(&shown, &of_part, allowance).ok_or(DeviationError::NoPoints)?;
    let (doubts, plate) = (doubts(part, &shown, &of_part), points.len() - shown.len());
    Ok(Deviation { distances, figures, plate, doubts })
}

/// The points that do not show the plate, with their distances; all points if none are left, since such a scan is more
/// likely in another unit.
fn without_plate(part: &Mesh, points: &[DVec3], distances: &[f64]) -> (Vec<DVec3>, Vec<f64>) {
    let stands = part.bounds().0.z.abs() < ON_SURFACE_MM;
    let is_plate = |(point, distance): &(DVec3, f64)| stands && point.z <= PLATE_MM && *distance > BESIDE_MM;
    let all = || points.iter().copied().zip(distances.iter().copied());
    let shown: (Vec<DVec3>, Vec<f64>) = all().filter(|point| !is_plate(point)).unzip();
    if shown.0.is_empty() { all().unzip() } else { shown }
}

fn figures(points: &[DVec3], distances: &[f64], allowance: f64) -> Option<Figures> {
    let extremes = || points.iter().zip(distances).map(|(&at, &distance)| Extreme { distance, at });
    let by_distance = |a: &Extreme, b: &Extreme| a.distance.total_cmp(&b.distance);
    let (lowest, highest) = (extremes().min_by(by_distance)?, extremes().max_by(by_distance)?);
    let count = distances.len() as f64;
    let mean = distances.iter().sum::<f64>() / count;
    let variance = distances.iter().map(|d| (d - mean).powi(2)).sum::<f64>() / count;
    let part = |is: fn(f64, f64) -> bool| distances.iter().filter(|&&d| is(d, allowance)).count() as f64 / count;
    let above = part(|distance, allowance| distance > allowance + ON_SURFACE_MM);
    let below = part(|distance, _| distance < -ON_SURFACE_MM);
    let within = part(|distance, allowance| (-ON_SURFACE_MM..=allowance + ON_SURFACE_MM).contains(&distance));
    let (points, standard_deviation) = (distances.len(), variance.sqrt());
    Some(Figures { points, mean, standard_deviation, highest, lowest, allowance, within, above, below })
}

fn doubts(part: &Mesh, points: &[DVec3], distances: &[f64]) -> Vec<Doubt> {
    let size = part.size().length();
    let low = points.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let high = points.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
    let ratio = (high - low).length() / size;
    let others = || Units::ALL.into_iter().map(|(_, unit)| unit).filter(|unit| *unit != Units::Millimetre);
    let scan = others().find(|unit| SEEN.contains(&(ratio * unit.in_mm()))).map(Doubt::ScanUnit);
    let unit = scan.or_else(|| others().find(|unit| SEEN.contains(&(ratio / unit.in_mm()))).map(Doubt::PartUnit));
    let mut far: Vec<f64> = distances.iter().map(|distance| distance.abs()).collect();
    let middle = far.len() / 2;
    let (_, half, _) = far.select_nth_unstable_by(middle, f64::total_cmp);
    // A wrong unit explains the distance.
    let off = Some(*half).filter(|half| *half > FAR * size && unit.is_none()).map(Doubt::Off);
    let open = part.neighbours.iter().flatten().filter(|&&across| across == NO_NEIGHBOUR).count();
    unit.into_iter().chain(off).chain((open > 0).then_some(Doubt::Open(open))).collect()
}

/// The triangles of a part in an R-tree.
pub(crate) struct Surface(RTree<Triangle>);

impl Surface {
    /// `None` if no triangle has an area.
    pub(crate) fn of(part: &Mesh) -> Option<Self> {
        let corner = |i: u32| part.vertices.get(i as usize).copied();
        let triangle = |&[a, b, c]: &[u32; 3]| Some(Triangle { corners: [corner(a)?, corner(b)?, corner(c)?] });
        let triangles = part.triangles.iter().filter_map(triangle);
        let triangles: Vec<Triangle> = triangles.filter(|triangle| triangle.normal().length_squared() > 0.0).collect();
        (!triangles.is_empty()).then(|| Self(RTree::bulk_load(triangles)))
    }

    /// Distance of a point from the surface, mm: positive outside, negative inside.
    fn signed_distance(&self, point: DVec3) -> f64 {
        self.nearest(point).0
    }

    /// Distance of a point, mm, positive outside and negative inside, and the nearest point of the surface.
    pub(crate) fn nearest(&self, point: DVec3) -> (f64, DVec3) {
        let at = point.to_array();
        let Some(nearest) = self.0.nearest_neighbor(&at) else { return (f64::INFINITY, point) };
        let spot = nearest.closest(point);
        let distance = point.distance(spot);
        let around = self.0.locate_within_distance(at, (distance + SAME_MM).powi(2));
        let touching = around.filter(|triangle| triangle.closest(point).distance(spot) < SAME_MM);
        let normal: DVec3 =
            touching.map(|triangle| triangle.normal().normalize_or_zero() * triangle.angle_at(spot)).sum();
        (if normal.dot(point - spot) < 0.0 { -distance } else { distance }, spot)
    }
}
