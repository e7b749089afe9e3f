//! Arms as a chain of six revolute joints, from Denavit-Hartenberg rows or a URDF file.
//!
//! Each joint is a line about which everything beyond it turns (product of exponentials: Brockett 1984; Murray, Li and
//! Sastry 1994). Two kinds of arm have closed forms (`inverse.rs`): axes 2 and 3 parallel with axes 4, 5 and 6 through
//! one point, as in most welding robots; and axes 2, 3 and 4 parallel with axes 5 and 6 through one point, as in the
//! arms of Universal Robots. A calibrated arm deviates slightly from that, so its closed forms are refined
//! (`polish.rs`).

mod inverse;
mod polish;
mod turn;

use crate::arm::{Axis, Branch, Frame, Joints, Model, from_zero};
use glam::{DQuat, DVec3};
use turn::{across, turned};

/// Axes count as parallel if the sine of their angle is less than this: 0.3°.
const PARALLEL: f64 = 5e-3;
/// Axes count as meeting if they pass each other nearer than this, mm.
const MEETING_MM: f64 = 5.0;
/// Least length of a link, mm.
const LEAST_LINK_MM: f64 = 1.0;

/// Why the joint angles of a chain cannot be computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error(
    "its joints 2 and 3 must be parallel and across joint 1, and either joints 4, 5 and 6 must meet in one point or joint 4 must \
     be parallel to them and joints 5 and 6 must meet; {0}. Arms of other kinds cannot be walked"
)]
pub struct ChainError(&'static str);

/// A chain of six revolute joints.
#[derive(Debug, Clone, PartialEq)]
pub struct Chain {
    /// The axes of the joints with all joints at 0°, in the frame of the foot.
    axes: [Axis; 6],
    /// The flange with all joints at 0°.
    flange: Frame,
    wrist: Wrist,
    /// The point where the axes of the wrist meet, with all joints at 0°.
    centre: DVec3,
    /// Unit vectors along axis 2, such that the arm leans forward by turning about it, and up along axis 1.
    side: DVec3,
    up: DVec3,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Wrist {
    /// Axes 4, 5 and 6 meet.
    Spherical,
    /// Axis 4 is parallel to axes 2 and 3; axes 5 and 6 meet.
    Offset,
}

impl Axis {
    /// The transform of a turn by `angle`, rad.
    fn turn(&self, angle: f64) -> Frame {
        let rotation = DQuat::from_axis_angle(self.along, angle);
        Frame { position: self.at - rotation * self.at, rotation }
    }

    /// Where another axis passes nearest; `None` if it is parallel or passes too far away.
    fn meets(&self, other: &Self) -> Option<DVec3> {
        let normal = self.along.cross(other.along);
        let (between, square) = (other.at - self.at, normal.length_squared());
        if square < PARALLEL * PARALLEL || (between.dot(normal) / square.sqrt()).abs() > MEETING_MM {
            return None;
        }
        Some(self.at + self.along * (between.cross(other.along).dot(normal) / square))
    }

    fn is_parallel(&self, other: &Self) -> bool {
        self.along.cross(other.along).length() < PARALLEL
    }
}

impl Chain {
    /// A chain from the foot: for each joint, its frame in that of the previous joint and the direction of its axis in
    /// its own frame, mm; then the flange in the last joint's frame.
    ///
    /// # Errors
    /// [`ChainError`] if no closed form fits the axes.
    pub fn new(joints: &[(Frame, DVec3); 6], flange: &Frame) -> Result<Self, ChainError> {
        let mut base = Frame { position: DVec3::ZERO, rotation: DQuat::IDENTITY };
        let axes = joints.map(|(frame, axis)| {
            base = base.then(&frame);
            Axis { at: base.position, along: (base.rotation * axis).normalize_or(DVec3::Z) }
        });
        let (wrist, centre) = wrist(&axes)?;
        let up = if axes[0].along.z < 0.0 { -axes[0].along } else { axes[0].along };
        let along = axes[1].along;
        let side = if along.cross(up).dot(centre - axes[0].at) < 0.0 { -along } else { along };
        let chain = Self { axes, flange: base.then(flange), wrist, centre, side, up };
        let [upper, fore] = chain.links_across(0.0).map(DVec3::length);
        if upper.min(fore) < LEAST_LINK_MM {
            return Err(ChainError("an upper arm or a forearm is shorter than 1 mm"));
        }
        Ok(chain)
    }

    /// A chain by Denavit-Hartenberg rows: a (mm), d (mm) and alpha (°) of each joint, as in Rz(q) Tz(d) Tx(a) Rx(alpha).
    ///
    /// # Errors
    /// [`ChainError`] if no closed form fits the axes.
    pub fn from_dh(rows: &[[f64; 3]; 6]) -> Result<Self, ChainError> {
        let mut before = Frame { position: DVec3::ZERO, rotation: DQuat::IDENTITY };
        let joints = rows.map(|[a, d, alpha]| {
            let rotation = DQuat::from_rotation_x(alpha.to_radians());
            let link = Frame { position: DVec3::new(a, 0.0, d), rotation };
            (std::mem::replace(&mut before, link), DVec3::Z)
        });
        Self::new(&joints, &before)
    }

    /// The end of the forearm with all joints at 0°: a point that the joints beyond it do not move.
    fn forearm_end(&self) -> DVec3 {
        match self.wrist {
            Wrist::Spherical => self.centre,
            Wrist::Offset => self.axes[3].at,
        }
    }

    /// Upper arm and forearm projected square to axis 2, with joint 3 turned by `q3`, rad.
    fn links_across(&self, q3: f64) -> [DVec3; 2] {
        let [_, shoulder, elbow, ..] = self.axes;
        let fore = turned(elbow.along, q3, self.forearm_end() - elbow.at);
        [elbow.at - shoulder.at, fore].map(|link| across(shoulder.along, link))
    }

    /// The combined transform of the first `count` joints, rad.
    fn moved(&self, joints: &[f64; 6], count: usize) -> Frame {
        let still = Frame { position: DVec3::ZERO, rotation: DQuat::IDENTITY };
        self.axes.iter().zip(joints).take(count).fold(still, |frame, (axis, q)| frame.then(&axis.turn(*q)))
    }

    /// The flange for joint angles in rad.
    fn flange_at(&self, joints: &[f64; 6]) -> Frame {
        self.moved(joints, 6).then(&self.flange)
    }

    /// Volume spanned by the wrist's axes: 0 in its singularity; its sign distinguishes the two solutions.
    fn wrist_volume(&self, q5: f64) -> f64 {
        let [.., four, five, six] = self.axes.map(|axis| axis.along);
        five.dot(four.cross(turned(five, q5, six)))
    }
}

impl Model for Chain {
    fn forward(&self, joints: &Joints) -> Frame {
        self.flange_at(&joints.map(f64::to_radians))
    }

    fn inverse(&self, base_from_flange: &Frame) -> Vec<Joints> {
        let polished = |joints| polish::polished(self, joints, base_from_flange);
        let solutions = self.closed_forms(base_from_flange).into_iter().filter_map(polished);
        solutions.map(|joints| joints.map(f64::to_degrees)).collect()
    }

    fn links(&self, joints: &Joints) -> [DVec3; 4] {
        let joints = joints.map(f64::to_radians);
        let wrist = if self.wrist == Wrist::Spherical { self.centre } else { self.axes[4].at };
        let place = |count: usize, at: DVec3| self.moved(&joints, count).apply(at);
        [DVec3::ZERO, place(1, self.axes[1].at), place(2, self.axes[2].at), place(4, wrist)]
    }

    fn axes(&self, joints: &Joints) -> [Axis; 6] {
        let joints = joints.map(f64::to_radians);
        std::array::from_fn(|joint| {
            let (moved, Axis { at, along }) = (self.moved(&joints, joint), self.axes[joint]);
            Axis { at: moved.apply(at), along: moved.rotation * along }
        })
    }

    fn branch(&self, joints: &Joints) -> Branch {
        let [_, q2, q3, q4, q5, _] = joints.map(f64::to_radians);
        let from_axis_1 = self.moved(&[0.0, q2, q3, q4, 0.0, 0.0], 4).apply(self.centre) - self.axes[0].at;
        let [upper, fore] = self.links_across(q3);
        let forward = self.side.cross(self.up).dot(from_axis_1);
        Branch::of([forward < 0.0, self.side.dot(upper.cross(fore)) < 0.0, self.wrist_volume(q5) < 0.0])
    }

    fn singular_margins(&self, joints: &Joints) -> [f64; 2] {
        let [_, _, q3, _, q5, _] = joints.map(f64::to_radians);
        let [.., four, five, six] = self.axes.map(|axis| axis.along);
        let greatest = four.cross(five).length() * five.cross(six).length();
        let [upper, fore] = self.links_across(q3).map(DVec3::normalize_or_zero);
        [self.wrist_volume(q5) / greatest, self.side.dot(upper.cross(fore))].map(from_zero)
    }

    fn beyond(&self, base_from_flange: &Frame) -> f64 {
        self.closed_miss(base_from_flange)
    }

    fn reach(&self) -> f64 {
        self.links_across(0.0).into_iter().map(DVec3::length).sum()
    }
}

/// Which closed form fits, and where the axes of the wrist meet.
fn wrist(axes: &[Axis; 6]) -> Result<(Wrist, DVec3), ChainError> {
    let [one, two, three, four, five, six] = axes;
    if !two.is_parallel(three) {
        return Err(ChainError("here joints 2 and 3 are not parallel"));
    }
    if one.is_parallel(two) {
        return Err(ChainError("here joints 1 and 2 are parallel"));
    }
    let centre = five.meets(six).ok_or(ChainError("here joints 5 and 6 do not meet"))?;
    if four.meets(five).is_some_and(|place| place.distance(centre) < MEETING_MM) {
        return Ok((Wrist::Spherical, centre));
    }
    if three.is_parallel(four) && !four.is_parallel(five) {
        return Ok((Wrist::Offset, centre));
    }
    Err(ChainError("here joint 4 neither meets joints 5 and 6 in one point nor is parallel to joint 3"))
}
