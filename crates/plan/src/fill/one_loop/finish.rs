//! What a controller can follow: few straight pieces and arcs, and stepwise widths.
//!
//! The relaxed line is replaced by the longest pieces that deviate from it by no more than a tolerance and along which
//! the smoothed width stays within a step. Each piece has one width.

use super::LoopSettings;
use super::line::Line;
use super::room::Room;
use super::tangles::tangled;
use glam::DVec2;
use planar::arcs::{Arc, Fit};

/// Tolerance: how far the line may deviate from the relaxed one, as a fraction of a width step.
const TOLERANCE: f64 = 0.2;
/// Arcs are drawn as chords that deviate from them by at most this, in bead widths.
const CHORD: f64 = 0.002;
/// The middle points of arcs are rounded to multiples of this, in bead widths.
const GRID: f64 = 1e-6;
/// Beads may extend this many bead widths beyond the outline: too low there to count as outside in the deposit model.
const OUT: f64 = 0.005;

/// Where lines lie so close that they would cross, they deviate by no more than these fractions of the tolerance.
const CLOSER: [f64; 3] = [1.0, 0.3, 0.05];

/// The lines, made of few pieces; lines that did not cross do not cross afterwards. Where some would, rings too short
/// to be welded are dropped: in front of narrow necks they lie across the loop.
pub fn all_finished(lines: &[Line], room: &Room, settings: &LoopSettings) -> Vec<Line> {
    let finished = |closer: &f64| {
        let tolerance = TOLERANCE * settings.width_step * closer;
        lines.iter().map(|line| finished_to(line, tolerance, room, settings)).collect::<Vec<_>>()
    };
    let [first, others @ ..] = CLOSER.each_ref();
    let first = finished(first);
    if !tangled(&first) {
        return first;
    }
    if !tangled(lines) {
        return others.into_iter().map(finished).find(|lines| !tangled(lines)).unwrap_or(first);
    }
    let is_long = |line: &Line| !line.closed || line.length() >= settings.shortest;
    let long: Vec<Line> = first.iter().filter(|line| is_long(line)).cloned().collect();
    if long.is_empty() { first } else { long }
}

/// The line, made of few pieces.
pub fn finished(line: &Line, room: &Room, settings: &LoopSettings) -> Line {
    finished_to(line, TOLERANCE * settings.width_step, room, settings)
}

fn finished_to(line: &Line, tolerance: f64, room: &Room, settings: &LoopSettings) -> Line {
    let w = settings.bead_width;
    let fit = Fit { tolerance, arcs: true, grid: GRID * w };
    let (points, widths, thin) = opened(line, line.smooth_widths(settings.smoothing_length), settings);
    let count = points.len().saturating_sub(1);
    let mut result = Line { closed: line.closed, ..Line::default() };
    let (mut start, mut width) = (0, 0.0);
    while start < count {
        let alike = alike(&widths, &thin, start, settings.width_step);
        let piece = fit.next(&points[start..=alike]);
        let end = start + piece.end;
        let own = &points[start..=end];
        let mean = mean_width(own, &widths[start..end]);
        // A width that hardly differs from the previous one is replaced by it.
        if (mean - width).abs() > settings.width_step / 2.0 {
            width = mean;
        }
        let drawn = piece.arc.map(|arc| chords(&arc, points[start], CHORD * w)).unwrap_or_default();
        let nearest = own.iter().chain(&drawn).map(|p| room.at(*p)).fold(f64::INFINITY, f64::min);
        let (low, high) = settings.limits(thin[start]);
        width = width.min(2.0 * (nearest + OUT * w)).clamp(low, high);
        for point in std::iter::once(points[start]).chain(drawn) {
            result.points.push(point);
            result.widths.push(width);
            result.thin.push(thin[start]);
        }
        start = end;
    }
    if !line.closed {
        result.points.extend(points.last());
        result.widths.push(width);
        result.thin.push(thin.last().copied().unwrap_or_default());
    }
    result
}

/// One minus the golden section: its multiples spread evenly over a loop.
const GOLDEN: f64 = 0.381_966_011_250_105;
/// The seam is put where the line is straightest, within this many bead widths of its planned place.
const SEAM: f64 = 3.0;

/// The points, widths and thin flags. A closed line begins far from where the layers below begin, and its first point
/// is repeated at its end.
fn opened(line: &Line, mut widths: Vec<f64>, settings: &LoopSettings) -> (Vec<DVec2>, Vec<f64>, Vec<bool>) {
    let (mut points, mut thin) = (line.points.clone(), line.thin.clone());
    if line.closed && !points.is_empty() {
        let n = points.len();
        let rear = (0..n).max_by(|&a, &b| points[a].y.total_cmp(&points[b].y)).unwrap_or(0);
        let place = rear + ((GOLDEN * settings.layer as f64).fract() * n as f64) as usize;
        let reach = (SEAM * settings.bead_width * n as f64 / line.length()) as usize;
        let straight = |i: usize| (points[i] - points[line.before(i)]).dot(points[line.behind(i)] - points[i]);
        let around = (0..=(2 * reach).min(n)).map(|k| (place + n + k - reach.min(n)) % n);
        let first = around.max_by(|&a, &b| straight(a).total_cmp(&straight(b)).then(b.cmp(&a))).unwrap_or(0);
        points.rotate_left(first);
        widths.rotate_left(first);
        thin.rotate_left(first);
        points.push(points[0]);
    }
    (points, widths, thin)
}

/// The last point, from `start` on, up to which the widths of the pieces stay within `step` of each other.
fn alike(widths: &[f64], thin: &[bool], start: usize, step: f64) -> usize {
    let (mut low, mut high) = (widths[start], widths[start]);
    let mut end = start + 1;
    while end < widths.len() && thin[end] == thin[start] {
        (low, high) = (low.min(widths[end]), high.max(widths[end]));
        if high - low > step {
            break;
        }
        end += 1;
    }
    end
}

fn mean_width(points: &[DVec2], widths: &[f64]) -> f64 {
    let pieces = points.windows(2).map(|w| w[0].distance(w[1])).zip(widths);
    let (length, area) = pieces.fold((0.0, 0.0), |(l, a), (length, width)| (l + length, a + length * width));
    if length > 0.0 { area / length } else { widths.first().copied().unwrap_or_default() }
}

/// The points on an arc between its ends.
fn chords(arc: &Arc, from: DVec2, error: f64) -> Vec<DVec2> {
    let step = 2.0 * (1.0 - (error / arc.radius).min(0.5)).acos();
    let count = (arc.sweep.abs() / step).ceil().clamp(4.0, 2000.0) as usize;
    let spoke = from - arc.centre;
    (1..count).map(|k| arc.centre + DVec2::from_angle(arc.sweep * k as f64 / count as f64).rotate(spoke)).collect()
}
