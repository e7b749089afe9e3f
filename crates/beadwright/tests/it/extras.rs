//! What some controllers can do besides: weaving, spline motions, and heights added to layers. Each is written, or refused.

use crate::common;
use beadwright::fill::StrategyName;

use beadwright::dialect::krl::{KrlArc, KrlMotion};
use beadwright::dialect::rapid::RapidArc;
use beadwright::dialect::reading::{ReadPass, ReadProgram};
use beadwright::dialect::{self, DialectError};
use beadwright::layer::Layer;
use beadwright::pass::{Along, Pass, PassKind};
use beadwright::plan::Plan;
use beadwright::profile::Profile;
use beadwright::program::Weave;
use common::{flat, planned, profile};
use glam::DVec3;
use std::collections::BTreeMap;

type Files = BTreeMap<String, String>;

fn plan_of(name: &str) -> (Plan, Profile) {
    let mut profile = flat(profile(name));
    profile.fill.strategy = StrategyName::Contour;
    profile.program.chord_tolerance = 0.05;
    profile.program.arcs = true;
    (planned("cross", &profile), profile)
}

fn try_write(post: &str, plan: &Plan, profile: &Profile) -> Result<Files, DialectError> {
    dialect::write(post, &plan.layers, &profile.job("demo"))
}

#[test]
fn the_torch_weaves_where_the_controller_can() {
    let weave = Weave { length: 4.0, amplitude: 1.5, dwell: 0.1, file: 3, layers: Vec::new() };
    let check = |post: &str, name: &str, change: fn(&mut Profile), words: &[&str]| {
        let (plan, mut profile) = plan_of(name);
        change(&mut profile);
        profile.weave = Some(weave.clone());
        let text: String = try_write(post, &plan, &profile).unwrap().into_values().collect();
        words.iter().for_each(|word| assert!(text.contains(word), "{post}: no {word}"));
        let passes = plan.summary.metrics.arc_starts;
        let begins = text.matches(words[0]).count();
        (passes, begins)
    };
    let (passes, begins) =
        check("fanuc", "cmt-steel-robots", |_| {}, &["Weave Sine[2.0Hz,1.5mm,0.100s,0.100s]", "Weave End"]);
    assert_eq!(passes, begins);
    let (passes, begins) = check("inform", "cmt-steel-robots", |_| {}, &["WVON WEV#(3)", "WVOF"]);
    assert_eq!(passes, begins);
    let pattern =
        "Pattern #Triangle,Length 4.00000,Amplitude 1.50000,Angle 0.0,LeftSideDelay 0.100,RightSideDelay 0.100";
    check("krl", "cmt-al2319-kuka", |p| p.dialects.krl.as_mut().unwrap().arc = KrlArc::Arctech, &[pattern]);
    let data = "weavedata wv1:=[1,0,4.000,3.000,0,0.800,0,0.800,0,0,0,0,0,0,0];";
    check("rapid", "cmt-steel-abb", |_| {}, &[data, ",wd1\\Weave:=wv1,"]);
    // A printer would lay its strands straight without a word.
    let (plan, mut profile) = plan_of("fdm-abs-0.4");
    profile.weave = Some(weave.clone());
    let said = try_write("marlin", &plan, &profile).unwrap_err().to_string();
    assert!(said.contains("[weave]"), "{said}");
}

