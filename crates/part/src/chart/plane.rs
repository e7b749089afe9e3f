//! Layers square to a direction: a rigid motion. Square to z through the origin they are the level layers of a part
//! standing on a plate.

use super::At;
use crate::model::{Mesh, cut};
use glam::{DQuat, DVec3};
use serde::{Deserialize, Serialize};

/// Layers square to a direction. In files it is text, as people write it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Plane {
    /// The point on the underside of the first layer that has coordinates 0, mm.
    pub origin: DVec3,
    /// Unit vector along which layers are stacked.
    pub up: DVec3,
}

/// Faces this close above a plane count as lying in it, mm: what only touches the plane leaves nothing.
const IN_IT: f64 = 1e-4;

impl Default for Plane {
    fn default() -> Self {
        Self { origin: DVec3::ZERO, up: DVec3::Z }
    }
}

impl Plane {
    fn turn(&self) -> DQuat {
        DQuat::from_rotation_arc(DVec3::Z, self.up)
    }

    /// Rounded to 0.001 mm and to 1e-6 in direction, so that its text is short.
    pub(crate) fn rounded(self) -> Self {
        let to = |v: DVec3, places: f64| (v * places).round() / places + DVec3::ZERO;
        Self { origin: to(self.origin, 1e3), up: to(self.up, 1e6) }
    }

    /// The part of a mesh above the plane, closed by a flat face; empty if all of it lies below.
    ///
    /// ```
    /// use bead_part::{chart::Plane, example};
    ///
    /// // A cross 20 mm high, cut by a plane that leans by 45 degrees through its middle: half of it is left.
    /// let cross = example::find("cross").ok_or("no such example")?.mesh();
    /// let half: Plane = "up=1/0/1,through=0/0/10".parse()?;
    /// assert!((half.above(&cross).volume() / cross.volume() - 0.5).abs() < 1e-5);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn above(&self, mesh: &Mesh) -> Mesh {
        let mut own = mesh.clone();
        own.vertices.iter_mut().for_each(|p| *p = self.coordinates(*p));
        if own.bounds().0.z < 0.0 {
            own = cut::above(&own, IN_IT).map_or_else(Mesh::default, |(above, _)| above);
            let lifted = own.vertices.iter_mut().filter(|p| p.z > 0.0);
            lifted.for_each(|p| p.z += IN_IT);
        }
        own.vertices.iter_mut().for_each(|p| *p = self.at(*p).place);
        own
    }

    /// The coordinates of a point in space: two along the plane, and its height above it, mm.
    pub fn coordinates(&self, p: DVec3) -> DVec3 {
        self.turn().conjugate() * (p - self.origin)
    }

    pub(super) fn at(&self, p: DVec3) -> At {
        let turn = self.turn();
        At { place: self.origin + turn * p, along: [turn * DVec3::X, turn * DVec3::Y], normal: self.up }
    }
}
