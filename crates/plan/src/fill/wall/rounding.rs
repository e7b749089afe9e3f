//! Trails become paths: corners rounded, junctions touched and left again, ends held back.
//!
//! At a node a path leaves one strand and enters the next. If the two are in line, it runs straight through. Otherwise
//! it leaves the first a tangent length L before the corner and enters the second a length L after it, along a cubic
//! with the tangents of both (between straight strands an arc of radius R = L cot(φ/2), φ the turn, to within 3·10⁻⁴
//! R). R is the corner radius; if other paths touch the junction too, R is made so large that the path keeps its
//! distance from it, R (1/cos(φ/2) − 1), so that two passes that touch lay no metal twice. Paths that end at a junction
//! stop before the metal of the others.

use super::WallSettings;
use super::strand::{Point, Strand};
use crate::fill::trails::{Dart, Network, Trail};
use glam::DVec2;
use std::f64::consts::PI;

/// Smaller turns count as straight, rad (8°).
const STRAIGHT: f64 = 8.0 * PI / 180.0;
/// Larger turns lead back along the neighbouring strand, rad (150°).
const BACK: f64 = 150.0 * PI / 180.0;
/// Greatest fraction of a strand given up to a curve or gap at either end.
const MOST: f64 = 0.45;
/// A curve around a corner begins at most this many bead widths before it.
const LONGEST: f64 = 3.0;
/// Ends are pulled back in steps of this fraction of a bead width.
const STEP: f64 = 0.02;

/// A path along strands.
#[derive(Debug, Clone, PartialEq)]
pub struct Rounded {
    /// Its points; the first one of a closed path is not repeated.
    pub points: Vec<Point>,
    /// Whether it ends where it began.
    pub closed: bool,
}

/// The paths of all trails.
pub fn paths(strands: &[Strand], network: &Network, trails: &[Trail], settings: &WallSettings) -> Vec<Rounded> {
    let lanes = Lanes { strands, settings, touched: touched(network, trails) };
    let mut paths: Vec<Rounded> = trails.iter().map(|trail| lanes.path(trail)).collect();
    let shared = shared_ends(network);
    let whole = paths.clone();
    for (i, (path, trail)) in paths.iter_mut().zip(trails).enumerate().filter(|(_, (_, trail))| !trail.closed) {
        let (Some(&first), Some(&last)) = (trail.darts.first(), trail.darts.last()) else { continue };
        for end in [first, last ^ 1] {
            if shared[end] {
                let room = MOST * length(&strands[end / 2].points);
                hold_back(path, (i, end == first), &whole, room, settings);
            }
        }
    }
    paths
}

/// For each dart, whether the path that turns there shares its node with another path that runs through.
fn touched(network: &Network, trails: &[Trail]) -> Vec<bool> {
    let mut paired = vec![false; 2 * network.walls.len()];
    for trail in trails {
        let (darts, count) = (&trail.darts, trail.darts.len());
        for i in 0..if trail.closed { count } else { count.saturating_sub(1) } {
            paired[darts[i] ^ 1] = true;
            paired[darts[(i + 1) % count]] = true;
        }
    }
    let mut touched = vec![false; paired.len()];
    for star in &network.stars {
        let pairs = star.iter().filter(|&&(dart, _)| paired[dart]).count() / 2;
        star.iter().for_each(|&(dart, _)| touched[dart] = pairs > 1);
    }
    touched
}

/// For each dart, whether other strands also meet its node.
fn shared_ends(network: &Network) -> Vec<bool> {
    let mut shared = vec![false; 2 * network.walls.len()];
    for star in network.stars.iter().filter(|star| star.len() > 1) {
        star.iter().for_each(|&(dart, _)| shared[dart] = true);
    }
    shared
}

struct Lanes<'a> {
    strands: &'a [Strand],
    settings: &'a WallSettings,
    touched: Vec<bool>,
}

