//! Start and stop of passes, wire feed that follows the bead, waits between layers, and the dry run: the same in every
//! dialect, and counted by the totals.

use crate::common;
use crate::readers;

use beadwright::check;
use beadwright::deposit::Judge;
use beadwright::dialect;
use beadwright::dialect::fanuc::FanucSpeed;
use beadwright::dialect::rapid::RapidArc;
use beadwright::dialect::reading::{Options, ReadProgram, read};
use beadwright::layer::Layer;
use beadwright::metrics::Metrics;
use beadwright::pass::{Along, Pass, PassKind};
use beadwright::plan;
use beadwright::process::{Follow, StartStop};
use beadwright::profile::{Profile, edit};
use beadwright::program::{Instruction, LayerProgram};
use beadwright::task::Task;
use beadwright::weld;
use glam::DVec3;
use readers::{Motion, Weld, distance};
use std::collections::BTreeMap;

type Files = BTreeMap<String, String>;

fn lines(lines: &[&str]) -> Vec<String> {
    lines.iter().map(|l| (*l).to_owned()).collect()
}

/// All dialects on one process, each able to set its wire feed and to draw the wire back.
fn plain() -> Profile {
    let built_in = |name| Profile::built_in(name).unwrap();
    let mut profile = built_in("cmt-steel-robots");
    profile.dialects.rapid = built_in("cmt-steel-abb").dialects.rapid;
    profile.dialects.krl = built_in("cmt-al2319-kuka").dialects.krl;
    profile.dialects.gcode = built_in("plasma-304-cnc").dialects.gcode;
    profile.dialects.gcode.as_mut().unwrap().safe_z = 0.0;
    profile.dialects.marlin = built_in("fdm-abs-0.4").dialects.marlin;
    profile.dialects.marlin.as_mut().unwrap().bed = None;
    profile
}

fn with_ends() -> Profile {
    let mut profile = plain();
    profile.start_stop = StartStop {
        end_overlap: 6.0,
        lead_in_length: 5.0,
        lead_in_power: 1.25,
        lead_out_length: 4.0,
        lead_out_power: 0.8,
        crater_fill_time: 0.4,
        crater_power: 0.5,
        wire_retract: 2.0,
        interpass_time: 7.5,
        min_layer_time: 700.0,
        dwell_height: 15.0,
        ..StartStop::default()
    };
    let krl = profile.dialects.krl.as_mut().unwrap();
    krl.wire_feed = lines(&["$ANOUT[1] = {{wire_feed_ratio}}"]);
    krl.arc_off.push("WAIT SEC {{wire_retract_time}}".to_owned());
    let gcode = profile.dialects.gcode.as_mut().unwrap();
    gcode.wire_feed = lines(&["M67 E0 Q{{wire_feed_ratio}}"]);
    gcode.crater = lines(&["M68 E0 Q{{wire_feed_ratio}}"]);
    gcode.arc_off.push("G4 P{{wire_retract_time}}".to_owned());
    let rapid = profile.dialects.rapid.as_mut().unwrap();
    rapid.wire_feed = lines(&["SetAO aoWire,{{wire_feed_ratio}};"]);
    rapid.arc_off.push("WaitTime \\InPos,{{wire_retract_time}};".to_owned());
    let fanuc = profile.dialects.fanuc.as_mut().unwrap();
    fanuc.wire_feed = lines(&["AO[1]={{wire_feed_ratio}}"]);
    // Their welders' own data know the gas; here the programs do, as in a cell whose gas is an output.
    fanuc.arc_on.insert(0, "WAIT {{gas_preflow}}(sec)".to_owned());
    fanuc.arc_off.extend(lines(&["WAIT {{gas_postflow}}(sec)", "WAIT {{wire_retract_time}}(sec)"]));
    let inform = profile.dialects.inform.as_mut().unwrap();
    inform.wire_feed = lines(&["AOUT AO#(1) {{wire_feed_ratio}}"]);
    inform.arc_on.insert(0, "TIMER T={{gas_preflow}}".to_owned());
    inform.arc_off.extend(lines(&["TIMER T={{gas_postflow}}", "TIMER T={{wire_retract_time}}"]));
    let urscript = profile.dialects.urscript.as_mut().unwrap();
    urscript.wire_feed = lines(&["set_standard_analog_out(0, {{wire_feed_ratio}})"]);
    urscript.arc_off.push("sleep({{wire_retract_time}})".to_owned());
    profile
}

