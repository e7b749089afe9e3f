//! Joint trajectories: the arm is where the program wants the torch, at times that run on.

use crate::common;

use beadwright::robot::{self, Cell, Trajectory};
use common::{planned, profile};

#[test]
fn the_arm_is_where_the_torch_is() {
    for (cell, part) in [("kuka-kr20-r1810", "cross"), ("abb-irb1410", "star")] {
        let (cell, profile) = (Cell::built_in(cell).unwrap(), profile("cmt-al2319-kuka"));
        let plan = planned(part, &profile);
        let track = profile.track(&plan.layers[..2]);
        let reach = robot::reach(&cell, cell.part, &track);
        let trajectory = Trajectory::of(&cell, &reach).unwrap();
        assert!(trajectory.points.len() > track.stops.len() / 2);
        // Forward kinematics of the table's angles, from the flange to the wire's tip, in the part's frame.
        let csv = trajectory.csv();
        let rows: Vec<Vec<f64>> =
            csv.lines().skip(1).map(|line| line.split(',').map(|v| v.parse().unwrap()).collect()).collect();
        assert_eq!(rows.len(), trajectory.points.len());
        for row in rows.iter().step_by(7) {
            let joints: [f64; 6] = row[8..].try_into().unwrap();
            let tip = cell.arm().forward(&joints).then(&cell.flange_from_tool());
            let at = cell
                .part
                .base_from_part()
                .then(&robot::Frame { position: [row[4], row[5], row[6]].into(), rotation: Default::default() });
            assert!(tip.position.distance(at.position) < 0.01, "{} for {}", tip.position, at.position);
        }
        let seconds: f64 = track.stops.iter().map(|stop| stop.seconds).sum();
        assert!(trajectory.points.windows(2).all(|w| w[1].seconds > w[0].seconds));
        assert!((trajectory.points.last().unwrap().seconds - seconds).abs() < 0.01 * seconds + 1.0);
        // The message has the same angles in radians, and the fields of trajectory_msgs/JointTrajectory.
        let ros = trajectory.ros();
        assert_eq!(ros["joint_names"].as_array().unwrap().len(), 6);
        let points = ros["points"].as_array().unwrap();
        assert_eq!(points.len(), rows.len());
        for (point, row) in points.iter().zip(&rows) {
            let time = &point["time_from_start"];
            let seconds = time["sec"].as_f64().unwrap() + 1e-9 * time["nanosec"].as_f64().unwrap();
            assert!((seconds - row[0]).abs() < 1e-6);
            for (angle, degrees) in point["positions"].as_array().unwrap().iter().zip(&row[8..]) {
                assert!((angle.as_f64().unwrap().to_degrees() - degrees).abs() < 1e-5);
            }
            assert!(
                ["velocities", "accelerations", "effort"].iter().all(|key| point[*key].as_array().unwrap().is_empty())
            );
        }
    }
}
