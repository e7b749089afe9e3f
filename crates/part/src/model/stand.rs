//! The flat faces on which a part can stand, and how much of it then overhangs.

use super::Mesh;
use glam::DVec3;
use std::cmp::Reverse;
use std::collections::HashMap;

/// Normals whose difference is shorter than this belong to one face.
const SAME_NORMAL: f64 = 1e-3;

/// Areas that differ by less than this, in squared extents of the part, are equal.
const SAME_AREA: f64 = 1e-6;

/// The part stands on a face if no point is farther below the face than this, in extents of the part.
const STANDING: f64 = 1e-3;

/// Number of faces examined, largest first.
const CANDIDATES: usize = 64;

/// Outward normals of the flat faces with the whole part on one side, largest first.
pub fn faces(mesh: &Mesh) -> impl Iterator<Item = DVec3> + '_ {
    let extent = mesh.size().max_element();
    let mut faces: HashMap<[i64; 4], (f64, DVec3, f64)> = HashMap::new();
    for corners in &mesh.triangles {
        let (a, doubled) = across(mesh, corners);
        let Some(normal) = doubled.try_normalize() else { continue };
        let height = normal.dot(a);
        let key =
            [normal.x / SAME_NORMAL, normal.y / SAME_NORMAL, normal.z / SAME_NORMAL, height / (STANDING * extent)];
        let face = faces.entry(key.map(|v| v.round() as i64)).or_insert((0.0, normal, height));
        face.0 += doubled.length() / 2.0;
    }
    let mut faces: Vec<_> = faces.into_iter().collect();
    // Faces of equal size are put in a fixed order that rounding, for example after a shift, does not change.
    let size = |area: f64| (area / (SAME_AREA * extent * extent)).round() as i64;
    faces.sort_by_key(|&([x, y, z, height], (area, ..))| (Reverse(size(area)), z, y, x, height));
    let stands = move |&(_, normal, height): &(f64, DVec3, f64)| {
        mesh.vertices.iter().all(|v| normal.dot(*v) <= height + STANDING * extent)
    };
    faces.into_iter().map(|(_, face)| face).take(CANDIDATES).filter(stands).map(|face| face.1)
}

/// Cosine of the slope from which a face that points down counts as overhanging: 45°.
const STEEP: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// Overhangs that differ by less than this fraction of the surface are equal.
const ALIKE: f64 = 0.01;

/// The face to stand on with the least overhang; if several are equal, the one with the lowest part.
pub(super) fn least_overhang(mesh: &Mesh) -> Option<DVec3> {
    let surface: f64 = mesh.triangles.iter().map(|corners| across(mesh, corners).1.length() / 2.0).sum();
    let judged = faces(mesh).map(|down| (overhang(mesh, down), extent_along(mesh, down), down));
    judged
        .reduce(|best, next| {
            let less = next.0 < best.0 - ALIKE * surface;
            let lower = next.0 < best.0 + ALIKE * surface && next.1 < 0.999 * best.1;
            if less || lower { next } else { best }
        })
        .map(|(.., down)| down)
}

/// Area (mm²) that overhangs by more than 45° if `down` points down; what lies on the plate does not count.
pub fn overhang(mesh: &Mesh, down: DVec3) -> f64 {
    let plate = mesh.vertices.iter().map(|v| down.dot(*v)).fold(f64::NEG_INFINITY, f64::max);
    let off = STANDING * mesh.size().max_element();
    let hangs = |corners: &&[u32; 3]| {
        let (corner, doubled) = across(mesh, corners);
        doubled.normalize_or_zero().dot(down) > STEEP && down.dot(corner) < plate - off
    };
    mesh.triangles.iter().filter(hangs).map(|corners| across(mesh, corners).1.length() / 2.0).sum()
}

fn extent_along(mesh: &Mesh, down: DVec3) -> f64 {
    let heights = mesh.vertices.iter().map(|v| down.dot(*v));
    let (low, high) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), h| (low.min(h), high.max(h)));
    high - low
}

/// A corner of a triangle, and its normal, of twice its area in length.
fn across(mesh: &Mesh, corners: &[u32; 3]) -> (DVec3, DVec3) {
    let [a, b, c] = corners.map(|i| mesh.vertices[i as usize]);
    (a, (b - a).cross(c - a))
}
