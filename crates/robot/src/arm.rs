//! An arm that can be moved, whatever its geometry: joint angles in ° as its maker's controller displays them, lengths
//! in mm.

use glam::{DQuat, DVec3, EulerRot};
use std::sync::Arc;

/// Angles of the six joints, °, as the maker's controller displays them.
pub type Joints = [f64; 6];

/// A position and a rotation: transforms are named `base_from_tool`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    /// Origin, mm.
    pub position: DVec3,
    /// Rotation.
    pub rotation: DQuat,
}

impl Frame {
    /// The frame in which it is given.
    pub const IDENTITY: Self = Self { position: DVec3::ZERO, rotation: DQuat::IDENTITY };

    /// The frame with this origin, mm, and these turns about z, the new y and the new x, °.
    ///
    /// ```
    /// use bead_robot::Frame;
    /// use glam::DVec3;
    ///
    /// // A quarter of a turn about z, then one about the new x: z points along the old x.
    /// let frame = Frame::from_zyx([10.0, 0.0, 0.0], [90.0, 0.0, 90.0]);
    /// assert!(frame.apply(DVec3::Z).distance(DVec3::new(11.0, 0.0, 0.0)) < 1e-12);
    /// assert!(DVec3::from(frame.zyx()).distance(DVec3::new(90.0, 0.0, 90.0)) < 1e-9);
    /// ```
    pub fn from_zyx(position: [f64; 3], turns: [f64; 3]) -> Self {
        let [z, y, x] = turns.map(f64::to_radians);
        Self { position: position.into(), rotation: DQuat::from_euler(EulerRot::ZYX, z, y, x) }
    }

    /// Its turns about z, the new y and the new x, °.
    pub fn zyx(&self) -> [f64; 3] {
        let (z, y, x) = self.rotation.to_euler(EulerRot::ZYX);
        [z, y, x].map(f64::to_degrees)
    }

    /// `inner` is given in this frame; returns it in this frame's own reference frame.
    pub fn then(&self, inner: &Self) -> Self {
        Self { position: self.apply(inner.position), rotation: (self.rotation * inner.rotation).normalize() }
    }

    /// The inverse: `a_from_b` becomes `b_from_a`.
    ///
    /// ```
    /// use bead_robot::Frame;
    /// use glam::{DQuat, DVec3};
    ///
    /// let frame = Frame { position: DVec3::new(100.0, 20.0, 3.0), rotation: DQuat::from_rotation_z(0.7) };
    /// let point = DVec3::new(1.0, 2.0, 3.0);
    /// assert!(frame.inverse().apply(frame.apply(point)).distance(point) < 1e-9);
    /// ```
    pub fn inverse(&self) -> Self {
        let rotation = self.rotation.conjugate();
        Self { position: rotation * -self.position, rotation }
    }

    /// A point given in this frame, mm; returns it in this frame's own reference frame.
    pub fn apply(&self, point: DVec3) -> DVec3 {
        self.position + self.rotation * point
    }
}

/// The line about which a joint turns.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Axis {
    /// A point on it, mm.
    pub at: DVec3,
    /// Its direction, of length 1; which of the two is left open.
    pub along: DVec3,
}

impl Axis {
    /// The point on it nearest to a place, mm.
    pub fn nearest(&self, place: DVec3) -> DVec3 {
        self.at + self.along * (place - self.at).dot(self.along)
    }
}

/// One of the eight ways in which an arm reaches a pose.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Branch(u8);

impl Branch {
    /// Number of branches.
    pub const COUNT: usize = 8;

    /// The branch with this number.
    pub fn new(index: usize) -> Self {
        Self((index % Self::COUNT) as u8)
    }

    /// The branch with these bits: reaching backwards, elbow down, wrist flipped.
    pub(crate) fn of(bits: [bool; 3]) -> Self {
        Self(bits.iter().enumerate().map(|(i, &bit)| u8::from(bit) << i).sum())
    }

    /// Number, from 0.
    pub fn index(self) -> usize {
        self.0.into()
    }

    /// Its name in words.
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
    /// Distance of each joint to its nearer limit, °.
    pub limits: [f64; 6],
    /// Distance of joint 5 from the angle at which axes 4 and 6 coincide, °.
    pub wrist: f64,
    /// Distance of the elbow from a straight or folded arm, °.
    pub elbow: f64,
}

impl Margins {
    /// The least of all margins, °.
    pub fn least(&self) -> f64 {
        self.limits.iter().copied().fold(self.wrist.min(self.elbow), f64::min)
    }

    /// The joint (from 0) that is nearest to a limit or farthest beyond one, and its margin, °.
    ///
    /// ```
    /// use bead_robot::Cell;
    ///
    /// // With all joints at 0°, joint 3 is the nearest to a limit: it turns from -65 to 70°.
    /// let arm = Cell::built_in("abb-irb1410")?.arm();
    /// assert_eq!(arm.margins(&[0.0; 6]).nearest_limit(), (2, 65.0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn nearest_limit(&self) -> (usize, f64) {
        let pairs = self.limits.iter().copied().enumerate();
        pairs.min_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or_default()
    }
}

