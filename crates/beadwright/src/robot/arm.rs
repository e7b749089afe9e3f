//! Forward and inverse kinematics of a six-axis arm: angles in ° as its maker shows them, lengths in mm.
//!
//! The closed forms are those of Brandstötter, Angerer and Hofbaur (2014), as the crate `rs-opw-kinematics` has them.
//! That crate works in metres and radians; nothing of it leaves this file.

use glam::{DQuat, DVec3};
use rs_opw_kinematics::kinematic_traits::{Kinematics, Pose};
use rs_opw_kinematics::kinematics_impl::OPWKinematics;
use rs_opw_kinematics::parallelogram::Parallelogram;
use rs_opw_kinematics::parameters::opw_kinematics::Parameters;
use std::sync::Arc;

/// Angles of the six joints, °, as the robot's maker shows them.
pub type Joints = [f64; 6];

const MM_PER_M: f64 = 1e3;
/// Poses farther out than this are not tried, mm; the library's own tolerance is smaller.
const BEYOND_MM: f64 = 0.1;

/// A place and a direction: transforms are named `base_from_tool`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    /// Origin, mm.
    pub position: DVec3,
    /// Rotation.
    pub rotation: DQuat,
}

impl Frame {
    /// `inner` is given in this frame; returns it in the frame in which this one is given.
    pub fn then(&self, inner: &Self) -> Self {
        Self { position: self.apply(inner.position), rotation: (self.rotation * inner.rotation).normalize() }
    }

    /// The inverse: `a_from_b` becomes `b_from_a`.
    pub fn inverse(&self) -> Self {
        let rotation = self.rotation.conjugate();
        Self { position: rotation * -self.position, rotation }
    }

    /// A point given in this frame, mm; returns it in the frame in which this one is given.
    pub fn apply(&self, point: DVec3) -> DVec3 {
        self.position + self.rotation * point
    }
}

/// Lengths of an arm, mm, named as in the paper.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lengths {
    /// Axis 1 forward to axis 2.
    pub a1: f64,
    /// Axis 3 to axis 4.
    pub a2: f64,
    /// Sideways.
    pub b: f64,
    /// Foot up to axis 2.
    pub c1: f64,
    /// Upper arm.
    pub c2: f64,
    /// Forearm.
    pub c3: f64,
    /// Wrist to flange.
    pub c4: f64,
}

/// One of the eight ways in which an arm reaches a pose.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Branch(u8);

impl Branch {
    /// How many there are.
    pub const COUNT: usize = 8;

    /// The branch of that number.
    pub fn new(index: usize) -> Self {
        Self((index % Self::COUNT) as u8)
    }

    /// Number, from 0.
    pub fn index(self) -> usize {
        self.0.into()
    }

    /// Words for people.
    pub fn name(self) -> String {
        let word = |bit: u8, no: &'static str, yes: &'static str| if self.0 & bit == 0 { no } else { yes };
        format!(
            "{}, {}, {}",
            word(1, "facing", "reaching backwards"),
            word(2, "elbow up", "elbow down"),
            word(4, "wrist plain", "wrist flipped")
        )
    }
}

/// How far a pose is from limits and singularities, °; negative where a limit is exceeded.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Margins {
    /// To the nearer limit of each joint.
    pub limits: [f64; 6],
    /// Of joint 5 to the angle at which axes 4 and 6 coincide.
    pub wrist: f64,
    /// Of the elbow to a straight or folded arm.
    pub elbow: f64,
}

impl Margins {
    /// The least of all.
    pub fn least(&self) -> f64 {
        self.limits.iter().copied().fold(self.wrist.min(self.elbow), f64::min)
    }

    /// The joint that is nearest to a limit or beyond, from 0, and its margin.
    pub fn nearest_limit(&self) -> (usize, f64) {
        let pairs = self.limits.iter().copied().enumerate();
        pairs.min_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or_default()
    }
}

/// An arm that can be moved.
#[derive(Clone)]
pub struct Arm {
    lengths: Lengths,
    offsets: Joints,
    signs: [i8; 6],
    parallelogram: bool,
    /// Least and greatest angle of each joint, °.
    pub limits: [[f64; 2]; 6],
    /// Greatest speed of each joint, °/s.
    pub speeds: [f64; 6],
    kinematics: Arc<dyn Kinematics>,
}

impl std::fmt::Debug for Arm {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Arm").field("lengths", &self.lengths).finish_non_exhaustive()
    }
}

