//! Arms that are chains: the UR arms by Denavit-Hartenberg rows and by URDF, both kinds of wrist, calibrated axes, and
//! URDF files that are refused.

use crate::common;

use beadwright::robot::cell::BUILT_IN;
use beadwright::robot::{self, Arm, Cell, Frame, PartPlace, Shape};
use common::{planned, profile};
use glam::{DMat4, DQuat, DVec3};

/// Rows a, d, alpha of the UR10e as its maker publishes them, m and rad.
const UR10E: [[f64; 3]; 6] = {
    let quarter = std::f64::consts::FRAC_PI_2;
    [
        [0.0, 0.1807, quarter],
        [-0.6127, 0.0, 0.0],
        [-0.571_55, 0.0, 0.0],
        [0.0, 0.174_15, quarter],
        [0.0, 0.119_85, -quarter],
        [0.0, 0.116_55, 0.0],
    ]
};

/// One joint of a URDF file.
fn joint(name: &str, kind: &str, [parent, child]: [&str; 2], [a, d, alpha]: [f64; 3], speed: f64) -> String {
    let turn = 2.0 * std::f64::consts::PI;
    format!(
        "  <joint name=\"{name}\" type=\"{kind}\">\n    <origin xyz=\"{a} 0 {d}\" rpy=\"{alpha} 0 0\"/>\n    <parent link=\"{parent}\"/>\n\
         \x20   <child link=\"{child}\"/>\n    <axis xyz=\"0 0 1\"/>\n\
         \x20   <limit lower=\"{}\" upper=\"{turn}\" effort=\"330\" velocity=\"{}\"/>\n  </joint>\n",
        -turn,
        speed.to_radians()
    )
}

/// A URDF file of an arm by its rows: each row is the origin of what follows it.
fn urdf(rows: &[[f64; 3]; 6]) -> String {
    let links = ["base_link", "shoulder", "upper_arm", "forearm", "wrist_1", "wrist_2", "wrist_3", "tool0"];
    let mut text = "<?xml version=\"1.0\"?>\n<robot name=\"arm\">\n  <link name=\"base_link\"/>\n".to_owned();
    for i in 0..7 {
        let row = if i == 0 { [0.0; 3] } else { rows[i - 1] };
        let (kind, speed) = (if i < 6 { "revolute" } else { "fixed" }, if i < 2 { 120.0 } else { 180.0 });
        text += &joint(&format!("joint_{}", i + 1), kind, [links[i], links[i + 1]], row, speed);
    }
    // A camera on a side branch, and a transmission that names a joint.
    text += &joint("camera", "fixed", ["forearm", "camera"], [0.0; 3], 1.0);
    text + "  <transmission name=\"t\"><joint name=\"joint_1\"><x/></joint></transmission>\n</robot>\n"
}

fn ur10e() -> Cell {
    Cell::built_in("ur10e").unwrap()
}

/// Angles within the limits, always the same ones.
fn random_joints(arm: &Arm, seed: u64) -> impl FnMut() -> [f64; 6] {
    let (mut state, limits) = (seed, arm.limits);
    move || {
        limits.map(|[low, high]| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            low + (high - low) * (state >> 11) as f64 / (1_u64 << 53) as f64
        })
    }
}

/// The product of the matrices of Denavit and Hartenberg, mm.
fn by_matrices(rows: &[[f64; 3]; 6], joints: &[f64; 6]) -> DMat4 {
    rows.iter().zip(joints).fold(DMat4::IDENTITY, |all, ([a, d, alpha], q)| {
        let at = DVec3::new(0.0, 0.0, d * 1e3);
        let along = DMat4::from_translation(DVec3::new(a * 1e3, 0.0, 0.0)) * DMat4::from_rotation_x(*alpha);
        all * DMat4::from_rotation_z(q.to_radians()) * DMat4::from_translation(at) * along
    })
}

fn off(a: &Frame, b: &Frame) -> (f64, f64) {
    let turned = |axis: DVec3| (a.rotation * axis).distance(b.rotation * axis);
    (a.position.distance(b.position), turned(DVec3::Z).max(turned(DVec3::X)))
}

/// Every solution leads to the flange, the one it was made with is among them, and each has a branch of its own.
#[track_caller]
fn there_and_back(arm: &Arm, poses: usize) -> usize {
    let (mut next, mut most) = (random_joints(arm, 3), 0);
    for _ in 0..poses {
        let joints = next();
        let flange = arm.forward(&joints);
        let found = arm.inverse(&flange);
        for (_, solution) in &found {
            let (mm, rad) = off(&arm.forward(solution), &flange);
            assert!(mm < 1e-4 && rad < 1e-6, "{joints:?}: {mm} mm, {rad} rad");
        }
        let same = |a: f64, b: f64| ((a - b + 540.0).rem_euclid(360.0) - 180.0).abs() < 1e-3;
        assert!(found.iter().any(|(_, s)| s.iter().zip(joints).all(|(a, b)| same(*a, b))), "{joints:?}: {found:?}");
        let branches: std::collections::BTreeSet<_> = found.iter().map(|(branch, _)| *branch).collect();
        assert_eq!(branches.len(), found.len(), "{joints:?}: {found:?}");
        most = most.max(found.len());
    }
    most
}

