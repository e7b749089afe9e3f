//! One small job in every dialect: golden files, and the same poses, arc starts and weld length read back from each.

use crate::common;
use beadwright::fill::StrategyName;

use crate::readers;
use common::{flat, with_all_dialects};

use beadwright::dialect::fanuc::FanucSpeed;
use beadwright::dialect::gcode::GcodeComments;
use beadwright::dialect::inform::InformSpeed;
use beadwright::dialect::krl::KrlArc;
use beadwright::dialect::rapid::RapidArc;
use beadwright::dialect::reading::{ArcCodes, Options, read};
use beadwright::layer::{Extent, Layer};
use beadwright::pass::PassKind;
use beadwright::pass::{Along, Pass};
use beadwright::plan;
use beadwright::process::{Dot, Spot};
use beadwright::profile::Profile;
use beadwright::task::Task;
use beadwright::warning::WarningKind;
use beadwright::{dialect, example};
use glam::{DVec2, DVec3};
use readers::{Motion, Point, Weld, distance};
use std::collections::BTreeMap;
use std::f64::consts::TAU;

type Files = BTreeMap<String, String>;

/// All dialects on one process: that of the steel cells, arcs fitted within 0.05 mm.
fn profile() -> Profile {
    let mut profile = with_all_dialects("cmt-steel-robots");
    (profile.program.chord_tolerance, profile.program.arcs) = (0.05, true);
    profile
}

/// Two layers: a ring of many points, and a line that goes straight, bends and becomes slower.
fn job() -> Vec<Layer> {
    let layer = |index: usize| {
        let z = 1.4187 * (index + 1) as f64;
        let ring = (0..120).map(|i| DVec2::new(20.0, 20.0) + 15.0 * DVec2::from_angle(TAU * f64::from(i) / 120.0));
        let straight = (0..=10).map(|i| DVec2::new(50.0 + f64::from(i), 5.0));
        let bend = (1..=18)
            .map(|i| DVec2::new(60.0, 15.0) + 10.0 * DVec2::from_angle((f64::from(i) * 5.0 - 90.0).to_radians()));
        let tail = [DVec2::new(70.0, 25.0), DVec2::new(70.0, 30.0)];
        let pass = |kind, closed, points: Vec<DVec2>, speed: Along| Pass {
            kind,
            closed,
            points: points.iter().map(|p| p.extend(z)).collect(),
            width: Along::Same(4.5),
            pace: speed,
            wait: 0.0,
        };
        let line: Vec<DVec2> = straight.chain(bend).chain(tail).collect();
        let speeds = (0..line.len()).map(|i| if i < 28 { 8.0 } else { 6.0 }).collect();
        let passes = vec![
            pass(PassKind::Contour, true, ring.collect(), Along::Same(8.0)),
            pass(PassKind::Infill, false, line, Along::Each(speeds)),
        ];
        let (islands, warnings) = (Vec::new(), Vec::new());
        Layer { index, z, height: 1.4187, islands, passes, warnings, ..Layer::default() }
    };
    vec![layer(0), layer(1)]
}

fn written(name: &str, part: &str, layers: &[Layer], profile: &Profile) -> Files {
    dialect::write(name, layers, &profile.job(part)).unwrap()
}

/// The flavours of G-code.
fn flavour(name: &str) -> Profile {
    let mut profile = profile();
    let gcode = profile.dialects.gcode.as_mut().unwrap();
    let lines = |lines: &[&str]| lines.iter().map(|l| (*l).to_owned()).collect::<Vec<_>>();
    match name {
        "fanuc" => {
            gcode.program_number = Some(1234);
            gcode.header = lines(&["G21 G90 G94 G17 G40 G49 G80", "G54", "G5.1 Q1"]);
            gcode.arc_on = lines(&["M64", "G4 P{{gas_preflow_ms}}", "M3", "G4 P{{arc_start_delay_ms}}"]);
            gcode.arc_off = lines(&["M5", "G4 P{{gas_postflow_ms}}", "M65"]);
        }
        "siemens" => {
            (gcode.percent_signs, gcode.comments) = (false, GcodeComments::Semicolon);
            gcode.extension = "MPF".to_owned();
            gcode.header = lines(&["G71 G90 G94 G17 G40", "G54"]);
            gcode.arc_on = lines(&["M64", "G4 F{{gas_preflow}}", "M3", "G4 F{{arc_start_delay}}"]);
            gcode.arc_off = lines(&["M5", "G4 F{{gas_postflow}}", "M65"]);
        }
        _ => gcode.header.push("G64 P0.05".to_owned()),
    }
    profile
}

