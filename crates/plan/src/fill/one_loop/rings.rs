//! Rings: the closed lines on which the phase is a whole number, made smooth.

use super::LoopSettings;
use super::room::Room;
use glam::DVec2;
use planar::isolines::isolines;
use planar::polyline;

/// Points per stepover on a ring.
pub const POINTS_PER_STEPOVER: f64 = 10.0;
/// Rounds of smoothing over neighbouring lattice steps.
const SMOOTHING: usize = 6;
/// Length of the shortest ring, in stepovers: about as tight as a bead can turn. Shorter ones become circles of this
/// length.
const SHORTEST: f64 = 2.2;

/// A closed centre-line.
#[derive(Debug, Clone, PartialEq)]
pub struct Ring {
    /// Number of the ring, counted inwards from the outline, from 1.
    pub level: u32,
    /// Its points, about evenly spaced; the first one is not repeated.
    pub points: Vec<DVec2>,
}

/// The rings of a phase field.
pub fn rings(room: &Room, phase: &[f32], settings: &LoopSettings) -> Vec<Ring> {
    let step = settings.stepover / POINTS_PER_STEPOVER;
    let mut rings = Vec::new();
    for line in isolines(&room.lattice, phase) {
        let mut points = resampled(&line.points, room.lattice.step / 2.0);
        for _ in 0..SMOOTHING {
            points = smoothed(&points);
        }
        let length = perimeter(&points);
        let shortest = SHORTEST * settings.stepover;
        if length < shortest {
            points = circle(&points, shortest);
        }
        rings.push(Ring { level: line.level, points: resampled(&points, step) });
    }
    rings
}

fn circle(points: &[DVec2], length: f64) -> Vec<DVec2> {
    let middle = points.iter().sum::<DVec2>() / points.len() as f64;
    let radius = length / std::f64::consts::TAU;
    (0..24).map(|k| middle + DVec2::from_angle(f64::from(k) * std::f64::consts::TAU / 24.0) * radius).collect()
}

/// Length of a closed line, mm.
pub fn perimeter(points: &[DVec2]) -> f64 {
    let closing = points.last().zip(points.first()).map_or(0.0, |(a, b)| a.distance(*b));
    polyline::length(points) + closing
}

/// A closed line with its points evenly spaced, about `step` (mm) apart, and at least six of them.
pub fn resampled(points: &[DVec2], step: f64) -> Vec<DVec2> {
    let Some(&first) = points.first() else { return Vec::new() };
    let length = perimeter(points);
    let count = ((length / step).round() as usize).max(6);
    let mut result = Vec::with_capacity(count);
    let (mut along, mut k) = (0.0, 0);
    let next = points.iter().copied().skip(1).chain([first]);
    for (a, b) in points.iter().copied().zip(next) {
        let piece = a.distance(b);
        while k < count {
            let at = length * k as f64 / count as f64;
            if at > along + piece || piece == 0.0 {
                break;
            }
            result.push(a.lerp(b, ((at - along) / piece).clamp(0.0, 1.0)));
            k += 1;
        }
        along += piece;
    }
    result
}

fn smoothed(points: &[DVec2]) -> Vec<DVec2> {
    let n = points.len();
    (0..n).map(|i| points[i] * 0.5 + (points[(i + n - 1) % n] + points[(i + 1) % n]) * 0.25).collect()
}