#[test]
fn the_ur10e_by_urdf_is_the_built_in_one() {
    let (built_in, read) = (ur10e(), ur10e().with_urdf(&urdf(&UR10E)).unwrap());
    let (a, b) = (built_in.arm(), read.arm());
    let mut next = random_joints(&a, 5);
    for _ in 0..2000 {
        let joints = next();
        let truth = by_matrices(&UR10E, &joints);
        for arm in [&a, &b] {
            let flange = arm.forward(&joints);
            assert!(flange.position.distance(truth.w_axis.truncate()) < 1e-6, "{joints:?}");
            assert!((flange.rotation * DVec3::Z).distance(truth.z_axis.truncate()) < 1e-9, "{joints:?}");
        }
    }
    assert_eq!(a.speeds, [120.0, 120.0, 180.0, 180.0, 180.0, 180.0]);
    for joint in 0..6 {
        assert!((a.speeds[joint] - b.speeds[joint]).abs() < 1e-9);
        assert!((b.limits[joint][0] + 360.0).abs() < 1e-9 && (b.limits[joint][1] - 360.0).abs() < 1e-9);
    }
}

#[test]
fn a_ur_arm_has_eight_ways_and_comes_back_by_each() {
    for name in ["ur5e", "ur10e"] {
        assert_eq!(there_and_back(&Cell::built_in(name).unwrap().arm(), 20_000), 8, "{name}");
    }
}

/// A welding robot with a spherical wrist as a chain: the same as by its six lengths.
#[test]
fn a_spherical_wrist_by_urdf_is_the_one_by_lengths() {
    let kuka = Cell::built_in("kuka-kr20-r1810").unwrap();
    // Axes of the KR 20 at zero: stretched level, A1, A4 and A6 clockwise.
    let joints = [
        ("0 0 0", "0 0 -1"),
        ("0.16 0 0.52", "0 1 0"),
        ("0.78 0 0", "0 1 0"),
        ("0 0 0.15", "-1 0 0"),
        ("0.86 0 0", "0 1 0"),
        ("0 0 0", "-1 0 0"),
    ];
    let mut text = "<robot name=\"kuka\">".to_owned();
    for (i, (at, axis)) in joints.iter().enumerate() {
        let [low, high] = kuka.arm.limits[i].map(f64::to_radians);
        text += &format!(
            "<joint name=\"a{i}\" type=\"revolute\"><parent link=\"l{i}\"/><child link=\"l{}\"/><origin xyz=\"{at}\"/>\
             <axis xyz=\"{axis}\"/><limit lower=\"{low}\" upper=\"{high}\" velocity=\"3\"/></joint>",
            i + 1
        );
    }
    text += "<joint name=\"f\" type=\"fixed\"><parent link=\"l6\"/><child link=\"flange\"/>\
             <origin xyz=\"0.153 0 0\" rpy=\"0 1.5707963267948966 0\"/></joint></robot>";
    let (a, b) = (kuka.arm(), kuka.clone().with_urdf(&text).unwrap().arm());
    let mut next = random_joints(&a, 9);
    let turn = a.forward(&[0.0; 6]).rotation.conjugate() * b.forward(&[0.0; 6]).rotation;
    for _ in 0..2000 {
        let joints = next();
        let mut flange = a.forward(&joints);
        assert!(flange.position.distance(b.forward(&joints).position) < 1e-6, "{joints:?}");
        assert!(a.links(&joints).iter().zip(b.links(&joints)).skip(1).all(|(p, q)| p.distance(q) < 1e-6));
        let (m, n) = (a.margins(&joints), b.margins(&joints));
        assert!((m.wrist - n.wrist).abs() < 1e-6 && (m.elbow - n.elbow).abs() < 1e-6, "{m:?} {n:?}");
        let mine = a.inverse(&flange);
        flange.rotation *= turn;
        let mut theirs = b.inverse(&flange);
        theirs.retain(|(branch, other)| {
            mine.iter()
                .any(|(own, joints)| own == branch && joints.iter().zip(other).all(|(p, q)| (p - q).abs() < 1e-3))
        });
        assert_eq!(theirs.len(), mine.len(), "{joints:?}");
    }
    there_and_back(&b, 5000);
}