/// Every dialect: its name, its files, and what an independent reader finds in them.
fn all() -> Vec<(&'static str, Files, Motion)> {
    all_of(&job())
}

fn all_of(job: &[Layer]) -> Vec<(&'static str, Files, Motion)> {
    let write = |post: &str| written(post, "demo", job, &profile());
    let mut plain = profile();
    plain.dialects.rapid.as_mut().unwrap().arc = RapidArc::Plain;
    let plain = written("rapid", "demo", job, &plain);
    let mut arctech = profile();
    arctech.dialects.krl.as_mut().unwrap().arc = KrlArc::Arctech;
    let arctech = written("krl", "demo", job, &arctech);
    let (krl, rapid, fanuc, inform) = (write("krl"), write("rapid"), write("fanuc"), write("inform"));
    let (urscript, marlin) = (write("urscript"), write("marlin"));
    let print = readers::marlin::run(&marlin["demo.gcode"]);
    let welds = print.paths.into_iter().map(|points| Weld { points, ..Weld::default() }).collect();
    let printed = Motion { welds, travel: print.travel, ..Motion::default() };
    let mut all = vec![
        ("krl", krl.clone(), readers::krl::run(&krl, "DEMO", "$OUT[2]")),
        ("rapid-arcs", rapid.clone(), readers::rapid::run(&rapid, "demo", "")),
        ("rapid-plain-arcs", plain.clone(), readers::rapid::run(&plain, "demo", "doArc")),
        ("fanuc", fanuc.clone(), readers::fanuc::run(&fanuc, "DEMO")),
        ("inform", inform.clone(), readers::inform::run(&inform, "DEMO")),
        ("urscript", urscript.clone(), readers::urscript::run(&urscript["demo.script"], 1)),
        ("marlin", marlin, printed),
        ("krl-arctech", arctech.clone(), readers::krl::run(&arctech, "DEMO", "no output")),
    ];
    for (name, file) in [("gcode-linuxcnc", "demo.nc"), ("gcode-fanuc", "demo.nc"), ("gcode-siemens", "demo.MPF")] {
        let files = written("gcode", "demo", job, &flavour(&name[6..]));
        let text = files[file].trim_matches(['%', '\n']).to_owned() + "\n";
        // The O number is no word of a block.
        let motion = readers::gcode::run_flavour(text.trim_start_matches("O1234\n"), 3, 5);
        all.push((name, files, motion));
    }
    all
}

#[test]
fn the_job_is_written_as_before() {
    all().iter().for_each(|(name, files, _)| readers::golden(name, files));
}

#[test]
fn every_dialect_reads_back_alike() {
    let planned: f64 = job().iter().flat_map(|l| &l.passes).map(Pass::length).sum();
    let all = all();
    let first = &all[0].2;
    assert!(first.circles >= 8, "{}", first.circles);
    for (name, _, motion) in &all {
        let length = motion.weld_length();
        println!("{name}: {length:.4} mm in {} welds, travel {:.3}", motion.welds.len(), motion.travel);
        assert!((length - first.weld_length()).abs() < 0.01, "{name}: {length} for {}", first.weld_length());
        assert!((length / planned - 1.0).abs() < 1e-3, "{name}: {length} for {planned}");
        assert_eq!(motion.welds.len(), 4, "{name}");
        for (a, b) in motion.welds.iter().zip(&first.welds) {
            let places = a.points.len() == b.points.len();
            assert!(places && a.points.iter().zip(&b.points).all(|(p, q)| distance(*p, *q) < 0.003), "{name}");
            assert!(a.speeds.iter().zip(&b.speeds).all(|(v, w)| (v - w).abs() < 0.051), "{name}");
        }
    }
}

