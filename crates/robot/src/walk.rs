//! The walk along the whole path: joint angles, margins, speeds and findings.

use crate::arm::{Arm, Branch, Frame, Joints, Margins, turned_near};
use crate::cell::{Cell, PartPlace};
use crate::finding::{Findings, ReachFinding, Trouble};
use crate::home::{Move, Way};
use crate::room::Room;
use crate::track::{Leg, Stop, Track};
use crate::turn;
use rayon::prelude::*;
use serde::Serialize;

/// Joint 5 closer than this to its singular angle is reported, °: |sin J5| = 0.087.
pub(crate) const WRIST_MARGIN: f64 = 5.0;
/// Joint angles that differ by less than this belong to one posture, °.
const SAME_POSTURE: f64 = 1.0;

/// The arm at one stop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// Turn of the torch about its axis, °.
    pub torch_angle: f64,
    /// Angles of the joints, °.
    pub joints: Joints,
    /// Its margins from limits and singularities.
    pub margins: Margins,
    /// Speed of each joint on the way here, °/s.
    pub speeds: [f64; 6],
}

/// The torch angle over the program.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Turning {
    /// Least and greatest angle chosen, °.
    pub range: (f64, f64),
    /// The best single angle for the whole program, °.
    pub single: f64,
    /// Least margin with that single angle, °; far below 0 if some point is out of reach.
    pub single_margin: f64,
}

impl Turning {
    /// The torch angle to plan with, `program.torch_angle`, -180 to 180°; `None` if no single angle reaches every
    /// point.
    pub fn program_angle(&self) -> Option<f64> {
        (self.single_margin >= 0.0).then(|| turned_near(self.single, 0.0))
    }
}

/// The results of a walk.
#[derive(Debug, Clone)]
pub struct Reach {
    /// Position of the part.
    pub place: PartPlace,
    /// The branch of the arm used.
    pub branch: Branch,
    /// The stops with the pose of the arm; `None` if it cannot get there.
    pub poses: Vec<(Stop, Option<Pose>)>,
    /// The torch angle.
    pub turning: Turning,
    /// What is wrong: one finding for each kind, joint and leg, the fatal ones first.
    pub findings: Vec<ReachFinding>,
    /// Number of poses computed.
    pub computed: usize,
}

/// Walks a track with the part at a given position in the cell, including the moves from home and back.
pub fn reach(cell: &Cell, place: PartPlace, track: &Track) -> Reach {
    let arm = cell.arm();
    let (base_from_part, tool_from_flange) = (place.base_from_part(), cell.flange_from_tool().inverse());
    let course = turn::course(&arm, &base_from_part, &tool_from_flange, &track.stops);
    let flange = |stop: &Stop, angle: f64| base_from_part.then(&stop.tool(angle)).then(&tool_from_flange);
    let pairs: Vec<(&Stop, f64)> = track.stops.iter().zip(course.angles.iter().copied()).collect();
    let solved: Vec<Option<Joints>> =
        pairs.par_iter().map(|(stop, angle)| solve(&arm, &flange(stop, *angle), course.branch)).collect();
    let room = Room::new(cell, &arm, &base_from_part, track.bead_width);
    let mut walk = Walk { arm: &arm, before: None, room, findings: Findings::default() };
    let flange_from_tool = cell.flange_from_tool();
    let home = cell.home.map(|home| {
        let (speed, by) = (track.travel_speed, home.by);
        let way = Move { arm: &arm, flange_from_tool: &flange_from_tool, base_from_part: &base_from_part, by, speed };
        (home.joints, way)
    });
    if let (Some((from, way)), Some((first, _)), Some(Some(to))) = (&home, pairs.first(), solved.first()) {
        walk.home(way, *from, *to, Stop { leg: Leg::FromHome, ..**first });
    }
    let mut before: Option<Stop> = None;
    let step = |((stop, angle), joints): (&(&Stop, f64), Option<Joints>)| {
        let pose = walk.step(stop, *angle, joints, Way::Line, || arm.beyond(&flange(stop, *angle)));
        if let (Some(room), Some(from)) = (&mut walk.room, before.replace(**stop).filter(|_| stop.arc)) {
            room.lay(&from, stop);
        }
        (**stop, pose)
    };
    let poses: Vec<(Stop, Option<Pose>)> = pairs.iter().zip(solved).map(step).collect();
    if let (Some((to, way)), Some((last, Some(pose)))) = (&home, poses.last()) {
        walk.home(way, pose.joints, *to, Stop { leg: Leg::ToHome, ..*last });
    }
    let angles = || course.angles.iter().copied();
    let turning = Turning {
        range: (angles().fold(f64::INFINITY, f64::min), angles().fold(f64::NEG_INFINITY, f64::max)),
        single: course.single.0,
        single_margin: course.single.1,
    };
    let computed = course.poses + pairs.len();
    Reach { place, branch: course.branch, poses, turning, findings: walk.findings.sorted(), computed }
}

fn solve(arm: &Arm, base_from_flange: &Frame, branch: Branch) -> Option<Joints> {
    let solutions = arm.inverse(base_from_flange).into_iter();
    solutions.filter(|(b, _)| *b == branch).map(|(_, joints)| joints).next()
}

struct Walk<'a> {
    arm: &'a Arm,
    before: Option<Joints>,
    /// Collision checks; `None` if the cell gives no thicknesses.
    room: Option<Room<'a>>,
    findings: Findings,
}