/// A calibrated arm, whose axes are a little askew: no closed form is exact, all solutions are.
#[test]
fn a_calibrated_arm_is_exact_too() {
    let mut rows = UR10E;
    for (i, row) in rows.iter_mut().enumerate() {
        let sign = if i % 2 == 0 { 1.0 } else { -1.0 };
        (row[0], row[1], row[2]) = (row[0] + 3e-4 * sign, row[1] - 2e-4, row[2] + 8e-4 * sign);
    }
    let arm = ur10e().with_urdf(&urdf(&rows)).unwrap().arm();
    let (mut next, mut own, poses) = (random_joints(&arm, 17), 0, 5000);
    for _ in 0..poses {
        let joints = next();
        let flange = arm.forward(&joints);
        let truth = by_matrices(&rows, &joints).w_axis.truncate();
        assert!(flange.position.distance(truth) < 1e-6);
        let found = arm.inverse(&flange);
        assert!(found.iter().all(|(_, s)| off(&arm.forward(s), &flange).0 < 2e-4));
        let same = |a: f64, b: f64| ((a - b + 540.0).rem_euclid(360.0) - 180.0).abs() < 1e-3;
        own += usize::from(found.iter().any(|(_, s)| s.iter().zip(joints).all(|(a, b)| same(*a, b))));
    }
    // Beside a singularity, where ideal axes do not reach at all, a way may be missed.
    assert!(own as f64 > 0.97 * f64::from(poses), "{own} of {poses}");
}

#[test]
fn beyond_its_reach_an_arm_says_how_far() {
    let arm = ur10e().arm();
    let down = DQuat::from_rotation_x(std::f64::consts::PI);
    let at = |x: f64, y: f64, z: f64| Frame { position: DVec3::new(x, y, z), rotation: down };
    assert_eq!(arm.beyond(&at(700.0, 0.0, 200.0)), 0.0);
    assert!((arm.reach() - 1184.25).abs() < 1e-9);
    let (near, far) = (arm.beyond(&at(2000.0, 0.0, 200.0)), arm.beyond(&at(2500.0, 0.0, 200.0)));
    assert!((far - near - 500.0).abs() < 5.0 && near > 500.0, "{near} {far}");
    assert!(arm.inverse(&at(2000.0, 0.0, 200.0)).is_empty());
    // The flange cannot come nearer to axis 1 than the wrist lies beside it.
    assert!(arm.inverse(&at(50.0, 0.0, 300.0)).is_empty() && arm.beyond(&at(50.0, 0.0, 300.0)) > 100.0);
    for far in [1e5, 1e300, f64::MAX, f64::NAN] {
        assert!(arm.inverse(&at(far, far, far)).is_empty());
    }
}

#[test]
fn the_propeller_is_welded_by_the_ur10e() {
    let plan = planned("propeller", &profile("cmt-al2319-kuka"));
    let track = profile("cmt-al2319-kuka").track(&plan.layers);
    let cell = ur10e();
    let reach = robot::reach(&cell, cell.part, &track);
    assert!(reach.is_reachable() && reach.findings.is_empty(), "{:?}", reach.findings);
    assert!(reach.least_margin().unwrap() > 45.0);
    let (arm, tool) = (cell.arm(), cell.flange_from_tool());
    for (stop, pose) in reach.reached() {
        let at = arm.forward(&pose.joints).then(&tool);
        assert!(at.position.distance(cell.part.base_from_part().apply(stop.at)) < 1e-4);
        assert!((at.rotation * DVec3::Z).distance(DVec3::NEG_Z) < 1e-6);
    }
    // By URDF the same is reached, within 0.1 mm of each other; far away neither reaches it.
    let mut by_urdf = cell.clone().with_urdf(&urdf(&UR10E)).unwrap();
    by_urdf.arm.limits = cell.arm.limits;
    let other = robot::reach(&by_urdf, cell.part, &track);
    assert_eq!((reach.branch, reach.poses.len()), (other.branch, other.poses.len()));
    for ((_, a), (_, b)) in reach.reached().zip(other.reached()) {
        let [a, b] = [a, b].map(|pose| arm.forward(&pose.joints).then(&tool));
        assert!(a.position.distance(b.position) < 0.1);
    }
    let far = PartPlace { position: [1500.0, 0.0, 0.0], rotation: 0.0 };
    for cell in [&cell, &by_urdf] {
        let bad = robot::reach(cell, far, &track);
        assert!(bad.first_bad().unwrap().sentence().contains("out of reach"));
    }
}