/// Every pass of a real part is as long in every dialect, and begins and ends at the same place.
#[test]
fn the_propeller_reads_back_alike_in_every_dialect() {
    let mesh = example::find("propeller").unwrap().mesh();
    for strategy in ["contour", "hybrid"] {
        let mut profile = Profile::built_in("cmt-al2319-kuka").unwrap();
        profile.fill.strategy = strategy.parse().unwrap();
        let plan = plan::plan("demo", &mesh, &profile, &Task::new()).unwrap();
        let all = all_of(&plan.layers);
        let first = &all[0].2;
        assert_eq!(first.welds.len(), plan.layers.iter().map(|l| l.passes.len()).sum::<usize>());
        for (name, _, motion) in &all {
            assert!((motion.travel - first.travel).abs() < 0.01, "{strategy} {name}: {}", motion.travel);
            assert_eq!(motion.welds.len(), first.welds.len(), "{strategy} {name}");
            for (a, b) in motion.welds.iter().zip(&first.welds) {
                let off = (length(a) - length(b)).abs();
                assert!(off < 0.01, "{strategy} {name}: {} for {}", length(a), length(b));
                let ends = [(a.points[0], b.points[0]), (*a.points.last().unwrap(), *b.points.last().unwrap())];
                assert!(ends.iter().all(|(p, q)| distance(*p, *q) < 0.002), "{strategy} {name}");
            }
        }
        println!("{strategy}: {} passes, {} arcs, {:.3} mm", first.welds.len(), first.circles, first.weld_length());
    }
}

/// A helix over many layers is one arc start, and rises all the way.
#[test]
fn a_helix_is_one_pass_in_every_dialect() {
    let mut profile = Profile::built_in("cmt-al2319-kuka").unwrap();
    profile.fill.strategy = StrategyName::Wall;
    profile.wall.helix = true;
    let mesh = common::tube(30.0, 7.54, 24.0, 0.0);
    let plan = plan::plan("demo", &mesh, &profile, &Task::new()).unwrap();
    assert!(plan.layers.len() > 8 && plan.summary.metrics.arc_starts == 1);
    let planned: f64 = plan.layers.iter().flat_map(|l| &l.passes).map(Pass::length).sum();
    for (name, _, motion) in &all_of(&plan.layers) {
        let [weld] = &motion.welds[..] else { panic!("{name}: {} arc starts", motion.welds.len()) };
        assert!((length(weld) / planned - 1.0).abs() < 1e-3, "{name}: {} for {planned}", length(weld));
        assert!(weld.points.windows(2).all(|p| p[1][2] >= p[0][2] - 1e-9), "{name}");
        let (first, last) = (weld.points[0][2], weld.points[weld.points.len() - 1][2]);
        assert!((first - plan.layers[0].z).abs() < 2e-3 && (last - 24.0).abs() < 0.5 * 2.0, "{name}: {first} {last}");
    }
}

/// A dot is a pass in every dialect, and its arc burns as long as it should.
#[test]
fn a_dot_takes_its_time_in_every_dialect() {
    let mut profile = Profile::built_in("cmt-al2319-kuka").unwrap();
    profile.spot = Some(Spot { time: 0.9, height: 2.6 });
    let mesh = common::tube(3.6, 3.6 - 1e-3, 8.0, 0.0);
    let plan = plan::plan("demo", &mesh, &profile, &Task::new()).unwrap();
    let passes: Vec<&Pass> = plan.layers.iter().flat_map(|l| &l.passes).collect();
    assert!(passes.len() == 4 && passes.iter().all(|pass| pass.kind == PassKind::Spot));
    for (name, _, motion) in &all_of(&plan.layers) {
        assert_eq!(motion.welds.len(), passes.len(), "{name}");
        for (weld, pass) in motion.welds.iter().zip(&passes) {
            assert!((length(weld) - Dot::LENGTH).abs() < 2e-3, "{name}: {}", length(weld));
            let planned = pass.seconds(&profile.process);
            let seconds = weld.speeds.last().map(|speed| length(weld) / speed);
            // Speeds have one decimal in some languages, and none at all are read from a printer's program.
            let near = |seconds: f64| (seconds / planned - 1.0).abs() < 0.1;
            assert!(seconds.is_none_or(near), "{name}: {seconds:?} s for {planned}");
        }
    }
}

