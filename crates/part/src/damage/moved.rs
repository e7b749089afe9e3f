//! Whether a scan and a part differ because the scan lies shifted or turned: then damage is imaginary.
//!
//! The movement is found that makes the sum of the distances of points spread over the scan least. Unlike that of their squares, it hardly
//! changes with damage, since what fits holds the scan in place. Each step is that of weighted least squares, with distances along the
//! part's normals, so that surfaces may slide.

use super::{DamageError, Settings, mouth};
use crate::deviation::Surface;
use crate::model::Mesh;
use crate::task::Task;
use glam::{DQuat, DVec3};
use rayon::prelude::*;

/// How a scan lies in comparison with the part.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Movement {
    /// How far the scan is shifted where the part has its middle, mm.
    pub shift: DVec3,
    /// The axis about which it is turned through there, as long as the angle, radians.
    pub turn: DVec3,
    /// Fraction of the scan that lies farther from the part than the tolerance.
    pub off: f64,
    /// The fraction that would if the scan were moved back.
    pub left: f64,
}

/// Number of points, and of steps at most.
const POINTS: usize = 1500;
const STEPS: usize = 30;
/// A step that is shorter ends the search, mm.
const LAST_STEP: f64 = 1e-3;
/// Distances below this fraction of the tolerance weigh alike.
const ALIKE: f64 = 0.1;
/// Directions in which nothing holds the scan stay as they are by this fraction of all weights.
const DAMPED: f64 = 1e-4;
/// Below this fraction of the scan, what is off is taken for damage.
const LEAST_OFF: f64 = 0.05;
/// A movement explains a difference if it leaves less than this fraction of it.
const EXPLAINED: f64 = 0.5;
/// Nearer points have no direction to the part's surface, mm.
const TOUCHING: f64 = 1e-3;

/// How the scan lies shifted or turned, if that explains most of where it lies farther from the part than the tolerance.
///
/// # Errors
/// [`DamageError::NoSurface`], [`DamageError::Cancelled`].
pub fn moved(part: &Mesh, scan: &Mesh, settings: Settings, task: &Task) -> Result<Option<Movement>, DamageError> {
    let surface = Surface::of(part).ok_or(DamageError::NoSurface)?;
    let (low, high) = part.bounds();
    let size = (high - low).length();
    let about = low.midpoint(high);
    let points = spread(scan);
    let off = |pose: &Pose| {
        let is_off = |(p, _): &&(DVec3, DVec3)| surface.nearest(pose.of(*p)).0.abs() > settings.tolerance;
        points.par_iter().filter(is_off).count() as f64 / points.len().max(1) as f64
    };
    let mut pose = Pose { about, turn: DQuat::IDENTITY, shift: DVec3::ZERO };
    let before = off(&pose);
    if before < LEAST_OFF {
        return Ok(None);
    }
    for _ in 0..STEPS {
        task.check()?;
        let Some(step) = step(&surface, &points, &pose, size, settings.tolerance) else { break };
        let [a, b, c, d, e, f] = step;
        let (shift, turn) = (DVec3::new(a, b, c), DVec3::new(d, e, f) / size);
        pose.turn = (DQuat::from_scaled_axis(turn) * pose.turn).normalize();
        pose.shift += shift;
        if shift.length() + turn.length() * size < LAST_STEP {
            break;
        }
    }
    let left = off(&pose);
    let turn = -pose.turn.to_scaled_axis();
    let moves = pose.shift.length() + turn.length() * size / 2.0 > settings.tolerance / 2.0;
    Ok((moves && left < EXPLAINED * before).then_some(Movement { shift: -pose.shift, turn, off: before, left }))
}

/// How the scan is moved: turned about a place, then shifted, mm.
struct Pose {
    about: DVec3,
    turn: DQuat,
    shift: DVec3,
}

impl Pose {
    fn of(&self, p: DVec3) -> DVec3 {
        self.about + self.turn * (p - self.about) + self.shift
    }
}

/// Points spread evenly over a scan, each with the normal of its face.
fn spread(scan: &Mesh) -> Vec<(DVec3, DVec3)> {
    let faces = scan.triangles.iter().map(|corners| corners.map(|corner| scan.vertices[corner as usize]));
    let faces: Vec<[DVec3; 3]> = faces.collect();
    let area: f64 = faces.iter().map(|face| mouth::vector(face).length()).sum();
    let (mut points, mut passed) = (Vec::with_capacity(POINTS), 0.0);
    for face in &faces {
        let vector = mouth::vector(face);
        passed += vector.length() / area * POINTS as f64;
        while (points.len() as f64) + 0.5 < passed {
            // The sequence R2 (Roberts 2018) is even in every part of it.
            let [s, t] = [0.754_877_666, 0.569_840_291].map(|by: f64| (by * points.len() as f64).fract());
            let [s, t] = if s + t > 1.0 { [1.0 - s, 1.0 - t] } else { [s, t] };
            points.push((face[0] + (face[1] - face[0]) * s + (face[2] - face[0]) * t, vector.normalize_or_zero()));
        }
    }
    points
}

/// The next shift and turn, the turn times the part's size, so that all six are mm.
fn step(surface: &Surface, points: &[(DVec3, DVec3)], pose: &Pose, size: f64, tolerance: f64) -> Option<[f64; 6]> {
    let row = |(p, normal): &(DVec3, DVec3)| {
        let at = pose.of(*p);
        let way = at - surface.nearest(at).1;
        let normal = if way.length() > TOUCHING { way.normalize() } else { pose.turn * *normal };
        let by = way.dot(normal);
        let turned = (at - pose.about - pose.shift).cross(normal) / size;
        ([normal.x, normal.y, normal.z, turned.x, turned.y, turned.z], by, 1.0 / by.abs().max(ALIKE * tolerance))
    };
    let rows: Vec<([f64; 6], f64, f64)> = points.par_iter().map(row).collect();
    let weights: f64 = rows.iter().map(|(.., weight)| weight).sum();
    // Six equations, each with its right side last.
    let mut equations = [[0.0; 7]; 6];
    for (changes, by, weight) in &rows {
        for (equation, change) in equations.iter_mut().zip(changes) {
            let terms = changes.iter().copied().chain([-by]);
            equation.iter_mut().zip(terms).for_each(|(sum, term)| *sum += weight * change * term);
        }
    }
    for (k, equation) in equations.iter_mut().enumerate() {
        equation[k] += DAMPED * weights;
    }
    solved(equations)
}

/// Solves six equations, positive definite, by elimination.
fn solved(mut equations: [[f64; 7]; 6]) -> Option<[f64; 6]> {
    for k in 0..6 {
        let pivot = equations[k];
        for (_, equation) in equations.iter_mut().enumerate().filter(|(row, _)| *row != k) {
            let times = equation[k] / pivot[k];
            equation.iter_mut().zip(pivot).for_each(|(term, of_pivot)| *term -= times * of_pivot);
        }
    }
    let mut solution = [0.0; 6];
    for (k, equation) in equations.iter().enumerate() {
        solution[k] = equation[6] / equation[k];
    }
    solution.iter().all(|value| value.is_finite()).then_some(solution)
}
