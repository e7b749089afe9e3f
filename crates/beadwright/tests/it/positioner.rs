//! Positioners in the programs: seen from the cell, the pool is level and the torch hangs as it always does, and on the part the path
//! is the one of the plan. The cell is computed here from the axes that independent readers find.

use crate::common;
use crate::readers;

use beadwright::chart::{Chart, Cylinder, Guide};
use beadwright::dialect::gcode::GcodePositioner;
use beadwright::dialect::{self, reading};
use beadwright::directions::{Settings, divisions};
use beadwright::example;
use beadwright::layer::Layer;
use beadwright::metrics::Metrics;
use beadwright::model::{self, RepairReport};
use beadwright::pass::{Along, Pass, PassKind};
use beadwright::plan;
use beadwright::profile::{Body, Profile};
use beadwright::program::{Instruction, MACHINES, Machine, Positioner, PositionerAxis, Turning};
use beadwright::report::Report;
use beadwright::task::Task;
use common::{profile, with_all_dialects};
use glam::{DMat3, DQuat, DVec3};
use readers::{Motion, Weld, distance};
use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::io::Write;
use std::process::{Command, Stdio};
use std::sync::{Arc, Mutex};

const FREE: [f64; 2] = [-1e5, 1e5];

fn axis(direction: [f64; 3], limits: [f64; 2]) -> PositionerAxis {
    PositionerAxis { direction, through: [0.0; 3], limits, speed: 90.0 }
}

/// A chuck whose axis lies level and carries the part by its lower face.
fn chuck() -> Positioner {
    Positioner { turning: Turning::Follow, axes: vec![axis([0.0, 0.0, 1.0], FREE)], up: [1.0, 0.0, 0.0] }
}

/// A table that tilts about x and turns about its own axis.
fn tilting(turning: Turning) -> Positioner {
    let axes = vec![axis([1.0, 0.0, 0.0], [-135.0, 135.0]), axis([0.0, 0.0, 1.0], FREE)];
    Positioner { turning, axes, up: [0.0, 0.0, 1.0] }
}

type Layers = Arc<Vec<Layer>>;

/// The first layers of each body of an example, planned once, with a profile for all dialects.
fn planned(name: &'static str) -> (Layers, Profile) {
    planned_at(name, 0, DVec3::ZERO)
}

/// The same of a part that is turned about z, °, and then shifted, mm, in its own space.
fn planned_at(name: &'static str, degrees: i32, shift: DVec3) -> (Layers, Profile) {
    static PLANS: Mutex<BTreeMap<(&str, i32), Layers>> = Mutex::new(BTreeMap::new());
    let example = example::find(name).unwrap();
    let turn = about(DVec3::Z, f64::from(degrees));
    let mut profile = profile("cmt-al2319-kuka");
    profile.layers.bodies = Body::read(&example.bodies().unwrap()).unwrap();
    profile.layers.bodies.iter_mut().for_each(|body| body.chart = moved(&body.chart, turn, shift));
    let layers = Arc::clone(PLANS.lock().unwrap().entry((name, degrees)).or_insert_with(|| {
        let mut mesh = example.mesh();
        mesh.vertices.iter_mut().for_each(|p| *p = turn * *p + shift);
        let plan = plan::plan(name, &mesh, &profile, &Task::new()).unwrap();
        let of = |body: usize| plan.layers.iter().filter(move |layer| layer.body == body && !layer.passes.is_empty());
        let bodies = profile.layers.bodies.len();
        Arc::new((0..bodies).flat_map(|body| of(body).step_by(1 + of(body).count() / 4)).cloned().collect())
    }));
    (layers, in_all_dialects(profile))
}

/// A profile with sections for all dialects.
fn in_all_dialects(mut profile: Profile) -> Profile {
    profile.dialects = with_all_dialects("cmt-steel-robots").dialects;
    profile.dialects.krl.as_mut().unwrap().max_megabytes = 1000.0;
    profile.dialects.rapid.as_mut().unwrap().speed_step = 0.001;
    profile.dialects.fanuc.as_mut().unwrap().table_group = Some(2);
    profile
}

