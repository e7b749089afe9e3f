//! A single triangle of a mesh: its distance from a point, its normal and angles.

use super::Mesh;
use glam::DVec3;
use rstar::{AABB, PointDistance, RTreeObject};
use std::f64::consts::{PI, TAU};

/// Points nearer to each other than this are one, mm.
pub(crate) const SAME_MM: f64 = 1e-6;

/// A triangle, wound counter-clockwise seen from outside.
pub(crate) struct Triangle {
    pub(crate) corners: [DVec3; 3],
}

impl Triangle {
    /// A triangle of a mesh.
    pub(crate) fn of(mesh: &Mesh, triangle: usize) -> Self {
        Self { corners: mesh.triangles[triangle].map(|corner| mesh.vertices[corner as usize]) }
    }

    pub(crate) fn middle(&self) -> DVec3 {
        self.corners.into_iter().sum::<DVec3>() / 3.0
    }

    fn edges(&self) -> [[DVec3; 2]; 3] {
        let [a, b, c] = self.corners;
        [[a, b], [b, c], [c, a]]
    }

    /// The outward normal; its length is twice the area, mm².
    pub(crate) fn normal(&self) -> DVec3 {
        let [a, b, c] = self.corners;
        (b - a).cross(c - a)
    }

    /// The solid angle it subtends from a point, sr; positive where its back is seen (Van Oosterom and Strackee 1983).
    pub(crate) fn solid_angle(&self, from: DVec3) -> f64 {
        let [a, b, c] = self.corners.map(|corner| corner - from);
        let [x, y, z] = [a, b, c].map(DVec3::length);
        2.0 * a.dot(b.cross(c)).atan2(x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y)
    }

    /// The point of the triangle nearest to a point.
    pub(crate) fn closest(&self, point: DVec3) -> DVec3 {
        let (normal, edges) = (self.normal(), self.edges());
        if edges.iter().all(|[a, b]| normal.dot((b - a).cross(point - a)) >= 0.0) {
            return point - normal * (normal.dot(point - self.corners[0]) / normal.length_squared());
        }
        let [first, others @ ..] = edges.map(|edge| on_edge(edge, point));
        others.into_iter().fold(first, |best, place| {
            if place.distance_squared(point) < best.distance_squared(point) { place } else { best }
        })
    }

    /// The triangle's angle at one of its points, rad: a full turn inside, half a turn on an edge.
    pub(crate) fn angle_at(&self, spot: DVec3) -> f64 {
        let [a, b, c] = self.corners;
        let corner = [[a, b, c], [b, c, a], [c, a, b]].into_iter().find(|[at, ..]| at.distance(spot) < SAME_MM);
        match corner {
            Some([at, next, last]) => (next - at).angle_between(last - at),
            None if self.edges().iter().any(|edge| on_edge(*edge, spot).distance(spot) < SAME_MM) => PI,
            None => TAU,
        }
    }
}

/// The point of an edge nearest to a point.
fn on_edge([from, to]: [DVec3; 2], point: DVec3) -> DVec3 {
    let along = to - from;
    let part = (point - from).dot(along) / along.length_squared();
    if part.is_finite() { from + along * part.clamp(0.0, 1.0) } else { from }
}

impl RTreeObject for Triangle {
    type Envelope = AABB<[f64; 3]>;

    fn envelope(&self) -> Self::Envelope {
        let [a, b, c] = self.corners;
        AABB::from_corners(a.min(b).min(c).to_array(), a.max(b).max(c).to_array())
    }
}

impl PointDistance for Triangle {
    fn distance_2(&self, point: &[f64; 3]) -> f64 {
        let point = DVec3::from_array(*point);
        self.closest(point).distance_squared(point)
    }
}