/// Two layers: a square, and a line whose bead grows wider.
fn job() -> Vec<Layer> {
    let layer = |index: usize| {
        let z = 1.4187 * (index + 1) as f64;
        let points = |xy: &[[f64; 2]]| xy.iter().map(|p| DVec3::new(p[0], p[1], z)).collect::<Vec<_>>();
        let square = points(&[[0.0, 0.0], [30.0, 0.0], [30.0, 30.0], [0.0, 30.0]]);
        let line = points(&[[50.0, 0.0], [70.0, 0.0], [90.0, 0.0]]);
        let pass = |kind, closed, points, width, speed| Pass { kind, closed, points, width, pace: speed, wait: 0.0 };
        let passes = vec![
            pass(PassKind::Contour, true, square, Along::Same(4.5), Along::Same(8.0)),
            pass(PassKind::Infill, false, line, Along::Each(vec![4.5, 6.0, 6.0]), Along::Each(vec![8.0, 6.0, 6.0])),
        ];
        Layer { index, z, height: 1.4187, passes, ..Layer::default() }
    };
    vec![layer(0), layer(1)]
}

/// Two squares with their overlaps and two lines, mm.
const LENGTH: f64 = 2.0 * (126.0 + 40.0);

fn written(name: &str, profile: &Profile) -> Files {
    written_of(name, profile, &job())
}

fn written_of(name: &str, profile: &Profile, layers: &[Layer]) -> Files {
    dialect::write(name, layers, &profile.job("demo")).unwrap()
}

/// Every dialect with its files and what an independent reader finds in them; `part` is its name in the files.
fn all(profile: &Profile, part: &str) -> Vec<(&'static str, Files, Motion)> {
    all_of(profile, part, &job())
}

fn all_of(profile: &Profile, part: &str, layers: &[Layer]) -> Vec<(&'static str, Files, Motion)> {
    let written = |name: &str, profile: &Profile| written_of(name, profile, layers);
    let upper = part.to_uppercase();
    let mut plain = profile.clone();
    plain.dialects.rapid.as_mut().unwrap().arc = RapidArc::Plain;
    let (krl, gcode, rapid) = (written("krl", profile), written("gcode", profile), written("rapid", profile));
    let (fanuc, inform, urscript) =
        (written("fanuc", profile), written("inform", profile), written("urscript", profile));
    let simple = written("rapid", &plain);
    // A dry run has no arc instructions.
    let output = if profile.is_dry_run() { "doArc" } else { "" };
    let motions = [
        readers::krl::run(&krl, &upper, "$OUT[2]"),
        readers::gcode::run(&gcode[&format!("{part}.nc")], 3, 5),
        readers::rapid::run(&rapid, part, output),
        readers::rapid::run(&simple, part, "doArc"),
        readers::fanuc::run(&fanuc, &upper),
        readers::inform::run(&inform, &upper),
        readers::urscript::run(&urscript[&format!("{part}.script")], 1),
    ];
    let names = ["krl", "gcode", "rapid", "rapid-plain", "fanuc", "inform", "urscript"];
    let files = [krl, gcode, rapid, simple, fanuc, inform, urscript];
    names.into_iter().zip(files).zip(motions).map(|((name, files), motion)| (name, files, motion)).collect()
}

/// A printer has no craters and its own retraction.
fn printer(mut profile: Profile) -> Profile {
    let ends = &mut profile.start_stop;
    (ends.crater_fill_time, ends.wire_retract) = (0.0, 0.0);
    profile
}

fn programs(profile: &Profile) -> Vec<LayerProgram> {
    let mut programmer = profile.programmer();
    job().iter().map(|layer| programmer.layer(layer)).collect()
}

fn metrics(profile: &Profile) -> Metrics {
    let mut metrics = Metrics::new(profile);
    job().iter().for_each(|layer| metrics.add(layer));
    metrics
}

/// Gas, start, end and drawing back 2 mm of wire at 2.4 m/min, s a pass.
const DELAY: f64 = 0.5 + 0.2 + 0.5 + 1.0 + 0.05;

fn near(a: f64, b: f64, by: f64) {
    assert!((a - b).abs() <= by, "{a} for {b}");
}

