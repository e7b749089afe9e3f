//! Relaxation on the height field: lines move to where metal is missing, and widths follow the surrounding height.
//!
//! Points move down the slope of the blurred heights, mainly across their line; a little tension keeps lines smooth.
//! Strides and gains decrease from round to round, and the best round is kept.

use super::LoopSettings;
use super::field::Field;
use super::line::Line;
use super::room::Room;
use super::tangles::Mend;
use glam::DVec2;
use planar::Region;

/// Move of a point, in bead widths, for a slope of one bead height per bead width.
const STRIDE: f64 = 0.03;
/// Greatest move of a point in a round, in bead widths.
const FARTHEST: f64 = 0.05;
/// Fraction of the slope along the line that is ignored.
const ACROSS: f64 = 0.8;
/// Each round a point is pulled this fraction of the way to the midpoint of its neighbours.
const TENSION: f64 = 0.08;
/// Factor by which the stride falls from round to round.
const STRIDE_FALL: f64 = 0.95;
/// Widths change by the ratio of wanted to current height, raised to this power.
const GAIN: f64 = 0.5;
/// Factor by which the gain falls from round to round.
const GAIN_FALL: f64 = 0.8;
/// Heights are taken as at least the first value, and widths change by at most the second, as a fraction, in a round.
const LOWEST: f64 = 0.3;
const MOST_CHANGE: f64 = 0.1;

/// Relaxes lines, with `mend` applied after each round; the best round is returned.
pub fn relaxed(mut lines: Vec<Line>, room: &Room, open: &Region, settings: &LoopSettings, mend: Mend) -> Vec<Line> {
    let field = Field::of(room, open, settings);
    let mut before = lines.clone();
    for line in &mut lines {
        line.keep_inside(room, settings);
        line.fit_inside(room, settings);
    }
    mend(&mut lines, &before);
    let mut heights = field.heights(&lines, settings);
    let mut best = (lines.clone(), field.faults(&heights));
    for round in 0..settings.rounds {
        let blurred = field.blurred(&heights);
        before.clone_from_slice(&lines);
        let (stride, gain) = (STRIDE * STRIDE_FALL.powi(round as i32), GAIN * GAIN_FALL.powi(round as i32));
        for line in &mut lines {
            shift(line, &blurred, room, settings, stride);
            adapt(line, &blurred, room, settings, gain);
        }
        mend(&mut lines, &before);
        heights = field.heights(&lines, settings);
        let faults = field.faults(&heights);
        if faults.cost() < best.1.cost() {
            best = (lines.clone(), faults);
        }
    }
    best.0
}

/// Moves the points of a line down the slope; those in walls for one bead stay in the middle.
fn shift(line: &mut Line, heights: &[f32], room: &Room, settings: &LoopSettings, stride: f64) {
    let w = settings.bead_width;
    let step = |i: usize| {
        let slope = room.lattice.slope_at(heights, line.points[i]) * w;
        let way = line.way(i);
        let down = way * (slope.dot(way) * ACROSS) - slope;
        if line.is_end(i) { DVec2::ZERO } else { (down * stride * w).clamp_length_max(FARTHEST * w) }
    };
    let steps: Vec<DVec2> = (0..line.points.len()).map(step).collect();
    let steps = line.smoothed(&line.smoothed(&steps));
    let held: Vec<(usize, DVec2)> = (0..line.points.len())
        .filter(|&i| line.thin[i] && line.thin[line.before(i)])
        .map(|i| (i, line.points[i]))
        .collect();
    line.points.iter_mut().zip(steps).for_each(|(point, step)| *point += step);
    line.tighten(TENSION);
    held.into_iter().for_each(|(i, point)| line.points[i] = point);
    line.keep_inside(room, settings);
}

/// Changes the widths of a line by the heights around its pieces. A bead alone in a wall stays as wide as the wall.
fn adapt(line: &mut Line, heights: &[f32], room: &Room, settings: &LoopSettings, gain: f64) {
    let target = settings.target();
    let wanted = |(a, b, width): (DVec2, DVec2, f64)| {
        let height = room.lattice.value_at(heights, (a + b) / 2.0).max(LOWEST);
        width * (target / height).clamp(1.0 - MOST_CHANGE, 1.0 + MOST_CHANGE).powf(gain)
    };
    let widths: Vec<f64> = line.pieces().map(wanted).collect();
    for (i, width) in widths.into_iter().enumerate() {
        let (low, high) = settings.limits(line.thin[i]);
        let middle = line.points[i].midpoint(line.points[line.behind(i)]);
        let width = if line.thin[i] { 2.0 * room.at(middle) } else { width };
        line.widths[i] = width.clamp(low, high);
    }
    line.fit_inside(room, settings);
}
