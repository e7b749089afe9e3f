//! What reach finds goes into programs: the torch's turn about its own axis, the same rotation in every robot's language; and
//! the angle of a turn table.

use crate::common;

use beadwright::dialect;
use beadwright::dialect::krl::KrlArc;
use beadwright::layer::Layer;
use beadwright::pass::PassKind;
use beadwright::pass::{Along, Pass};
use beadwright::profile::Profile;
use beadwright::robot::{self, Cell, part_from_tool};
use common::with_all_dialects;
use glam::{DMat3, DQuat, DVec3, EulerRot};
use std::collections::BTreeMap;

fn job() -> Vec<Layer> {
    let points = vec![DVec3::new(0.0, 0.0, 2.0), DVec3::new(60.0, 0.0, 2.0), DVec3::new(60.0, 40.0, 2.0)];
    let (width, speed) = (Along::Same(4.5), Along::Same(8.0));
    let pass = Pass { kind: PassKind::Infill, closed: false, points, width, pace: speed, wait: 0.0 };
    vec![Layer { index: 0, z: 2.0, height: 2.0, passes: vec![pass], ..Layer::default() }]
}

/// The numbers after every occurrence of a text, as many as there are to the end of the brackets.
fn numbers_behind(files: &BTreeMap<String, String>, mark: &str, count: usize) -> Vec<Vec<f64>> {
    let number = |t: &str| t.trim().trim_start_matches(|c: char| c.is_alphabetic() || c == '=' || c == ' ').to_owned();
    let mut found = Vec::new();
    for rest in files.values().flat_map(|text| text.split(mark).skip(1)) {
        let fields = rest.split([',', ']', '}', ')', '\r']).take(count);
        let numbers: Vec<f64> =
            fields.filter_map(|f| number(f).split(' ').next().unwrap_or_default().parse().ok()).collect();
        found.extend((numbers.len() == count).then_some(numbers));
    }
    found
}

/// The rotations that a dialect writes, by the definition of its angles.
fn rotations(post: &str, profile: &Profile) -> Vec<DMat3> {
    let mut files = dialect::write(post, &job(), &profile.job("part")).unwrap();
    // RAPID's main module holds frames too.
    files.retain(|name, _| post != "rapid" || name.contains("_L"));
    let about = |x: f64, y: f64, z: f64| {
        let [x, y, z] = [x, y, z].map(f64::to_radians);
        DMat3::from_rotation_z(z) * DMat3::from_rotation_y(y) * DMat3::from_rotation_x(x)
    };
    match post {
        "krl" => numbers_behind(&files, "{X ", 6).iter().map(|n| about(n[5], n[4], n[3])).collect(),
        "rapid" => numbers_behind(&files, "],[", 4)
            .iter()
            .filter(|n| n.iter().any(|v| *v != 0.0) && n.iter().all(|v| v.abs() <= 1.0))
            .map(|n| DMat3::from_quat(DQuat::from_xyzw(n[1], n[2], n[3], n[0])))
            .collect(),
        "fanuc" => numbers_behind(&files, "    W =", 3).iter().map(|n| about(n[0], n[1], n[2])).collect(),
        "inform" => files
            .values()
            .filter(|text| text.contains("///RECTAN"))
            .flat_map(|text| text.lines())
            .filter(|line| line.starts_with("C0"))
            .map(|line| line.split(['=', ',']).skip(1).map(|v| v.parse().unwrap()).collect::<Vec<f64>>())
            .map(|n| about(n[3], n[4], n[5]))
            .collect(),
        _ => numbers_behind(&files, "pose_trans(part_frame, p[", 6)
            .iter()
            .map(|n| DMat3::from_quat(DQuat::from_scaled_axis(DVec3::new(n[3], n[4], n[5]))))
            .collect(),
    }
}

#[track_caller]
fn all_are(post: &str, profile: &Profile, expected: DMat3) {
    let found = rotations(post, profile);
    assert!(found.len() >= 4, "{post}: {} poses", found.len());
    let off = |m: &DMat3| (*m - expected).to_cols_array().iter().fold(0.0_f64, |a, v| a.max(v.abs()));
    assert!(found.iter().all(|m| off(m) < 3e-6), "{post}: {:?} is not {expected:?}", found[0]);
}

const POSTS: [&str; 5] = ["krl", "rapid", "fanuc", "inform", "urscript"];

#[test]
fn every_dialect_writes_the_same_turn() {
    for angle in [0.0, 37.5, 100.0, -90.0, 180.0, 315.0] {
        let mut profile = with_all_dialects("cmt-steel-robots");
        profile.program.torch_angle = angle;
        let expected = DMat3::from_quat(part_from_tool(DVec3::ZERO, angle).rotation);
        POSTS.iter().for_each(|post| all_are(post, &profile, expected));
        profile.dialects.krl.as_mut().unwrap().arc = KrlArc::Arctech;
        all_are("krl", &profile, expected);
    }
}

