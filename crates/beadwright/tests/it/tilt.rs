//! A torch that leans with the wall and along its way, and a turn table that turns with it: in every robot's language.

use crate::common;

use beadwright::dialect;
use beadwright::layer::Layer;
use beadwright::pass::{Along, Pass, PassKind};
use beadwright::profile::Profile;
use beadwright::robot::{self, Cell};
use common::with_all_dialects;
use glam::{DMat3, DQuat, DVec2, DVec3};
use planar::{Polygon, Ring};
use std::f64::consts::TAU;

fn circle(centre: DVec2, radius: f64) -> Vec<DVec2> {
    (0..144).map(|k| centre + radius * DVec2::from_angle(TAU * f64::from(k) / 144.0)).collect()
}

/// Layers of a cone whose wall leans outward by `slope` (°), one contour each.
fn cone(centre: DVec2, slope: f64) -> Vec<Layer> {
    let layer = |index: usize| {
        let (z, radius) = (2.0 * (index + 1) as f64, 40.0 + 2.0 * index as f64 * slope.to_radians().tan());
        let points = circle(centre, radius - 2.25).into_iter().map(|p| p.extend(z)).collect();
        let (width, pace) = (Along::Same(4.5), Along::Same(8.0));
        let passes = vec![Pass { kind: PassKind::Contour, closed: true, points, width, pace, wait: 0.0 }];
        let islands = vec![Polygon { outer: Ring::new(circle(centre, radius)), holes: Vec::new() }];
        Layer { index, z, height: 2.0, islands, passes, ..Layer::default() }
    };
    (0..3).map(layer).collect()
}

/// The numbers of a text.
fn numbers(text: &str) -> Vec<f64> {
    let words = text.split(|c: char| !(c.is_ascii_digit() || matches!(c, '.' | '-' | '+' | 'E')));
    words.filter_map(|word| word.parse().ok()).collect()
}

fn euler(x: f64, y: f64, z: f64) -> DMat3 {
    let [x, y, z] = [x, y, z].map(f64::to_radians);
    DMat3::from_rotation_z(z) * DMat3::from_rotation_y(y) * DMat3::from_rotation_x(x)
}

/// The tools of all positions that a dialect writes at the height of the layer `number` (from 1), each with the angle of its
/// turn table.
fn tools(post: &str, layers: &[Layer], number: usize, profile: &Profile) -> Vec<(DVec3, DMat3, Option<f64>)> {
    let files = dialect::write(post, layers, &profile.job("part")).unwrap();
    let text: String = files.into_values().collect();
    let behind = |mark: &str, end: &str| -> Vec<Vec<f64>> {
        text.split(mark).skip(1).map(|t| numbers(&t.split(end).next().unwrap().replace("E1", ""))).collect()
    };
    let tool = |n: &[f64], rotation: DMat3| (DVec3::new(n[0], n[1], n[2]), rotation, n.get(6).copied());
    let quaternion = |n: &[f64]| DMat3::from_quat(DQuat::from_xyzw(n[1], n[2], n[3], n[0]));
    let turned = |v: &[f64]| DMat3::from_quat(DQuat::from_scaled_axis(DVec3::new(v[0], v[1], v[2])));
    let all: Vec<_> = match post {
        "krl" => behind("{X ", "}").iter().map(|n| tool(n, euler(n[5], n[4], n[3]))).collect(),
        "rapid" => behind("[[", ";")
            .iter()
            .filter(|n| n.len() > 12)
            .map(|n| (DVec3::new(n[0], n[1], n[2]), quaternion(&n[3..]), Some(n[11]).filter(|angle| *angle < 1e9)))
            .collect(),
        "fanuc" => behind("    X =", "}").iter().map(|n| tool(n, euler(n[3], n[4], n[5]))).collect(),
        "inform" => {
            let lines = text.lines().filter(|line| line.starts_with("C0")).map(|line| numbers(&line[6..]));
            lines.filter(|n| n.len() == 6).map(|n| tool(&n, euler(n[3], n[4], n[5]))).collect()
        }
        _ => {
            let poses = behind("pose_trans(part_frame, p[", "]");
            poses.iter().map(|n| (DVec3::new(n[0], n[1], n[2]) * 1000.0, turned(&n[3..]), None)).collect()
        }
    };
    let at_height = |(at, ..): &(DVec3, DMat3, Option<f64>)| (at.z - layers[number - 1].z).abs() < 1e-6;
    all.into_iter().filter(at_height).collect()
}

const POSTS: [&str; 5] = ["krl", "rapid", "fanuc", "inform", "urscript"];

fn leaning(follow_wall: f64, travel_angle: f64) -> Profile {
    let mut profile = with_all_dialects("cmt-steel-robots");
    (profile.program.follow_wall, profile.program.travel_angle) = (follow_wall, travel_angle);
    profile
}

