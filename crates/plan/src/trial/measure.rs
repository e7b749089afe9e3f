//! Beads measured in a scan of the plate, in place of callipers.

use super::shape::{ENDS, OVERLAP};
use crate::bead::library::Factored;
use glam::{DVec2, DVec3};

/// What a scan says of a bead, or of beads side by side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BeadSize {
    /// Width at the foot, mm: mean over the middle of the length.
    pub width: f64,
    /// Height of the crown above the plate, mm: mean over the middle of the length, and over the beads.
    pub height: f64,
    /// What only one bead by itself, or beads side by side, show.
    pub more: More,
}

/// What a scan says of one bead, or of beads side by side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum More {
    /// Of one bead.
    One {
        /// Standard deviation of the width along the bead, mm.
        width_varies: f64,
        /// Standard deviation of the height along the bead, mm.
        height_varies: f64,
        /// How much higher it begins; `None` if the scan does not show its start.
        hump: Option<Slope>,
        /// How much lower it ends; `None` if the scan does not show its end.
        crater: Option<Slope>,
    },
    /// Of beads side by side.
    Beside {
        /// Depth of the deepest valley below the crowns on both of its sides, mm.
        valley: f64,
    },
}

/// How much higher or lower a bead is at its end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slope {
    /// The difference at the very end, mm.
    pub height: f64,
    /// Length over which it fades evenly, mm; `None` if it is too small to be told from the rest of the bead.
    pub length: Option<f64>,
}

impl BeadSize {
    /// Columns of the sheet, with what goes into them; nothing where the scan does not show it.
    pub(super) fn cells(&self) -> Vec<(&'static str, Option<f64>)> {
        let size = [(OVERLAP[0], Some(self.width)), (OVERLAP[1], Some(self.height))].into_iter();
        match self.more {
            More::Beside { valley } => size.chain([(OVERLAP[2], Some(valley))]).collect(),
            More::One { hump, crater, .. } => {
                let slope = |slope: Option<Slope>| [slope.map(|own| own.height), slope.and_then(|own| own.length)];
                let ends = [slope(hump), slope(crater)].concat();
                size.chain(ENDS[2..].iter().copied().zip(ends)).collect()
            }
        }
    }
}

/// Where starts and craters are left out: this fraction of the length at both ends.
pub(super) const LEFT_OUT: f64 = 0.2;
/// Humps and craters are sought up to this fraction of the length.
const FADED: f64 = 0.45;
/// Lengths of humps and craters that are tried.
const LENGTHS: usize = 40;
/// A hump or crater has a length if it is this many times as high as its standard error: of many lengths the best is taken, and
/// beads are wavy.
const SEEN: f64 = 5.0;
/// Places across a stepover at which the heights of beads side by side are averaged, and how many of them need points.
const ACROSS: f64 = 24.0;
const ACROSS_LEAST: usize = 3;
/// Beads side by side lie at least this far apart, as a fraction of their reach.
const APART: f64 = 0.05;
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

/// Where a trial is sought in a scan.
#[derive(Debug, Clone, PartialEq)]
pub struct Sought {
    /// A straight bead, or several side by side: each from one place to another on the plate, mm.
    pub beads: Vec<[DVec2; 2]>,
    /// Distance from the middle of a bead up to which it may lie, mm.
    pub reach: f64,
}

/// The sizes of trials in a scan of the plate (mm); `None` where the scan does not show one.
///
/// # Errors
/// [`MeasureError`] if the scan shows no bare plate.
pub fn measured(scan: &[DVec3], trials: &[Sought]) -> Result<Vec<Option<BeadSize>>, MeasureError> {
    let apart =
        |p: DVec3, [from, to]: [DVec2; 2]| planar::polyline::distance_squared_to_segment(p.truncate(), from, to).sqrt();
    let bare = |p: &&DVec3| trials.iter().all(|trial| trial.beads.iter().all(|bead| apart(**p, *bead) > trial.reach));
    let plate = Plane::fitted(&scan.iter().filter(bare).copied().collect::<Vec<_>>()).ok_or(MeasureError::NoPlate)?;
    let size = |trial: &Sought| match &trial.beads[..] {
        [bead] => one(scan, *bead, trial.reach, &plate),
        beads => beside(scan, beads, trial.reach, &plate),
    };
    Ok(trials.iter().map(size).collect())
}

