//! The torch and the part together: how the torch is held along every arc, and where the path runs on the part, in every
//! dialect, as readers see it that know how the controllers carry the tool and what turns with the table.

use crate::common;
use crate::readers;
use beadwright::chart::Chart;
use beadwright::fill::StrategyName;
use beadwright::model::{Mesh, solid::Solid};
use beadwright::task::Task;

use beadwright::dialect;
use beadwright::dialect::krl::{KrlArc, KrlMotion};
use beadwright::dialect::rapid::RapidArc;
use beadwright::layer::Layer;
use beadwright::profile::Profile;
use beadwright::program::{Instruction, Weave};
use common::{planned, profile, with_all_dialects};
use glam::{DQuat, DVec2, DVec3};
use readers::cnc::Control;
use readers::{Motion, Weld, distance};
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex};

type Files = BTreeMap<String, String>;

/// Parts: curved arms, a thin curved wall, a frame of walls that meet.
const PARTS: [&str; 3] = ["cross", "blade", "tian"];

/// What a program is asked for.
const FEATURES: [&str; 6] = ["arcs", "table", "weave", "restart", "offsets", "tilt"];

/// A way of writing a program.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Way {
    Krl,
    KrlSplines,
    ArcTech,
    Rapid,
    RapidPlain,
    Fanuc,
    Inform,
    Urscript,
    Linuxcnc,
    Cnc(Control, &'static str),
}

use Way::{ArcTech, Cnc, Fanuc, Inform, Krl, KrlSplines, Linuxcnc, Rapid, RapidPlain, Urscript};

const WAYS: [Way; 12] = [
    Krl,
    KrlSplines,
    ArcTech,
    Rapid,
    RapidPlain,
    Fanuc,
    Inform,
    Urscript,
    Linuxcnc,
    Cnc(Control::Fanuc, "plasma-304-fanuc"),
    Cnc(Control::Siemens, "plasma-304-siemens"),
    Cnc(Control::TwinCat, "plasma-304-twincat"),
];

impl Way {
    fn post(self) -> &'static str {
        match self {
            Krl | KrlSplines | ArcTech => "krl",
            Rapid | RapidPlain => "rapid",
            Fanuc => "fanuc",
            Inform => "inform",
            Urscript => "urscript",
            Linuxcnc | Cnc(..) => "gcode",
        }
    }

    /// All ways have the process of the steel cells, so the same plan is written by each.
    fn profile(self) -> Profile {
        let mut all = with_all_dialects("cmt-steel-robots");
        all.dialects.urscript.as_mut().unwrap().max_megabytes = 1000.0;
        all.dialects.krl.as_mut().unwrap().max_megabytes = 1000.0;
        match self {
            KrlSplines => all.dialects.krl.as_mut().unwrap().motion = KrlMotion::Slin,
            ArcTech => all.dialects.krl.as_mut().unwrap().arc = KrlArc::Arctech,
            RapidPlain => all.dialects.rapid.as_mut().unwrap().arc = RapidArc::Plain,
            Cnc(_, name) => all.dialects.gcode = profile(name).dialects.gcode,
            _ => {}
        }
        all.dialects.rapid.as_mut().unwrap().speed_step = 0.001;
        all
    }

    /// What an independent reader finds; `table` is the external axis that turns the part.
    fn read(self, files: &Files, table: Option<usize>) -> Motion {
        match self {
            Krl => readers::krl::run_in(files, "DEMO", "$OUT[2]", table),
            // Spline motions run where the others do.
            KrlSplines => {
                let plain = |text: &String| {
                    text.replace("SLIN ", "LIN ").replace("SCIRC ", "CIRC ").replace(" C_SPL", " C_DIS")
                };
                let files: Files = files.iter().map(|(name, text)| (name.clone(), plain(text))).collect();
                readers::krl::run_in(&files, "DEMO", "$OUT[2]", table)
            }
            ArcTech => readers::krl::run_in(files, "DEMO", "no output", table),
            Rapid => readers::rapid::run_in(files, "demo", "", table),
            RapidPlain => readers::rapid::run_in(files, "demo", "doArc", table),
            Fanuc => readers::fanuc::run(files, "DEMO"),
            Inform => readers::inform::run(files, "DEMO"),
            Urscript => readers::urscript::run(&files["demo.script"], 1),
            Linuxcnc => readers::gcode::run(&files["demo.nc"], 3, 5),
            Cnc(control, _) => {
                let arc = if control == Control::TwinCat { [62, 63] } else { [3, 5] };
                readers::cnc::run(control, files.values().next().unwrap(), arc).motion
            }
        }
    }

    fn has_wrist(self) -> bool {
        self.post() != "gcode"
    }
}