/// A torch that leans in the section turns about its own axis: the wire's direction stays.
#[test]
fn a_leaning_torch_keeps_its_wire() {
    let lean = DQuat::from_euler(EulerRot::ZYX, 0.3, 0.2, 2.9);
    let (z, y, x) = lean.to_euler(EulerRot::ZYX);
    let mut profile = with_all_dialects("cmt-steel-robots");
    profile.dialects.krl.as_mut().unwrap().orientation = [z, y, x].map(f64::to_degrees);
    profile.dialects.fanuc.as_mut().unwrap().orientation = [x, y, z].map(f64::to_degrees);
    profile.dialects.inform.as_mut().unwrap().orientation = [x, y, z].map(f64::to_degrees);
    profile.dialects.rapid.as_mut().unwrap().orientation = [lean.w, lean.x, lean.y, lean.z];
    profile.dialects.urscript.as_mut().unwrap().orientation = lean.to_scaled_axis().to_array();
    for angle in [0.0_f64, 25.0, -140.0] {
        profile.program.torch_angle = angle;
        let expected = DMat3::from_quat(lean) * DMat3::from_rotation_z(-angle.to_radians());
        assert!((expected * DVec3::Z).distance(lean * DVec3::Z) < 1e-12);
        POSTS.iter().for_each(|post| all_are(post, &profile, expected));
    }
}

/// The joints that reach found hold the torch as the program then writes it.
#[test]
fn the_angle_of_reach_is_what_the_program_has() {
    for name in ["kuka-kr20-r1810", "abb-irb1410"] {
        let cell = Cell::built_in(name).unwrap();
        let reach = robot::reach(&cell, cell.part, &Profile::built_in("cmt-al2319-kuka").unwrap().track(&job()));
        let angle = reach.turning.program_angle().unwrap();
        assert!((-180.0..=180.0).contains(&angle) && reach.turning.range.0 == reach.turning.range.1);
        let mut profile = with_all_dialects("cmt-steel-robots");
        profile.program.torch_angle = angle;
        let base_from_part = cell.part.base_from_part();
        let (_, pose) = reach.reached().last().unwrap();
        let tool = base_from_part.inverse().then(&cell.arm().forward(&pose.joints)).then(&cell.flange_from_tool());
        POSTS.iter().for_each(|post| all_are(post, &profile, DMat3::from_quat(tool.rotation)));
    }
}

#[test]
fn the_table_is_in_every_pose_or_the_dialect_refuses() {
    let mut profile = with_all_dialects("cmt-steel-robots");
    profile.program.table_angle = Some(-35.0);
    let krl = dialect::write("krl", &job(), &profile.job("part")).unwrap();
    let poses = |text: &str, mark: &str| text.matches(mark).count();
    let layer = &krl["PART_L001.src"];
    assert_eq!((poses(layer, "{X "), poses(layer, ",C 180.0000,E1 -35.0000}")), (5, 5), "{layer}");
    let rapid = dialect::write("rapid", &job(), &profile.job("part")).unwrap();
    let layer = &rapid["part_L001.mod"];
    let axes = ",[-35.0000,9E+09,9E+09,9E+09,9E+09,9E+09]]";
    assert_eq!((poses(layer, ",[0,0,0,0],"), poses(layer, axes)), (5, 5), "{layer}");
    for post in ["fanuc", "inform", "urscript"] {
        let error = dialect::write(post, &job(), &profile.job("part")).unwrap_err().to_string();
        assert!(error.contains("program.table_angle") && error.contains(post), "{error}");
    }
    // A robot on a track has that as its first external axis.
    profile.program.linear_axis = Some(1250.0);
    let krl = dialect::write("krl", &job(), &profile.job("part")).unwrap();
    assert_eq!(poses(&krl["PART_L001.src"], ",C 180.0000,E1 1250.0000,E2 -35.0000}"), 5);
    let rapid = dialect::write("rapid", &job(), &profile.job("part")).unwrap();
    assert_eq!(poses(&rapid["part_L001.mod"], ",[1250.0000,-35.0000,9E+09,9E+09,9E+09,9E+09]]"), 5);
    profile.program.table_angle = None;
    let krl = dialect::write("krl", &job(), &profile.job("part")).unwrap();
    assert_eq!(poses(&krl["PART_L001.src"], ",C 180.0000,E1 1250.0000}"), 5);
    assert!(dialect::write("inform", &job(), &profile.job("part")).unwrap_err().to_string().contains("linear_axis"));
    profile.program.linear_axis = None;
    assert!(dialect::write("krl", &job(), &profile.job("part")).unwrap().values().all(|text| !text.contains(",E1 ")));
}