/// Points of a scan seen along a bead: how far along, how far to its left, and how far above the plate, mm.
fn along(scan: &[DVec3], [from, to]: [DVec2; 2], plate: &Plane) -> impl Iterator<Item = DVec3> {
    let direction = (to - from).normalize_or_zero();
    scan.iter().map(move |p| {
        let by = p.truncate() - from;
        DVec3::new(direction.dot(by), direction.perp_dot(by), p.z - plate.height(p.truncate()))
    })
}

fn one(scan: &[DVec3], bead: [DVec2; 2], reach: f64, plate: &Plane) -> Option<BeadSize> {
    let length = bead[0].distance(bead[1]);
    let count = (length / SLICE).floor().max(1.0);
    let mut slices: Vec<Vec<(f64, f64)>> = vec![Vec::new(); count as usize];
    for p in along(scan, bead, plate).filter(|p| p.y.abs() <= reach) {
        let slice = (p.x / length * count).floor();
        if (0.0..count).contains(&slice) {
            slices[slice as usize].push((p.y, p.z));
        }
    }
    let places = (0..).map(|slice| (f64::from(slice) + 0.5) * length / count);
    let sizes: Vec<(f64, (f64, f64))> =
        places.zip(&mut slices).filter_map(|(at, slice)| Some((at, section(slice, plate.noise)?))).collect();
    let middle = LEFT_OUT * length..(1.0 - LEFT_OUT) * length;
    let middle: Vec<(f64, f64)> = sizes.iter().filter(|(at, _)| middle.contains(at)).map(|(_, size)| *size).collect();
    if middle.len() < SLICES {
        return None;
    }
    let spread = |of: fn(&(f64, f64)) -> f64| {
        let mean = middle.iter().map(of).sum::<f64>() / middle.len() as f64;
        let square = middle.iter().map(|size| (of(size) - mean).powi(2)).sum::<f64>();
        (mean, (square / (middle.len() - 1) as f64).sqrt())
    };
    let ((width, width_varies), (height, height_varies)) = (spread(|size| size.0), spread(|size| size.1));
    let crowns: Vec<(f64, f64)> = sizes.iter().map(|(at, (_, height))| (*at, *height)).collect();
    let [hump, crater] = ends(&crowns, length);
    Some(BeadSize { width, height, more: More::One { width_varies, height_varies, hump, crater } })
}

/// Hump and crater of a bead of this length (mm) with crowns at these places along it (mm): even slopes, as the deposit model lays
/// them, that with a level bead between come nearest to all crowns (least squares). `None` at an end without crowns.
fn ends(crowns: &[(f64, f64)], length: f64) -> [Option<Slope>; 2] {
    let from = |end: usize, at: f64| if end == 0 { at } else { length - at };
    let heights: Vec<f64> = crowns.iter().map(|(_, height)| *height).collect();
    let tried = |end: usize| -> Vec<Option<f64>> {
        let nearest = crowns.iter().map(|(at, _)| from(end, *at)).fold(f64::INFINITY, f64::min);
        let (least, most) = (nearest + 2.0 * SLICE, FADED * length);
        if nearest > SLICE || most <= least {
            return vec![None];
        }
        (0..LENGTHS).map(|k| Some(least + (most - least) * k as f64 / (LENGTHS - 1) as f64)).collect()
    };
    let fit = |over: [Option<f64>; 2]| -> Option<(f64, [Option<Slope>; 2])> {
        let slope = |end: usize| {
            let over = over[end]?;
            Some(crowns.iter().map(|(at, _)| (1.0 - from(end, *at) / over).max(0.0)).collect::<Vec<f64>>())
        };
        let columns: Vec<Vec<f64>> =
            [Some(vec![1.0; crowns.len()]), slope(0), slope(1)].into_iter().flatten().collect();
        let factored = Factored::new(&columns);
        let values = factored.solve(&heights);
        if values.len() < columns.len() {
            return None;
        }
        let laid = |k: usize| columns.iter().zip(&values).map(|(column, value)| column[k] * value).sum::<f64>();
        let missed = (0..crowns.len()).map(|k| (heights[k] - laid(k)).powi(2)).sum::<f64>();
        let scatter = (missed / crowns.len().saturating_sub(columns.len()).max(1) as f64).sqrt();
        let mut column = 0;
        let slope = [0, 1].map(|end| {
            let over = over[end]?;
            column += 1;
            let height = if end == 0 { values[column] } else { -values[column] };
            let error = scatter * factored.error_of(column);
            Some(Slope { height, length: (height > SEEN * error).then_some(over) })
        });
        Some((missed, slope))
    };
    let all = tried(0).into_iter().flat_map(|hump| tried(1).into_iter().map(move |crater| [hump, crater]));
    all.filter_map(fit).min_by(|a, b| a.0.total_cmp(&b.0)).map_or([None; 2], |(_, slopes)| slopes)
}

