//! Beads measured in a scan of the plate, in place of callipers.

use crate::bead::library::Factored;
use glam::{DVec2, DVec3};

/// What a scan says of a bead.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BeadSize {
    /// Width at the foot, mm: mean over its middle.
    pub width: f64,
    /// Height of the crown above the plate, mm: mean over its middle.
    pub height: f64,
    /// Standard deviation of the width along the bead, mm.
    pub width_varies: f64,
    /// Standard deviation of the height along the bead, mm.
    pub height_varies: f64,
}

/// Where starts and craters are left out: this fraction of the length at both ends.
const ENDS: f64 = 0.2;
/// Length of a slice across the bead, mm, and the points that it needs.
const SLICE: f64 = 2.0;
const POINTS: usize = 12;
/// Slices that a bead needs.
const SLICES: usize = 5;
/// The foot is sought at this fraction of the height, and from there to the plate along a parabola: at the plate itself,
/// noise hides it.
const FOOT: f64 = 0.25;
/// The crown is the height that this fraction of the highest points exceeds: single points are noise.
const CROWN: f64 = 0.1;
/// Points whose distance from the plate is more than this many standard deviations are no plate.
const OUTLYING: f64 = 2.5;
const FITS: usize = 8;

/// The sizes of straight beads, each from one place to another on the plate (mm), in a scan of it (mm); `reach` is the
/// distance from a bead's middle up to which it may lie, mm. `None` where the scan does not show a bead.
///
/// # Errors
/// [`MeasureError`] if the scan shows no bare plate.
pub fn measured(scan: &[DVec3], beads: &[[DVec2; 2]], reach: f64) -> Result<Vec<Option<BeadSize>>, MeasureError> {
    let bare = |p: &&DVec3| {
        beads
            .iter()
            .all(|[from, to]| planar::polyline::distance_squared_to_segment(p.truncate(), *from, *to) > reach * reach)
    };
    let plate = Plane::fitted(&scan.iter().filter(bare).copied().collect::<Vec<_>>()).ok_or(MeasureError::NoPlate)?;
    Ok(beads.iter().map(|bead| size(scan, *bead, reach, &plate)).collect())
}

fn size(scan: &[DVec3], [from, to]: [DVec2; 2], reach: f64, plate: &Plane) -> Option<BeadSize> {
    let (length, along) = (from.distance(to), (to - from).normalize_or_zero());
    let count = ((1.0 - 2.0 * ENDS) * length / SLICE).floor().max(1.0) as usize;
    let mut slices: Vec<Vec<(f64, f64)>> = vec![Vec::new(); count];
    for p in scan {
        let by = p.truncate() - from;
        let (at, across) = (along.dot(by) - ENDS * length, along.perp_dot(by));
        let slice = (at / SLICE).floor();
        if (0.0..count as f64).contains(&slice) && across.abs() <= reach {
            slices[slice as usize].push((across, p.z - plate.height(p.truncate())));
        }
    }
    let sizes: Vec<(f64, f64)> = slices.iter_mut().filter_map(|slice| section(slice, plate.noise)).collect();
    (sizes.len() >= SLICES).then(|| {
        let spread = |of: fn(&(f64, f64)) -> f64| {
            let mean = sizes.iter().map(of).sum::<f64>() / sizes.len() as f64;
            let square = sizes.iter().map(|size| (of(size) - mean).powi(2)).sum::<f64>();
            (mean, (square / (sizes.len() - 1) as f64).sqrt())
        };
        let ((width, width_varies), (height, height_varies)) = (spread(|size| size.0), spread(|size| size.1));
        BeadSize { width, height, width_varies, height_varies }
    })
}

