//! Aligns a scan with the part: by the plate, and by the outline of the part.
//!
//! The height comes from the plate alone: fitting the top would remove the very error that is sought. In plan view,
//! raised points belong inside the outline of the layers above half the height, and points of the plate outside the
//! outline of all layers. From several starts, damped Gauss–Newton steps minimise the squared distances of the points
//! that are on the wrong side, which gives shift and turn.

use crate::layer::Layer;
use glam::{DMat3, DVec2, DVec3};
use planar::{Region, polyline};

/// How a scan is aligned with the part.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Align {
    /// Not moved: its coordinates are already those of the part.
    #[default]
    AsIs,
    /// The plate gives the height.
    Plate,
    /// The plate gives the height, the outline of the part shift and turn.
    Fit,
}

/// A scan aligned with the part.
#[derive(Debug, Clone, PartialEq)]
pub struct Aligned {
    /// The points, mm, in the coordinates of the part.
    pub points: Vec<DVec3>,
    /// How far the middle of the scan was moved, mm.
    pub shift: DVec3,
    /// Rotation about the vertical through its middle, radians.
    pub turn: f64,
    /// Whether the scan shows the plate.
    pub plate: bool,
    /// Fraction of the points, 0 to 1, that lie more than half a bead on the wrong side of the outline; 0 without a
    /// fit.
    pub astray: f64,
}

/// Why a scan cannot be aligned with the part.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AlignError {
    /// The scan shows no plate.
    #[error(
        "the scan does not show the plate, which its height is taken from: its points span {range:.2} mm in z, but the build is \
         {height:.2} mm high. Scan a strip of the plate next to the part as well, or give z as the height above the plate."
    )]
    NoPlate {
        /// Height from its lowest to its highest points, mm.
        range: f64,
        /// Planned height of the build, mm.
        height: f64,
    },
    /// The shape does not fit.
    #[error(
        "the scan does not fit the outline of the part: {percent:.0} % of its points are more than half a bead on the wrong \
         side of it; at most {most:.0} % may be. Is it a scan of this part?"
    )]
    NoFit {
        /// Share of the points that are astray, %.
        percent: f64,
        /// Greatest share that is accepted, %.
        most: f64,
    },
}

/// Fraction of the points that may be more than half a bead on the wrong side of the outline.
const ASTRAY: f64 = 0.1;
/// Points are kept this far from the outline, in bead widths, which centres a scan that has play.
const MARGIN: f64 = 0.125;
/// Once a scan is nearly aligned, points within this many margins of the outline are considered.
const NEAR: f64 = 16.0;
/// Fractions of the points at the bottom and at the top that are taken for noise.
const NOISE: f64 = 0.02;
/// Points within this fraction of the range above the lowest one show the plate.
const PLATE: f64 = 0.1;
/// A scan whose heights range over less than this fraction of the build's height shows no plate.
const SEES_PLATE: f64 = 0.5;
/// Number of points used to find a start, and for the fit.
const POINTS: (usize, usize) = (300, 3000);
/// Turns from which a fit begins, °.
const TURNS: [f64; 7] = [0.0, -10.0, 10.0, -20.0, 20.0, -30.0, 30.0];
/// Largest turn, radians (45°): beyond it a symmetric part would fit just as well another way round.
const MOST_TURN: f64 = std::f64::consts::FRAC_PI_4;
/// A later start is preferred only if what it leaves is below this fraction of what the best one so far leaves.
const BETTER: f64 = 0.8;
/// Maximum number of steps of a fit, and the step that ends it, mm.
const STEPS: usize = 100;
const LAST_STEP: f64 = 1e-4;
/// Outlines are simplified by this much, mm.
const SIMPLIFY: f64 = 0.02;