impl Walk<'_> {
    /// Walks a move between home and an end of the program.
    fn home(&mut self, way: &Move<'_>, from: Joints, to: Joints, like: Stop) {
        self.before = None;
        for (stop, joints, flange) in way.stops(from, to, like) {
            self.step(&stop, 0.0, joints, way.by, || way.arm.beyond(&flange));
        }
        let off = |at: Joints| (0..6).map(|j| (j, (at[j] - to[j]).abs(), at[j])).max_by(|a, b| a.1.total_cmp(&b.1));
        let off = self.before.take().and_then(off).filter(|(_, off, _)| *off > SAME_POSTURE);
        if let Some((joint, _, angle)) = off {
            self.findings.add(&like, Trouble::Posture { joint, angle, judged: to[joint] });
        }
    }

    /// Walks to one stop.
    fn step(
        &mut self,
        stop: &Stop,
        torch_angle: f64,
        joints: Option<Joints>,
        by: Way,
        beyond: impl Fn() -> f64,
    ) -> Option<Pose> {
        let Some(mut joints) = joints else {
            self.findings.add(stop, Trouble::OutOfReach { beyond: beyond(), reach: self.arm.reach() });
            self.before = None;
            return None;
        };
        // A joint continues from its current angle and does not jump by a whole turn.
        for (joint, before) in joints.iter_mut().zip(self.before.into_iter().flatten()) {
            *joint = turned_near(*joint, before);
        }
        let from = self.before.unwrap_or(joints);
        let seconds = stop.seconds.max(1e-6);
        let speeds = std::array::from_fn(|j| (joints[j] - from[j]).abs() / seconds);
        self.before = Some(joints);
        let pose = Pose { torch_angle, joints, margins: self.arm.margins(&joints), speeds };
        self.note(stop, &pose, by);
        self.touch(stop, &joints);
        Some(pose)
    }

    fn note(&mut self, stop: &Stop, pose: &Pose, by: Way) {
        for joint in 0..6 {
            let [low, high] = self.arm.limits[joint];
            if pose.margins.limits[joint] < 0.0 {
                self.findings.add(stop, Trouble::Limit { joint, angle: pose.joints[joint], low, high });
            }
            let limit = self.arm.speeds[joint];
            if pose.speeds[joint] > limit {
                self.findings.add(stop, Trouble::Speed { joint, speed: pose.speeds[joint], limit, arc: stop.arc });
            }
        }
        // Joint moves pass through the singularity unharmed.
        if by == Way::Line && pose.margins.wrist < WRIST_MARGIN {
            self.findings.add(stop, Trouble::Wrist { margin: pose.margins.wrist });
        }
    }
}

impl Walk<'_> {
    /// Checks for collisions at a stop.
    fn touch(&mut self, stop: &Stop, joints: &Joints) {
        let contacts = self.room.as_ref().map(|room| room.contacts(joints, &stop.turned_table())).unwrap_or_default();
        for contact in contacts {
            self.findings.add(stop, Trouble::Collision { solids: contact.solids, depth: contact.depth });
        }
    }
}

impl Reach {
    /// Whether the robot can weld the whole program.
    pub fn is_reachable(&self) -> bool {
        self.findings.iter().all(|f| !f.trouble.is_fatal())
    }

    /// The first fatal finding along the path.
    pub fn first_bad(&self) -> Option<&ReachFinding> {
        self.findings
            .iter()
            .filter(|f| f.trouble.is_fatal())
            .min_by_key(|f| (f.stop.leg, f.stop.layer, f.stop.pass, f.stop.point))
    }

    /// Least margin of all points that have joint angles, °.
    pub fn least_margin(&self) -> Option<f64> {
        self.reached().map(|(_, pose)| pose.margins.least()).min_by(f64::total_cmp)
    }

    /// The stops that the arm reaches, with its pose there.
    pub fn reached(&self) -> impl Iterator<Item = (&Stop, &Pose)> {
        self.poses.iter().filter_map(|(stop, pose)| Some((stop, pose.as_ref()?)))
    }

    /// Range of a joint (from 0), its least margin, and its greatest speed with and without arc; `None` if no stop is
    /// reached.
    pub fn joint(&self, joint: usize) -> Option<JointRange> {
        let mut range: Option<JointRange> = None;
        for (stop, pose) in self.reached() {
            let (angle, speed) = (pose.joints[joint], pose.speeds[joint]);
            let r = range.get_or_insert(JointRange {
                low: angle,
                high: angle,
                margin: f64::INFINITY,
                arc_speed: 0.0,
                travel_speed: 0.0,
            });
            (r.low, r.high) = (r.low.min(angle), r.high.max(angle));
            r.margin = r.margin.min(pose.margins.limits[joint]);
            let fastest = if stop.arc { &mut r.arc_speed } else { &mut r.travel_speed };
            *fastest = fastest.max(speed);
        }
        range
    }
}

/// What one joint does over the program.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct JointRange {
    /// Least angle, °.
    pub low: f64,
    /// Greatest angle, °.
    pub high: f64,
    /// Least distance to a limit, °.
    pub margin: f64,
    /// Greatest speed with the arc on, °/s.
    pub arc_speed: f64,
    /// Greatest speed on travels, °/s.
    pub travel_speed: f64,
}
