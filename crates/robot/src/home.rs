//! The move from home to the first point of a program, and from its last point back.

use crate::arm::{Arm, Frame, Joints, turned_near};
use crate::track::{PIECE_MM, Stop};
use serde::{Deserialize, Serialize};

/// Where programs begin and end: a section of a cell.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Home {
    /// Angles of the joints, °, as the maker's controller displays them.
    pub joints: Joints,
    /// How programs move from there to their first point, and back from their last.
    pub by: Way,
}

/// How an arm moves from one pose to another.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Way {
    /// The tool point moves in a straight line (LIN, MoveL, L): the arm cannot change its posture.
    Line,
    /// Every joint turns directly to its angle (PTP, MoveAbsJ, J): singularities do not matter.
    Joint,
}

/// Greatest turn of a joint between two stops of a joint move, °.
const JOINT_STEP: f64 = 2.0;
/// Greatest turn of the torch between two stops of a straight move, °.
const TURN_STEP: f64 = 2.0;

/// A move between home and the program.
pub(crate) struct Move<'a> {
    pub(crate) arm: &'a Arm,
    pub(crate) flange_from_tool: &'a Frame,
    pub(crate) base_from_part: &'a Frame,
    pub(crate) by: Way,
    /// Speed, mm/s.
    pub(crate) speed: f64,
}

impl Move<'_> {
    /// Stops along the move, both ends included, with the joint angles and the frame of the flange; the angles are
    /// `None` if the arm cannot get there. Stops are labelled as in `like`.
    pub(crate) fn stops(&self, from: Joints, to: Joints, like: Stop) -> Vec<(Stop, Option<Joints>, Frame)> {
        match self.by {
            Way::Joint => self.joint(from, to, like),
            Way::Line => self.line(from, to, like),
        }
    }

    fn joint(&self, from: Joints, to: Joints, like: Stop) -> Vec<(Stop, Option<Joints>, Frame)> {
        let turns: Joints = std::array::from_fn(|j| to[j] - from[j]);
        let pieces = count(turns.iter().fold(0.0, |most: f64, turn| most.max(turn.abs())), JOINT_STEP);
        // All joints arrive together, the slowest at its greatest speed.
        let slowest = (0..6).map(|j| turns[j].abs() / self.arm.speeds[j]).fold(0.0, f64::max);
        let stop = |k: usize| {
            let joints = std::array::from_fn(|j| from[j] + turns[j] * k as f64 / pieces as f64);
            self.stop(joints, like, slowest * (1.0 + 1e-9) / pieces as f64)
        };
        (0..=pieces).map(stop).collect()
    }

    fn line(&self, from: Joints, to: Joints, like: Stop) -> Vec<(Stop, Option<Joints>, Frame)> {
        let [start, end] = [from, to].map(|joints| self.arm.forward(&joints).then(self.flange_from_tool));
        let (length, angle) = (start.position.distance(end.position), start.rotation.angle_between(end.rotation));
        let pieces = count(length, PIECE_MM).max(count(angle.to_degrees(), TURN_STEP));
        let seconds = length / pieces as f64 / self.speed.max(1e-6);
        let (tool_from_flange, mut before) = (self.flange_from_tool.inverse(), from);
        let mut stops = vec![self.stop(from, like, 0.0)];
        for k in 1..=pieces {
            let part = k as f64 / pieces as f64;
            let position = start.position.lerp(end.position, part);
            let tool = Frame { position, rotation: start.rotation.slerp(end.rotation, part) };
            let flange = tool.then(&tool_from_flange);
            let joints = nearest(self.arm, &flange, &before);
            before = joints.unwrap_or(before);
            let at = self.base_from_part.inverse().apply(position);
            stops.push((Stop { at, seconds, arc: false, ..like }, joints, flange));
        }
        stops
    }

    fn stop(&self, joints: Joints, like: Stop, seconds: f64) -> (Stop, Option<Joints>, Frame) {
        let flange = self.arm.forward(&joints);
        let at = self.base_from_part.inverse().apply(flange.then(self.flange_from_tool).position);
        (Stop { at, seconds, arc: false, ..like }, Some(joints), flange)
    }
}

/// The joint angles for this frame of the flange with the smallest turns.
fn nearest(arm: &Arm, base_from_flange: &Frame, before: &Joints) -> Option<Joints> {
    let near = |(_, joints): (_, Joints)| -> Joints { std::array::from_fn(|j| turned_near(joints[j], before[j])) };
    let turn = |joints: &Joints| (0..6).map(|j| (joints[j] - before[j]).abs()).fold(0.0, f64::max);
    arm.inverse(base_from_flange).into_iter().map(near).min_by(|a, b| turn(a).total_cmp(&turn(b)))
}

/// The number of steps, limited to what any move needs.
fn count(whole: f64, step: f64) -> usize {
    (whole / step).ceil().clamp(1.0, 1e4) as usize
}