/// Aligns `points` (mm) with a build of these layers with beads of `width` (mm).
///
/// # Errors
/// [`AlignError`].
pub fn align(points: Vec<DVec3>, built: &[Layer], width: f64, how: Align) -> Result<Aligned, AlignError> {
    let [Some(first), Some(last)] = [built.first(), built.last()] else { return Ok(Aligned::as_is(points)) };
    let (floor, height) = (first.z - first.height, last.z - first.z + first.height);
    let ranges = Ranges::of(&points);
    let plate = ranges.high - ranges.low >= SEES_PLATE * height;
    let mut aligned = Aligned { plate, ..Aligned::as_is(points) };
    if how == Align::AsIs {
        return Ok(aligned);
    }
    if plate {
        aligned.shift.z = floor - ranges.plate;
        aligned.points.iter_mut().for_each(|p| p.z += floor - ranges.plate);
    } else if how == Align::Plate {
        return Err(AlignError::NoPlate { range: ranges.high - ranges.low, height });
    }
    if how == Align::Fit {
        aligned.fit(built, floor, height, width);
        if aligned.astray > ASTRAY {
            return Err(AlignError::NoFit { percent: 100.0 * aligned.astray, most: 100.0 * ASTRAY });
        }
    }
    Ok(aligned)
}

impl Aligned {
    fn as_is(points: Vec<DVec3>) -> Self {
        Self { points, shift: DVec3::ZERO, turn: 0.0, plate: false, astray: 0.0 }
    }

    fn fit(&mut self, built: &[Layer], floor: f64, height: f64, width: f64) {
        let middle = floor + height / 2.0;
        // Without a plate the height is not known, so all points count as raised. With one, points in between are
        // ignored.
        let stands = |p: &&DVec3| !self.plate || p.z > middle;
        let lies = |p: &&DVec3| self.plate && p.z < floor + PLATE * height;
        let points =
            |kind: &dyn Fn(&&DVec3) -> bool| self.points.iter().filter(|p| kind(p)).map(|p| p.truncate()).collect();
        let sides = [
            Side { points: points(&stands), outline: Outline::of(shadow(built, middle)), inside: true },
            Side { points: points(&lies), outline: Outline::of(shadow(built, f64::NEG_INFINITY)), inside: false },
        ];
        let motion = best(&sides, MARGIN * width);
        self.points.iter_mut().for_each(|p| *p = motion.of(p.truncate()).extend(p.z));
        self.turn = motion.turn;
        self.astray = sides.iter().map(|side| side.astray(&motion, width / 2.0)).fold(0.0, f64::max);
        self.shift += motion.shift.extend(0.0);
    }
}

/// The area covered by the layers that end above a height (mm), seen from above.
fn shadow(built: &[Layer], above: f64) -> Region {
    let (mut sum, mut before) = (Region::EMPTY, Region::EMPTY);
    for layer in built.iter().filter(|layer| layer.z >= above) {
        let next = Region::from_normalised(layer.islands.clone());
        // Layers of straight walls are alike.
        if next.polygons() != before.polygons() {
            sum = sum.union(&next);
            before = next;
        }
    }
    sum
}

/// Heights of a scan, mm.
struct Ranges {
    low: f64,
    high: f64,
    plate: f64,
}

impl Ranges {
    fn of(points: &[DVec3]) -> Self {
        let mut heights: Vec<f64> = points.iter().map(|p| p.z).collect();
        heights.sort_by(f64::total_cmp);
        let at = |part: f64| heights.get((part * heights.len() as f64) as usize).copied().unwrap_or_default();
        let (low, high) = (at(NOISE), at(1.0 - NOISE));
        let below = heights.partition_point(|z| *z <= low + PLATE * (high - low));
        Self { low, high, plate: heights.get(below / 2).copied().unwrap_or_default() }
    }
}

/// Points that belong on one side of an outline.
#[derive(Clone)]
struct Side {
    points: Vec<DVec2>,
    outline: Outline,
    inside: bool,
}

impl Side {
    /// About `most` of the points.
    fn some(&self, most: usize) -> impl Iterator<Item = &DVec2> {
        self.points.iter().step_by(self.points.len().div_ceil(most).max(1))
    }

    /// The points that, once moved, lie on the wrong side or within `reach` (mm) of the outline.
    fn near(&self, motion: &Motion, reach: f64) -> Self {
        let near = |p: &&DVec2| self.outline.beyond(motion.of(**p), self.inside).is_some_and(|(by, _)| by > -reach);
        Self { points: self.points.iter().filter(near).copied().collect(), ..self.clone() }
    }

    /// Fraction of the points that, once moved, lie more than `far` (mm) on the wrong side.
    fn astray(&self, motion: &Motion, far: f64) -> f64 {
        let out = |p: &&DVec2| self.outline.beyond(motion.of(**p), self.inside).is_some_and(|(by, _)| by > far);
        let (count, out) = (self.some(POINTS.1).count(), self.some(POINTS.1).filter(out).count());
        out as f64 / count.max(1) as f64
    }
}

