//! Arms with a spherical wrist, given by six lengths.
//!
//! The closed forms are those of Brandstötter, Angerer and Hofbaur (2014), as implemented in the crate
//! `rs-opw-kinematics`. That crate works in metres and radians, which stay within this file.

use crate::arm::{Axis, Branch, Frame, Joints, Model, from_zero};
use glam::{DQuat, DVec3};
use rs_opw_kinematics::kinematic_traits::{Kinematics, Pose};
use rs_opw_kinematics::kinematics_impl::OPWKinematics;
use rs_opw_kinematics::parallelogram::Parallelogram;
use rs_opw_kinematics::parameters::opw_kinematics::Parameters;
use std::sync::Arc;

const MM_PER_M: f64 = 1e3;
/// Poses farther out of reach than this are not tried, mm; the library's own tolerance is smaller.
const BEYOND_MM: f64 = 0.1;

/// Lengths of an arm, mm, named as in the paper.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Lengths {
    /// From axis 1 forward to axis 2.
    pub(crate) a1: f64,
    /// From axis 3 to axis 4.
    pub(crate) a2: f64,
    /// Sideways offset of the arm.
    pub(crate) b: f64,
    /// From the foot up to axis 2.
    pub(crate) c1: f64,
    /// Upper arm.
    pub(crate) c2: f64,
    /// Forearm.
    pub(crate) c3: f64,
    /// From the wrist to the flange.
    pub(crate) c4: f64,
}

/// A six-axis arm with parallel base and spherical wrist.
pub(crate) struct Opw {
    lengths: Lengths,
    offsets: Joints,
    signs: [i8; 6],
    parallelogram: bool,
    kinematics: Arc<dyn Kinematics>,
}

impl std::fmt::Debug for Opw {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Opw").field("lengths", &self.lengths).finish_non_exhaustive()
    }
}

/// Change of a parallelogram arm's displayed joint 3 per degree of joint 2, which makes it the forearm's angle to the
/// floor.
fn coupling(signs: [i8; 6]) -> f64 {
    f64::from(signs[1] * signs[2])
}

impl Opw {
    /// An arm with these offsets, °; whole turns are dropped from them.
    pub(crate) fn new(lengths: Lengths, offsets: Joints, signs: [i8; 6], parallelogram: bool) -> Self {
        let offsets = offsets.map(|v| if v.is_finite() { v % 360.0 } else { 0.0 });
        let m = |mm: f64| mm / MM_PER_M;
        let parameters = Parameters {
            a1: m(lengths.a1),
            a2: m(lengths.a2),
            b: m(lengths.b),
            c1: m(lengths.c1),
            c2: m(lengths.c2),
            c3: m(lengths.c3),
            c4: m(lengths.c4),
            offsets: offsets.map(f64::to_radians),
            sign_corrections: signs,
            dof: 6,
        };
        let plain = Arc::new(OPWKinematics::new(parameters));
        let kinematics: Arc<dyn Kinematics> = match parallelogram {
            true => Arc::new(Parallelogram { robot: plain, scaling: coupling(signs), driven: 1, coupled: 2 }),
            false => plain,
        };
        Self { lengths, offsets, signs, parallelogram, kinematics }
    }

    /// Distance from axis 3 to the wrist, mm.
    fn forearm(&self) -> f64 {
        self.lengths.a2.hypot(self.lengths.c3)
    }

    /// Angle between the forearm's axis and the line from axis 3 to the wrist, rad.
    fn bend(&self) -> f64 {
        self.lengths.a2.atan2(self.lengths.c3)
    }

    /// Angles of the model, rad: all 0 when the arm points straight up.
    fn model(&self, joints: &Joints) -> [f64; 6] {
        let mut model = *joints;
        if self.parallelogram {
            model[2] -= coupling(self.signs) * model[1];
        }
        for ((angle, sign), offset) in model.iter_mut().zip(self.signs).zip(self.offsets) {
            *angle = (*angle * f64::from(sign) - offset).to_radians();
        }
        model
    }
}

impl Model for Opw {
    fn forward(&self, joints: &Joints) -> Frame {
        let pose = self.kinematics.forward(&joints.map(f64::to_radians));
        Frame { position: pose.translation * MM_PER_M, rotation: pose.rotation }
    }

    fn inverse(&self, base_from_flange: &Frame) -> Vec<Joints> {
        let Frame { position, rotation } = base_from_flange;
        if self.beyond(base_from_flange) > BEYOND_MM || !position.is_finite() {
            return Vec::new();
        }
        let pose = Pose::from_parts(*position / MM_PER_M, *rotation);
        self.kinematics.inverse(&pose).into_iter().map(|joints| joints.map(f64::to_degrees)).collect()
    }

    fn links(&self, joints: &Joints) -> [DVec3; 4] {
        let Lengths { a1, b, c1, c2, .. } = self.lengths;
        let [q1, q2, q3, ..] = self.model(joints);
        let upright = DQuat::from_rotation_z(q1);
        let link = |from: DVec3, length: f64, lean: f64| from + DVec3::new(lean.sin(), 0.0, lean.cos()) * length;
        let shoulder = DVec3::new(a1, b, c1);
        let elbow = link(shoulder, c2, q2);
        let wrist = link(elbow, self.forearm(), q2 + q3 + self.bend());
        [DVec3::ZERO, shoulder, elbow, wrist].map(|place| upright * place)
    }

    fn axes(&self, joints: &Joints) -> [Axis; 6] {
        let [q1, q2, q3, q4, q5, _] = self.model(joints);
        let [foot, shoulder, elbow, wrist] = self.links(joints);
        let upright = DQuat::from_rotation_z(q1);
        let forearm = upright * DQuat::from_rotation_y(q2 + q3);
        let hand = forearm * DQuat::from_rotation_z(q4);
        let six = hand * DQuat::from_rotation_y(q5) * DVec3::Z;
        let side = upright * DVec3::Y;
        let lines = [
            (foot, DVec3::Z),
            (shoulder, side),
            (elbow, side),
            (wrist, forearm * DVec3::Z),
            (wrist, hand * DVec3::Y),
            (wrist, six),
        ];
        lines.map(|(at, along)| Axis { at, along })
    }

    fn branch(&self, joints: &Joints) -> Branch {
        let Lengths { a1, c2, .. } = self.lengths;
        let [_, q2, q3, _, q5, _] = self.model(joints);
        let forward = a1 + c2 * q2.sin() + self.forearm() * (q2 + q3 + self.bend()).sin();
        Branch::of([forward < 0.0, (q3 + self.bend()).sin() < 0.0, q5.sin() < 0.0])
    }

    fn singular_margins(&self, joints: &Joints) -> [f64; 2] {
        let [_, _, q3, _, q5, _] = self.model(joints);
        [q5, q3 + self.bend()].map(|angle| from_zero(angle.sin()))
    }

    fn beyond(&self, base_from_flange: &Frame) -> f64 {
        let Lengths { a1, b, c1, c2, c4, .. } = self.lengths;
        let wrist = base_from_flange.apply(DVec3::new(0.0, 0.0, -c4));
        let radial = (wrist.truncate().length_squared() - b * b).max(0.0).sqrt();
        let (forward, backward) = ((radial - a1).hypot(wrist.z - c1), (radial + a1).hypot(wrist.z - c1));
        let miss =
            |distance: f64| (distance - c2 - self.forearm()).max((c2 - self.forearm()).abs() - distance).max(0.0);
        miss(forward).min(miss(backward))
    }

    fn reach(&self) -> f64 {
        self.lengths.c2 + self.forearm()
    }
}