/// Where the controller does not weave by itself, the torch swings by moves: from end to end of each pass in the time of the
/// pass, to both sides of it. A dry run swings too.
#[test]
fn the_torch_weaves_by_moves_elsewhere() {
    for (post, name, main) in [
        ("krl", "cmt-al2319-kuka", "DEMO.src"),
        ("rapid", "cmt-steel-abb", "demo.mod"),
        ("urscript", "cmt-steel-robots", "demo.script"),
        ("gcode", "plasma-304-cnc", "cross.nc"),
    ] {
        let (plan, mut profile) = plan_of(name);
        (profile.program.chord_tolerance, profile.program.arcs) = (0.0, false);
        if let Some(rapid) = profile.dialects.rapid.as_mut() {
            (rapid.arc, rapid.speed_step) = (RapidArc::Plain, 0.001);
        }
        if let Some(urscript) = profile.dialects.urscript.as_mut() {
            urscript.max_megabytes = 1000.0;
        }
        let read = |profile: &Profile| {
            let files =
                dialect::write(post, &plan.layers, &profile.job(if post == "gcode" { "cross" } else { "demo" }));
            common::read_back(&files.unwrap(), main).unwrap()
        };
        let plain = read(&profile);
        profile.weave = Some(Weave { length: 4.0, amplitude: 1.5, dwell: 0.05, file: 1, layers: Vec::new() });
        let woven = read(&profile);
        assert_eq!(plain.totals().arc_starts, woven.totals().arc_starts, "{post}");
        let seconds = |program: &ReadProgram| program.layers().iter().flat_map(|l| &l.passes).map(time).sum::<f64>();
        let (a, b) = (seconds(&plain), seconds(&woven));
        assert!((a / b - 1.0).abs() < 2e-3, "{post}: {b} s for {a}");
        assert!(woven.totals().deposited_length_mm > 1.3 * plain.totals().deposited_length_mm, "{post}");
        for (straight, swinging) in plain.layers().iter().zip(&woven.layers()) {
            for (pass, swings) in straight.passes.iter().zip(&swinging.passes) {
                assert_eq!((pass.points[0], pass.points.last()), (swings.points[0], swings.points.last()));
                let off = |p: &DVec3| pass.points.windows(2).map(|w| gap(w, *p)).fold(f64::INFINITY, f64::min);
                let farthest = swings.points.iter().map(off).fold(0.0, f64::max);
                assert!((1.3..1.51).contains(&farthest), "{post}: {farthest}");
            }
        }
    }
}

/// Time of a pass, s.
fn time(pass: &ReadPass) -> f64 {
    pass.points.windows(2).zip(&pass.speed).map(|(w, speed)| w[0].distance(w[1]) / speed).sum()
}

/// How far a point lies from a piece.
fn gap(piece: &[DVec3], at: DVec3) -> f64 {
    let (from, along) = (piece[0], piece[1] - piece[0]);
    let part = ((at - from).dot(along) / along.length_squared().max(1e-12)).clamp(0.0, 1.0);
    at.distance(from + along * part)
}

/// The frequency follows the speed of each move, so that a swing is as long everywhere; so does the way for which RobotWare
/// stays at a side.
#[test]
fn the_weave_follows_the_speed_of_each_move() {
    let at = |x: f64| DVec3::new(x, 0.0, 2.0);
    let pass = Pass {
        kind: PassKind::Infill,
        closed: false,
        points: vec![at(0.0), at(40.0), at(80.0)],
        width: Along::Same(4.5),
        pace: Along::Each(vec![8.0, 10.4, 10.4]),
        wait: 0.0,
    };
    let layers = vec![Layer { z: 2.0, height: 2.0, passes: vec![pass], ..Layer::default() }];
    let weave = Weave { length: 4.0, amplitude: 1.5, dwell: 0.1, file: 1, layers: Vec::new() };
    let mut robots = profile("cmt-steel-robots");
    robots.weave = Some(weave.clone());
    let text = &dialect::write("fanuc", &layers, &robots.job("demo")).unwrap()["DEMO_L001.ls"];
    let lines: Vec<&str> =
        text.lines().filter(|l| l.contains("Weave") || l.contains(":L P")).map(|l| &l[5..]).collect();
    assert_eq!(
        lines[1..6],
        [
            "  Weave Sine[2.0Hz,1.5mm,0.100s,0.100s] ;",
            "L P[3] 8.0mm/sec CNT100 ;",
            "  Weave End ;",
            "  Weave Sine[2.6Hz,1.5mm,0.100s,0.100s] ;",
            "L P[4] 10.4mm/sec FINE ;"
        ]
    );
    let mut abb = profile("cmt-steel-abb");
    abb.weave = Some(weave);
    let text = &dialect::write("rapid", &layers, &abb.job("demo")).unwrap()["demo_L001.mod"];
    for part in ["wv1:=[1,0,4.000,3.000,0,0.800,0,0.800,", "wv2:=[1,0,4.000,3.000,0,1.040,0,1.040,", "wd2\\Weave:=wv2,"]
    {
        assert!(text.contains(part), "no {part} in {text}");
    }
}