#[derive(Clone)]
struct Outline {
    region: Region,
    edges: Vec<(DVec2, DVec2)>,
}

impl Outline {
    fn of(region: Region) -> Self {
        let region = region.simplified(SIMPLIFY);
        let edges = region.rings().flat_map(|ring| ring.edges().collect::<Vec<_>>()).collect();
        Self { region, edges }
    }

    /// How far a point lies on the wrong side, mm (negative on the right side), and the direction in which this
    /// distance grows.
    fn beyond(&self, p: DVec2, inside: bool) -> Option<(f64, DVec2)> {
        let to_edge = |&(a, b): &(DVec2, DVec2)| p - polyline::closest_on_segment(p, a, b);
        let way = self.edges.iter().map(to_edge).min_by(|a, b| a.length_squared().total_cmp(&b.length_squared()))?;
        let wrong = if self.region.contains(p) == inside { -1.0 } else { 1.0 };
        Some((wrong * way.length(), wrong * way.normalize_or_zero()))
    }
}

/// A turn about a place, then a shift; mm and radians.
#[derive(Clone, Copy)]
struct Motion {
    about: DVec2,
    turn: f64,
    shift: DVec2,
}

impl Motion {
    fn of(&self, p: DVec2) -> DVec2 {
        self.about + DVec2::from_angle(self.turn).rotate(p - self.about) + self.shift
    }
}

/// The best of the fits from all starts.
fn best(sides: &[Side; 2], margin: f64) -> Motion {
    let scan = planar::Bounds::of(sides[0].points.iter().copied()).map(|bounds| bounds.center());
    let part = sides[0].outline.region.bounds().map(|bounds| bounds.center());
    let about = scan.unwrap_or_default();
    let shifts = [DVec2::ZERO, part.map_or(DVec2::ZERO, |part| part - about)];
    let mut found: Option<(Motion, f64)> = None;
    for shift in shifts {
        for turn in TURNS.map(f64::to_radians) {
            let fit = fitted(sides, Motion { about, turn, shift }, margin, POINTS.0);
            if fit.0.turn.abs() <= MOST_TURN && found.is_none_or(|(_, left)| fit.1 < BETTER * left) {
                found = Some(fit);
            }
        }
    }
    let start = found.map_or(Motion { about, turn: 0.0, shift: DVec2::ZERO }, |(motion, _)| motion);
    // Only points near the outline matter from here on.
    let near = |side: &Side| side.near(&start, NEAR * margin);
    fitted(&[near(&sides[0]), near(&sides[1])], start, margin, POINTS.1).0
}

/// The fit from one start with about `most` points of each side, and the mean square of the remaining distances, mm².
fn fitted(sides: &[Side; 2], mut motion: Motion, margin: f64, most: usize) -> (Motion, f64) {
    let mut left = 0.0;
    for _ in 0..STEPS {
        let (mut normal, mut slope, mut square, mut count) = (DMat3::ZERO, DVec3::ZERO, 0.0, 0.0_f64);
        for (side, p) in sides.iter().flat_map(|side| side.some(most).map(move |p| (side, p))) {
            let at = motion.of(*p);
            count += 1.0;
            let Some((by, out)) = side.outline.beyond(at, side.inside).filter(|(by, _)| *by > -margin) else {
                continue;
            };
            // How the distance changes with the shift and with the turn.
            let change = out.extend(out.dot((at - motion.about - motion.shift).perp()));
            normal += DMat3::from_cols(change * change.x, change * change.y, change * change.z);
            slope += change * (by + margin);
            square += (by + margin).powi(2);
        }
        left = square / count.max(1.0);
        let diagonal = DVec3::new(normal.x_axis.x, normal.y_axis.y, normal.z_axis.z);
        let damped = normal + DMat3::from_diagonal(DVec3::splat(1e-9) + 1e-3 * diagonal);
        let step = -(damped.inverse() * slope);
        if !step.is_finite() || step.length() < LAST_STEP {
            break;
        }
        motion.shift += step.truncate();
        motion.turn += step.z;
    }
    (motion, left)
}