impl Lanes<'_> {
    fn path(&self, trail: &Trail) -> Rounded {
        let mut trail = trail.clone();
        if trail.closed {
            // Start in the middle of the longest strand, which is halved.
            let longest = |a: &usize, b: &usize| {
                length(&self.leg(trail.darts[*a])).total_cmp(&length(&self.leg(trail.darts[*b]))).then(b.cmp(a))
            };
            let start = (0..trail.darts.len()).max_by(longest).unwrap_or(0);
            trail.darts.rotate_left(start);
        }
        let mut legs: Vec<Vec<Point>> = trail.darts.iter().map(|&dart| self.leg(dart)).collect();
        let mut darts = trail.darts;
        if let (true, Some(&dart)) = (trail.closed, darts.first()) {
            let (first, second) = halves(&legs[0]);
            legs[0] = second;
            legs.push(first);
            darts.push(dart);
        }
        let mut points: Vec<Point> = Vec::new();
        for i in 0..legs.len().saturating_sub(1) {
            let curve = if self.strands[darts[i] / 2].ring {
                Vec::new()
            } else {
                let (before, behind) = legs.split_at_mut(i + 1);
                self.turn(&mut before[i], &mut behind[0], darts[i + 1])
            };
            points.append(&mut legs[i]);
            points.extend(curve);
        }
        points.extend(legs.pop().unwrap_or_default());
        points.dedup_by(|a, b| a.at.distance(b.at) < 1e-6);
        if trail.closed && points.len() > 1 {
            points.pop();
        }
        Rounded { points, closed: trail.closed }
    }

    /// A strand's points in the direction in which a dart enters it.
    fn leg(&self, dart: Dart) -> Vec<Point> {
        let mut points = self.strands[dart / 2].points.clone();
        if dart % 2 == 1 {
            points.reverse();
        }
        points
    }

    /// The curve from one leg into the next; both legs are shortened or extended for it.
    fn turn(&self, from: &mut Vec<Point>, to: &mut Vec<Point>, entered: Dart) -> Vec<Point> {
        let (Some(&end), Some(&start)) = (from.last(), to.first()) else { return Vec::new() };
        let reach = 0.5 * end.width.max(start.width);
        to.reverse();
        let (way, onward) = (end_way(from, reach), -end_way(to, reach));
        let angle = way.angle_to(onward).abs();
        let aligned = (start.at - end.at).perp_dot(way).abs() < 0.02 * reach;
        if angle >= STRAIGHT || !aligned {
            let (tangent, before, behind) = self.tangent(way, onward, angle, end, start, entered);
            let room = |leg: &[Point]| MOST * length(leg);
            move_end(from, (before - tangent).max(-room(from)));
            move_end(to, (behind - tangent).max(-room(to)));
        }
        let (p, q) = (from.last().copied().unwrap_or(end), to.last().copied().unwrap_or(start));
        let (way, onward) = (end_way(from, 0.1 * reach), -end_way(to, 0.1 * reach));
        to.reverse();
        curve(p, q, way, onward, self.settings.chord_error)
    }

    /// Tangent length, and how far the corner lies beyond the end of one leg and before the start of the next, mm.
    fn tangent(
        &self,
        way: DVec2,
        onward: DVec2,
        angle: f64,
        end: Point,
        start: Point,
        entered: Dart,
    ) -> (f64, f64, f64) {
        let width = 0.5 * (end.width + start.width);
        let gap = start.at - end.at;
        if angle >= BACK {
            return (0.0, 0.0, 0.0);
        }
        if angle < STRAIGHT {
            return (1.5 * gap.perp_dot(way).abs(), 0.0, 0.0);
        }
        // end + way · before is the corner, and start − onward · behind.
        let area = way.perp_dot(onward);
        let (before, behind) = (gap.perp_dot(onward) / area, -gap.perp_dot(way) / area);
        let half = angle / 2.0;
        let mut radius = self.settings.corner_radius * width;
        if self.touched[entered] && self.strands[entered / 2].alone {
            radius = radius.max(self.settings.junction_gap * width / (1.0 / half.cos() - 1.0));
        }
        ((radius * half.tan()).min(LONGEST * width), before, behind)
    }
}

/// Length of a line of points, mm.
pub fn length(points: &[Point]) -> f64 {
    points.windows(2).map(|w| w[0].at.distance(w[1].at)).sum()
}

/// A line cut in its middle.
fn halves(points: &[Point]) -> (Vec<Point>, Vec<Point>) {
    let mut first = points.to_vec();
    let mut second: Vec<Point> = points.iter().rev().copied().collect();
    let half = 0.5 * length(points);
    move_end(&mut first, -half);
    move_end(&mut second, -half);
    second.reverse();
    (first, second)
}