/// A chart turned and shifted with its part.
fn moved(chart: &Chart, turn: DMat3, shift: DVec3) -> Chart {
    let place = |p: DVec3| turn * p + shift;
    match chart.clone() {
        Chart::Cylinder(own) => Chart::Cylinder(Cylinder { axis: turn * own.axis, through: place(own.through), ..own }),
        Chart::Guide(own) => {
            let points = own.points().iter().map(|p| place(*p)).collect();
            Chart::Guide(Arc::new(Guide::new(points, own.radii().to_vec()).unwrap()))
        }
        other => {
            assert!(turn == DMat3::IDENTITY && shift == DVec3::ZERO);
            other
        }
    }
}

fn read(post: &str, layers: &[Layer], profile: &Profile) -> Motion {
    let files = dialect::write(post, layers, &profile.job("demo")).unwrap();
    match post {
        "krl" => readers::krl::run(&files, "DEMO", "$OUT[2]"),
        "fanuc" => readers::fanuc::run(&files, "DEMO"),
        _ => readers::rapid::run(&files, "demo", ""),
    }
}

/// A turn about a unit vector (Rodrigues).
fn about(axis: DVec3, degrees: f64) -> DMat3 {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let cross = DMat3::from_cols(axis.cross(DVec3::X), axis.cross(DVec3::Y), axis.cross(DVec3::Z));
    DMat3::IDENTITY + cross * sin + cross * cross * (1.0 - cos)
}

/// What takes the part's directions to the cell where up is up.
fn cell(positioner: &Positioner, axes: [Option<f64>; 2]) -> DMat3 {
    positioner.axes.iter().zip(axes).fold(DMat3::IDENTITY, |all, (axis, angle)| {
        all * about(DVec3::from(axis.direction).normalize(), angle.unwrap())
    })
}

/// Along a weld, how far the wire hangs from straight down in the cell at most, °.
fn off_plumb(weld: &Weld, positioner: &Positioner) -> f64 {
    let places = weld.tools.iter().zip(&weld.axes);
    let lean = places.map(|(tool, axes)| {
        let wire = cell(positioner, *axes) * (*tool * DVec3::Z);
        wire.angle_between(-DVec3::from(positioner.up)).to_degrees()
    });
    lean.fold(0.0, f64::max)
}

fn same_path(case: &str, a: &[Weld], b: &[Weld]) {
    assert!(!a.is_empty() && a.len() == b.len(), "{case}: {} {}", a.len(), b.len());
    for (a, b) in a.iter().zip(b) {
        assert_eq!((a.points.len(), a.speeds.len()), (b.points.len(), b.speeds.len()), "{case}");
        let off = a.points.iter().zip(&b.points).map(|(p, q)| distance(*p, *q)).fold(0.0, f64::max);
        let slower = a.speeds.iter().zip(&b.speeds).map(|(v, w)| (v / w - 1.0).abs()).fold(0.0, f64::max);
        assert!(off <= 0.01 && slower <= 0.005, "{case}: {off} mm, {slower}");
    }
}

