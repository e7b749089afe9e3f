//! Robots: known poses, there and back, limits, speeds, singular wrists, and whole plans.

use beadwright::example;
use beadwright::layer::Layer;
use beadwright::pass::{Along, Pass, PassKind};
use beadwright::plan;
use beadwright::profile::Profile;
use beadwright::robot::cell::BUILT_IN;
use beadwright::robot::{
    self, Body, Cell, CellError, Frame, Home, Leg, PartPlace, Reach, Shape, Solid, Track, Trouble, Way,
};
use beadwright::task::Task;
use glam::{DQuat, DVec3};
use proptest::prelude::*;

fn cell(name: &str) -> Cell {
    Cell::built_in(name).unwrap()
}

/// A cell that gives neither home nor how thick its arm is.
fn bare(name: &str) -> Cell {
    Cell { home: None, body: None, ..cell(name) }
}

fn kuka() -> Cell {
    bare("kuka-kr20-r1810")
}

fn abb() -> Cell {
    bare("abb-irb1410")
}

fn place(x: f64, y: f64, z: f64, rotation: f64) -> PartPlace {
    PartPlace { position: [x, y, z], rotation }
}

/// An open pass through these points, 10 mm/s.
pub(crate) fn pass(points: Vec<DVec3>) -> Pass {
    let (width, pace) = (Along::Same(5.0), Along::Same(10.0));
    Pass { kind: PassKind::Infill, closed: false, points, width, pace, wait: 0.0 }
}

/// One layer with one open pass through these points.
fn track(points: &[[f64; 3]]) -> Track {
    let pass = pass(points.iter().map(|&p| p.into()).collect());
    let layer = Layer { index: 0, z: 2.0, height: 2.0, passes: vec![pass], ..Layer::default() };
    // Travels 20 mm above at 100 mm/s.
    Profile::built_in("cmt-al2319-kuka").unwrap().track(&[layer])
}

fn square() -> Track {
    track(&[[-50.0, -50.0, 2.0], [50.0, -50.0, 2.0], [50.0, 50.0, 2.0], [-50.0, 50.0, 2.0]])
}

#[track_caller]
fn stands(cell: &Cell, joints: [f64; 6], at: [f64; 3], along: DVec3) {
    let flange = cell.arm().forward(&joints);
    assert!(flange.position.distance(at.into()) < 1e-9, "{joints:?}: {}", flange.position);
    assert!((flange.rotation * DVec3::Z).distance(along) < 1e-12, "{joints:?}: {}", flange.rotation * DVec3::Z);
}

#[test]
fn the_kuka_reaches_where_its_maker_says() {
    // Straight up, the home pose, stretched level, and turned: A1 runs clockwise.
    stands(&kuka(), [0.0, -90.0, 0.0, 0.0, 0.0, 0.0], [10.0, 0.0, 2313.0], DVec3::Z);
    stands(&kuka(), [0.0, -90.0, 90.0, 0.0, 0.0, 0.0], [1173.0, 0.0, 1450.0], DVec3::X);
    stands(&kuka(), [0.0, 0.0, 0.0, 0.0, 0.0, 0.0], [1953.0, 0.0, 670.0], DVec3::X);
    stands(&kuka(), [90.0, -90.0, 90.0, 0.0, 0.0, 0.0], [0.0, -1173.0, 1450.0], DVec3::NEG_Y);
    // A5 = 90 bends the hand down.
    stands(&kuka(), [0.0, -90.0, 90.0, 0.0, 90.0, 0.0], [1020.0, 0.0, 1297.0], DVec3::NEG_Z);
    // Looking at the flange, A6 runs clockwise too; at home its x axis points down.
    let turned = kuka().arm().forward(&[0.0, -90.0, 90.0, 0.0, 0.0, 90.0]);
    assert!((turned.rotation * DVec3::X).distance(DVec3::NEG_Y) < 1e-12, "{}", turned.rotation * DVec3::X);
}

#[test]
fn the_abb_reaches_where_its_maker_says() {
    stands(&abb(), [0.0; 6], [955.0, 0.0, 1195.0], DVec3::X);
    stands(&abb(), [0.0, 0.0, -90.0, 0.0, 0.0, 0.0], [30.0, 0.0, 1880.0], DVec3::Z);
    stands(&abb(), [90.0, 0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 955.0, 1195.0], DVec3::Y);
    stands(&abb(), [0.0, 0.0, 0.0, 0.0, 90.0, 0.0], [870.0, 0.0, 1110.0], DVec3::NEG_Z);
    // The parallelogram: axis 2 moves the hand, and does not turn it.
    let (a, b) = (
        abb().arm().forward(&[5.0, -30.0, 10.0, 20.0, 30.0, 40.0]),
        abb().arm().forward(&[5.0, 40.0, 10.0, 20.0, 30.0, 40.0]),
    );
    assert!(a.rotation.angle_between(b.rotation) < 1e-7 && a.position.distance(b.position) > 300.0);
}