/// Two layers of a part, planned once.
fn layers(part: &str) -> Arc<Vec<Layer>> {
    static PLANS: Mutex<BTreeMap<String, Arc<Vec<Layer>>>> = Mutex::new(BTreeMap::new());
    let mut plans = PLANS.lock().unwrap();
    let plan = || {
        let mut profile = profile("cmt-steel-robots");
        profile.posts = Vec::new();
        profile.fill.strategy = StrategyName::Contour;
        Arc::new(planned(part, &profile).layers.into_iter().take(2).collect())
    };
    Arc::clone(plans.entry(part.to_owned()).or_insert_with(plan))
}

fn ask(profile: &mut Profile, feature: &str) {
    let program = &mut profile.program;
    (program.chord_tolerance, program.arcs) = (0.05, true);
    match feature {
        "table" => program.table_side = Some(-90.0),
        "weave" => {
            profile.weave = Some(Weave { length: 4.0, amplitude: 1.5, dwell: 0.05, file: 1, layers: Vec::new() })
        }
        "restart" => program.restart = true,
        "offsets" => program.layer_offsets = true,
        "tilt" => (program.follow_wall, program.travel_angle) = (1.0, 8.0),
        _ => {}
    }
}

/// The torch as the neutral program holds it at the end of each move, and the moves' arcs: what the programs are to do.
fn wanted(layers: &[Layer], profile: &Profile, woven: bool) -> Vec<Vec<(DVec3, DQuat, Option<f64>)>> {
    let down = DQuat::from_xyzw(1.0, 0.0, 0.0, 0.0);
    let mut programmer = profile.programmer().woven(profile.weave.as_ref().filter(|_| woven));
    let (mut welds, mut at, mut attitude) =
        (Vec::<Vec<_>>::new(), DVec3::ZERO, beadwright::program::Attitude::default());
    for instruction in layers.iter().flat_map(|layer| programmer.layer(layer).instructions) {
        attitude = instruction.attitude().unwrap_or(attitude);
        let stand = |at| (at, attitude.rotation() * down, attitude.held.map(|held| held.angles[0]));
        match instruction {
            Instruction::ArcOn { .. } => welds.push(vec![stand(at)]),
            Instruction::Weld { to, .. } => welds.last_mut().unwrap().push(stand(to)),
            _ => {}
        }
        at = instruction.target().unwrap_or(at);
    }
    welds
}

/// Degrees between two tools, of which either may be the other's negative.
fn turned(a: DQuat, b: DQuat) -> f64 {
    // Exact for small angles, whatever the digits of a program leave of the length.
    let between = a.conjugate() * b;
    (2.0 * between.xyz().length().atan2(between.w.abs())).to_degrees()
}

/// Along every arc the torch is held as at its ends: as the plan wants it, within 0.05°, and it turns nowhere faster than
/// the plan turns it.
fn held(case: &str, weld: &Weld, wanted: &[(DVec3, DQuat, Option<f64>)]) {
    let mut next = 0;
    for (i, &point) in weld.points.iter().enumerate() {
        let at = |k: usize| distance(wanted[k].0.to_array(), point) < 1e-3;
        if next < wanted.len() && at(next) {
            let off = turned(weld.tools[i], wanted[next].1);
            assert!(off < 0.05, "{case}: the torch is {off:.3}° off at {point:?}");
            next += 1;
            continue;
        }
        // Between two points of the program, on an arc: evenly from the one to the other.
        let (from, to) = (&wanted[next - 1], &wanted[next]);
        let off = turned(weld.tools[i], from.1) + turned(weld.tools[i], to.1) - turned(from.1, to.1);
        assert!(off < 0.05, "{case}: the torch swings {off:.3}° out along the arc at {point:?}");
    }
    assert_eq!(next, wanted.len(), "{case}: points are missing");
}

/// On the part, the beads of a program run within 0.01 mm of those of another.
fn same_path(case: &str, a: &[Weld], b: &[Weld]) {
    assert_eq!(a.len(), b.len(), "{case}");
    for (a, b) in a.iter().zip(b) {
        assert_eq!(a.points.len(), b.points.len(), "{case}");
        let off = a.points.iter().zip(&b.points).map(|(p, q)| distance(*p, *q)).fold(0.0, f64::max);
        assert!(off < 0.01, "{case}: the path is {off} mm off");
    }
}

