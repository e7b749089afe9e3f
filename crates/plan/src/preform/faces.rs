//! The metal over the faces of a part in its preform: the basis of a milling program.

use super::{Plate, Preform};
use bead_part::model::{Mesh, NO_NEIGHBOUR};
use glam::DVec3;
use planar::Region;
use planar::boxes::Boxes;
use rayon::prelude::*;
use serde::Serialize;

/// A face of the part: triangles that meet without a sharp edge.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Face {
    /// Area, mm².
    pub area: f64,
    /// The middle of its largest triangle, mm; z = 0 is the top of the plate.
    pub place: DVec3,
    /// Unit normal there, outwards.
    pub normal: DVec3,
    /// Metal over it along its normals, mm: least, mean over its area, and greatest.
    pub stock: [f64; 3],
}

/// Triangles that meet at a smaller angle than this belong to one face: cosine of 20°.
const SMOOTH: f64 = 0.94;
/// Metal is probed in increments of this fraction of a step, then to [`TOLERANCE`] mm.
const PROBE: f64 = 0.25;
const TOLERANCE: f64 = 1e-3;

/// Metal over each triangle of a part in its preform, along its normal from its middle, mm. There is none below the
/// saw's cut; a plate that is kept counts as far as the preform stands on it.
pub fn stock(part: &Mesh, preform: &Preform, plate: Plate) -> Vec<f64> {
    let floor = match plate {
        Plate::Sawn { cut } => cut,
        Plate::Kept { thickness } => -thickness,
    };
    // Each step is queried for many points.
    let steps: Vec<(Boxes, usize)> = preform.steps.par_iter().map(edges).collect();
    let is_metal = |p: DVec3| {
        let step = steps.get((p.z.max(0.0) / preform.step) as usize);
        p.z >= floor && step.is_some_and(|(edges, count)| edges.inside(p.truncate(), *count))
    };
    let probe = PROBE * preform.step;
    let over = |triangle: &[u32; 3]| {
        let (middle, normal) = middle_and_normal(part, triangle);
        if normal == DVec3::ZERO {
            return 0.0;
        }
        let mut far = probe;
        while is_metal(middle + far * normal) {
            far += probe;
        }
        let mut near = far - probe;
        while far - near > TOLERANCE {
            let between = near.midpoint(far);
            if is_metal(middle + between * normal) { near = between } else { far = between }
        }
        near
    };
    part.triangles.par_iter().map(over).collect()
}

/// The edges of a step, and how many there are.
fn edges(step: &Region) -> (Boxes, usize) {
    let edges: Vec<_> = step.rings().flat_map(|ring| ring.edges()).map(|(a, b)| [a, b]).collect();
    let count = edges.len();
    (Boxes::new(edges), count)
}

/// The faces of a part, the largest first; `stock` as [`stock`] gives it.
pub fn faces(part: &Mesh, stock: &[f64]) -> Vec<Face> {
    let normals: Vec<DVec3> = part.triangles.iter().map(|triangle| middle_and_normal(part, triangle).1).collect();
    let mut seen = vec![false; part.triangles.len()];
    let mut faces = Vec::new();
    for first in 0..part.triangles.len() {
        if std::mem::replace(&mut seen[first], true) {
            continue;
        }
        let (mut face, mut next) = (Vec::new(), vec![first]);
        while let Some(triangle) = next.pop() {
            face.push(triangle);
            for &other in part.neighbours[triangle].iter().filter(|other| **other != NO_NEIGHBOUR) {
                let beside = other as usize;
                if !seen[beside] && normals[triangle].dot(normals[beside]) > SMOOTH {
                    seen[beside] = true;
                    next.push(beside);
                }
            }
        }
        faces.extend(summed(part, &face, stock));
    }
    faces.sort_by(|a: &Face, b| b.area.total_cmp(&a.area));
    faces
}

/// Some triangles as one face; `None` without an area.
fn summed(part: &Mesh, triangles: &[usize], stock: &[f64]) -> Option<Face> {
    let area = |&triangle: &usize| {
        let [a, b, c] = corners(part, &part.triangles[triangle]);
        (b - a).cross(c - a).length() / 2.0
    };
    let largest = triangles.iter().max_by(|a, b| area(a).total_cmp(&area(b)))?;
    let whole: f64 = triangles.iter().map(area).sum();
    let least = triangles.iter().map(|&triangle| stock[triangle]).fold(f64::INFINITY, f64::min);
    let most = triangles.iter().map(|&triangle| stock[triangle]).fold(0.0, f64::max);
    let mean = triangles.iter().map(|triangle| area(triangle) * stock[*triangle]).sum::<f64>() / whole;
    let (place, normal) = middle_and_normal(part, &part.triangles[*largest]);
    (whole > 0.0).then_some(Face { area: whole, place, normal, stock: [least, mean, most] })
}

fn corners(part: &Mesh, triangle: &[u32; 3]) -> [DVec3; 3] {
    triangle.map(|corner| part.vertices[corner as usize])
}

/// Middle of a triangle, mm, and its unit normal; zero for a triangle without an area.
fn middle_and_normal(part: &Mesh, triangle: &[u32; 3]) -> (DVec3, DVec3) {
    let [a, b, c] = corners(part, triangle);
    ((a + b + c) / 3.0, (b - a).cross(c - a).normalize_or_zero())
}
