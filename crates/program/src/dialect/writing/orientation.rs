//! The tool's orientation turned about the torch's own axis and leaning with it, as each robot writes it.
//!
//! The tool's z axis runs along the wire, out of the torch. A positive torch angle turns counter-clockwise as seen from
//! behind the torch, with z pointing away from the viewer: for a torch pointing straight down that is counter-clockwise
//! seen from above, as in `robot`. Without a turn, the numbers of the profile are unchanged, to the last digit.

use crate::program::Attitude;
use glam::{DMat3, DQuat, DVec3, EulerRot};

/// A rotation of the tool.
#[derive(Debug, Clone, Copy)]
pub(in crate::dialect) enum Turn {
    /// About the torch's own axis, °.
    Torch(f64),
    /// As required by a move.
    Attitude(Attitude),
    /// About the axes of the frame.
    By(DQuat),
}

impl Turn {
    fn is_none(self) -> bool {
        match self {
            Self::Torch(angle) => angle == 0.0,
            Self::Attitude(attitude) => attitude.is_upright(),
            Self::By(rotation) => rotation == DQuat::IDENTITY,
        }
    }

    fn of(self, orientation: DQuat) -> DQuat {
        let turned = match self {
            Self::Torch(angle) => orientation * DQuat::from_rotation_z(-angle.to_radians()),
            Self::Attitude(attitude) => attitude.rotation() * orientation,
            Self::By(rotation) => rotation * orientation,
        };
        turned.normalize()
    }
}

/// Euler angles A, B, C (°) about z, the new y and the new x, turned.
pub(in crate::dialect) fn zyx(angles: [f64; 3], turn: Turn) -> [f64; 3] {
    if turn.is_none() {
        return angles;
    }
    let [a, b, c] = angles.map(f64::to_radians);
    euler(&DMat3::from_quat(turn.of(DQuat::from_euler(EulerRot::ZYX, a, b, c))))
}

/// The same angles in the order of FANUC (W, P, R) and Yaskawa (Rx, Ry, Rz).
pub(in crate::dialect) fn xyz([x, y, z]: [f64; 3], turn: Turn) -> [f64; 3] {
    let [z, y, x] = zyx([z, y, x], turn);
    [x, y, z]
}

/// A quaternion w, x, y, z, turned.
pub(in crate::dialect) fn quaternion([w, x, y, z]: [f64; 4], turn: Turn) -> [f64; 4] {
    if turn.is_none() {
        return [w, x, y, z];
    }
    let q = turn.of(DQuat::from_xyzw(x, y, z, w).normalize());
    [q.w, q.x, q.y, q.z]
}

/// A rotation vector (rad), turned.
pub(in crate::dialect) fn vector(vector: [f64; 3], turn: Turn) -> [f64; 3] {
    if turn.is_none() {
        return vector;
    }
    let q = turn.of(DQuat::from_scaled_axis(DVec3::from(vector)));
    // The shorter of the two ways round.
    let q = if q.w < 0.0 { -q } else { q };
    q.to_scaled_axis().to_array()
}

/// A, B, C of a rotation, °. Where B is ±90°, A and C turn about one axis, and A is 0.
fn euler(m: &DMat3) -> [f64; 3] {
    let level = m.x_axis.x.hypot(m.x_axis.y);
    let b = (-m.x_axis.z).atan2(level);
    let (a, c) = if level > 1e-9 {
        (m.x_axis.y.atan2(m.x_axis.x), m.y_axis.z.atan2(m.z_axis.z))
    } else {
        (0.0, (-m.z_axis.y).atan2(m.y_axis.y))
    };
    // A value that rounds to -180° becomes 180°.
    let degrees = |v: f64| if v.to_degrees() < -179.999_95 { v.to_degrees() + 360.0 } else { v.to_degrees() };
    [a, b, c].map(degrees)
}

#[cfg(test)]
mod tests {
    use super::{Turn, quaternion, vector, xyz, zyx};
    use std::f64::consts::PI;

    fn near<const N: usize>(a: [f64; N], b: [f64; N]) {
        assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-9), "{a:?} is not {b:?}");
    }

    #[test]
    fn a_torch_straight_down_turns_about_the_vertical() {
        near(zyx([0.0, 0.0, 180.0], Turn::Torch(100.0)), [100.0, 0.0, 180.0]);
        near(zyx([30.0, 0.0, 180.0], Turn::Torch(100.0)), [130.0, 0.0, 180.0]);
        near(xyz([180.0, 0.0, 0.0], Turn::Torch(-90.0)), [180.0, 0.0, -90.0]);
        let half = 0.5_f64.sqrt();
        near(quaternion([0.0, 1.0, 0.0, 0.0], Turn::Torch(90.0)), [0.0, half, half, 0.0]);
        near(vector([PI, 0.0, 0.0], Turn::Torch(90.0)).map(|v| v.abs()), [PI * half, PI * half, 0.0]);
    }

    #[test]
    fn a_level_torch_turns_about_itself() {
        // z lies along the part's x before and after.
        near(zyx([0.0, 90.0, 0.0], Turn::Torch(40.0)), [-90.0, 50.0, -90.0]);
        // A whole turn is no turn; at B = 90 A and C are one turn.
        near(zyx([25.0, 90.0, 40.0], Turn::Torch(360.0)), [0.0, 90.0, 15.0]);
        near(zyx([10.0, 20.0, 30.0], Turn::Torch(360.0)), [10.0, 20.0, 30.0]);
        near(vector([0.1, 0.2, 0.3], Turn::Torch(-360.0)), [0.1, 0.2, 0.3]);
    }
}
