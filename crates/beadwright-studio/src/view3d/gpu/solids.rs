//! What is around the part, as triangles: the plate below it, the torch, the arm.

use super::chunks::Point;
use super::globals::role;
use crate::view3d::lie::Stance;
use crate::view3d::style::{Plate, Style};
use glam::{DVec3, Vec3};

/// Number of sides of round bodies.
const SIDES: usize = 36;

/// Number of steps from the side of a round end to its tip.
const ROUND: usize = 8;

/// The top of the plate lies this far below the part, mm, so that the grid is seen on it.
pub(in crate::view3d) const BELOW: f32 = 0.05;

/// Everything that a style shows around the part.
pub(super) fn solids(style: &Style) -> Vec<Point> {
    let mut points = Vec::new();
    style.plate.iter().for_each(|place| plate(&mut points, place));
    style.torch.iter().for_each(|stance| torch(&mut points, stance));
    for link in &style.arm {
        capsule(&mut points, link.ends, link.radius);
    }
    points
}

/// The plate: a box below z = 0.
fn plate(points: &mut Vec<Point>, Plate { low, high, thickness }: &Plate) {
    let (low, high) = (low.as_vec2().extend(-*thickness as f32 - BELOW), high.as_vec2().extend(-BELOW));
    let corner =
        |i: usize| Vec3::from_array([0, 1, 2].map(|axis| if i >> axis & 1 == 0 { low[axis] } else { high[axis] }));
    for [a, b, c, d] in [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]] {
        let side = [a, b, c, a, c, d].map(corner);
        points.extend(side.map(|at| Point { at: at.into(), role: role::PLATE }));
    }
}

/// A torch with its tip at a given place.
fn torch(points: &mut Vec<Point>, stance: &Stance) {
    /// Height above the tip and radius, mm: the wire, the gas nozzle, the neck.
    const PROFILE: [(f32, f32, u32); 6] = [
        (0.0, 0.6, role::NOZZLE),
        (12.0, 0.6, role::NOZZLE),
        (12.0, 7.0, role::NOZZLE),
        (30.0, 9.5, role::TORCH),
        (75.0, 9.5, role::TORCH),
        (75.0, 0.0, role::TORCH),
    ];
    revolved(points, stance.at.as_vec3(), stance.up.as_vec3(), &PROFILE);
}

/// A line with a thickness and round ends.
fn capsule(points: &mut Vec<Point>, ends: [DVec3; 2], radius: f64) {
    let [from, to] = ends.map(|end| end.as_vec3());
    let (length, radius) = (from.distance(to), radius as f32);
    let axis = (to - from).try_normalize().unwrap_or(Vec3::Z);
    let end = |k: usize| (k as f32 / ROUND as f32 * std::f32::consts::FRAC_PI_2).sin_cos();
    let first = (0..=ROUND).map(end).map(|(sin, cos)| (-radius * cos, radius * sin, role::ARM));
    let last = (0..=ROUND).rev().map(end).map(|(sin, cos)| (length + radius * cos, radius * sin, role::ARM));
    revolved(points, from, axis, &first.chain(last).collect::<Vec<_>>());
}

/// A body of revolution about an axis of length 1; `profile` gives distances along the axis and from it, mm, and the
/// role up to the next ring.
fn revolved(points: &mut Vec<Point>, from: Vec3, axis: Vec3, profile: &[(f32, f32, u32)]) {
    let (i, j) = axis.any_orthonormal_pair();
    let at = |side: usize, (along, radius, _): (f32, f32, u32)| {
        let (sin, cos) = (side as f32 * std::f32::consts::TAU / SIDES as f32).sin_cos();
        from + axis * along + (i * cos + j * sin) * radius
    };
    for rings in profile.windows(2) {
        let [lower, upper] = [rings[0], rings[1]];
        for side in 0..SIDES {
            let [a, b, c, d] = [at(side, lower), at(side + 1, lower), at(side, upper), at(side + 1, upper)];
            points.extend([a, b, c, b, d, c].map(|v| Point { at: v.into(), role: lower.2 }));
        }
    }
}