/// Poses worked out by hand from the axes of their descriptions: all joints at zero, straight up, turned, hand down.
#[test]
fn arms_for_arc_welding_reach_as_described() {
    let abb = bare("abb-irb2600-12-165");
    stands(&abb, [0.0; 6], [1030.0, 0.0, 1260.0], DVec3::X);
    stands(&abb, [0.0, 0.0, -90.0, 0.0, 0.0, 0.0], [35.0, 0.0, 2025.0], DVec3::Z);
    stands(&abb, [90.0, 0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 1030.0, 1260.0], DVec3::Y);
    stands(&abb, [0.0, 0.0, 0.0, 0.0, 90.0, 0.0], [945.0, 0.0, 1175.0], DVec3::NEG_Z);
    let kuka = bare("kuka-kr8-r1440-arc");
    stands(&kuka, [0.0, -90.0, 0.0, 0.0, 0.0, 0.0], [-40.0, 0.0, 1742.0], DVec3::Z);
    stands(&kuka, [0.0, -90.0, 90.0, 0.0, 0.0, 0.0], [877.0, 0.0, 1245.0], DVec3::X);
    stands(&kuka, [0.0; 6], [1487.0, 0.0, 635.0], DVec3::X);
    stands(&kuka, [90.0, -90.0, 90.0, 0.0, 0.0, 0.0], [0.0, -877.0, 1245.0], DVec3::NEG_Y);
    stands(&kuka, [0.0, -90.0, 90.0, 0.0, 90.0, 0.0], [797.0, 0.0, 1165.0], DVec3::NEG_Z);
    let fanuc = bare("fanuc-arc-mate-100id");
    stands(&fanuc, [0.0; 6], [850.0, 0.0, 1285.0], DVec3::X);
    stands(&fanuc, [0.0, 0.0, 90.0, 0.0, 0.0, 0.0], [-120.0, 0.0, 1865.0], DVec3::Z);
    stands(&fanuc, [90.0, 0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 850.0, 1285.0], DVec3::Y);
    stands(&fanuc, [0.0, 0.0, 0.0, 0.0, -90.0, 0.0], [775.0, 0.0, 1210.0], DVec3::NEG_Z);
    // J2 moves the forearm, and does not turn it; at rest the flange's x axis points up.
    let (sin, cos) = 30.0_f64.to_radians().sin_cos();
    stands(&fanuc, [0.0, 30.0, 0.0, 0.0, 0.0, 0.0], [850.0 + 640.0 * sin, 0.0, 645.0 + 640.0 * cos], DVec3::X);
    assert!((fanuc.arm().forward(&[0.0; 6]).rotation * DVec3::X).distance(DVec3::Z) < 1e-12);
    let yaskawa = bare("yaskawa-ar2010");
    stands(&yaskawa, [0.0; 6], [1332.0, 0.0, 1465.0], DVec3::X);
    stands(&yaskawa, [0.0, 0.0, 90.0, 0.0, 0.0, 0.0], [-50.0, 0.0, 2447.0], DVec3::Z);
    stands(&yaskawa, [90.0, 0.0, 0.0, 0.0, 0.0, 0.0], [0.0, 1332.0, 1465.0], DVec3::Y);
    stands(&yaskawa, [0.0, 0.0, 0.0, 0.0, -90.0, 0.0], [1232.0, 0.0, 1365.0], DVec3::NEG_Z);
    assert!((yaskawa.arm().forward(&[0.0; 6]).rotation * DVec3::X).distance(DVec3::Z) < 1e-12);
    // Any pose, worked out from the descriptions by another program; J3 of the description is J3 + J2 on the pendant.
    for (cell, joints, at, x, z) in [
        (
            &kuka,
            [10.0, -70.0, 60.0, 20.0, 30.0, 40.0],
            [1016.307, -193.094, 1288.914],
            [-0.446748, -0.764968, -0.463939],
            [0.890564, -0.330679, -0.312325],
        ),
        (
            &fanuc,
            [10.0, 20.0, -15.0, 25.0, -40.0, 35.0],
            [1052.061, 164.818, 1001.512],
            [0.447725, 0.876089, 0.178913],
            [0.627385, -0.16522, -0.76098],
        ),
        (
            &yaskawa,
            [10.0, 20.0, -15.0, 25.0, -40.0, 35.0],
            [1423.145, 223.354, 670.728],
            [0.472765, 0.880504, -0.034713],
            [0.336078, -0.216585, -0.916593],
        ),
    ] {
        let flange = cell.arm().forward(&joints);
        assert!(flange.position.distance(at.into()) < 2e-3, "{}: {}", cell.name, flange.position);
        assert!((flange.rotation * DVec3::X).distance(x.into()) < 2e-6, "{}", cell.name);
        assert!((flange.rotation * DVec3::Z).distance(z.into()) < 2e-6, "{}", cell.name);
    }
    // Stretched out, the wrist is as far from axis 1 as the makers say, mm.
    for (cell, reach) in [(&abb, 1653.0), (&kuka, 1441.0), (&fanuc, 1441.0), (&yaskawa, 2010.0)] {
        let Shape::Opw(arm) = &cell.arm.shape else { panic!("lengths") };
        assert!((arm.a1 + arm.c2 + arm.c3.hypot(arm.a2) - reach).abs() < 1.0, "{}", cell.name);
    }
}