#[test]
fn every_dialect_writes_starts_and_stops_alike() {
    let profile = with_ends();
    let waited = metrics(&profile).dwell_time_s;
    assert!(waited > 600.0 && waited < 700.0, "{waited}");
    let all = all(&profile, "demo");
    let first = &all[0].2;
    // Hot start, steady, and lead-out; each piece of the line has its own speed.
    let speeds = |weld: &Weld| weld.speeds.clone();
    let expected = [vec![6.4, 8.0, 8.0, 8.0, 8.0, 8.0, 10.0], vec![6.4, 8.0, 6.0, 7.5]];
    for (weld, expected) in first.welds.iter().zip(expected.iter().cycle()) {
        assert_eq!(speeds(weld).len(), expected.len(), "{:?}", speeds(weld));
        assert!(speeds(weld).iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-3), "{:?}", speeds(weld));
    }
    for (name, files, motion) in &all {
        readers::golden(&format!("{name}-ends"), files);
        println!(
            "{name}: {:.4} mm, {} welds, {:.2} s of waits",
            motion.weld_length(),
            motion.welds.len(),
            motion.waits
        );
        near(motion.weld_length(), LENGTH, 0.01);
        assert_eq!(motion.welds.len(), 4, "{name}");
        near(motion.travel, first.travel, 0.01);
        for (a, b) in motion.welds.iter().zip(&first.welds) {
            assert!(a.points.iter().zip(&b.points).all(|(p, q)| distance(*p, *q) < 0.002), "{name}");
            // RAPID has steps of 0.2 mm/s.
            assert!(a.speeds.iter().zip(&b.speeds).all(|(v, w)| (v - w).abs() < 0.101), "{name}: {:?}", a.speeds);
        }
        // The arc instructions have times of their own in the seamdata, and wait for the end of the arc only.
        let own = *name == "rapid";
        let pass = if own { 0.5 } else { DELAY + 0.4 };
        near(motion.waits, 4.0 * pass + waited, 0.05);
        // Nominal, weak in the crater, nominal for the next pass; every layer begins with its own.
        let feeds = [1.0, 0.5, 1.0, 0.5, 1.0, 0.5, 1.0, 0.5];
        assert_eq!(motion.feeds, if own { &[][..] } else { &feeds[..] }, "{name}");
    }
    // Crater of 0.4 s with half of 2.4 m/min, and the wire drawn back for 0.05 s.
    let seam = all[2].1["demo.mod"].lines().find(|l| l.contains("seamdata")).unwrap();
    assert!(seam.contains(",0.400,[1,7,0.000,1.200,0.000,129.000,0,0,0],0.080,0.050,"), "{seam}");
}

#[test]
fn printers_write_waits_and_filament() {
    let profile = printer(with_ends());
    let files = written("marlin", &profile);
    readers::golden("marlin-ends", &files);
    let print = readers::marlin::run(&files["demo.gcode"]);
    let length: f64 = print.paths.iter().flat_map(|p| p.windows(2)).map(|p| distance(p[0], p[1])).sum();
    near(length, LENGTH, 0.01);
    assert_eq!(print.paths.len(), 4);
    near(print.waits, metrics(&profile).dwell_time_s, 1e-3);
    // A slower torch with the same wire lays more of it on each millimetre.
    let filament = |speed: f64| {
        let of = print.moves.iter().filter(|(s, _)| (s - speed).abs() < 0.01).map(|m| m.1);
        of.sum::<f64>() / print.moves.iter().filter(|(s, _)| (s - speed).abs() < 0.01).count() as f64
    };
    near(filament(6.4) / filament(8.0), 1.25, 1e-3);
    near(filament(10.0) / filament(8.0), 0.8, 1e-3);
}