impl Arm {
    /// An arm; whole turns are dropped from the offsets.
    pub fn new(
        lengths: Lengths,
        offsets: Joints,
        signs: [i8; 6],
        parallelogram: bool,
        limits: [[f64; 2]; 6],
        speeds: [f64; 6],
    ) -> Self {
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
            true => Arc::new(Parallelogram { robot: plain, scaling: 1.0, driven: 1, coupled: 2 }),
            false => plain,
        };
        Self { lengths, offsets, signs, parallelogram, limits, speeds, kinematics }
    }

    /// The flange for finite angles of the joints, °.
    pub fn forward(&self, joints: &Joints) -> Frame {
        let pose = self.kinematics.forward(&joints.map(f64::to_radians));
        Frame { position: pose.translation * MM_PER_M, rotation: pose.rotation }
    }

    /// Foot, axis 2, axis 3 and wrist for angles of the joints, °; mm from the foot.
    pub fn links(&self, joints: &Joints) -> [DVec3; 4] {
        let Lengths { a1, b, c1, c2, .. } = self.lengths;
        let [q1, q2, q3, ..] = self.model(joints);
        let upright = DQuat::from_rotation_z(q1);
        let link = |from: DVec3, length: f64, lean: f64| from + DVec3::new(lean.sin(), 0.0, lean.cos()) * length;
        let shoulder = DVec3::new(a1, b, c1);
        let elbow = link(shoulder, c2, q2);
        let wrist = link(elbow, self.forearm(), q2 + q3 + self.bend());
        [DVec3::ZERO, shoulder, elbow, wrist].map(|place| upright * place)
    }

    /// All ways to put the flange there, including those beyond a limit. Of a joint's angles that differ by whole
    /// turns, the one nearest to the middle of its range is returned.
    pub fn inverse(&self, base_from_flange: &Frame) -> Vec<(Branch, Joints)> {
        let Frame { position, rotation } = base_from_flange;
        if self.beyond(base_from_flange) > BEYOND_MM || !position.is_finite() {
            return Vec::new();
        }
        let pose = Pose::from_parts(*position / MM_PER_M, *rotation);
        let solution = |joints: [f64; 6]| {
            let mut joints = joints.map(f64::to_degrees);
            for (joint, [low, high]) in joints.iter_mut().zip(self.limits) {
                *joint = turned_near(*joint, (low + high) / 2.0);
            }
            (self.branch(&joints), joints)
        };
        self.kinematics.inverse(&pose).into_iter().map(solution).collect()
    }

    /// Distance to limits, wrist singularity and straight arm.
    pub fn margins(&self, joints: &Joints) -> Margins {
        let model = self.model(joints);
        let mut limits = [0.0; 6];
        for ((margin, joint), [low, high]) in limits.iter_mut().zip(joints).zip(self.limits) {
            *margin = (joint - low).min(high - joint);
        }
        let from_zero = |angle: f64| angle.sin().abs().min(1.0).asin().to_degrees();
        Margins { limits, wrist: from_zero(model[4]), elbow: from_zero(model[2] + self.bend()) }
    }

    /// How far the wrist lies beyond what the arm can reach, or short of it, mm; 0 where it can get there.
    pub fn beyond(&self, base_from_flange: &Frame) -> f64 {
        let Lengths { a1, b, c1, c2, c4, .. } = self.lengths;
        let wrist = base_from_flange.apply(DVec3::new(0.0, 0.0, -c4));
        let radial = (wrist.truncate().length_squared() - b * b).max(0.0).sqrt();
        let (forward, backward) = ((radial - a1).hypot(wrist.z - c1), (radial + a1).hypot(wrist.z - c1));
        let miss =
            |distance: f64| (distance - c2 - self.forearm()).max((c2 - self.forearm()).abs() - distance).max(0.0);
        miss(forward).min(miss(backward))
    }

    /// Greatest distance of the wrist from axis 2, mm.
    pub fn reach(&self) -> f64 {
        self.lengths.c2 + self.forearm()
    }

    /// Axis 3 to the wrist, mm.
    fn forearm(&self) -> f64 {
        self.lengths.a2.hypot(self.lengths.c3)
    }

    /// Angle between the forearm's axis and the line from axis 3 to the wrist, rad.
    fn bend(&self) -> f64 {
        self.lengths.a2.atan2(self.lengths.c3)
    }

    /// Angles of the model, rad: all 0 when the arm stands straight up.
    fn model(&self, joints: &Joints) -> [f64; 6] {
        let mut model = *joints;
        if self.parallelogram {
            model[2] -= model[1];
        }
        for ((angle, sign), offset) in model.iter_mut().zip(self.signs).zip(self.offsets) {
            *angle = (*angle * f64::from(sign) - offset).to_radians();
        }
        model
    }

    fn branch(&self, joints: &Joints) -> Branch {
        let Lengths { a1, c2, .. } = self.lengths;
        let [_, q2, q3, _, q5, _] = self.model(joints);
        let forward = a1 + c2 * q2.sin() + self.forearm() * (q2 + q3 + self.bend()).sin();
        let bits = [forward < 0.0, (q3 + self.bend()).sin() < 0.0, q5.sin() < 0.0];
        Branch(bits.iter().enumerate().map(|(i, &bit)| u8::from(bit) << i).sum())
    }
}

/// `angle` plus the whole turns that bring it nearest to `near`, °.
pub(super) fn turned_near(angle: f64, near: f64) -> f64 {
    angle - ((angle - near) / 360.0).round() * 360.0
}
