//! Layers square to a direction: a rigid motion. Square to z through the origin they are the level layers of a part that
//! stands on a plate.

use super::At;
use glam::{DQuat, DVec3};

/// Layers square to a direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plane {
    /// The point of the first layer's underside that has the coordinates 0, mm.
    pub origin: DVec3,
    /// Unit vector along which layers follow one another.
    pub up: DVec3,
}

impl Default for Plane {
    fn default() -> Self {
        Self { origin: DVec3::ZERO, up: DVec3::Z }
    }
}

impl Plane {
    fn turn(&self) -> DQuat {
        DQuat::from_rotation_arc(DVec3::Z, self.up)
    }

    pub(super) fn coordinates(&self, p: DVec3) -> DVec3 {
        self.turn().conjugate() * (p - self.origin)
    }

    pub(super) fn at(&self, p: DVec3) -> At {
        let turn = self.turn();
        At { place: self.origin + turn * p, along: [turn * DVec3::X, turn * DVec3::Y], normal: self.up }
    }
}