/// Numbers from 0 to 1, always the same ones.
fn noise(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    }
}

#[test]
fn there_and_back_for_100_000_poses() {
    for (name, _) in BUILT_IN {
        let arm = cell(name).arm();
        let mut noise = noise(7);
        let (mut worst, mut turned, mut lost) = (0.0_f64, 0.0_f64, 0);
        for _ in 0..100_000 {
            let joints = arm.limits.map(|[low, high]| low + (high - low) * noise());
            let flange = arm.forward(&joints);
            let solutions = arm.inverse(&flange);
            lost += usize::from(solutions.is_empty());
            for (_, found) in &solutions {
                let again = arm.forward(found);
                worst = worst.max(again.position.distance(flange.position));
                turned = turned.max(again.rotation.angle_between(flange.rotation));
            }
            // The way in which the pose was made is among them.
            let same = |found: &[f64; 6]| {
                found.iter().zip(joints).all(|(a, b)| ((a - b + 540.0).rem_euclid(360.0) - 180.0).abs() < 1e-3)
            };
            assert!(solutions.iter().any(|(_, found)| same(found)), "{name}: {joints:?} is not among {solutions:?}");
        }
        println!("{name}: {worst:e} mm, {turned:e} rad");
        assert_eq!(lost, 0, "{name}");
        assert!(worst < 1e-3, "{name}: {worst} mm");
        assert!(turned < 1e-6, "{name}: {turned} rad");
    }
}

/// The wrist lies behind the flange by the length of the hand, and the links are as long as the cell says.
#[test]
fn links_hang_together() {
    for (name, _) in BUILT_IN {
        let (cell, mut noise) = (cell(name), noise(11));
        let (arm, Shape::Opw(table)) = (cell.arm(), cell.arm.shape) else { continue };
        for _ in 0..1000 {
            let joints = arm.limits.map(|[low, high]| low + (high - low) * noise());
            let [foot, shoulder, elbow, wrist] = arm.links(&joints);
            let flange = arm.forward(&joints);
            assert!(wrist.distance(flange.apply(DVec3::new(0.0, 0.0, -table.c4))) < 1e-6, "{name}: {joints:?}");
            assert_eq!(foot, DVec3::ZERO);
            assert!((shoulder.distance(elbow) - table.c2).abs() < 1e-9);
            assert!((elbow.distance(wrist) - table.a2.hypot(table.c3)).abs() < 1e-9);
        }
    }
}

/// From the home pose of the profile, whose J5 is 0, a straight move begins in the singularity; a joint move does not mind.
#[test]
fn the_wrist_at_home_matters_on_straight_moves_only() {
    let full = Cell { body: None, ..cell("kuka-kr20-r1810") };
    let joints = full.home.unwrap().joints;
    let walk = |joints, by| {
        let cell = Cell { home: Some(Home { joints, by }), ..full.clone() };
        robot::reach(&cell, cell.part, &square())
    };
    let line = walk(joints, Way::Line);
    let wrist = |leg| line.findings.iter().find(|f| f.stop.leg == leg && matches!(f.trouble, Trouble::Wrist { .. }));
    for (leg, words) in [(Leg::FromHome, "from home to the first point"), (Leg::ToHome, "from the last point to home")]
    {
        let found = wrist(leg).unwrap();
        assert!(matches!(found.worst.1, Trouble::Wrist { margin } if margin < 1e-6), "{found:?}");
        let sentence = found.sentence();
        assert!(sentence.contains(words) && sentence.contains("joint move") && !found.trouble.is_fatal(), "{sentence}");
    }
    assert!(line.is_reachable());
    let joint = walk(joints, Way::Joint);
    assert!(joint.findings.is_empty(), "{:?}", joint.findings);
    // A home that a joint cannot reach is fatal by either way.
    let beyond = walk([0.0, -90.0, 90.0, 0.0, 140.0, 0.0], Way::Joint);
    let bad = beyond.first_bad().unwrap();
    assert!(matches!(bad.trouble, Trouble::Limit { joint: 4, .. }) && bad.stop.leg == Leg::FromHome, "{bad:?}");
    // From the other side of the wrist a straight move cannot get to the posture that was judged.
    let judged = walk(joints, Way::Joint).poses[0].1.unwrap().joints;
    let flipped = [judged[0], judged[1], judged[2], judged[3] - 180.0, -judged[4], judged[5] + 180.0];
    let found = walk(flipped, Way::Line);
    let posture = found.findings.iter().find(|f| matches!(f.trouble, Trouble::Posture { .. }));
    assert!(posture.is_some_and(|f| f.sentence().contains("from home")), "{:?}", found.findings);
    assert!(walk(judged, Way::Line).findings.is_empty());
}