/// Parts with their positioners, and how far the wire may hang from plumb, °: where a normal passes close by the axis of the table,
/// that would have to spin, and the pool leans a little instead.
fn cases() -> [(&'static str, Positioner, f64); 8] {
    [
        ("hub", chuck(), 0.05),
        ("shaft", chuck(), 0.05),
        ("hub", tilting(Turning::Follow), 0.05),
        ("elbow", tilting(Turning::Follow), 0.05),
        ("elbow", tilting(Turning::Index), 0.05),
        ("y-tube", tilting(Turning::Index), 0.05),
        ("dome", tilting(Turning::Follow), 5.0),
        ("clad", tilting(Turning::Follow), 5.0),
    ]
}

#[test]
fn the_wire_hangs_straight_down_on_the_planned_path() {
    for (name, positioner, allowed) in cases() {
        let (layers, plain) = planned(name);
        robots_weld_it(name, &layers, &plain, &positioner, allowed);
    }
}

/// Every robot that turns the part welds the path that it welds with the part held still, the wire as it stood on the part, straight down
/// within some degrees, and the axes within their limits.
fn robots_weld_it(name: &str, layers: &[Layer], plain: &Profile, positioner: &Positioner, allowed: f64) {
    let mut turned = plain.clone();
    turned.program.positioner = Some(positioner.clone());
    for post in ["krl", "rapid", "fanuc"] {
        let case = format!("{name} {post} {:?}", positioner.turning);
        let (by_torch, by_part) = (read(post, layers, plain), read(post, layers, &turned));
        same_path(&case, &by_torch.welds, &by_part.welds);
        let worst = by_part.welds.iter().map(|weld| off_plumb(weld, positioner)).fold(0.0, f64::max);
        println!("{case}: {} welds, the wire is off plumb by {worst:.4}°", by_part.welds.len());
        assert!(worst <= allowed, "{case}: {worst}°");
        for (weld, other) in by_part.welds.iter().zip(&by_torch.welds) {
            // The wire stands on the part as it did.
            let along = weld.tools.iter().zip(&other.tools);
            let off = along.map(|(a, b)| (*a * DVec3::Z).angle_between(*b * DVec3::Z).to_degrees()).fold(0.0, f64::max);
            assert!(off < 0.05, "{case}: {off}°");
            let within = |axes: &[Option<f64>; 2]| {
                let mut each = positioner.axes.iter().zip(axes);
                each.all(|(axis, at)| at.is_some_and(|at| (axis.limits[0]..=axis.limits[1]).contains(&at)))
            };
            assert!(weld.axes.iter().all(within), "{case}");
            if positioner.turning == Turning::Index {
                assert!(weld.axes.iter().all(|axes| *axes == weld.axes[0]), "{case}: it turns under the arc");
            }
        }
    }
}

/// A machine of LinuxCNC with these axes under the part.
fn machine(profile: &Profile, positioner: &Positioner, words: &[&str]) -> Profile {
    let mut profile = profile.clone();
    let lines = |line: &str| vec![line.to_owned()];
    let axes = words.iter().map(|word| (*word).to_owned()).collect();
    let gcode = profile.dialects.gcode.as_mut().unwrap();
    gcode.positioner = Some(GcodePositioner { axes, tcp_on: lines("M428"), tcp_off: lines("M429") });
    profile.program.positioner = Some(positioner.clone());
    profile
}

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

/// The same of a machine with these words for its axes, in the words of LinuxCNC and of Siemens.
fn a_machine_welds_it(
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
    let along = |points: &[DVec3]| points.windows(2).map(|p| p[0].distance(p[1])).sum::<f64>();
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

/// A foreign propeller, whose hub is found: its blades are welded around the hub by all that can.
#[test]
#[cfg_attr(no_models, ignore = "no shared models")]
fn a_propeller_from_elsewhere_is_welded_around_its_hub() {
    let mut mesh = model::import(&common::model("propeller_on_hub.stl"), &Task::new()).unwrap().mesh;
    mesh.place(4.0, DVec3::ZERO);
    let mut profile = profile("cmt-al2319-kuka");
    let settings = Settings { lean: 45.0, tilt: 90.0, bead: profile.bead.width };
    let found = divisions(&mesh, settings, &Task::new()).unwrap();
    // The hub lies along x; its axis becomes that of the chuck and of the machine.
    let Chart::Cylinder(hub) = &found[0].pieces[0].chart else { panic!("{:?}", found[0]) };
    assert!(hub.axis.abs().distance(DVec3::X) < 1e-3, "{}", hub.axis);
    mesh.vertices.iter_mut().for_each(|p| *p -= hub.through);
    profile.layers.bodies = Body::of_division("propeller", &found[0]);
    profile.layers.bodies[0].chart = Chart::Cylinder(Cylinder { through: DVec3::ZERO, ..*hub });
    let plan = plan::plan("propeller", &mesh, &profile, &Task::new()).unwrap();
    assert!(plan.summary.metrics.passes > 300, "{:?}", plan.summary.metrics);
    let layers: Vec<Layer> = plan.layers.into_iter().step_by(20).collect();
    let plain = in_all_dialects(profile);
    let lying = Positioner { turning: Turning::Follow, axes: vec![axis([1.0, 0.0, 0.0], FREE)], up: [0.0, 0.0, 1.0] };
    robots_weld_it("propeller_on_hub", &layers, &plain, &lying, 0.05);
    a_machine_welds_it("propeller_on_hub", &layers, &plain, (&lying, &["A"]), 0.05);
}

/// However the part lies in its own space, beside the axes and turned about z, robots and machines weld what was planned, with the wire
/// straight down and within the limits.
#[test]
fn a_part_that_lies_elsewhere_is_welded_alike() {
    let shift = DVec3::new(35.0, -20.0, 12.0);
    for (name, degrees) in [("elbow", 37), ("elbow", 200), ("hub", 37), ("hub", 200)] {
        let (layers, plain) = planned_at(name, degrees, shift);
        let by_torch = read("krl", &layers, &plain).welds;
        let as_it_was = planned(name);
        let expected =
            about(DVec3::Z, f64::from(degrees)) * centre(&read("krl", &as_it_was.0, &as_it_was.1).welds) + shift;
        assert!(centre(&by_torch).distance(expected) < 3.0, "{name} {degrees}: {} {expected}", centre(&by_torch));
        let positioner = tilting(Turning::Follow);
        let mut turned = plain.clone();
        turned.program.positioner = Some(positioner.clone());
        let robot = read("krl", &layers, &turned).welds;
        same_path(&format!("{name} {degrees}° krl"), &by_torch, &robot);
        let files = dialect::write("gcode", &layers, &machine(&plain, &positioner, &["A", "C"]).job("demo")).unwrap();
        let cnc = readers::gcode::run(&files.into_values().next().unwrap(), 3, 5).welds;
        same_path(&format!("{name} {degrees}° gcode"), &by_torch, &cnc);
        let (mut worst, mut reached) = (0.0_f64, [[f64::MAX, f64::MIN]; 2]);
        for (weld, other) in robot.iter().zip(&by_torch).chain(cnc.iter().zip(&by_torch)) {
            let tools = weld.tools.iter().zip(&other.tools);
            worst = tools.map(|(a, b)| (*a * DVec3::Z).angle_between(*b * DVec3::Z).to_degrees()).fold(worst, f64::max);
        }
        worst = robot.iter().map(|weld| off_plumb(weld, &positioner)).fold(worst, f64::max);
        for axes in robot.iter().flat_map(|weld| &weld.axes) {
            for (range, angle) in reached.iter_mut().zip(axes) {
                *range = [range[0].min(angle.unwrap()), range[1].max(angle.unwrap())];
            }
        }
        println!("{name} turned by {degrees}°: the wire is off by {worst:.4}°, axes {reached:.1?}°");
        assert!(worst <= 0.05, "{name} {degrees}: {worst}°");
        let within =
            |(range, axis): (&[f64; 2], &PositionerAxis)| axis.limits[0] <= range[0] && range[1] <= axis.limits[1];
        assert!(reached.iter().zip(&positioner.axes).all(within), "{name} {degrees}: {reached:?}");
    }
}

/// The middle of all that is welded.
fn centre(welds: &[Weld]) -> DVec3 {
    let (mut middle, mut length) = (DVec3::ZERO, 0.0);
    for pair in welds.iter().flat_map(|weld| weld.points.windows(2)) {
        let [from, to] = [0, 1].map(|k| DVec3::from(pair[k]));
        middle += (from + to) / 2.0 * from.distance(to);
        length += from.distance(to);
    }
    middle / length
}

/// What the axes turn between passes, read from a program, is in the plan's time, but for the travels on the way.
#[test]
fn the_time_of_turns_between_passes_counts() {
    for (name, turning) in [("y-tube", Turning::Index), ("elbow", Turning::Follow), ("hub", Turning::Follow)] {
        let (layers, mut profile) = planned(name);
        let mut seconds = |speed: f64| {
            let mut positioner = tilting(turning);
            positioner.axes.iter_mut().for_each(|axis| axis.speed = speed);
            profile.program.positioner = (speed > 0.0).then_some(positioner);
            let mut metrics = Metrics::new(&profile);
            layers.iter().for_each(|layer| metrics.add(layer));
            (metrics.total_time_s, read("krl", &layers, &profile).welds)
        };
        let ((slow, welds), (slower, _), (fast, _), (none, _)) =
            (seconds(0.02), seconds(0.01), seconds(1e4), seconds(0.0));
        let farthest = |pair: &[Weld]| {
            let (from, to) = (pair[0].axes.last().unwrap(), pair[1].axes[0]);
            (0..2).map(|k| (to[k].unwrap() - from[k].unwrap()).abs()).fold(0.0, f64::max)
        };
        let turned: f64 = welds.windows(2).map(farthest).sum();
        let (found, expected) = (slower - slow, turned / 0.02);
        println!(
            "{name}: {turned:.1}° between passes, {:.1} s longer at 0.02°/s, {found:.1} s more at 0.01°/s",
            slow - none
        );
        assert!(turned > 1.0 && (found / expected - 1.0).abs() < 1e-3, "{name}: {found} s, {expected} s");
        assert!(slow - none < expected && (fast - none).abs() < 1e-6, "{name}: {slow} {fast} {none}");
    }
}

/// The report shows each axis over the passes, with its limits unless they are far away.
#[test]
fn the_report_shows_the_angles_of_the_axes() {
    let page = |positioner: Option<Positioner>| {
        let (_, mut profile) = planned("y-tube");
        profile.program.positioner = positioner;
        let plan = plan::plan("y-tube", &example::find("y-tube").unwrap().mesh(), &profile, &Task::new()).unwrap();
        let mut report = Report::new(&plan.header, &profile);
        plan.layers.iter().for_each(|layer| report.layer(layer, None));
        report.finish(&plan.summary, &RepairReport::default(), &[], &[])
    };
    let with = page(Some(tilting(Turning::Index)));
    // The arms are welded on slopes of 14°, to either side of the trunk; the table turns them towards the axis that tilts.
    for words in [
        "<h2>Positioner</h2>",
        "Axis 1, limits -135° to 135°: angle, ° over passes welded; axis 1 -14.00 to 14.00",
        "turned between passes",
    ] {
        assert!(with.contains(words), "{words}");
    }
    assert_eq!(with.matches("within its limits").count(), 1, "those of the table are too far away");
    assert!(!page(None).contains("<h2>Positioner</h2>"));
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

/// Each arm of the fork is welded in one position, and the trunk in another.
#[test]
fn an_indexed_part_is_turned_once_for_each_body() {
    let (layers, mut profile) = planned("y-tube");
    profile.program.positioner = Some(tilting(Turning::Index));
    let welds = read("krl", &layers, &profile).welds;
    let mut poses: Vec<[Option<f64>; 2]> = welds.iter().map(|weld| weld.axes[0]).collect();
    poses.dedup();
    assert_eq!(poses.len(), 3, "{poses:?}");
}

/// The part is turned so that the torch need not: its turn in the cell stays what it was, but for rounding.
#[test]
fn the_torch_does_not_turn_with_the_part() {
    let (layers, mut profile) = planned("shaft");
    profile.program.positioner = Some(chuck());
    for weld in read("krl", &layers, &profile).welds {
        let tool = |k: usize| cell(&chuck(), weld.axes[k]) * DMat3::from_quat(weld.tools[k]);
        let first = tool(0);
        let off = (0..weld.tools.len()).map(|k| (tool(k).x_axis).angle_between(first.x_axis)).fold(0.0, f64::max);
        assert!(off.to_degrees() < 0.05, "{}°", off.to_degrees());
    }
}

fn kinds(layers: &[Layer], profile: &Profile) -> Vec<(&'static str, String)> {
    let settings = plan::deposit_settings(profile);
    let found = beadwright::check(layers, profile, settings, &Task::new()).unwrap();
    let known = ["off-level", "positioner-speed"];
    found.into_iter().filter(|finding| known.contains(&finding.kind)).map(|f| (f.kind, f.text)).collect()
}

#[test]
fn checks_judge_the_part_as_the_positioner_holds_it() {
    let (layers, mut profile) = planned("shaft");
    let found = |profile: &Profile| kinds(&layers, profile);
    assert_eq!(found(&profile)[0].0, "off-level");
    profile.program.positioner = Some(chuck());
    assert_eq!(found(&profile), []);
    // It cannot turn all around.
    profile.program.positioner.as_mut().unwrap().axes[0].limits = [-90.0, 90.0];
    let limited = found(&profile);
    assert!(limited[0].0 == "off-level" && limited[0].1.contains("as the positioner holds the part"), "{limited:?}");
    profile.program.positioner = Some(chuck());
    profile.program.positioner.as_mut().unwrap().axes[0].speed = 1.0;
    let slow = found(&profile);
    assert!(slow.len() == 1 && slow[0].0 == "positioner-speed" && slow[0].1.contains("its speed is 1°/s"), "{slow:?}");
    // Between passes only, a ring cannot be kept level.
    profile.program.positioner = Some(Positioner { turning: Turning::Index, ..chuck() });
    assert_eq!(found(&profile)[0].0, "off-level");
}

/// The program goes on with the axes where the body before has left them, and so do the checks.
#[test]
fn checks_see_the_turns_of_the_program() {
    let (layers, mut profile) = planned("y-tube");
    // The arms lean by 14° along x: this axis reaches one of them half, and the other not at all.
    let axes = vec![axis([0.0, 1.0, 0.0], [-7.0, 0.0])];
    profile.program.positioner = Some(Positioner { turning: Turning::Follow, axes, up: [0.0, 0.0, 1.0] });
    profile.program.max_off_level = 1.0;
    let (mut programmer, mut worst) = (profile.programmer(), BTreeMap::new());
    for layer in layers.iter() {
        for instruction in programmer.layer(layer).instructions {
            let Instruction::Weld { attitude, .. } = instruction else { continue };
            let up = attitude.held.unwrap().turn * attitude.layer * DVec3::Z;
            let lean = worst.entry(layer.body).or_insert(0.0_f64);
            *lean = lean.max(up.angle_between(DVec3::Z).to_degrees());
        }
    }
    let expected: Vec<String> =
        worst.values().filter(|lean| **lean > 1.0).map(|lean| format!("leans by {lean:.1}°")).collect();
    let found = kinds(&layers, &profile);
    assert!(expected.len() == 2 && found.len() == 2, "{expected:?}, {found:?}");
    assert!(expected.iter().zip(&found).all(|(lean, (_, text))| text.contains(lean)), "{expected:?}, {found:?}");
}

#[test]
fn what_a_positioner_cannot_be_is_refused() {
    let wrong = |change: fn(&mut Positioner)| {
        let (mut profile, mut positioner) = (profile("cmt-al2319-kuka"), tilting(Turning::Follow));
        change(&mut positioner);
        profile.program.positioner = Some(positioner);
        Profile::parse(&profile.toml_text().unwrap()).unwrap_err().to_string()
    };
    assert!(wrong(|p| p.axes.clear()).contains("one axis or two"));
    assert!(wrong(|p| p.axes[1].direction = [3.0, 0.0, 0.1]).contains("turn the part in the same way"));
    assert!(wrong(|p| p.axes[0].limits = [90.0, -90.0]).contains("the least angle comes first"));
    assert!(wrong(|p| p.axes[0].direction = [0.0; 3]).contains("needs a direction"));
    assert!(wrong(|p| p.axes[0].speed = 0.0).contains("program.positioner.axes.speed"));
    let (layers, mut profile) = planned("dome");
    profile.program.positioner = Some(tilting(Turning::Follow));
    for post in ["inform", "urscript"] {
        let refused = dialect::write(post, &layers, &profile.job("demo")).unwrap_err().to_string();
        assert!(refused.contains("program.positioner") && refused.contains("krl"), "{refused}");
    }
    (profile.dialects.krl.as_mut().unwrap().table_machine, profile.dialects.fanuc.as_mut().unwrap().table_group) =
        (None, None);
    for (post, key) in [("krl", "krl.table_machine"), ("fanuc", "fanuc.table_group")] {
        let refused = dialect::write(post, &layers, &profile.job("demo")).unwrap_err().to_string();
        assert!(refused.contains(key) && refused.contains("program.positioner"), "{refused}");
    }
}

/// A profile that turns the part with these lines.
fn with_lines(lines: &str) -> Result<Profile, String> {
    let text = Profile::built_in_text("cmt-al2319-kuka").unwrap().to_owned() + "\n[program.positioner]\n" + lines;
    Profile::parse(&text).map_err(|error| error.to_string())
}

#[test]
fn every_built_in_positioner_can_be_named_or_copied() {
    for (name, text) in MACHINES {
        let named = with_lines(&format!("turning = \"index\"\nmachine = \"{name}\"\n")).unwrap();
        let copied: String =
            text.lines().filter(|line| !line.starts_with("description")).map(|l| l.to_owned() + "\n").collect();
        assert_eq!(named, with_lines(&format!("turning = \"index\"\n{copied}")).unwrap(), "{name}");
        assert!(Machine::built_in(name).unwrap().description.len() > 20, "{name}");
        // What is written out is read again.
        assert_eq!(Profile::parse(&named.toml_text().unwrap()).unwrap(), named);
    }
}

/// Heights above the floor, mm, as the sources of the files give them: the plate lies level at 857, 900 and 639.5, and tilted by
/// a quarter its middle comes to the height of the tilt axis, beside it by the distance between them.
#[test]
fn plates_lie_where_their_sources_have_them() {
    for (name, axis, plate) in [
        ("kuka-dkp-400", 510.0, 857.0),
        ("abb-irbp-a250", 1020.0, 900.0),
        ("yaskawa-mt1-500", 475.0, 639.5),
        ("trunnion-ac", 0.0, 0.0),
        ("trunnion-bc", 0.0, 0.0),
    ] {
        let Machine { axes, up, .. } = Machine::built_in(name).unwrap();
        let positioner = Positioner { turning: Turning::Index, axes, up };
        assert_eq!(positioner.up, [0.0, 0.0, 1.0], "{name}");
        let tilted = positioner.held([90.0, 0.0]);
        assert!((plate + tilted.shift.z - axis).abs() < 1e-9, "{name}: {}", tilted.shift);
        let beside = tilted.shift.truncate().length();
        assert!((beside - f64::abs(plate - axis)).abs() < 1e-9, "{name}: {}", tilted.shift);
        assert!((tilted.turn * DVec3::Z).z.abs() < 1e-9, "{name}: the plate stands upright");
        // The other axis leaves the plate where it is.
        let turned = positioner.held([0.0, 90.0]);
        assert!(turned.shift.length() < 1e-9 && (turned.turn * DVec3::Z).distance(DVec3::Z) < 1e-9, "{name}");
    }
}

#[test]
fn a_positioner_is_named_or_described() {
    let refused = |lines: &str| with_lines(&format!("turning = \"follow\"\n{lines}\n")).unwrap_err();
    let axes = "axes = [{ direction = [0, 0, 1], limits = [-90, 90], speed = 60 }]";
    let unknown = refused("machine = \"kuka-dkp400\"");
    assert!(
        unknown.ends_with("there is no built-in positioner \"kuka-dkp400\". Did you mean \"kuka-dkp-400\"?"),
        "{unknown}"
    );
    let line = Profile::built_in_text("cmt-al2319-kuka").unwrap().lines().count() + 2;
    assert!(unknown.starts_with(&format!("line {line} of the profile: ")), "{unknown}");
    assert!(refused("machine = \"x\"").contains("Known: kuka-dkp-400, "), "{}", refused("machine = \"x\""));
    for both in [format!("machine = \"kuka-dkp-400\"\n{axes}"), "machine = \"trunnion-ac\"\nup = [0, 0, 1]".to_owned()]
    {
        assert!(refused(&both).contains("stands for \"axes\" and \"up\": remove it or them."), "{}", refused(&both));
    }
    assert!(refused("").contains("needs the key \"machine\" or \"axes\"."), "{}", refused(""));
    assert!(with_lines(&format!("turning = \"follow\"\n{axes}\n")).is_ok());
}

/// `reach` follows the part as it turns, about the lines of the axes: the tool's tip is where the part has been turned to, and the wire
/// hangs straight down all the way.
#[test]
fn a_robot_finds_the_part_where_the_positioner_holds_it() {
    let (layers, mut profile) = planned("elbow");
    let mut positioner = tilting(Turning::Follow);
    let through = [DVec3::new(0.0, 20.0, -150.0), DVec3::new(30.0, -10.0, 0.0)];
    positioner.axes.iter_mut().zip(through).for_each(|(axis, through)| axis.through = through.to_array());
    profile.program.positioner = Some(positioner.clone());
    let track = profile.track(&layers);
    let (mut turned, mut last) = (0, None);
    for stop in track.stops.iter().filter(|stop| stop.arc) {
        let held = stop.attitude.held.unwrap();
        // About the axis next to the part first.
        let mut place = stop.at;
        for k in [1, 0] {
            let direction = DVec3::from(positioner.axes[k].direction);
            place = about(direction, held.angles[k]) * (place - through[k]) + through[k];
        }
        let tool = stop.tool(0.0);
        assert!(tool.position.distance(place) < 0.2, "{} {place}", tool.position);
        assert!((tool.rotation * DVec3::Z).angle_between(-DVec3::Z).to_degrees() < 0.1);
        turned += usize::from(last != Some(held.angles));
        last = Some(held.angles);
    }
    assert!(turned >= 4, "each of the layers has a position of its own: {turned}");
}

/// Rings that all run the same way turn the part on and on; a chuck that cannot is wound back between passes, above the part, and
/// never passes its limits.
#[test]
fn a_chuck_is_wound_back_between_passes() {
    let (_, mut profile) = planned("shaft");
    let (radius, height) = (30.0, profile.layers.height);
    profile.layers.bodies.clear();
    profile.layers.chart = "cylinder:axis=z,radius=30".parse().unwrap();
    let around = 1.05 * TAU * (radius + height / 2.0);
    let ring = |k: usize| Pass {
        kind: PassKind::Contour,
        closed: false,
        points: (0..=8).map(|i| DVec3::new(around * f64::from(i) / 8.0, 5.0 * k as f64, height)).collect(),
        width: Along::Same(profile.bead.width),
        pace: Along::Same(profile.process.deposition_speed),
        wait: 0.0,
    };
    let layers = [Layer { z: height, height, passes: (0..6).map(ring).collect(), ..Layer::default() }];
    let plain = read("krl", &layers, &profile).welds;
    for limits in [FREE, [-400.0, 400.0]] {
        let mut chuck = chuck();
        chuck.axes[0].limits = limits;
        profile.program.positioner = Some(chuck.clone());
        for post in ["krl", "rapid", "fanuc"] {
            let welds = read(post, &layers, &profile).welds;
            same_path(post, &plain, &welds);
            let angles = |weld: &Weld| weld.axes.iter().map(|axes| axes[0].unwrap()).collect::<Vec<_>>();
            assert!(welds.iter().flat_map(angles).all(|angle| (limits[0]..=limits[1]).contains(&angle)), "{post}");
            let jumps = |pair: &[Weld]| (angles(&pair[1])[0] - angles(&pair[0]).last().unwrap()).abs() > 180.0;
            let wound = welds.windows(2).filter(|pair| jumps(pair)).count();
            assert_eq!(wound > 0, limits != FREE, "{post}: wound back {wound} times");
            let worst = welds.iter().map(|weld| off_plumb(weld, &chuck)).fold(0.0, f64::max);
            assert!(worst <= 0.05, "{post}: {worst}°");
        }
    }
}
