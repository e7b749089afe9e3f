//! Rotations about one axis: the angle that brings a vector onto another, or to a given height. Angles in rad.

use glam::{DQuat, DVec3};

/// A height may exceed the reach of a turn by this fraction of its amplitude: the turn then ends at its crest.
const ROUNDING: f64 = 1e-12;

/// `vector` turned about a unit axis.
pub(super) fn turned(axis: DVec3, angle: f64, vector: DVec3) -> DVec3 {
    DQuat::from_axis_angle(axis, angle) * vector
}

/// The component of a vector perpendicular to a unit axis.
pub(super) fn across(axis: DVec3, vector: DVec3) -> DVec3 {
    vector - axis * axis.dot(vector)
}

/// The turn about `axis` that brings `from` into the half plane of `to`.
pub(super) fn turn_onto(axis: DVec3, from: DVec3, to: DVec3) -> f64 {
    let (from, to) = (across(axis, from), across(axis, to));
    axis.dot(from.cross(to)).atan2(from.dot(to))
}

/// The height of a rotating vector along a direction: `amplitude` · cos(angle − `crest`), and its required value.
pub(super) struct Wave {
    amplitude: f64,
    crest: f64,
    height: f64,
}

impl Wave {
    /// `vector` turns about `axis` until its height along `direction` is `height`.
    pub(super) fn new(axis: DVec3, vector: DVec3, direction: DVec3, height: f64) -> Self {
        let (cosine, sine) = (direction.dot(across(axis, vector)), direction.dot(axis.cross(vector)));
        let height = height - axis.dot(vector) * axis.dot(direction);
        Self { amplitude: cosine.hypot(sine), crest: sine.atan2(cosine), height }
    }

    /// Amount by which the required height is out of reach.
    pub(super) fn excess(&self) -> f64 {
        (self.height.abs() - self.amplitude).max(0.0)
    }

    /// The two angles that reach the height; empty if it cannot be reached.
    pub(super) fn angles(&self) -> Vec<f64> {
        if self.height.abs() <= self.amplitude * (1.0 + ROUNDING) {
            let beside = (self.height / self.amplitude.max(f64::MIN_POSITIVE)).clamp(-1.0, 1.0).acos();
            vec![self.crest + beside, self.crest - beside]
        } else {
            Vec::new()
        }
    }
}