/// The direction in which a line ends, taken over its last `reach`, mm.
fn end_way(points: &[Point], reach: f64) -> DVec2 {
    let Some(end) = points.last() else { return DVec2::X };
    let mut left = reach;
    let mut from = end.at;
    for w in points.windows(2).rev() {
        let step = w[0].at.distance(w[1].at);
        if step >= left {
            from = w[1].at.lerp(w[0].at, left / step);
            break;
        }
        left -= step;
        from = w[0].at;
    }
    (end.at - from).normalize_or(DVec2::X)
}

/// Extends a line straight by `by` (mm), or shortens its end by that much if negative.
fn move_end(points: &mut Vec<Point>, by: f64) {
    if by > 0.0 {
        let way = end_way(points, 1e-3);
        if let Some(&end) = points.last() {
            points.push(Point { at: end.at + way * by, ..end });
        }
        return;
    }
    let mut left = -by;
    while let [.., a, b] = points[..] {
        let (step, last) = (a.at.distance(b.at), points.len() - 1);
        if step > left {
            let share = left / step;
            points[last] = Point { at: b.at.lerp(a.at, share), width: b.width + share * (a.width - b.width) };
            return;
        }
        left -= step;
        points.pop();
    }
}

/// The inner points of a cubic from `p` to `q` with these directions, close to an arc; chords deviate from it by at
/// most `error` (mm).
fn curve(p: Point, q: Point, way: DVec2, onward: DVec2, error: f64) -> Vec<Point> {
    let angle = way.angle_to(onward).abs();
    let chord = p.at.distance(q.at);
    if chord < 1e-9 {
        return Vec::new();
    }
    // Arc: radius = chord / (2 sin(φ/2)), handles = 4/3 tan(φ/4) radius; straight: handles = a third of the chord.
    let handle =
        if angle < 1e-3 { chord / 3.0 } else { 4.0 / 3.0 * (angle / 4.0).tan() * chord / (2.0 * (angle / 2.0).sin()) };
    let (a, b) = (p.at + way * handle, q.at - onward * handle);
    let radius = chord / (2.0 * (angle / 2.0).sin().max(0.05));
    let step = 2.0 * (1.0 - (error / radius).min(0.5)).acos();
    let count = ((angle.max(0.4) / step).ceil()).clamp(2.0, 200.0) as usize;
    let at = |k: usize| {
        let t = k as f64 / count as f64;
        let s = 1.0 - t;
        let at = p.at * (s * s * s) + a * (3.0 * s * s * t) + b * (3.0 * s * t * t) + q.at * (t * t * t);
        Point { at, width: s * p.width + t * q.width }
    };
    (1..count).map(at).collect()
}

/// Shortens an end until it keeps the end gap from all other paths, and from its own path beyond that strand.
fn hold_back(
    path: &mut Rounded,
    (number, at_start): (usize, bool),
    others: &[Rounded],
    room: f64,
    settings: &WallSettings,
) {
    if at_start {
        path.points.reverse();
    }
    if let Some(&end) = path.points.last() {
        let gap = settings.end_gap * end.width;
        let near: Vec<[DVec2; 2]> = others
            .iter()
            .enumerate()
            .flat_map(|(i, other)| segments(other, (i == number).then_some((at_start, room / MOST))))
            .filter(|[a, b]| planar::polyline::distance_squared_to_segment(end.at, *a, *b) < (3.0 * end.width).powi(2))
            .collect();
        let clear =
            |p: DVec2| near.iter().all(|[a, b]| planar::polyline::distance_squared_to_segment(p, *a, *b) >= gap * gap);
        let step = STEP * end.width;
        let mut left = room;
        while left > 0.0 && path.points.last().is_some_and(|end| !clear(end.at)) {
            move_end(&mut path.points, -step);
            left -= step;
        }
    }
    if at_start {
        path.points.reverse();
    }
}

/// The pieces of a path; for the path being shortened, only those more than a given length (mm) from its start or end.
fn segments(path: &Rounded, own: Option<(bool, f64)>) -> Vec<[DVec2; 2]> {
    let again = path.closed.then(|| path.points.first()).flatten();
    let mut points: Vec<Point> = path.points.iter().chain(again).copied().collect();
    if let Some((at_start, strand)) = own {
        if at_start {
            points.reverse();
        }
        move_end(&mut points, -strand);
    }
    points.windows(2).map(|w| [w[0].at, w[1].at]).collect()
}