/// The geometry of an arm: forward and inverse kinematics without limits.
pub(crate) trait Model: std::fmt::Debug + Send + Sync {
    /// The frame of the flange for finite joint angles, °.
    fn forward(&self, joints: &Joints) -> Frame;
    /// All joint angles, °, that put the flange there, each joint in any of its turns.
    fn inverse(&self, base_from_flange: &Frame) -> Vec<Joints>;
    /// Foot, axis 2, axis 3 and wrist, mm from the foot.
    fn links(&self, joints: &Joints) -> [DVec3; 4];
    /// The axes of the joints, in the frame of the foot.
    fn axes(&self, joints: &Joints) -> [Axis; 6];
    /// The branch of these joint angles.
    fn branch(&self, joints: &Joints) -> Branch;
    /// How far the wrist and the elbow are from their singular angles, °.
    fn singular_margins(&self, joints: &Joints) -> [f64; 2];
    /// How far the wrist lies outside the arm's reach, or inside its inner limit, mm; 0 if it can get there.
    fn beyond(&self, base_from_flange: &Frame) -> f64;
    /// Greatest distance of the wrist from axis 2, mm.
    fn reach(&self) -> f64;
}

/// An arm that can be moved.
#[derive(Debug, Clone)]
pub struct Arm {
    /// Least and greatest angle of each joint, °.
    pub limits: [[f64; 2]; 6],
    /// Greatest speed of each joint, °/s.
    pub speeds: [f64; 6],
    model: Arc<dyn Model>,
}

impl Arm {
    pub(crate) fn new(model: Arc<dyn Model>, limits: [[f64; 2]; 6], speeds: [f64; 6]) -> Self {
        Self { limits, speeds, model }
    }

    /// The frame of the flange for finite joint angles, °.
    pub fn forward(&self, joints: &Joints) -> Frame {
        self.model.forward(joints)
    }

    /// Foot, axis 2, axis 3 and wrist for these joint angles, °; mm from the foot.
    pub fn links(&self, joints: &Joints) -> [DVec3; 4] {
        self.model.links(joints)
    }

    /// The axes of the joints for these joint angles, °; in the frame of the foot, mm.
    ///
    /// ```
    /// use bead_robot::Cell;
    ///
    /// // Axis 6 goes through the flange, square to it.
    /// let (arm, joints) = (Cell::built_in("kuka-kr20-r1810")?.arm(), [10.0, -70.0, 60.0, 20.0, 30.0, 40.0]);
    /// let (flange, six) = (arm.forward(&joints), arm.axes(&joints)[5]);
    /// assert!(six.nearest(flange.position).distance(flange.position) < 1e-6);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn axes(&self, joints: &Joints) -> [Axis; 6] {
        self.model.axes(joints)
    }

    /// All joint angles, °, that put the flange there, including those beyond a limit. Of a joint's angles that differ
    /// by whole turns, the one nearest to the middle of its range is returned.
    ///
    /// ```
    /// use bead_robot::Cell;
    ///
    /// let arm = Cell::built_in("kuka-kr20-r1810")?.arm();
    /// let flange = arm.forward(&[10.0, -70.0, 60.0, 20.0, 30.0, 40.0]);
    /// let ways = arm.inverse(&flange);
    /// assert!(!ways.is_empty());
    /// assert!(ways.iter().all(|(_, joints)| arm.forward(joints).position.distance(flange.position) < 1e-3));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn inverse(&self, base_from_flange: &Frame) -> Vec<(Branch, Joints)> {
        let solution = |mut joints: Joints| {
            for (joint, [low, high]) in joints.iter_mut().zip(self.limits) {
                *joint = turned_near(*joint, (low + high) / 2.0);
            }
            (self.model.branch(&joints), joints)
        };
        self.model.inverse(base_from_flange).into_iter().map(solution).collect()
    }

    /// Distances from limits, wrist singularity and straight arm, °.
    pub fn margins(&self, joints: &Joints) -> Margins {
        let mut limits = [0.0; 6];
        for ((margin, joint), [low, high]) in limits.iter_mut().zip(joints).zip(self.limits) {
            *margin = (joint - low).min(high - joint);
        }
        let [wrist, elbow] = self.model.singular_margins(joints);
        Margins { limits, wrist, elbow }
    }

    /// How far the wrist lies outside the arm's reach, or inside its inner limit, mm; 0 if it can get there.
    pub fn beyond(&self, base_from_flange: &Frame) -> f64 {
        self.model.beyond(base_from_flange)
    }

    /// Greatest distance of the wrist from axis 2, mm.
    pub fn reach(&self) -> f64 {
        self.model.reach()
    }
}

/// Distance of an angle with this sine from 0° or 180°, °.
pub(crate) fn from_zero(sine: f64) -> f64 {
    sine.abs().min(1.0).asin().to_degrees()
}

/// `angle` plus as many whole turns as bring it nearest to `near`, °.
pub(crate) fn turned_near(angle: f64, near: f64) -> f64 {
    angle - ((angle - near) / 360.0).round() * 360.0
}