/// With the wire feed following, the torch keeps its speed and the same metal is laid.
#[test]
fn the_wire_feed_follows() {
    let mut profile = with_ends();
    profile.process.follow = Follow::WireFeed;
    let ratios = [1.25, 1.0, 0.8, 0.5, 1.25, 1.0, 8.0 / 6.0, 0.8 * 8.0 / 6.0, 0.5];
    let metal = |motion: &Motion| -> f64 { motion.welds.iter().map(|w| w.speeds.len() as f64).sum() };
    let all = all(&profile, "demo");
    for (name, files, motion) in &all {
        assert!(motion.welds.iter().flat_map(|w| &w.speeds).all(|s| (s - 8.0).abs() < 1e-3), "{name}");
        assert_eq!(metal(motion), 2.0 * 11.0, "{name}");
        near(motion.weld_length(), LENGTH, 0.01);
        let feeds: Vec<f64> = ratios.iter().chain(&ratios).copied().collect();
        let alike = motion.feeds.iter().zip(&feeds).all(|(a, b)| (a - b).abs() < 1e-4);
        assert!(if *name == "rapid" { motion.feeds.is_empty() } else { alike && motion.feeds.len() == 18 }, "{name}");
        if *name == "rapid" {
            // 2.4 m/min times 1.25, where the nominal feed would go with 6.4 mm/s.
            assert!(
                files["demo_L001.mod"].contains("wd1:=[8.000,0,[1,7,0.000,3.000,0.000,"),
                "{}",
                files["demo_L001.mod"]
            );
            assert_eq!(files["demo_L001.mod"].matches("LOCAL PERS welddata ").count(), 5);
        }
    }
    // Time is another, wire is the same.
    let (speed, wire) = (metrics(&with_ends()), metrics(&profile));
    near(speed.wire_length_m, wire.wire_length_m, 1e-9);
    near(wire.arc_time_s, LENGTH / 8.0 + 4.0 * 0.4, 1e-9);
    let print = readers::marlin::run(&written("marlin", &printer(profile.clone()))["demo.gcode"]);
    let filament: f64 = print.moves.iter().map(|m| m.1).fold(0.0, f64::max);
    let least: f64 = print.moves.iter().map(|m| m.1).fold(f64::INFINITY, f64::min);
    near(filament / least, (8.0 / 6.0) / 0.8, 1e-3);
    assert!(print.moves.iter().all(|m| (m.0 - 8.0).abs() < 1e-3));
    // Feeds that differ by no more than the tolerance are written once.
    profile.program.speed_tolerance = 0.3;
    let changes = |layers: Vec<LayerProgram>| {
        let all = layers.into_iter().flat_map(|l| l.instructions);
        all.filter(|i| matches!(i, Instruction::WireFeed { .. })).count()
    };
    let joined = changes(programs(&profile));
    assert!(joined < 18, "{joined}");
}

/// Time and wire of the instructions, each counted for itself.
fn counted(profile: &Profile) -> (f64, f64) {
    let layers = programs(profile);
    let (mut at, mut time, mut wire, mut feed) = (None::<DVec3>, 0.0, 0.0, 1.0);
    for instruction in layers.iter().flat_map(|l| &l.instructions) {
        match *instruction {
            Instruction::Approach { to } | Instruction::Travel { to } | Instruction::Retract { to } => {
                time += at.map_or(0.0, |at| at.distance(to)) / profile.travel.speed;
                at = Some(to);
            }
            Instruction::Weld { to, speed, .. } => {
                let seconds = at.unwrap().distance(to) / speed;
                (time, wire, at) = (time + seconds, wire + seconds * feed, Some(to));
            }
            Instruction::ArcOn { .. } => time += DELAY,
            Instruction::ArcOff { .. }
            | Instruction::PassStart { .. }
            | Instruction::Turn { .. }
            | Instruction::Above
            | Instruction::PassEnd => {}
            Instruction::WireFeed { ratio } => feed = ratio,
            Instruction::Crater { seconds, ratio } => {
                feed = ratio.unwrap_or(feed);
                (time, wire) = (time + seconds, wire + seconds * feed);
            }
            Instruction::Dwell { seconds } => time += seconds,
        }
    }
    (time, wire * profile.process.wire_feed_speed / 60.0)
}

