//! Which face of the model is seen along a line of sight.

use beadwright::model::Mesh;
use glam::DVec3;

/// The outward normal of the nearest face of a mesh on a ray; `None` if the ray misses.
pub fn face(mesh: &Mesh, (origin, way): (DVec3, DVec3)) -> Option<DVec3> {
    let hits = mesh.triangles.iter().filter_map(|triangle| {
        let [a, b, c] = triangle.map(|i| mesh.vertices.get(i as usize).copied().unwrap_or_default());
        let normal = (b - a).cross(c - a).try_normalize()?;
        Some((meets([a, b, c], origin, way)?, normal))
    });
    hits.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, normal)| normal)
}

/// The multiple of `way` at which a ray meets a triangle (Möller and Trumbore 1997).
fn meets([a, b, c]: [DVec3; 3], origin: DVec3, way: DVec3) -> Option<f64> {
    let (ab, ac, from_a) = (b - a, c - a, origin - a);
    let (across, turned) = (way.cross(ac), from_a.cross(ab));
    let volume = ab.dot(across);
    if volume.abs() < 1e-12 {
        return None;
    }
    let (v, w, t) = (from_a.dot(across) / volume, way.dot(turned) / volume, ac.dot(turned) / volume);
    (v >= 0.0 && w >= 0.0 && v + w <= 1.0 && t > 0.0).then_some(t)
}