#[test]
fn every_dialect_holds_the_torch_along_arcs_and_the_path_on_the_part() {
    let mut table = String::new();
    for way in WAYS {
        for part in PARTS {
            let layers = layers(part);
            let mut plain = way.profile();
            ask(&mut plain, "arcs");
            let whole = way.read(&dialect::write(way.post(), &layers, &plain.job("demo")).unwrap(), None);
            for feature in FEATURES {
                let case = format!("{way:?} {part} {feature}");
                let mut profile = way.profile();
                ask(&mut profile, feature);
                let mut files = match dialect::write(way.post(), &layers, &profile.job("demo")) {
                    Ok(files) => files,
                    Err(refused) => {
                        table.push_str(&format!("{case}: refused, {refused}\n"));
                        continue;
                    }
                };
                let lifted = feature == "offsets";
                if lifted {
                    lift_second_layer(&mut files);
                }
                let motion = way.read(&files, (feature == "table").then_some(0));
                let welds: Vec<Weld> = motion.welds.iter().map(|weld| lowered(weld, &whole, lifted)).collect();
                let native = matches!(way, ArcTech | Rapid | Fanuc | Inform);
                let wanted = wanted(&layers, &profile, !native);
                if feature != "weave" || native {
                    // Leaning divides moves, so its points are those of the leaning plan.
                    if feature != "tilt" {
                        same_path(&case, &welds, &whole.welds);
                    }
                }
                if way.has_wrist() {
                    assert_eq!(welds.len(), wanted.len(), "{case}");
                    welds.iter().zip(&wanted).for_each(|(weld, wanted)| held(&case, weld, wanted));
                }
                table.push_str(&format!("{case}: {} arcs, {:.1} mm\n", motion.circles, motion.weld_length()));
            }
        }
    }
    println!("{table}");
    let refusals = |way: &str| table.lines().filter(|l| l.starts_with(way) && l.contains("refused")).count();
    // What a language or a machine cannot do is refused: a table, a lean, a shift in the forms of ArcTech, a restart with the
    // wire as an axis.
    assert_eq!(
        ["Krl ", "KrlSplines ", "ArcTech", "Rapid ", "RapidPlain", "Fanuc", "Inform", "Urscript"].map(refusals),
        [0, 0, 3, 0, 0, 3, 3, 3]
    );
    assert_eq!(["Linuxcnc", "Cnc(Fanuc", "Cnc(Siemens", "Cnc(TwinCat"].map(refusals), [6, 6, 6, 9]);
}

/// Around an axis, every robot's program lies on the layers of the part and holds the torch along their normals; no other
/// machine gets one.
#[test]
fn every_robot_follows_layers_around_an_axis() {
    const RADIUS: f64 = 25.0;
    for axis in ["z", "-0.2/1/0.4"] {
        let chart: Chart = format!("cylinder:axis={axis},radius={RADIUS}").parse().unwrap();
        // A pipe along the axis.
        let along = chart.sheet(0.0).at(DVec3::new(0.0, 1.0, -RADIUS)).place.normalize();
        let ends = [[RADIUS, 0.0], [RADIUS + 3.0, 0.0], [RADIUS + 3.0, 20.0], [RADIUS, 20.0]];
        let Solid { mut vertices, triangles } = Solid::revolve(&ends.map(DVec2::from_array), 90);
        let turn = DQuat::from_rotation_arc(DVec3::Z, along);
        vertices.iter_mut().for_each(|p| *p = turn * *p);
        let pipe = Mesh::from_triangles(vertices, triangles).0;
        let mut profile = profile("cmt-steel-robots");
        profile.layers.chart = chart.clone();
        let layers = beadwright::plan("demo", &pipe, &profile, &Task::new()).unwrap().layers;
        for way in WAYS {
            let case = format!("{way:?} {axis}");
            let mut profile = way.profile();
            profile.layers.chart = chart.clone();
            let files = dialect::write(way.post(), &layers, &profile.job("demo"));
            if !way.has_wrist() {
                assert!(files.unwrap_err().to_string().contains("layers.chart"), "{case}");
                continue;
            }
            let motion = way.read(&files.unwrap(), None);
            let wanted = wanted(&layers, &profile, false);
            assert_eq!(motion.welds.len(), wanted.len(), "{case}");
            motion.welds.iter().zip(&wanted).for_each(|(weld, wanted)| held(&case, weld, wanted));
            let tops: Vec<f64> = layers.iter().map(|layer| RADIUS + layer.z).collect();
            for (point, tool) in motion.welds.iter().flat_map(|weld| weld.points.iter().zip(&weld.tools)) {
                let at = DVec3::from_array(*point);
                let outward = at - along * at.dot(along);
                let off = tops.iter().map(|top| (outward.length() - top).abs()).fold(f64::INFINITY, f64::min);
                assert!(off < 0.01, "{case}: {at} lies {off} mm off the layers");
                let wire = (*tool * DVec3::Z).angle_between(-outward).to_degrees();
                assert!(wire < 0.05, "{case}: the wire is {wire:.3}° off at {at}");
            }
        }
    }
}