#[test]
fn totals_are_those_of_the_program() {
    for follow in [Follow::Speed, Follow::WireFeed] {
        let mut profile = with_ends();
        profile.process.follow = follow;
        let (time, wire) = counted(&profile);
        let metrics = metrics(&profile);
        // The totals leave the way down to the first pass out, which may come from anywhere.
        let down = profile.travel.clearance / profile.travel.speed;
        println!(
            "{:.3} s for {time:.3} s, {:.5} m for {wire:.5} m",
            metrics.total_time_s + down,
            metrics.wire_length_m
        );
        near((metrics.total_time_s + down) / time, 1.0, 1e-5);
        near(metrics.wire_length_m / wire, 1.0, 1e-5);
        near(metrics.deposited_length_mm, LENGTH, 1e-9);
        for (name, main) in [("krl", "DEMO.src"), ("gcode", "demo.nc")] {
            let program = back(&written(name, &profile), main);
            let totals = program.totals();
            let unknown = if name == "gcode" { totals.travel_length_mm / profile.travel.speed } else { 0.0 };
            let reported = totals.time_s + unknown - down;
            println!("{name}: {reported:.3} s for {:.3} s", metrics.total_time_s);
            near(reported / metrics.total_time_s, 1.0, 1e-5);
            near(totals.deposited_length_mm, LENGTH, 0.01);
            assert_eq!(totals.arc_starts, 4, "{name}");
            assert!(
                program.notes.iter().all(|n| ["axis angles", "$BASE"].iter().any(|known| n.contains(known))),
                "{:?}",
                program.notes
            );
        }
        // The seamdata let the wire burn back for 0.08 s, too, and so count the totals; speeds have steps.
        profile.posts = vec!["rapid".to_owned()];
        let totals = back(&written("rapid", &profile), "demo.mod").totals();
        assert_eq!(totals.arc_starts, 4);
        near((totals.time_s - down) / self::metrics(&profile).total_time_s, 1.0, 1e-4);
        // The wait after the first layer is as much shorter.
        near(self::metrics(&profile).total_time_s - metrics.total_time_s, 2.0 * 0.08, 1e-6);
        near(totals.deposited_length_mm, LENGTH, 0.01);
    }
}

fn back(files: &Files, main: &str) -> ReadProgram {
    common::read_back(files, main).unwrap()
}

#[test]
fn waits_of_fanuc_controls_are_read_in_milliseconds() {
    let program = |head: &str, wait: &str| {
        let text = format!("%\n{head}G21 G90\nG0 X0 Y0 Z0\nM3\nG4 {wait}\nG1 X10 F600\nM5\nM30\n%\n");
        read(&text, &mut |_| None, &Options::default()).unwrap().dwell
    };
    let number = "O1234 (PART)\n";
    assert_eq!((program("", "P500"), program(number, "P500")), (500.0, 0.5));
    assert_eq!((program(number, "P2.5"), program(number, "X20.0")), (2.5, 20.0));
}

#[test]
fn a_layer_waits_for_what_it_lacks() {
    let wait = |interpass: f64, least: f64| {
        let mut profile = plain();
        (profile.start_stop.interpass_time, profile.start_stop.min_layer_time) = (interpass, least);
        let m = metrics(&profile);
        (m.dwell_time_s, m.total_time_s)
    };
    let (none, whole) = wait(0.0, 0.0);
    assert_eq!(none, 0.0);
    assert_eq!(wait(7.5, 0.0).0, 7.5);
    // A layer takes about 25 s with its delays: only the rest is waited for, and never twice.
    let (rest, longer) = wait(0.0, 60.0);
    assert!(rest > 20.0 && rest < 40.0, "{rest}");
    // The torch goes up before it waits, instead of after.
    near(longer, whole + rest, 1e-6);
    assert_eq!(wait(5.0, 60.0).0, rest);
    assert_eq!(wait(rest + 5.0, 60.0).0, rest + 5.0);
}

#[test]
fn passes_wait_for_cool_metal_in_every_dialect() {
    let (profile, mut layers) = (plain(), job());
    let before = all_of(&profile, "demo", &layers);
    (layers[0].passes[1].wait, layers[1].passes[0].wait, layers[1].passes[1].wait) = (33.25, 12.0, 700.0);
    let metrics = layers.iter().fold(Metrics::new(&profile), |mut metrics, layer| {
        metrics.add(layer);
        metrics
    });
    near(metrics.dwell_time_s, 745.25, 1e-9);
    for ((name, _, without), (_, files, with)) in before.iter().zip(all_of(&profile, "demo", &layers)) {
        near(with.waits - without.waits, 745.25, 0.01);
        near(with.weld_length(), without.weld_length(), 1e-9);
        let main = files.keys().find(|file| file.to_lowercase().starts_with("demo.")).unwrap();
        println!("{name}: {main}");
        // Our own reader counts the waits too.
        if !name.starts_with("rapid") && *name != "krl" {
            let waited = |files: &Files| back(files, main).dwell;
            assert!(waited(&files) > 745.0, "{name}: {}", waited(&files));
        }
    }
}