/// SLIN and SCIRC run where LIN and CIRC do.
#[test]
fn spline_motions_run_the_same_way() {
    let (plan, mut profile) = plan_of("cmt-al2319-kuka");
    let plain = try_write("krl", &plan, &profile).unwrap();
    profile.dialects.krl.as_mut().unwrap().motion = KrlMotion::Slin;
    let splines = try_write("krl", &plan, &profile).unwrap();
    let text: String = splines.values().map(String::as_str).collect();
    assert!(text.contains("SLIN {") && text.contains("SCIRC {") && text.contains(" C_SPL\r\n"), "{text}");
    let back = |text: &str| text.replace("SLIN ", "LIN ").replace("SCIRC ", "CIRC ").replace(" C_SPL", " C_DIS");
    for (file, text) in &splines {
        assert_eq!(back(text), plain[file], "{file}");
    }
    assert_eq!(totals(&splines, "DEMO.src"), totals(&plain, "DEMO.src"));
    // The forms of ArcTech move by LIN; the two kinds do not blend into each other.
    profile.dialects.krl.as_mut().unwrap().arc = KrlArc::Arctech;
    let said = try_write("krl", &plan, &profile).unwrap_err().to_string();
    assert!(said.contains("slin") && said.contains("arctech"), "{said}");
}

/// Length, starts, travel and time as our own reader finds them, and what it does not apply.
fn totals(files: &Files, main: &str) -> (String, bool) {
    let program = common::read_back(files, main).unwrap();
    let reported = ["added", "PDispSet", "an offset", "shifts"]
        .iter()
        .any(|word| program.notes.iter().any(|note| note.contains(word)));
    (format!("{:?}", program.totals()), reported)
}

/// Layers have heights of their own to be added: 0 until somebody sets them, which our reader then reports.
#[test]
fn layers_can_be_lifted() {
    for (post, name, main, zero, lifted) in [
        ("krl", "cmt-al2319-kuka", "DEMO.src", "DEMO_DZ[2]=0.0", "DEMO_DZ[2]=0.5"),
        ("rapid", "cmt-steel-abb", "demo.mod", ":=[0,0,", ":=[0,0.5,"),
        ("fanuc", "cmt-steel-robots", "DEMO.ls", "PR[90,3]=0 ;", "PR[90,3]=0.5 ;"),
        ("urscript", "cmt-steel-robots", "demo.script", "layer_dz = [0.0, 0.0", "layer_dz = [0.0, 0.5"),
        ("inform", "cmt-steel-robots", "DEMO.jbi", "SETE P090 (3) 0", "SETE P090 (3) 500"),
        ("gcode", "plasma-304-cnc", "demo.nc", "G52 X0.0 Y0.0 Z0.000", "G52 X0.0 Y0.0 Z0.5"),
        ("gcode", "plasma-304-fanuc", "demo.nc", "G52 X0.0 Y0.0 Z0.000", "G52 X0.0 Y0.0 Z0.5"),
        ("gcode", "plasma-304-siemens", "DEMO.MPF", "TRANS Z0.000", "TRANS Z0.5"),
        ("gcode", "plasma-304-twincat", "demo.nc", "G58 X0.0 Y0.0 Z0.000", "G58 X0.0 Y0.0 Z0.5"),
    ] {
        let (plan, mut profile) = plan_of(name);
        if let Some(urscript) = profile.dialects.urscript.as_mut() {
            urscript.max_megabytes = 1000.0;
        }
        let plain = try_write(post, &plan, &profile).unwrap();
        profile.program.layer_offsets = true;
        let mut files = try_write(post, &plan, &profile).unwrap();
        assert_eq!(totals(&files, main), totals(&plain, main), "{post}");
        assert!(files.values().any(|text| text.contains(zero)), "{post}: no {zero}");
        files.values_mut().for_each(|text| *text = text.replacen(zero, lifted, 1));
        assert!(totals(&files, main).1 || post == "urscript", "{post}: nothing reported");
    }
    for (post, name) in [("gcode", "plasma-304-cnc"), ("marlin", "fdm-abs-0.4")] {
        let (plan, mut profile) = plan_of(name);
        profile.program.layer_offsets = true;
        profile.dialects.gcode.iter_mut().for_each(|gcode| gcode.control = None);
        let said = try_write(post, &plan, &profile).unwrap_err().to_string();
        assert!(said.contains("program.layer_offsets"), "{said}");
    }
}