fn length(weld: &Weld) -> f64 {
    weld.points.windows(2).map(|p| distance(p[0], p[1])).sum()
}

#[test]
fn what_the_project_reads_is_the_same() {
    let options = Options {
        arc: ArcCodes {
            on: vec!["$OUT[2] = TRUE".to_owned(), "SetDO doArc,1".to_owned()],
            off: vec!["$OUT[2] = FALSE".to_owned(), "SetDO doArc,0".to_owned()],
            ..ArcCodes::default()
        },
        ..Options::default()
    };
    let mains = ["DEMO.src", "demo.mod", "demo.mod", "", "", "", "", "DEMO.src", "demo.nc", "demo.nc", "demo.MPF"];
    for ((name, files, motion), main) in all().iter().zip(mains).filter(|(_, main)| !main.is_empty()) {
        let mut find = |name: &str| {
            [name.to_owned(), format!("{name}.src"), format!("{name}.mod")].iter().find_map(|n| files.get(n)).cloned()
        };
        let totals = read(&files[main], &mut find, &options).unwrap().totals();
        assert_eq!(totals.arc_starts, 4, "{name}");
        // It takes chords within 0.01 mm of an arc.
        let off = (totals.deposited_length_mm / motion.weld_length() - 1.0).abs();
        assert!(off < 5e-4, "{name}: {} for {}", totals.deposited_length_mm, motion.weld_length());
    }
}

/// A form of ArcTech is written where the arc is lit and where it ends, and nowhere else; speeds change in between, and ARCOFF
/// moves at that of its own piece.
#[test]
fn arctech_forms_are_written_where_the_arc_is_switched() {
    let mut profile = profile();
    profile.dialects.krl.as_mut().unwrap().arc = KrlArc::Arctech;
    let mut job = job();
    for pass in job.iter_mut().flat_map(|l| &mut l.passes) {
        if let Along::Each(speeds) = &mut pass.pace {
            speeds.iter_mut().for_each(|s| *s = s.max(7.0));
        }
    }
    let count = |profile: &Profile| {
        let files = written("krl", "demo", &job, profile);
        let with_forms = readers::krl::run(&files, "DEMO", "no output");
        let mut plain = profile.clone();
        plain.dialects.krl.as_mut().unwrap().arc = KrlArc::Outputs;
        let plain = readers::krl::run(&written("krl", "demo", &job, &plain), "DEMO", "$OUT[2]");
        assert_eq!(with_forms.welds, plain.welds);
        let (src, dat) = (&files["DEMO_L001.src"], &files["DEMO_L001.dat"]);
        let forms = ["ARCON", "ARCSWI", "ARCOFF"].map(|word| src.matches(&format!(";FOLD {word} ")).count());
        (forms, dat.matches("DECL stArcDat_T WDAT").count())
    };
    // The passes end at two speeds, and the crater is one set.
    assert_eq!(count(&profile), ([2, 0, 2], 3));
    profile.dialects.krl.as_mut().unwrap().arctech.as_mut().unwrap().version = "3.3.3".to_owned();
    let error = Profile::parse(&toml::to_string(&profile).unwrap()).unwrap_err().to_string();
    assert!(error.contains("krl.arctech.version = \"3.3.3\""), "{error}");
    profile.dialects.krl.as_mut().unwrap().arctech = None;
    let error = Profile::parse(&toml::to_string(&profile).unwrap()).unwrap_err().to_string();
    assert!(error.contains("krl.arc = \"arctech\"") && error.contains("[krl.arctech]"), "{error}");
}