/// The wire points down the wall of a cone, wherever the cone is and however it leans.
#[test]
fn the_wire_points_down_the_wall() {
    for (centre, slope) in [(DVec2::ZERO, 15.0_f64), (DVec2::new(-61.0, 17.0), 25.0), (DVec2::new(9.0, 90.0), -20.0)] {
        let (layers, profile) = (cone(centre, slope), leaning(1.0, 0.0));
        for post in POSTS {
            let tools = tools(post, &layers, 3, &profile);
            assert!(tools.len() >= 144, "{post}: {}", tools.len());
            for (at, rotation, _) in tools {
                let outward = (at.truncate() - centre).normalize() * slope.to_radians().sin();
                let wall = outward.extend(slope.to_radians().cos());
                let off = (rotation * DVec3::Z).angle_between(-wall).to_degrees();
                assert!(off < 0.6, "{post}: {off}° off at {at}");
            }
        }
        // The first layer stands on the plate.
        let upright =
            |(_, rotation, _): &(DVec3, DMat3, Option<f64>)| (*rotation * DVec3::Z).distance(-DVec3::Z) < 1e-5;
        POSTS.iter().for_each(|post| assert!(tools(post, &layers, 1, &profile).iter().all(upright), "{post}"));
    }
}

/// A torch that drags points back along its way.
#[test]
fn the_travel_angle_follows_the_path() {
    let layers = cone(DVec2::ZERO, 0.0);
    for angle in [12.0_f64, -8.0] {
        for post in POSTS {
            let tools = tools(post, &layers, 2, &leaning(0.0, angle));
            assert!(tools.len() >= 144, "{post}: {}", tools.len());
            for pair in tools[1..].windows(3) {
                let way = (pair[2].0 - pair[0].0).normalize();
                let wire = pair[1].1 * DVec3::Z;
                let forward = wire.dot(way).asin().to_degrees();
                assert!((forward - angle).abs() < 0.6, "{post}: {forward}° for {angle}°");
            }
        }
    }
}

/// Leaning changes where the torch points and nothing else: the same places, and the same moves along arcs.
#[test]
fn leaning_keeps_the_path() {
    let layers = cone(DVec2::new(5.0, 5.0), 20.0);
    for post in POSTS {
        let places = |profile: &Profile| tools(post, &layers, 3, profile).iter().map(|t| t.0).collect::<Vec<_>>();
        assert_eq!(places(&leaning(1.0, 5.0)), places(&leaning(0.0, 0.0)), "{post}");
        let mut fitted = leaning(1.0, 0.0);
        (fitted.program.chord_tolerance, fitted.program.arcs) = (0.05, true);
        let tools = tools(post, &layers, 3, &fitted);
        assert!((24..=140).contains(&tools.len()), "{post}: {}", tools.len());
        for (at, ..) in &tools {
            let radius = at.truncate().distance(DVec2::new(5.0, 5.0));
            assert!((radius - 37.75 - 4.0 * 20.0_f64.to_radians().tan()).abs() < 0.06, "{post}: {radius}");
        }
    }
}

/// The arc stays on its side of the table's axis, and the torch stands still in the cell but for its way up and out.
#[test]
fn the_table_turns_with_the_torch() {
    for side in [0.0, -90.0, 135.0_f64] {
        let layers = cone(DVec2::ZERO, 0.0);
        let mut profile = leaning(0.0, 0.0);
        profile.program.table_side = Some(side);
        for post in ["krl", "rapid"] {
            let tools = tools(post, &layers, 2, &profile);
            assert!(tools.len() > 144, "{post}");
            for (at, rotation, table) in tools {
                let turn = DMat3::from_rotation_z(table.unwrap().to_radians());
                let place = turn * at;
                let wanted = DVec2::from_angle(side.to_radians());
                assert!(place.truncate().normalize().distance(wanted) < 1e-3, "{post}: {place}");
                assert!(((turn * rotation) * DVec3::Z).distance(-DVec3::Z) < 1e-5);
                assert!(((turn * rotation) * DVec3::X).distance(DVec3::X) < 1e-4, "{post}: {rotation}");
            }
        }
        for post in ["fanuc", "inform", "urscript", "gcode"] {
            let error = dialect::write(post, &layers, &profile.job("part")).unwrap_err().to_string();
            assert!(error.contains("program.table_side"), "{error}");
        }
    }
}

#[test]
fn machines_without_a_wrist_refuse() {
    let mut profile = Profile::built_in("plasma-304-cnc").unwrap();
    profile.program.follow_wall = 1.0;
    let error = dialect::write("gcode", &cone(DVec2::ZERO, 10.0), &profile.job("part")).unwrap_err().to_string();
    assert!(error.contains("program.follow_wall") && error.contains("gcode"), "{error}");
}

/// `reach` walks with the torch as the program holds it.
#[test]
fn reach_leans_and_turns_too() {
    let cell = Cell::built_in("kuka-kr20-r1810").unwrap();
    let layers = cone(DVec2::ZERO, 20.0);
    let mut profile = leaning(1.0, 0.0);
    for side in [None, Some(180.0)] {
        profile.program.table_side = side;
        let reach = robot::reach(&cell, cell.part, &profile.track(&layers));
        let part_from_base = cell.part.base_from_part().inverse();
        let (mut leans, mut far) = (0.0_f64, 0.0_f64);
        for (stop, pose) in reach.reached().filter(|(stop, _)| stop.arc) {
            let tool = part_from_base.then(&cell.arm().forward(&pose.joints)).then(&cell.flange_from_tool());
            leans = leans.max((tool.rotation * DVec3::Z).angle_between(-DVec3::Z).to_degrees());
            if side.is_some() {
                let off = tool.position.truncate().normalize().distance(-DVec2::X);
                far = far.max(off);
            } else {
                far = far.max(tool.position.distance(stop.at));
            }
        }
        assert!((leans - 20.0).abs() < 0.6 && far < 1e-3, "{side:?}: {leans}° and {far}");
    }
}