fn beside(scan: &[DVec3], beads: &[[DVec2; 2]], reach: f64, plate: &Plane) -> Option<BeadSize> {
    let bead = *beads.first()?;
    let length = bead[0].distance(bead[1]);
    let direction = (bead[1] - bead[0]).normalize_or_zero();
    let mut lines: Vec<f64> = beads.iter().map(|[from, _]| direction.perp_dot(*from - bead[0])).collect();
    lines.sort_by(f64::total_cmp);
    let stepover = lines.windows(2).map(|pair| pair[1] - pair[0]).fold(f64::INFINITY, f64::min);
    if stepover < APART * reach {
        return None;
    }
    let (low, high) = (lines[0] - reach, lines[lines.len() - 1] + reach);
    let middle = LEFT_OUT * length..(1.0 - LEFT_OUT) * length;
    let points = along(scan, bead, plate).filter(|p| middle.contains(&p.x) && (low..high).contains(&p.y));
    let heights = averaged(points, low, high, stepover / ACROSS);
    // The crown of each bead, within half a stepover of where it was planned.
    let near = |line: f64| heights.iter().filter(move |(at, _)| (at - line).abs() <= 0.5 * stepover);
    if lines.iter().any(|line| near(*line).count() < ACROSS_LEAST) {
        return None;
    }
    let highest = |line: &f64| near(*line).copied().max_by(|a, b| a.1.total_cmp(&b.1));
    let crowns: Vec<(f64, f64)> = lines.iter().filter_map(highest).collect();
    let height = crowns.iter().map(|crown| crown.1).sum::<f64>() / crowns.len() as f64;
    if height < 4.0 * plate.noise || height <= 0.0 {
        return None;
    }
    let valley = |pair: &[(f64, f64)]| {
        let (a, b) = (pair[0], pair[1]);
        // Below a straight edge across both crowns.
        let below = |(at, own): &(f64, f64)| a.1 + (b.1 - a.1) * (at - a.0) / (b.0 - a.0).max(1e-9) - own;
        heights.iter().filter(|(at, _)| (a.0..=b.0).contains(at)).map(below).fold(0.0, f64::max)
    };
    let foot = FOOT * height;
    let up = |(_, own): &(f64, f64)| *own >= foot;
    let first = heights.iter().position(up)?;
    let last = heights.iter().rposition(up)?;
    let left = crossing(heights[first], *heights.get(first.checked_sub(1)?)?, foot);
    let right = crossing(heights[last], *heights.get(last + 1)?, foot);
    // From a crown to the foot, and along a parabola to the plate.
    let half = |(at, top): (f64, f64), edge: f64| (edge - at).abs() / (1.0 - foot / top).max(0.1).sqrt();
    let outer = [crowns[0], crowns[crowns.len() - 1]];
    let width = outer[1].0 - outer[0].0 + half(outer[0], left) + half(outer[1], right);
    let valley = crowns.windows(2).map(valley).fold(0.0, f64::max);
    Some(BeadSize { width, height, more: More::Beside { valley } })
}

/// Mean heights of points along a bead, with the places to its left, mm; places without enough points are left out.
fn averaged(points: impl Iterator<Item = DVec3>, low: f64, high: f64, step: f64) -> Vec<(f64, f64)> {
    let count = ((high - low) / step).ceil().max(1.0) as usize;
    let mut sums = vec![(0, 0.0, 0.0); count];
    for p in points {
        let sum = &mut sums[(((p.y - low) / step) as usize).min(count - 1)];
        *sum = (sum.0 + 1, sum.1 + p.y, sum.2 + p.z);
    }
    let mean = |(number, at, height): (usize, f64, f64)| (at / number as f64, height / number as f64);
    sums.into_iter().filter(|sum| sum.0 >= POINTS).map(mean).collect()
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
    let (a, b) = (crossing(points[left + 1], points[left], low), crossing(points[right - 1], points[right], low));
    let height = crown(&points[left + 1..right])?;
    Some(((b - a) / (1.0 - low / height).max(0.1).sqrt(), height))
}

/// Where a surface that is straight between two points, the inner of them higher, has this height.
fn crossing(inner: (f64, f64), outer: (f64, f64), height: f64) -> f64 {
    inner.0 + (outer.0 - inner.0) * (inner.1 - height) / (inner.1 - outer.1).max(1e-9)
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