pub(crate) fn hits(reach: &Reach) -> Vec<([Solid; 2], f64)> {
    let hit = |trouble: Trouble| match trouble {
        Trouble::Collision { solids, depth } => Some((solids, depth)),
        _ => None,
    };
    reach.findings.iter().filter_map(|f| hit(f.worst.1)).collect()
}

#[test]
fn what_the_arm_hits_is_reported() {
    let full = Cell { home: None, ..cell("kuka-kr20-r1810") };
    let body = full.body.clone().unwrap();
    let with = |change: fn(&mut Body), at: PartPlace, track: &Track| {
        let mut body = body.clone();
        change(&mut body);
        robot::reach(&Cell { body: Some(body), ..full.clone() }, at, track)
    };
    assert_eq!(hits(&with(|_| {}, full.part, &square())), []);
    // A table as high as the elbow, down to the floor and reaching up to the base.
    let high = place(1000.0, 0.0, 1100.0, 0.0);
    let table = hits(&with(|b| b.table = [1900.0, 800.0], high, &square()));
    assert!(table.iter().any(|(solids, _)| *solids == [Solid::UpperArm, Solid::Table]), "{table:?}");
    assert_eq!(hits(&with(|b| b.table = [300.0, 300.0], high, &square())), []);
    // A base so thick that it reaches the part.
    let thick = with(|b| b.base = 1100.0, full.part, &square());
    let sentence = thick.findings.iter().find(|f| matches!(f.trouble, Trouble::Collision { .. })).unwrap().sentence();
    assert!(sentence.contains("the torch hits the robot's base, by ") && sentence.contains("[body]"), "{sentence}");
    assert!(thick.is_reachable(), "capsules only warn");
    // Ten millimetres more of thickness go ten millimetres deeper.
    let thicker = with(|b| b.base = 1110.0, full.part, &square());
    let depth = |reach: &Reach| hits(reach).iter().find(|(s, _)| *s == [Solid::Torch, Solid::Base]).unwrap().1;
    assert!((depth(&thicker) - depth(&thick) - 10.0).abs() < 1e-9, "{} {}", depth(&thicker), depth(&thick));
    // The torch stands upright at x 1150 mm and more; the axis of the base ends at (160, 0, 520) mm.
    assert!((depth(&thick) - (1100.0 + 25.0 - 1000.0)).abs() < 60.0, "{}", depth(&thick));
}

#[test]
fn a_branch_is_kept_on_small_moves() {
    let arm = kuka().arm();
    let joints = [10.0, -80.0, 95.0, 20.0, 60.0, 30.0];
    let near = [10.2, -80.2, 95.1, 20.1, 60.3, 30.4];
    let branch = |joints| {
        let found = arm.inverse(&arm.forward(joints)).into_iter();
        found.min_by(|a, b| distance(&a.1, joints).total_cmp(&distance(&b.1, joints))).unwrap().0
    };
    assert_eq!(branch(&joints), branch(&near));
    let all = arm.inverse(&arm.forward(&joints));
    let mut branches: Vec<_> = all.iter().map(|(b, _)| *b).collect();
    branches.sort();
    branches.dedup();
    assert_eq!(branches.len(), all.len(), "every solution has a branch of its own: {all:?}");
}

fn distance(a: &[f64; 6], b: &[f64; 6]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).sum()
}

fn propeller() -> Track {
    let profile = Profile::built_in("cmt-al2319-kuka").unwrap();
    let mesh = example::find("propeller").unwrap().mesh();
    let plan = plan::plan("propeller", &mesh, &profile, &Task::new()).unwrap();
    profile.track(&plan.layers)
}

#[test]
fn both_robots_reach_the_propeller() {
    let track = propeller();
    for (name, margin) in [("kuka-kr20-r1810", 50.0), ("abb-irb1410", 20.0)] {
        let cell = cell(name);
        let reach = robot::reach(&cell, cell.part, &track);
        let on_part = reach.findings.iter().filter(|f| f.stop.leg == Leg::Part);
        assert!(reach.is_reachable() && on_part.count() == 0, "{:?}", reach.findings);
        for finding in &reach.findings {
            println!("{name}: {}", finding.sentence());
        }
        assert!(reach.least_margin().unwrap() > margin, "{:?}", reach.least_margin());
        assert!((0..6).all(|j| reach.joint(j).unwrap().margin > margin));
        check_way(&cell, cell.part, &reach);
    }
}