#[test]
fn long_waits_are_cut_for_timers() {
    let mut profile = plain();
    profile.start_stop.interpass_time = 2000.0;
    let wait = |name: &str| written(name, &profile);
    near(readers::fanuc::run(&wait("fanuc"), "DEMO").waits, 2000.0 + 4.0 * 0.7, 1e-6);
    near(readers::inform::run(&wait("inform"), "DEMO").waits, 2000.0 + 4.0 * 0.7, 1e-6);
}

#[test]
fn a_dry_run_moves_alike_and_lights_nothing() {
    let mut profile = with_ends();
    profile.dialects.fanuc.as_mut().unwrap().speed = FanucSpeed::WeldSpeed;
    profile.process.follow = Follow::WireFeed;
    let dry = profile.clone().dry_run();
    profile.dialects.fanuc.as_mut().unwrap().speed = FanucSpeed::MillimetresPerSecond;
    let hot = all(&profile, "demo");
    let cold = all(&dry, "dry_demo");
    for ((name, files, motion), (_, _, hot)) in cold.iter().zip(&hot) {
        println!("{name}: {:.3} mm", motion.travel);
        assert!(motion.welds.is_empty() && motion.feeds.is_empty() && motion.waits == 0.0, "{name}: {motion:?}");
        near(motion.travel, hot.travel + hot.weld_length(), 0.01);
        let said = |text: &String| text.contains("DRY RUN") || text.contains("dry_demo") || text.contains("DRY_DEMO");
        assert!(files.values().all(said), "{name}");
        let lit =
            ["$OUT[1] = TRUE", "M3\n", "M64", "ArcL", "SetDO", "Weld Start", "DO[1]=ON", "ARCON", "_out(0, True)"];
        assert!(files.values().all(|text| lit.iter().all(|w| !text.contains(w))), "{name}");
    }
    let print = readers::marlin::run(&written("marlin", &dry)["dry_demo.gcode"]);
    assert!(print.paths.is_empty() && print.filament == 0.0 && print.drawn_back == 0.0);
    near(print.travel, cold[0].2.travel, 0.01);
    // Arcs too.
    (profile.program.chord_tolerance, profile.program.arcs) = (0.05, true);
    for (_, _, motion) in all(&profile.dry_run(), "dry_demo") {
        near(motion.travel, cold[0].2.travel, 0.01);
    }
}

#[test]
fn what_a_dialect_cannot_do_is_refused() {
    let refused = |name: &str, change: fn(&mut Profile)| {
        let mut profile = plain();
        change(&mut profile);
        dialect::writer(name, &profile.job("demo")).err().map(|e| e.to_string())
    };
    for name in ["krl", "gcode", "fanuc", "inform", "urscript"] {
        let feed = refused(name, |p| p.process.follow = Follow::WireFeed).unwrap();
        let says = [&*format!("no {name}.wire_feed"), "process.follow = \"wire-feed\"", "{{wire_feed_ratio}}"];
        assert!(says.iter().all(|words| feed.contains(words)), "{feed}");
        let weak = |p: &mut Profile| (p.start_stop.crater_fill_time, p.start_stop.crater_power) = (0.5, 0.5);
        assert!(refused(name, weak).unwrap().contains("crater_power"));
        assert_eq!(refused(name, |p| p.start_stop.crater_fill_time = 0.5), None);
        let wire = refused(name, |p| p.start_stop.wire_retract = 2.0).unwrap();
        assert!(wire.contains(&format!("no {name}.arc_off with {{{{wire_retract}}}}")), "{wire}");
    }
    // RAPID's arc instructions have all of it; plain moves have not.
    assert_eq!(refused("rapid", |p| p.process.follow = Follow::WireFeed), None);
    let plain = |p: &mut Profile| {
        (p.process.follow, p.dialects.rapid.as_mut().unwrap().arc) = (Follow::WireFeed, RapidArc::Plain);
    };
    assert!(refused("rapid", plain).unwrap().contains("no rapid.wire_feed"));
    assert_eq!(refused("marlin", |p| p.process.follow = Follow::WireFeed), None);
    assert!(refused("marlin", |p| p.start_stop.crater_fill_time = 0.5).unwrap().contains("crater"));
    assert!(refused("marlin", |p| p.start_stop.wire_retract = 2.0).unwrap().contains("marlin.retract_length"));
}