#[test]
fn the_krl_reader_refuses_what_arctech_would() {
    let mut profile = profile();
    profile.dialects.krl.as_mut().unwrap().arc = KrlArc::Arctech;
    let good = written("krl", "demo", &job(), &profile);
    let taken = |files: &Files| std::panic::catch_unwind(|| readers::krl::run(files, "DEMO", "no output")).is_ok();
    assert!(taken(&good));
    for (file, old, new) in [
        ("DEMO_L001.src", "LIN XP1\r\n", "LIN XP1 C_DIS\r\n"),
        ("DEMO_L001.src", "(#ArcOffAfterMoveStd, WDAT2", "(#ArcOffAfterMoveStd, WDAT1"),
        ("DEMO_L001.src", "DO ArcMainNG(#ArcOffMoveStd, WDAT2", "DO ArcMainNG(#ArcOffMoveStd, WDAT1"),
        ("DEMO_L001.src", ";ENDFOLD\r\n", ""),
        ("DEMO_L001.src", "FDAT_ACT = FP1\r\n", ""),
        ("DEMO_L001.dat", "DECL FDAT FP3=", "DECL FDAT FP30="),
        ("DEMO_L001.dat", "DECL stArcDat_T WDAT2=", "DECL stArcDat_T WDAT3="),
        ("DEMO_L002.dat", "303030366", "303030367"),
    ] {
        let mut bad = good.clone();
        let text = bad.get_mut(file).unwrap();
        *text = text.replacen(old, new, 1);
        assert_ne!(*text, good[file], "{old:?} is not in {file}");
        assert!(!taken(&bad), "{old:?} became {new:?} in {file}, and the reader took it");
    }
}

#[test]
fn long_layers_are_split_and_read_back_alike() {
    let mut profile = profile();
    (profile.program.arcs, profile.program.chord_tolerance) = (false, 0.0);
    let long = |part: &str, profile: &Profile| {
        let (fanuc, inform) = (written("fanuc", part, &job(), profile), written("inform", part, &job(), profile));
        let main = |files: &Files, end: &str| {
            files.keys().min_by_key(|k| k.len()).unwrap().strip_suffix(end).unwrap().to_owned()
        };
        let (a, b) = (main(&fanuc, ".ls"), main(&inform, ".jbi"));
        (readers::fanuc::run(&fanuc, &a), readers::inform::run(&inform, &b), fanuc.len(), inform.len())
    };
    let whole = long("demo", &profile);
    profile.dialects.fanuc.as_mut().unwrap().max_points = 20;
    profile.dialects.inform.as_mut().unwrap().max_points = 20;
    for part in ["demo", &*"long ".repeat(20), "7-segment display", "Gr\u{fc}n", ""] {
        let split = long(part, &profile);
        assert!(split.2 == whole.2 + 2 && split.3 == whole.3 + 2, "{} {}", split.2, split.3);
        assert_eq!((&split.0, &split.1), (&whole.0, &whole.1));
    }
    profile.dialects.fanuc.as_mut().unwrap().speed = FanucSpeed::CentimetresPerMinute;
    profile.dialects.inform.as_mut().unwrap().speed = InformSpeed::CentimetresPerMinute;
    let other = long("demo", &profile);
    assert!((other.0.welds[1].speeds[0] - 8.0).abs() < 0.02);
    assert!((other.1.welds[1].speeds[0] - 48.0).abs() < 0.06);
}