/// The torch is where the plan wants it, straight down, and no joint springs.
fn check_way(cell: &Cell, place: PartPlace, reach: &Reach) {
    let (arm, tool) = (cell.arm(), cell.flange_from_tool());
    let mut before: Option<[f64; 6]> = None;
    for (stop, pose) in reach.reached() {
        let at = arm.forward(&pose.joints).then(&tool);
        assert!(at.position.distance(place.base_from_part().apply(stop.at)) < 1e-6);
        assert!((at.rotation * DVec3::Z).distance(DVec3::NEG_Z) < 1e-9);
        if let Some(before) = before {
            assert!(distance(&pose.joints, &before) < 25.0, "{stop:?}: {before:?} to {:?}", pose.joints);
        }
        before = Some(pose.joints);
    }
}

#[test]
fn a_part_three_metres_away_is_refused_with_its_first_point() {
    let reach = robot::reach(&kuka(), place(3000.0, 0.0, 500.0, 0.0), &propeller());
    let bad = reach.first_bad().unwrap();
    assert_eq!((bad.stop.layer, bad.stop.pass, bad.stop.point), (0, 0, 0));
    assert!(matches!(bad.trouble, Trouble::OutOfReach { beyond, .. } if (1200.0..1700.0).contains(&beyond)));
    assert_eq!(bad.count, reach.poses.len());
    let sentence = bad.sentence();
    assert!(sentence.starts_with("Layer 1, pass 1, point 1") && sentence.contains("out of reach"), "{sentence}");
}

#[test]
fn a_part_half_within_reach_is_refused_where_reach_ends() {
    // A line straight away from the robot.
    let track = track(&[[0.0, 0.0, 2.0], [400.0, 0.0, 2.0], [800.0, 0.0, 2.0], [1200.0, 0.0, 2.0]]);
    let reach = robot::reach(&kuka(), place(1200.0, 0.0, 500.0, 0.0), &track);
    let bad = reach.first_bad().unwrap();
    assert!(bad.stop.arc && bad.stop.point >= 1 && reach.reached().count() > 10, "{bad:?}");
    assert!(matches!(bad.trouble, Trouble::OutOfReach { .. } | Trouble::Limit { .. }));
}

#[test]
fn a_limit_is_named_with_its_joint() {
    let mut narrow = kuka();
    narrow.arm.limits[0] = [-3.0, 3.0];
    // Left of the robot: the model's joint 1 would have to turn by some −27°.
    let reach = robot::reach(&narrow, place(1200.0, 600.0, 500.0, 0.0), &square());
    let bad = reach.first_bad().unwrap();
    assert!(matches!(bad.trouble, Trouble::Limit { joint: 0, angle, .. } if angle < -3.0), "{bad:?}");
    assert!(bad.sentence().contains("joint 1 would have to be at"), "{}", bad.sentence());
}

#[test]
fn a_slow_joint_is_found() {
    let mut slow = kuka();
    slow.arm.speeds[0] = 0.2;
    let track = track(&[[0.0, -100.0, 2.0], [0.0, 100.0, 2.0]]);
    let reach = robot::reach(&slow, slow.part, &track);
    let bad = reach.first_bad().unwrap();
    // 10 mm/s at some 1.2 m are 0.48 °/s.
    assert!(
        matches!(bad.trouble, Trouble::Speed { joint: 0, arc: true, speed, .. } if (0.3..0.7).contains(&speed)),
        "{bad:?}"
    );
    assert!(bad.sentence().contains("joint 1 would have to turn at"), "{}", bad.sentence());
}

#[test]
fn a_slow_travel_is_only_reported() {
    let mut slow = kuka();
    // Between what welding at 10 mm/s and travelling at 100 mm/s need.
    slow.arm.speeds[1] = 1.5;
    let reach = robot::reach(&slow, slow.part, &square());
    assert!(reach.is_reachable(), "{:?}", reach.findings);
    assert!(
        reach.findings.iter().any(|f| matches!(f.trouble, Trouble::Speed { joint: 1, arc: false, .. })),
        "{:?}",
        reach.joint(1)
    );
}

