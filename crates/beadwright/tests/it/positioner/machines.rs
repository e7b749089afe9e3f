//! CNC machines whose torch cannot turn, with axes under the part.

use super::{about, along, chuck, planned, read, same_path, tilting};
use crate::readers;
use crate::readers::distance;
use beadwright::dialect;
use beadwright::dialect::gcode::GcodePositioner;
use beadwright::dialect::reading;
use beadwright::layer::Layer;
use beadwright::profile::Profile;
use beadwright::program::{Positioner, Turning};
use glam::{DQuat, DVec3};
use std::io::Write;
use std::process::{Command, Stdio};

/// The machines: on a table that tilts about x or y, or in a chuck with its axis along x.
fn machines() -> Vec<(&'static str, Positioner, &'static [&'static str], f64)> {
    let about_y = |turning| {
        let mut positioner = tilting(turning);
        positioner.axes[0].direction = [0.0, 1.0, 0.0];
        positioner
    };
    // With the part's x up, its z lies against the machine's x.
    let mut lying = chuck();
    lying.axes[0].direction = [0.0, 0.0, -1.0];
    vec![
        ("hub", tilting(Turning::Follow), &["A", "C"], 0.05),
        ("elbow", about_y(Turning::Follow), &["B", "C"], 0.05),
        ("y-tube", about_y(Turning::Index), &["B", "C"], 0.05),
        ("elbow", tilting(Turning::Index), &["A", "C"], 0.05),
        ("dome", tilting(Turning::Follow), &["A", "C"], 5.0),
        ("shaft", lying, &["A"], 0.05),
    ]
}

/// On a machine with three axes the torch cannot turn, so all of it is done by the part.
#[test]
fn a_torch_that_cannot_turn_welds_the_planned_path_on_a_part_that_does() {
    for (name, positioner, words, allowed) in machines() {
        let (layers, plain) = planned(name);
        a_machine_welds_it(name, &layers, &plain, (&positioner, words), allowed);
    }
}

/// A program that can begin at any pass turns the part from its beginning as one that cannot.
#[test]
fn a_machine_turns_the_part_alike_where_programs_can_begin_anywhere() {
    let (layers, plain) = planned("y-tube");
    let positioner = tilting(Turning::Index);
    let mut profile = machine(&plain, &positioner, &["A", "C"]);
    let welds = |profile: &Profile| {
        let files = dialect::write("gcode", &layers, &profile.job("demo")).unwrap();
        readers::gcode::run(&files.into_values().next().unwrap(), 3, 5).welds
    };
    let once = welds(&profile);
    profile.program.restart = true;
    assert!(once == welds(&profile));
}

/// Places of X, Y, Z, A, B, C, and LinuxCNC's own joints for them; `BEADWRIGHT_LINUXCNC_KINEMATICS` is the program that
/// `benches/linuxcnc.sh` builds, followed by the folder of LinuxCNC's modules.
fn joints(module: &str, places: &[[f64; 6]]) -> Vec<[f64; 5]> {
    let variable = std::env::var("BEADWRIGHT_LINUXCNC_KINEMATICS").expect("set by benches/linuxcnc.sh");
    let (command, folder) = variable.split_once(':').unwrap();
    let mut run = Command::new(command)
        .arg(format!("{folder}/{module}.so"))
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let text: String = places.iter().map(|place| format!("{place:?}\n").replace(['[', ']', ','], " ")).collect();
    let mut input = run.stdin.take().unwrap();
    let writing = std::thread::spawn(move || input.write_all(text.as_bytes()).unwrap());
    let output = run.wait_with_output().unwrap();
    writing.join().unwrap();
    assert!(output.status.success());
    let numbers =
        |line: &str| line.split_whitespace().map(|n| n.parse().unwrap()).collect::<Vec<f64>>().try_into().unwrap();
    String::from_utf8(output.stdout).unwrap().lines().map(numbers).collect()
}

/// A move of LinuxCNC's interpreter: whether the arc burns, whether tool centre point control is on, and X, Y, Z, A, B, C.
struct Move {
    burns: bool,
    tip: bool,
    to: [f64; 6],
}

fn moves(canon: &str) -> Vec<Move> {
    let (mut burns, mut tip, mut moves) = (false, false, Vec::new());
    for line in canon.lines() {
        let Some((call, rest)) = line.split_once('(') else { continue };
        let values: Vec<f64> =
            rest.trim_end_matches(')').split(',').filter_map(|text| text.trim().parse().ok()).collect();
        match (call.split_whitespace().last().unwrap_or_default(), &values[..]) {
            ("STRAIGHT_TRAVERSE" | "STRAIGHT_FEED", &[x, y, z, a, b, c, ..]) => {
                moves.push(Move { burns, tip, to: [x, y, z, a, b, c] })
            }
            ("SET_AUX_OUTPUT_VALUE", &[3.0, value]) => tip = value == 1.0,
            ("START_SPINDLE_CLOCKWISE", _) => burns = true,
            ("STOP_SPINDLE_TURNING", _) => burns = false,
            _ => {}
        }
    }
    moves
}

/// LinuxCNC's own interpreter and kinematics: where its joints bring the torch's tip, on the part as the table has turned it, lies
/// the path of the plan. From the machine's axes the torch comes straight down.
#[test]
#[ignore = "needs LinuxCNC's interpreter and kinematics: run benches/linuxcnc.sh"]
fn the_joints_of_linuxcnc_bring_the_tip_to_the_planned_path() {
    for (name, positioner, words, _) in machines().into_iter().filter(|(_, _, words, _)| words.len() == 2) {
        let (layers, plain) = planned(name);
        let files = dialect::write("gcode", &layers, &machine(&plain, &positioner, words).job("demo")).unwrap();
        let moves = moves(&crate::cnc::canon(&files.into_values().next().unwrap()));
        let places: Vec<[f64; 6]> = moves.iter().map(|one| one.to).collect();
        let tilt = if words[0] == "A" { (3, DVec3::X) } else { (4, DVec3::Y) };
        let module = if words[0] == "A" { "xyzac-trt-kins" } else { "xyzbc-trt-kins" };
        // Without tool centre point control the joints are what the program says.
        let all = joints(module, &places);
        let joints: Vec<DVec3> = moves
            .iter()
            .zip(&all)
            .map(|(one, by)| {
                let [x, y, z] = if one.tip { [by[0], by[1], by[2]] } else { [one.to[0], one.to[1], one.to[2]] };
                DVec3::new(x, y, z)
            })
            .collect();
        let on_part = |k: usize| {
            let turned = about(tilt.1, moves[k].to[tilt.0]) * about(DVec3::Z, moves[k].to[5]);
            turned.transpose() * joints[k]
        };
        let mut found = Vec::new();
        for k in 1..moves.len() {
            if moves[k].burns {
                if !moves[k - 1].burns {
                    found.push(vec![on_part(k - 1)]);
                }
                found.last_mut().unwrap().push(on_part(k));
            }
            if moves[k].tip && !moves[k - 1].tip {
                let across = (joints[k] - joints[k - 1]).truncate().length();
                assert!(across < 0.01, "{name}: {across} mm across as it comes down");
            }
        }
        let by_torch = read("krl", &layers, &plain).welds;
        assert_eq!(found.len(), by_torch.len());
        let off = found.iter().zip(&by_torch).flat_map(|(found, weld)| {
            assert_eq!(found.len(), weld.points.len());
            found.iter().zip(&weld.points).map(|(a, b)| a.distance(DVec3::from_array(*b)))
        });
        let worst = off.fold(0.0, f64::max);
        println!("{name} {words:?}: {} places, the tip is off by {worst:.4} mm at most", places.len());
        assert!(worst <= 0.01, "{name}: {worst} mm");
    }
}

#[test]
fn a_machine_that_cannot_turn_the_part_is_refused() {
    let (layers, plain) = planned("shaft");
    let mut missing = plain.clone();
    missing.program.positioner = Some(chuck());
    let refused = |profile: &Profile| dialect::write("gcode", &layers, &profile.job("demo")).unwrap_err().to_string();
    assert!(refused(&missing).contains("gcode.positioner"), "{}", refused(&missing));
    assert!(refused(&plain).contains("layers.chart"), "{}", refused(&plain));
    let wrong = |change: fn(&mut Profile)| {
        let mut profile = machine(&plain, &chuck(), &["A"]);
        change(&mut profile);
        Profile::parse(&profile.toml_text().unwrap()).unwrap_err().to_string()
    };
    assert!(
        wrong(|p| p.dialects.gcode.as_mut().unwrap().positioner.as_mut().unwrap().axes = vec!["X".to_owned()])
            .contains("one letter")
    );
    assert!(
        wrong(|p| p.dialects.gcode.as_mut().unwrap().positioner.as_mut().unwrap().axes.push("C".to_owned()))
            .contains("number of axes")
    );
    assert!(
        wrong(|p| p.dialects.gcode.as_mut().unwrap().positioner.as_mut().unwrap().tcp_on.clear())
            .contains("the blocks of both")
    );
    assert!(wrong(|p| (p.program.arcs, p.program.chord_tolerance) = (true, 0.05)).contains("program.positioner.up"));
}

/// A machine of LinuxCNC with these axes under the part.
pub(super) fn machine(profile: &Profile, positioner: &Positioner, words: &[&str]) -> Profile {
    let mut profile = profile.clone();
    let lines = |line: &str| vec![line.to_owned()];
    let axes = words.iter().map(|word| (*word).to_owned()).collect();
    let gcode = profile.dialects.gcode.as_mut().unwrap();
    gcode.positioner = Some(GcodePositioner { axes, tcp_on: lines("M428"), tcp_off: lines("M429") });
    profile.program.positioner = Some(positioner.clone());
    profile
}

/// The same of a machine with these words for its axes, in the words of LinuxCNC and of Siemens.
pub(super) fn a_machine_welds_it(
    name: &str,
    layers: &[Layer],
    plain: &Profile,
    (positioner, words): (&Positioner, &[&str]),
    allowed: f64,
) {
    let case = format!("{name} {words:?} {:?}", positioner.turning);
    let turned = machine(plain, positioner, words);
    let files = dialect::write("gcode", layers, &turned.job("demo")).unwrap();
    let text = files.into_values().next().unwrap();
    let mut welds = readers::gcode::run(&text, 3, 5).welds;
    let by_torch = read("krl", layers, plain).welds;
    // From the machine, with all axes at 0, to the part.
    let lies = DQuat::from_rotation_arc(DVec3::Z, DVec3::from(positioner.up));
    for weld in &mut welds {
        weld.points.iter_mut().for_each(|at| *at = (lies * DVec3::from_array(*at)).to_array());
    }
    same_path(&case, &by_torch, &welds);
    let leans = welds.iter().zip(&by_torch).flat_map(|(weld, other)| {
        let tools = weld.tools.iter().zip(&other.tools);
        tools.map(|(a, b)| (lies * (*a * DVec3::Z)).angle_between(*b * DVec3::Z).to_degrees())
    });
    let worst = leans.fold(0.0, f64::max);
    assert!(worst <= allowed, "{case}: the wire leans by {worst}° on the part");
    // The path is a program's own reading of it, too.
    let program = dialect::read(&text, &mut |_| None, &reading::Options::default()).unwrap();
    let own: f64 = program.layers().iter().flat_map(|layer| &layer.passes).map(|pass| along(&pass.points)).sum();
    let length: f64 = welds.iter().flat_map(|weld| weld.points.windows(2)).map(|p| distance(p[0], p[1])).sum();
    assert!((own / length - 1.0).abs() < 1e-3, "{case}: {own} mm read, {length} mm welded");
    assert_eq!(program.notes, Vec::<String>::new(), "{case}");
    // In the words of Siemens it says the same.
    let mut siemens = turned.clone();
    let own = siemens.dialects.gcode.as_mut().unwrap().positioner.as_mut().unwrap();
    own.axes.iter_mut().for_each(|axis| axis.push('='));
    (own.tcp_on[0], own.tcp_off[0]) = ("TRAORI".to_owned(), "TRAFOOF".to_owned());
    let other = dialect::write("gcode", layers, &siemens.job("demo")).unwrap().into_values().next().unwrap();
    let again = dialect::read(&other, &mut |_| None, &reading::Options::default()).unwrap();
    assert_eq!(again.notes, Vec::<String>::new(), "{case}");
    for (layer, other) in program.layers().iter().zip(again.layers()) {
        assert_eq!(*layer, other, "{case}");
    }
    let translated = other.replace("=", "").replace("TRAORI", "M428").replace("TRAFOOF", "M429");
    assert_eq!(translated, text.replace("=", ""), "{case}");
}