/// What is changed in the text, and words of the sentence that refuses it.
const BROKEN: [(&str, &str, &[&str]); 13] = [
    ("<robot name=\"arm\">", "<robot name=\"arm\"", &["not a URDF file"]),
    ("robot", "sdf", &["outermost element is <sdf>"]),
    ("<robot name", "<robot xmlns:xacro=\"http://ros.org/wiki/xacro\" name", &[]),
    ("<link name=\"base_link\"/>", "<xacro:arm xmlns:xacro=\"http://www.ros.org/wiki/xacro\"/>", &["xacro robot"]),
    ("type=\"revolute\"", "type=\"prismatic\"", &["joint \"joint_1\"", "prismatic"]),
    ("type=\"revolute\"", "type=\"fixed\"", &["six turning joints", "5: joint_2"]),
    ("type=\"revolute\"", "", &["joint \"joint_1\"", "type"]),
    ("<parent link=\"base_link\"/>", "", &["line 4, joint \"joint_1\"", "<parent link"]),
    ("xyz=\"0 0 0\"", "xyz=\"0 0\"", &["xyz=\"0 0\"", "three numbers"]),
    ("xyz=\"0 0 0\"", "xyz=\"0 nan 0\"", &["three numbers"]),
    ("<axis xyz=\"0 0 1\"/>", "<axis xyz=\"0 0 0\"/>", &["no direction"]),
    ("velocity=", "speed=", &["<limit velocity", "joint \"joint_1\""]),
    ("link=\"tool0\"", "link=\"tip\"", &["tip, camera", "arm.tip"]),
];

#[test]
fn broken_urdf_files_are_refused_with_a_sentence() {
    let text = urdf(&UR10E);
    for (from, to, words) in BROKEN {
        let changed = if from == "robot" { text.replace(from, to) } else { text.replacen(from, to, 1) };
        assert_ne!(changed, text, "{from}");
        match ur10e().with_urdf(&changed) {
            // A template's name space alone does no harm.
            Ok(_) => assert!(words.is_empty(), "{to} was taken"),
            Err(error) => {
                let sentence = error.to_string();
                assert!(!words.is_empty() && words.iter().all(|word| sentence.contains(word)), "{to}: {sentence}");
            }
        }
    }
    let endless = text.replace("<parent link=\"base_link\"/>", "<parent link=\"wrist_3\"/>");
    assert!(ur10e().with_urdf(&endless).unwrap_err().to_string().contains("loop"));
    // Joint 3 across joint 2: no closed form.
    let mut askew = UR10E;
    askew[1][2] = 1.0;
    let error = ur10e().with_urdf(&urdf(&askew)).unwrap_err().to_string();
    assert!(error.contains("joints 2 and 3 are not parallel"), "{error}");
    // Cut short anywhere, it is refused or read, and never a panic.
    for end in (0..text.len()).step_by(37) {
        assert!(ur10e().with_urdf(&text[..end]).is_err());
    }
}

#[test]
fn a_cell_names_its_urdf_file() {
    let text = BUILT_IN.iter().find(|(name, _)| *name == "ur10e").unwrap().1;
    let without = |key: &str| {
        let lines: Vec<&str> = text.lines().filter(|line| !line.starts_with(key)).collect();
        lines.join("\n")
    };
    let named =
        without("dh =").replace("[arm]\n", "[arm]\nurdf = \"arm.urdf\"\nbase = \"base_link\"\ntip = \"wrist_3\"\n");
    let cell = Cell::parse_with(&named, |file| Ok(format!("{}<!-- {file} -->", urdf(&UR10E)))).unwrap();
    // The cell's own limits and speeds hold; the tip lies on axis 6 before the last row.
    assert!(matches!(cell.arm.shape, Shape::Chain(_)) && cell.arm.limits == ur10e().arm.limits);
    let (a, b) = (cell.arm().forward(&[0.0; 6]), ur10e().arm().forward(&[0.0; 6]));
    assert!((a.position.distance(b.position) - 116.55).abs() < 1e-6);
    for (error, words) in [
        (Cell::parse(&named).unwrap_err(), "arm.urdf of arm.urdf"),
        (Cell::parse_with(&named, |_| Ok(String::new())).unwrap_err(), "not a URDF file"),
        (Cell::parse(&without("dh =")).unwrap_err(), "the key \"a1\" is missing"),
        (Cell::parse(&without("limits =")).unwrap_err(), "the key \"limits\" is missing"),
        (Cell::parse(&text.replace("[arm]\n", "[arm]\nc2 = 3.0\n")).unwrap_err(), "\"c2\" does not go with"),
        (Cell::parse(&text.replace("[arm]\n", "[arm]\ntip = \"x\"\n")).unwrap_err(), "\"tip\" does not go with"),
        (Cell::parse(&text.replace("180.7", "1e9")).unwrap_err(), "row 1"),
        (Cell::parse(&text.replace("-612.7, 0.0, 0.0", "-612.7, 0.0, 45.0")).unwrap_err(), "not parallel"),
    ] {
        assert!(error.to_string().contains(words), "{error}");
    }
    assert!(Cell::parse(&text.replace("180.7", "1e9")).unwrap_err().to_string().starts_with("line 10"));
}
