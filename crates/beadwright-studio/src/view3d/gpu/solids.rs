//! What is around the part, as triangles: the plate below it, the torch, robot, positioner and table.

use super::chunks::Point;
use super::globals::role;
use crate::view3d::lie::Stance;
use crate::view3d::shape::{Look, Shape};
use crate::view3d::style::{Plate, Style};
use glam::Vec3;

/// Number of sides of round bodies.
const SIDES: usize = 64;

/// The top of the plate lies this far below the part, mm, so that the grid is seen on it.
pub(crate) const BELOW: f32 = 0.05;

/// Everything that a style shows around the part.
pub(super) fn solids(style: &Style) -> Vec<Point> {
    let mut points = Vec::new();
    style.plate.iter().for_each(|place| plate(&mut points, place));
    style.torch.iter().for_each(|stance| torch(&mut points, stance));
    style.around.iter().for_each(|body| shape(&mut points, body));
    points
}

/// The plate: a box below z = 0.
fn plate(points: &mut Vec<Point>, Plate { low, high, thickness }: &Plate) {
    let (low, high) = (low.as_vec2().extend(-*thickness as f32 - BELOW), high.as_vec2().extend(-BELOW));
    block(points, role::PLATE, |axes| low + (high - low) * Vec3::from(axes));
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

/// What stands around the part.
fn shape(points: &mut Vec<Point>, shape: &Shape) {
    let role = |look: &Look| match look {
        Look::Link => role::LINK,
        Look::Joint => role::JOINT,
        Look::Torch => role::TORCH,
        Look::Table => role::TABLE,
    };
    match shape {
        Shape::Turned { from, axis, rings, look } => {
            let ring = |[along, radius]: &[f64; 2]| (*along as f32, *radius as f32, role(look));
            revolved(points, from.as_vec3(), axis.as_vec3(), &rings.iter().map(ring).collect::<Vec<_>>());
        }
        Shape::Block { corner, edges, look } => {
            let (corner, edges) = (corner.as_vec3(), edges.map(|edge| edge.as_vec3()));
            block(points, role(look), |axes| corner + (0..3).map(|k| edges[k] * axes[k]).sum::<Vec3>());
        }
    }
}

/// The six sides of a box; `corner` has its corners by shares of its edges, 0 or 1.
fn block(points: &mut Vec<Point>, role: u32, corner: impl Fn([f32; 3]) -> Vec3) {
    let corner = |i: usize| corner([0, 1, 2].map(|axis| (i >> axis & 1) as f32));
    for [a, b, c, d] in [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]] {
        points.extend([a, b, c, a, c, d].map(corner).map(|at| Point { at: at.into(), role }));
    }
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