#[test]
fn passes_too_short_for_their_ends_share_them() {
    let ends = with_ends().start_stop;
    let x = |at: f64| DVec3::new(at, 0.0, 0.0);
    let pass = |closed, points| Pass {
        kind: PassKind::Infill,
        closed,
        points,
        width: Along::Same(4.5),
        pace: Along::Same(8.0),
        wait: 0.0,
    };
    // 5 and 4 mm on 4.5 mm: half of each.
    let short = weld::path(&pass(false, vec![x(0.0), x(4.5)]), &ends);
    assert_eq!(short.len(), 3);
    near(short[1].0.x, 2.5, 1e-9);
    assert_eq!((short[1].1, short[2].1), (6.4, 10.0));
    // An overlap goes around once at most: there and back twice.
    let tiny = weld::path(&pass(true, vec![x(0.0), x(2.0)]), &ends);
    let length: f64 = tiny.windows(2).map(|w| w[0].0.distance(w[1].0)).sum();
    near(length, 8.0, 1e-9);
    // Where a change falls on a point, no point is added.
    let exact = weld::path(&pass(false, vec![x(0.0), x(5.0), x(16.0), x(20.0)]), &ends);
    assert_eq!(exact.iter().map(|m| m.1).skip(1).collect::<Vec<_>>(), [6.4, 8.0, 10.0]);
    for points in [vec![], vec![x(1.0)], vec![x(1.0), x(1.0)]] {
        assert!(weld::path(&pass(false, points), &ends).iter().all(|m| m.0 == x(1.0)));
    }
}

#[test]
fn ends_that_do_not_fit_the_shortest_pass_are_noted() {
    let mut profile = plain();
    let none = profile.notes().len();
    (profile.start_stop.lead_in_length, profile.start_stop.lead_out_length) = (3.0, 2.5);
    assert!(profile.notes().iter().any(|n| n.contains("take 5.5 mm, but fill.min_pass_length is 5 mm")));
    profile.start_stop.end_overlap = 6.0;
    assert_eq!(profile.notes().len(), none + 2);
}

/// What is judged is what the program lays: the metal of the ends is in the deposit model.
#[test]
fn the_deposit_model_sees_overlaps_and_leads() {
    let mesh = beadwright::example::find("cross").unwrap().mesh();
    let base = Profile::built_in_text("cmt-al2319-kuka").unwrap();
    let with = |values: &[(&str, &str)]| {
        let lay = |text: String, (k, v): &(&str, &str)| edit::with_value(&text, k, v).unwrap();
        Profile::parse(&values.iter().fold(base.to_owned(), lay)).unwrap()
    };
    let volumes = |profile: &Profile| {
        let plan = plan::plan("cross", &mesh, profile, &Task::new()).unwrap();
        let settings = plan::deposit_settings(profile);
        let judged =
            check::judge_layers(&plan.layers[..1], profile, Judge::new(settings), None, &Task::new(), |_, _| ())
                .unwrap();
        let mut metrics = Metrics::new(profile);
        metrics.add(&plan.layers[0]);
        (judged.total.deposited_volume, metrics.deposited_volume_mm3, judged.total.overfill_percent())
    };
    let plain = volumes(&with(&[]));
    assert!((plain.0 / plain.1 - 1.0).abs() < 1e-9);
    let ends =
        [("start_stop.end_overlap", "12.0"), ("start_stop.lead_in_length", "8.0"), ("start_stop.lead_in_power", "1.5")];
    let more = volumes(&with(&ends));
    assert!((more.0 / more.1 - 1.0).abs() < 1e-9, "{more:?}");
    assert!(more.0 > plain.0 + 1.0 && more.2 > plain.2, "{plain:?} {more:?}");
    // A crater is filled at one place, which no piece of a pass shows.
    let crater = volumes(&with(&[("start_stop.crater_fill_time", "2.0")]));
    assert_eq!(crater.0, plain.0);
}