/// A torch at right angles to the flange, and axis 4 held fast: over (1173, 0) at 1150 mm the arm stands in the home
/// pose, whose J5 is 0.
#[test]
fn a_singular_wrist_is_reported() {
    let mut cell = kuka();
    cell.torch.position = [300.0, 0.0, 0.0];
    cell.torch.rotation = [0.0, 90.0, 0.0];
    cell.arm.limits[3] = [-1.0, 1.0];
    // Only the posture of the home pose is left.
    cell.arm.limits[0] = [-20.0, 20.0];
    cell.arm.limits[1] = [-100.0, -70.0];
    let line = track(&[[-20.0, 0.0, 0.0], [20.0, 0.0, 0.0]]);
    let reach = robot::reach(&cell, place(1173.0, 0.0, 1150.0, 0.0), &line);
    let found = reach.findings.iter().find(|f| matches!(f.trouble, Trouble::Wrist { .. })).unwrap();
    assert!(matches!(found.worst.1, Trouble::Wrist { margin } if margin < 0.5), "{found:?}");
    assert!(!found.trouble.is_fatal() && found.sentence().contains("singularity"), "{}", found.sentence());
    // With axis 4 free the torch is turned away from it.
    cell.arm.limits = kuka().arm.limits;
    let free = robot::reach(&cell, place(1173.0, 0.0, 1150.0, 0.0), &line);
    assert!(free.findings.is_empty() && free.least_margin().unwrap() > 20.0, "{:?}", free.findings);
}

#[test]
fn the_torch_turns_only_where_that_helps() {
    let reach = robot::reach(&kuka(), kuka().part, &square());
    assert_eq!(reach.turning.range.0, reach.turning.range.1);
    // Axis 6 held in a narrow range on a way round the robot: no single angle would do.
    let mut cell = kuka();
    cell.arm.limits[5] = [-25.0, 25.0];
    let arc: Vec<[f64; 3]> = (-6..=6)
        .map(|k| (f64::from(k) * 10.0).to_radians())
        .map(|a| [1200.0 * a.cos(), 1200.0 * a.sin(), 2.0])
        .collect();
    let reach = robot::reach(&cell, place(0.0, 0.0, 500.0, 0.0), &track(&arc));
    assert!(reach.is_reachable(), "{:?}", reach.findings);
    assert!(reach.turning.range.1 - reach.turning.range.0 >= 60.0, "{:?}", reach.turning);
    assert!(reach.turning.single_margin < 0.0, "{:?}", reach.turning);
    check_way(&cell, reach.place, &reach);
}

#[test]
fn a_suggested_place_is_better() {
    let (cell, track) = (abb(), square());
    for start in [cell.part, place(3000.0, 0.0, 500.0, 0.0)] {
        let found = robot::suggest(&cell, start, &track).unwrap();
        let before = robot::reach(&cell, start, &track);
        let after = robot::reach(&cell, found.place, &track);
        assert!(after.is_reachable() && found.place.position[2] >= 0.0);
        let least = |reach: &Reach| if reach.is_reachable() { reach.least_margin().unwrap() } else { -1.0 };
        assert!(least(&after) > least(&before), "{} {}", least(&after), least(&before));
        assert_eq!(found, robot::suggest(&cell, start, &track).unwrap());
    }
    let long = self::track(&[[-4000.0, 0.0, 2.0], [4000.0, 0.0, 2.0]]);
    assert_eq!(robot::suggest(&cell, cell.part, &long), None);
}

/// A part far along a track brings the robot to it; the table beside it is seen from there.
#[test]
fn a_linear_axis_brings_the_robot_near() {
    let with = |sections: &str| Cell::parse(&format!("{}\n{sections}", BUILT_IN[0].1)).unwrap();
    let axis = "[linear_axis]\ndirection = [0.0, 2.0, 0.0]\nlimits = [-500.0, 6000.0]\n";
    let part = square();
    let near = place(1200.0, 0.0, 500.0, 0.0);
    let own = robot::reach(&kuka(), near, &part).least_margin().unwrap();
    for (y, turn) in [(3000.0, 0.0), (4520.0, 30.0)] {
        let far = place(1200.0, y, 500.0, turn);
        assert!(!robot::reach(&kuka(), far, &part).is_reachable());
        let found = robot::external_axes(&with(axis), far, &part);
        let station = found.station.unwrap();
        assert!(station.at_zero.is_none() && (station.position - y).abs() < 900.0, "{station:?}");
        // The part is seen as far nearer as the robot has gone.
        assert!((found.place.position[1] - (y - station.position)).abs() < 1e-9 && found.place.rotation == turn);
        let reach = robot::reach(&found.cell, found.place, &part);
        assert!(reach.is_reachable() && reach.least_margin().unwrap() > own - 10.0, "{:?}", reach.least_margin());
        // Walked anew where the part really lies near: the same joints.
        let bare = robot::reach(&kuka(), found.place, &part);
        let joints = |reach: &robot::Reach| reach.reached().map(|(_, pose)| pose.joints).collect::<Vec<_>>();
        assert_eq!(joints(&reach), joints(&bare));
    }
    // A part that lies well leaves the robot where it is; without an axis it stays, too.
    let found = robot::external_axes(&with(axis), near, &part);
    assert!(found.station.unwrap().position.abs() < 1e-9 && found.place == near);
    assert_eq!(robot::external_axes(&kuka(), near, &part).station, None);
    let table = "[table]\naxis = [1600.0, 3000.0]\ndirection = 1\nlimits = [-180.0, 180.0]\n";
    let found = robot::external_axes(&with(&format!("{axis}{table}")), place(1600.0, 3000.0, 500.0, 0.0), &part);
    let moved = found.station.unwrap().position;
    assert_eq!(found.cell.table.unwrap().axis, [1600.0, 3000.0 - moved]);
    for (keys, word) in [
        ("direction = [0.0, 0.0, 0.0]\nlimits = [0.0, 1.0]", "linear_axis.direction"),
        ("direction = [0.0, 1.0, 0.0]\nlimits = [1.0, 1.0]", "linear_axis.limits"),
    ] {
        let error = Cell::parse(&format!("{}\n[linear_axis]\n{keys}\n", BUILT_IN[0].1)).unwrap_err().to_string();
        assert!(error.contains(word), "{error}");
    }
}