/// Width and height, mm, of a section of points across the bead and above the plate; `None` if it does not show a bead.
fn section(points: &mut [(f64, f64)], noise: f64) -> Option<(f64, f64)> {
    if points.len() < POINTS {
        return None;
    }
    points.sort_by(|a, b| b.1.total_cmp(&a.1));
    let rough = points[points.len() / 20].1;
    if rough < 4.0 * noise || rough <= 0.0 {
        return None;
    }
    // The part of the bead above its foot, from its highest place outwards.
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    let top = points.iter().enumerate().max_by(|a, b| a.1.1.total_cmp(&b.1.1))?.0;
    let low = FOOT * rough;
    let right = points[top..].iter().position(|p| p.1 < low)? + top;
    let left = points[..top].iter().rposition(|p| p.1 < low)?;
    // Between two points the surface is straight.
    let foot = |inner: (f64, f64), outer: (f64, f64)| {
        inner.0 + (outer.0 - inner.0) * (inner.1 - low) / (inner.1 - outer.1).max(1e-9)
    };
    let (a, b) = (foot(points[left + 1], points[left]), foot(points[right - 1], points[right]));
    let height = crown(&points[left + 1..right])?;
    Some(((b - a) / (1.0 - low / height).max(0.1).sqrt(), height))
}

/// The top of a parabola through the upper half of a section (least squares).
fn crown(points: &[(f64, f64)]) -> Option<f64> {
    let highest = {
        let mut heights: Vec<f64> = points.iter().map(|p| p.1).collect();
        heights.sort_by(|a, b| b.total_cmp(a));
        heights[(CROWN * heights.len() as f64) as usize]
    };
    let upper: Vec<(f64, f64)> = points.iter().filter(|p| p.1 > highest / 2.0).copied().collect();
    let middle = upper.iter().map(|p| p.0).sum::<f64>() / upper.len() as f64;
    let column = |power: i32| upper.iter().map(|p| (p.0 - middle).powi(power)).collect();
    let heights: Vec<f64> = upper.iter().map(|p| p.1).collect();
    let [c, b, a] = Factored::new(&[column(0), column(1), column(2)]).solve(&heights)[..] else { return Some(highest) };
    let top = if a < 0.0 { c - b * b / (4.0 * a) } else { highest };
    (top > 0.0).then_some(top)
}

/// A nearly level plane, z over x and y.
struct Plane {
    middle: DVec2,
    /// Height in the middle, mm, and slopes.
    values: DVec3,
    /// Standard deviation of its points, mm.
    noise: f64,
}

impl Plane {
    /// The plane of most points: least squares, without those that lie far from it.
    fn fitted(points: &[DVec3]) -> Option<Self> {
        let middle = points.iter().map(|p| p.truncate()).sum::<DVec2>() / points.len().max(1) as f64;
        let mut heights: Vec<f64> = points.iter().map(|p| p.z).collect();
        heights.sort_by(f64::total_cmp);
        let median = *heights.get(heights.len() / 2)?;
        let mut plane = Self { middle, values: DVec3::new(median, 0.0, 0.0), noise: f64::INFINITY };
        for _ in 0..FITS {
            let near = |p: &&DVec3| (p.z - plane.height(p.truncate())).abs() <= OUTLYING * plane.noise;
            let near: Vec<DVec3> = points.iter().filter(near).copied().collect();
            if near.len() < POINTS {
                return None;
            }
            let column = |of: fn(DVec3) -> f64| near.iter().map(|p| of(plane.own(p.truncate()))).collect();
            let heights: Vec<f64> = near.iter().map(|p| p.z).collect();
            let columns = [column(|own| own.x), column(|own| own.y), column(|own| own.z)];
            // Points on one line show no plane.
            let [height, x, y] = Factored::new(&columns).solve(&heights)[..] else { return None };
            plane.values = DVec3::new(height, x, y);
            let square = near.iter().map(|p| (p.z - plane.height(p.truncate())).powi(2)).sum::<f64>();
            plane.noise = (square / near.len() as f64).sqrt();
        }
        Some(plane)
    }

    fn height(&self, at: DVec2) -> f64 {
        self.values.dot(self.own(at))
    }

    fn own(&self, at: DVec2) -> DVec3 {
        let by = at - self.middle;
        DVec3::new(1.0, by.x, by.y)
    }
}

/// Why beads cannot be measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum MeasureError {
    /// Heights are measured from the plate.
    #[error(
        "the scan shows no bare plate beside the beads, from which their heights could be measured. Scan some of it, too."
    )]
    NoPlate,
}