/// KRL and RAPID are cut between passes only: a module may have to be loaded, and no arc burns meanwhile.
#[test]
fn long_layers_of_krl_and_rapid_are_cut_between_passes() {
    let mut profile = profile();
    for (arc, outputs) in [(KrlArc::Outputs, "$OUT[2]"), (KrlArc::Arctech, "no output")] {
        profile.dialects.krl.as_mut().unwrap().arc = arc;
        profile.dialects.krl.as_mut().unwrap().max_points = 2000;
        let whole = written("krl", "demo", &job(), &profile);
        profile.dialects.krl.as_mut().unwrap().max_points = 10;
        let cut = written("krl", "demo", &job(), &profile);
        assert!(cut.len() > whole.len() && cut.contains_key("DEMO_L001_2.src"), "{:?}", cut.keys());
        assert_eq!(readers::krl::run(&cut, "DEMO", outputs), readers::krl::run(&whole, "DEMO", outputs));
        let long = written("krl", &"long ".repeat(20), &job(), &profile);
        assert!(long.keys().all(|file| file.split('.').next().unwrap().len() <= 24), "{:?}", long.keys());
    }
    for (arc, output) in [(RapidArc::Instructions, ""), (RapidArc::Plain, "doArc")] {
        let rapid = profile.dialects.rapid.as_mut().unwrap();
        (rapid.arc, rapid.max_points) = (arc, 10_000);
        let whole = written("rapid", "demo", &job(), &profile);
        profile.dialects.rapid.as_mut().unwrap().max_points = 10;
        let cut = written("rapid", "demo", &job(), &profile);
        assert!(cut.len() > whole.len() && cut.contains_key("demo_L001_2.mod"), "{:?}", cut.keys());
        assert_eq!(readers::rapid::run(&cut, "demo", output), readers::rapid::run(&whole, "demo", output));
    }
}

#[test]
fn urscript_sets_the_payload() {
    let mut profile = profile();
    assert!(!written("urscript", "demo", &job(), &profile)["demo.script"].contains("set_payload"));
    profile.dialects.urscript.as_mut().unwrap().payload = Some(4.2);
    let script = &written("urscript", "demo", &job(), &profile)["demo.script"];
    let place = |words: &str| script.find(words).unwrap();
    assert!(place("set_payload(4.200)") < place("move"));
}

#[test]
fn odd_names_are_legal_in_urscript() {
    for part in ["end", "layer_001", "7up", "Gr\u{fc}n", ""] {
        let files = written("urscript", part, &job(), &profile());
        readers::urscript::run(files.values().next().unwrap(), 1);
    }
}

/// The readers measure an arc as it is: a quarter of a circle of 10 mm.
#[test]
fn the_test_readers_know_arcs() {
    let mut machine = readers::Machine::default();
    let at = |x: f64, y: f64| -> Point { DVec3::new(x, y, 1.0).to_array() };
    machine.move_to(at(10.0, 0.0), 1.0);
    machine.arc_on();
    let half = 10.0 * 0.5_f64.sqrt();
    machine.arc_to(at(half, half), at(0.0, 10.0), 1.0);
    machine.arc_off();
    machine.move_to(DVec3::new(0.0, 10.0, 5.0).to_array(), 1.0);
    let length = machine.finish().weld_length();
    assert!((length - 2.5 * TAU).abs() < 1e-3, "{length}");
}

/// Volumes that fit into a controller: together they weld what one program would, each from home to home.
#[test]
fn large_programs_come_in_volumes() {
    let mut profile = profile();
    let whole = [written("krl", "demo", &job(), &profile), written("urscript", "demo", &job(), &profile)];
    // Room for a main program and one of two layers.
    profile.dialects.krl.as_mut().unwrap().max_megabytes = 0.004;
    profile.dialects.urscript.as_mut().unwrap().max_megabytes = 0.0055;
    let write = |name: &str| {
        let job_settings = profile.job("demo");
        let mut writer = dialect::writer(name, &job_settings).unwrap();
        let mut programmer = job_settings.programmer(false);
        let mut files = Files::new();
        let mut chunks = writer.begin(&Extent { layers: 2, ..Extent::default() });
        job().iter().for_each(|layer| chunks.extend(writer.layer(&programmer.layer(layer))));
        chunks.extend(writer.end());
        chunks.into_iter().for_each(|chunk| files.entry(chunk.file).or_default().push_str(&chunk.text));
        (files, writer.notes())
    };
    let [(krl, krl_notes), (urscript, ur_notes)] = [write("krl"), write("urscript")];
    let motions = [
        [readers::krl::run(&krl, "DEMO", "$OUT[2]"), readers::krl::run(&krl, "DEMO_2", "$OUT[2]")],
        [readers::urscript::run(&urscript["demo.script"], 1), readers::urscript::run(&urscript["demo_2.script"], 1)],
    ];
    let one = [readers::krl::run(&whole[0], "DEMO", "$OUT[2]"), readers::urscript::run(&whole[1]["demo.script"], 1)];
    for ([first, second], whole) in motions.into_iter().zip(one) {
        assert_eq!([first.welds, second.welds].concat(), whole.welds);
    }
    for (notes, last) in [(krl_notes, "DEMO_2.src"), (ur_notes, "demo_2.script")] {
        assert!(matches!(&notes[..], [note] if note.contains("2 volumes") && note.contains(last)), "{notes:?}");
    }
}