/// A part that sticks out on the far side of a table is turned towards the robot.
#[test]
fn a_table_brings_the_part_near() {
    let with_table = |table: &str| Cell::parse(&format!("{}\n[table]\n{table}", BUILT_IN[0].1)).unwrap();
    let cell = with_table("axis = [1600.0, 0.0]\ndirection = -1\nlimits = [-180.0, 180.0]\n");
    let far = track(&[[300.0, -50.0, 2.0], [500.0, -50.0, 2.0], [500.0, 50.0, 2.0]]);
    let start = place(1600.0, 0.0, 500.0, 0.0);
    assert!(!robot::reach(&cell, start, &far).is_reachable());
    let found = robot::turn_table(&cell, start, &far).unwrap();
    assert!(found.unturned.is_none() && found.margin > 10.0 && found.angle.abs() > 45.0, "{found:?}");
    assert!(robot::reach(&cell, found.place, &far).is_reachable());
    // The axis is where it was, and the table's positive direction is clockwise.
    assert_eq!(found.place.position, start.position);
    assert!((found.place.rotation + found.angle).rem_euclid(360.0) < 1e-9, "{found:?}");
    let turned = place(1700.0, 0.0, 500.0, 10.0).turned_about(cell.table.as_ref().unwrap(), 90.0);
    assert!(DVec3::from(turned.position).distance(DVec3::new(1600.0, -100.0, 500.0)) < 1e-9, "{turned:?}");
    assert!((turned.rotation + 80.0).abs() < 1e-9);
    // A part in the middle is as well anywhere, and stays; limits are kept; without a table nothing is turned.
    let middle = robot::turn_table(&cell, cell.part, &square()).unwrap();
    assert_eq!((middle.angle, Some(middle.margin)), (0.0, middle.unturned));
    let narrow = with_table("axis = [1600.0, 0.0]\ndirection = 1\nlimits = [-20.0, 20.0]\n");
    assert!(robot::turn_table(&narrow, start, &far).is_none_or(|t| t.angle.abs() <= 20.0));
    assert_eq!(robot::turn_table(&kuka(), start, &far), None);
    for (table, word) in [
        ("axis = [1e9, 0.0]\ndirection = 1\nlimits = [-20.0, 20.0]", "table.axis"),
        ("axis = [0.0, 0.0]\ndirection = 2\nlimits = [-20.0, 20.0]", "table.direction"),
        ("axis = [0.0, 0.0]\ndirection = 1\nlimits = [20.0, -20.0]", "table.limits"),
    ] {
        let error = Cell::parse(&format!("{}\n[table]\n{table}\n", BUILT_IN[0].1)).unwrap_err().to_string();
        assert!(error.contains(word), "{error}");
    }
}

#[test]
fn errors_of_cells_name_the_line() {
    let text = BUILT_IN[0].1;
    let line = |needle: &str| text.lines().position(|l| l.starts_with(needle)).unwrap() + 1;
    let refused = |from: &str, to: &str| Cell::parse(&text.replacen(from, to, 1)).unwrap_err();
    match refused("c2 = 780.0", "c2 = -780.0") {
        CellError::Value { line: at, key, .. } => assert_eq!((at, key), (line("c2"), "arm.c2")),
        other => panic!("{other}"),
    }
    let error = refused("speeds = ", "speedz = ").to_string();
    assert!(
        error.contains(&format!("line {}", line("speeds"))) && error.contains("Did you mean \"speeds\"?"),
        "{error}"
    );
    assert!(refused("signs = [-1,", "signs = [0,").to_string().contains("each sign is 1 or -1"));
    assert!(refused("[-185.0, 185.0]", "[185.0, -185.0]").to_string().contains("the least angle comes first"));
    assert!(refused("offsets = [0.0", "offsets = [nan").to_string().contains("arm.offsets"));
    assert!(refused("rotation = 0.0", "rotation = \"x\"").to_string().contains("line"));
    assert!(Cell::built_in("kuka-kr20").unwrap_err().to_string().contains("Did you mean \"kuka-kr20-r1810\"?"));
}

