//! The path of the joints over a program, for simulators and motion software: a table, or ROS 2's
//! `trajectory_msgs/JointTrajectory` as JSON.
//!
//! Times are those at the wanted speeds, without waits and acceleration; a ROS message has positions and times only,
//! since the torch changes its speed from point to point.

use crate::cell::Cell;
use crate::walk::Reach;
use crate::{Joints, Stop};
use bead_program::number::push_fixed;
use serde_json::{Value, json};

/// Least time between points, s: ROS accepts no two points at the same time.
const SHORTEST_S: f64 = 1e-6;

/// The path of the joints.
#[derive(Debug, Clone, PartialEq)]
pub struct Trajectory {
    /// Name of the cell.
    pub cell: String,
    /// Its points.
    pub points: Vec<Point>,
}

/// A point of the path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// Time since the first point, s.
    pub seconds: f64,
    /// Angles of the joints, °.
    pub joints: Joints,
    /// Turn of the torch about its axis, °.
    pub torch_angle: f64,
    /// Position of the torch, and the stop's other data.
    pub stop: Stop,
}

const HEAD: &str =
    "time (s),layer,pass,arc,x (mm),y (mm),z (mm),torch angle (°),J1 (°),J2 (°),J3 (°),J4 (°),J5 (°),J6 (°)\n";

impl Trajectory {
    /// The path of the joints in a cell; `None` if a stop is out of reach.
    pub fn of(cell: &Cell, reach: &Reach) -> Option<Self> {
        let (mut points, mut now): (Vec<Point>, f64) = (Vec::with_capacity(reach.poses.len()), 0.0);
        for (stop, pose) in &reach.poses {
            let pose = pose.as_ref()?;
            let still = points.last().is_some_and(|last| last.joints == pose.joints && last.stop.arc == stop.arc);
            if still && stop.seconds < SHORTEST_S {
                continue;
            }
            if !points.is_empty() {
                now += stop.seconds.max(SHORTEST_S);
            }
            points.push(Point { seconds: now, joints: pose.joints, torch_angle: pose.torch_angle, stop: *stop });
        }
        Some(Self { cell: cell.name.clone(), points })
    }

    /// A CSV table with a line for each point; layers and passes count from 1.
    pub fn csv(&self) -> String {
        let mut text = String::with_capacity(HEAD.len() + 110 * self.points.len());
        text.push_str(HEAD);
        for Point { seconds, joints, torch_angle, stop } in &self.points {
            push_fixed(&mut text, *seconds, 6);
            text.push_str(&format!(",{},{},{}", stop.layer + 1, stop.pass + 1, u8::from(stop.arc)));
            let places = [stop.at.x, stop.at.y, stop.at.z, *torch_angle];
            for (value, decimals) in places.iter().map(|v| (*v, 4)).chain(joints.iter().map(|v| (*v, 6))) {
                text.push(',');
                push_fixed(&mut text, value, decimals);
            }
            text.push('\n');
        }
        text
    }

    /// The message `trajectory_msgs/JointTrajectory`: joints `joint_1` to `joint_6`, positions in radians.
    pub fn ros(&self) -> Value {
        let names: Vec<String> = (1..=6).map(|joint| format!("joint_{joint}")).collect();
        let empty: [f64; 0] = [];
        let point = |point: &Point| {
            let nanoseconds = (point.seconds * 1e9).round() as u64;
            json!({
                "positions": point.joints.map(f64::to_radians), "velocities": empty, "accelerations": empty, "effort": empty,
                "time_from_start": { "sec": nanoseconds / 1_000_000_000, "nanosec": nanoseconds % 1_000_000_000 },
            })
        };
        let points: Vec<Value> = self.points.iter().map(point).collect();
        json!({
            "header": { "stamp": { "sec": 0, "nanosec": 0 }, "frame_id": "base_link" },
            "joint_names": names, "points": points,
        })
    }
}