/// No volume is larger than the controller's memory, its main program, data and all modules taken together: layers are
/// divided between passes.
#[test]
fn no_volume_is_larger_than_it_may_be() {
    let mut profile = flat(profile());
    profile.fill.strategy = StrategyName::Contour;
    (profile.program.chord_tolerance, profile.program.arcs, profile.program.restart) = (0.0, false, true);
    profile.dialects.krl.as_mut().unwrap().max_points = 200;
    profile.dialects.urscript.as_mut().unwrap().max_megabytes = 0.25;
    let mut plan = plan::plan("demo", &example::find("gear").unwrap().mesh(), &profile, &Task::new()).unwrap();
    plan.layers.truncate(4);
    let whole = readers::krl::run(&written("krl", "demo", &plan.layers, &profile), "DEMO", "$OUT[2]");
    for megabytes in [0.07, 0.14] {
        profile.dialects.krl.as_mut().unwrap().max_megabytes = megabytes;
        let files = written("krl", "demo", &plan.layers, &profile);
        let mains: Vec<&str> = files.keys().filter_map(|file| file.strip_suffix(".dat")).collect();
        assert!(mains.len() > 4, "{mains:?}");
        let mut welds = Vec::new();
        let ordered = (1..=mains.len()).map(|n| if n == 1 { "DEMO".to_owned() } else { format!("DEMO_{n}") });
        for main in ordered {
            let text = &files[&format!("{main}.src")];
            let calls = text.lines().filter_map(|line| line.strip_suffix("( )"));
            // Other calls are of routines in the same file.
            let called = calls.filter_map(|name| files.get(&format!("{name}.src"))).map(String::len).sum::<usize>();
            let size = called + text.len() + files[&format!("{main}.dat")].len();
            assert!(size as f64 <= megabytes * 1e6, "{main} has {size} bytes");
            welds.extend(readers::krl::run(&files, &main, "$OUT[2]").welds);
        }
        assert_eq!(welds, whole.welds);
    }
    let scripts = written("urscript", "demo", &plan.layers, &profile);
    assert!(scripts.len() > 2);
    scripts.iter().for_each(|(file, text)| assert!(text.len() <= 250_000, "{file}: {}", text.len()));
}

/// A CNC torch rises to the safe height first, then goes across, then down.
#[test]
fn gcode_goes_to_the_safe_height_first() {
    let mut profile = profile();
    profile.dialects.gcode.as_mut().unwrap().safe_z = 80.0;
    let files = written("gcode", "demo", &job(), &profile);
    let moves: Vec<&str> = files["demo.nc"].lines().filter(|line| line.contains(" G0 ")).take(4).collect();
    let words: Vec<&str> = moves.iter().map(|line| line.split_once(" G0 ").unwrap().1).collect();
    assert_eq!(words, ["Z80.000", "X35.000 Y20.000", "Z21.419", "Z1.419"]);
}