/// Adds half a millimetre to the second layer, in each program's own way.
fn lift_second_layer(files: &mut Files) {
    let changes = [
        ("DEMO_DZ[2]=0.0", "DEMO_DZ[2]=0.5"),
        ("nDz{2}:=[0,0]", "nDz{2}:=[0,0.5]"),
        ("layer_dz = [0.0, 0.0]", "layer_dz = [0.0, 0.5]"),
    ];
    let second = [("PR[90,3]=0 ;", "PR[90,3]=0.5 ;"), ("SETE P090 (3) 0\r", "SETE P090 (3) 500\r")];
    let in_one = [
        ("G52 X0.0 Y0.0 Z0.000", "G52 X0.0 Y0.0 Z0.5"),
        ("TRANS Z0.000", "TRANS Z0.5"),
        ("G58 X0.0 Y0.0 Z0.000", "G58 X0.0 Y0.0 Z0.5"),
    ];
    let mut changed = 0;
    for (file, text) in files {
        for (old, new) in changes.iter().chain(second.iter().filter(|_| file.contains("L002"))) {
            changed += usize::from(text.contains(old));
            *text = text.replacen(old, new, 1);
        }
        for (old, new) in in_one {
            if let Some(at) = text.find(old).and_then(|first| Some(first + 1 + text[first + 1..].find(old)?)) {
                text.replace_range(at..at + old.len(), new);
                changed += 1;
            }
        }
    }
    assert_eq!(changed, 1);
}

/// The second layer of a program in which it was lifted, as it would lie without.
fn lowered(weld: &Weld, whole: &Motion, lifted: bool) -> Weld {
    let first = whole.welds[0].points[0][2];
    let mut weld = weld.clone();
    if lifted && weld.points[0][2] > first + 0.1 {
        weld.points.iter_mut().for_each(|point| point[2] -= 0.5);
    }
    weld
}

/// Where a table turns under a frame that stands, the path leaves the part, and an arc held to its tangent turns the torch:
/// the readers see both.
#[test]
fn the_readers_see_a_standing_frame_and_a_turning_torch() {
    let layers = layers("cross");
    let write = |way: Way, feature: &str| {
        let mut profile = way.profile();
        ask(&mut profile, feature);
        (dialect::write(way.post(), &layers, &profile.job("demo")).unwrap(), profile)
    };
    let broken = |files: &Files, old: &str, new: &str| -> Files {
        assert!(files.values().any(|text| text.contains(old)), "no {old}");
        files.iter().map(|(name, text)| (name.clone(), text.replace(old, new))).collect()
    };
    for (way, old, new) in [
        (Krl, "EK(MACHINE_DEF[2].ROOT,MACHINE_DEF[2].MECH_TYPE,BASE_DATA[1])", "BASE_DATA[1]"),
        (Rapid, "[FALSE,FALSE,\"STN1\",", "[FALSE,TRUE,\"\","),
    ] {
        let files = write(way, "table").0;
        let good = way.read(&files, Some(0));
        let bad = way.read(&broken(&files, old, new), Some(0));
        let off =
            |(a, b): (&Weld, &Weld)| a.points.iter().zip(&b.points).map(|(p, q)| distance(*p, *q)).fold(0.0, f64::max);
        assert!(good.welds.iter().zip(&bad.welds).map(off).fold(0.0, f64::max) > 10.0, "{way:?}");
    }
    let (files, profile) = write(Urscript, "arcs");
    let motion = Urscript.read(&broken(&files, "mode=0", "mode=1"), None);
    let wanted = wanted(&layers, &profile, false);
    let seen = std::panic::catch_unwind(|| {
        motion.welds.iter().zip(&wanted).for_each(|(weld, wanted)| held("broken", weld, wanted));
    });
    assert!(seen.is_err(), "the torch turns with the tangent");
}