#[test]
fn long_moves_are_divided_and_keep_their_time() {
    let track = track(&[[0.0, 0.0, 2.0], [105.0, 0.0, 2.0]]);
    let welding: Vec<_> = track.stops.iter().filter(|s| s.arc).collect();
    assert_eq!(welding.len(), 6);
    assert!((welding.iter().map(|s| s.seconds).sum::<f64>() - 10.5).abs() < 1e-9);
    assert!(track.stops.windows(2).all(|w| w[0].at.distance(w[1].at) <= 20.0 + 1e-9));
    assert!(welding.iter().all(|s| s.point == 1 && s.pass == 0));
}

#[test]
fn the_page_holds_findings_and_plots() {
    let reach = robot::reach(&kuka(), kuka().part, &square());
    let page = beadwright::report::reach::page("square", &kuka(), &reach, None).html();
    assert!(page.contains("can be welded by kuka-kr20-r1810") && page.matches("<svg").count() == 3);
    let far = robot::reach(&kuka(), place(3000.0, 0.0, 0.0, 0.0), &square());
    let page = beadwright::report::reach::page("square", &kuka(), &far, None).html();
    assert!(page.contains("cannot be welded") && page.contains("out of reach"));
}

#[test]
fn absurd_places_are_refused_without_harm() {
    for far in [1e5, 1e300, f64::MAX] {
        let reach = robot::reach(&kuka(), place(far, far, far, 1.0), &square());
        assert!(!reach.is_reachable());
    }
    let reach = robot::reach(&kuka(), kuka().part, &Track::default());
    assert!(reach.is_reachable() && reach.least_margin().is_none());
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, failure_persistence: None, ..ProptestConfig::default() })]

    /// Part and place turned about axis 1 together: only joint 1 follows.
    #[test]
    fn turning_the_place_about_axis_1_turns_joint_1_only(turn in -90.0..90.0_f64, x in 1000.0..1300.0_f64, abb_too in any::<bool>()) {
        let (cell, sign) = if abb_too { (abb(), 1.0) } else { (kuka(), -1.0) };
        let x = if abb_too { x - 250.0 } else { x };
        let turned = DQuat::from_rotation_z(turn.to_radians()) * DVec3::new(x, 150.0, 400.0);
        let a = robot::reach(&cell, place(x, 150.0, 400.0, 0.0), &square());
        let b = robot::reach(&cell, PartPlace { position: turned.to_array(), rotation: turn }, &square());
        prop_assert_eq!(a.branch, b.branch);
        for ((_, p), (_, q)) in a.reached().zip(b.reached()) {
            prop_assert!((q.joints[0] - p.joints[0] - sign * turn).abs() < 1e-6);
            prop_assert!((1..6).all(|j| (q.joints[j] - p.joints[j]).abs() < 1e-6), "{:?} {:?}", p.joints, q.joints);
        }
    }

    /// A frame and its inverse are nothing.
    #[test]
    fn frames_and_their_inverses_undo_each_other(p in prop::array::uniform3(-1e3..1e3_f64), r in prop::array::uniform3(-3.0..3.0_f64)) {
        let frame = Frame { position: p.into(), rotation: DQuat::from_euler(glam::EulerRot::ZYX, r[0], r[1], r[2]) };
        let back = frame.then(&frame.inverse());
        prop_assert!(back.position.length() < 1e-9 && back.rotation.angle_between(DQuat::IDENTITY) < 1e-6);
    }

    /// What a cell's text says wrongly is refused or taken, and never a panic.
    #[test]
    fn any_cell_text_is_taken_or_refused(at in 0..2000_usize, with in "[-0-9.a-z\\[\\]= \n]{0,4}") {
        let text = BUILT_IN[1].1;
        let at = (0..=at.min(text.len())).rev().find(|&i| text.is_char_boundary(i)).unwrap();
        let end = (at + 3..text.len()).find(|&i| text.is_char_boundary(i)).unwrap_or(text.len());
        let changed = format!("{}{with}{}", &text[..at], &text[end..]);
        if let Ok(cell) = Cell::parse(&changed) {
            robot::reach(&cell, cell.part, &track(&[[0.0, 0.0, 2.0], [10.0, 0.0, 2.0]]));
        }
    }
}