/// No program ends while the arc burns: a pass too long for one is cut, and lit again on the end of its bead.
#[test]
fn passes_too_long_for_a_program_are_lit_again() {
    for part in ["gear", "star"] {
        let mut profile = Profile::built_in("cmt-steel-robots").unwrap();
        profile.posts = Vec::new();
        profile.fill.strategy = StrategyName::Loop;
        let mut mesh = example::find(part).unwrap().mesh();
        mesh.vertices.iter_mut().for_each(|v| v.z = v.z.min(2.0));
        let whole = plan::plan(part, &mesh, &profile, &Task::new()).unwrap();
        profile.posts = vec!["fanuc".to_owned(), "inform".to_owned()];
        for max in [60, 150] {
            profile.dialects.fanuc.as_mut().unwrap().max_points = max;
            let cut = plan::plan(part, &mesh, &profile, &Task::new()).unwrap();
            let programmer = || profile.programmer();
            let again: usize = cut.layers.iter().map(|l| l.passes.len()).sum::<usize>()
                - whole.layers.iter().map(|l| l.passes.len()).sum::<usize>();
            assert!(again > 0, "{part} {max}");
            let reported = cut.summary.warnings.summaries().find(|w| w.kind == WarningKind::Relit).unwrap();
            assert_eq!(reported.total as usize, again);
            for pass in cut.layers.iter().flat_map(|l| &l.passes) {
                let alone = Layer { passes: vec![pass.clone()], ..Layer::default() };
                assert!(programmer().layer(&alone).instructions.len() <= max);
            }
            // Each new start lies an overlap back, and a closed pass that is cut ends as far beyond its own start.
            let overlap = profile.start_stop.end_overlap.max(profile.bead.width);
            let length = |plan: &plan::Plan| plan.summary.metrics.deposited_length_mm;
            let ends = reported.count as f64 * (overlap - profile.start_stop.end_overlap);
            let wanted = length(&whole) + again as f64 * overlap + ends;
            assert!((length(&cut) / wanted - 1.0).abs() < 1e-6, "{part} {max}: {} mm for {wanted}", length(&cut));
            let files = written("fanuc", part, &cut.layers, &profile);
            let motion = readers::fanuc::run(&files, &part.to_uppercase());
            assert!((motion.weld_length() / length(&cut) - 1.0).abs() < 1e-3);
        }
    }
}

/// A build stopped in layer 7, pass 3: the metal laid before and that of the resumed program are, place by place, that of
/// one program.
#[test]
fn a_stopped_build_goes_on_at_its_pass() {
    let mut profile = profile();
    profile.fill.strategy = StrategyName::Contour;
    let plan = plan::plan("demo", &example::find("gear").unwrap().mesh(), &profile, &Task::new()).unwrap();
    let (layer, pass) = (6, 2);
    assert!(plan.layers.len() > layer && plan.layers[layer].passes.len() > pass);
    let before = plan.layers[..layer].iter().map(|l| l.passes.len()).sum::<usize>() + pass;
    let resumed = |post: &str| -> Files {
        let job = profile.job("demo");
        let (mut writer, mut programmer, mut files) =
            (dialect::writer(post, &job).unwrap(), job.programmer(false), Files::new());
        let mut chunks = writer.begin(&plan.header.extent);
        for at in &plan.layers[layer..] {
            chunks.extend(writer.layer(&programmer.layer_from(at, if at.index == layer { pass } else { 0 })));
        }
        chunks.extend(writer.end());
        chunks.into_iter().for_each(|chunk| files.entry(chunk.file).or_default().push_str(&chunk.text));
        files
    };
    let run = |post: &str, files: &Files| match post {
        "krl" => readers::krl::run(files, "DEMO", "$OUT[2]"),
        "rapid" => readers::rapid::run(files, "demo", ""),
        "fanuc" => readers::fanuc::run(files, "DEMO"),
        "inform" => readers::inform::run(files, "DEMO"),
        "urscript" => readers::urscript::run(&files["demo.script"], 1),
        _ => readers::gcode::run(&files["demo.nc"], 3, 5),
    };
    for post in ["krl", "rapid", "fanuc", "gcode", "inform", "urscript"] {
        let (whole, rest) = (run(post, &written(post, "demo", &plan.layers, &profile)), run(post, &resumed(post)));
        assert_eq!([&whole.welds[..before], &rest.welds[..]].concat(), whole.welds, "{post}");
        assert_eq!(rest.welds.len(), whole.welds.len() - before, "{post}");
    }
}
