//! What some controllers can do besides: weaving, spline motions, and heights added to layers. Each is told, or refused.
#![allow(clippy::unwrap_used)]

mod common;

use beadwright::dialect::krl::{KrlArc, KrlMotion};
use beadwright::dialect::{self, DialectError};
use beadwright::plan::Plan;
use beadwright::profile::Profile;
use beadwright::program::Weave;
use common::{planned, profile};
use std::collections::BTreeMap;

type Files = BTreeMap<String, String>;

fn plan_of(name: &str) -> (Plan, Profile) {
    let mut profile = profile(name);
    profile.fill.strategy = "contour".to_owned();
    profile.program.chord_tolerance = 0.05;
    profile.program.arcs = true;
    (planned("cross", &profile), profile)
}

fn try_write(post: &str, plan: &Plan, profile: &Profile) -> Result<Files, DialectError> {
    dialect::write(post, &plan.layers, &profile.job("demo"))
}

#[test]
fn the_torch_weaves_where_the_controller_can() {
    let weave = Weave { length: 4.0, amplitude: 1.5, dwell: 0.1, file: 3 };
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
    let data = "weavedata wvBead:=[1,0,4.000,3.000,0,0.800,0,0.800,0,0,0,0,0,0,0];";
    check("rapid", "cmt-steel-abb", |_| {}, &[data, ",wd1\\Weave:=wvBead,"]);
    // Others would weld straight without a word.
    for (post, name) in [("krl", "cmt-al2319-kuka"), ("urscript", "cmt-steel-robots"), ("gcode", "plasma-304-cnc")] {
        let (plan, mut profile) = plan_of(name);
        profile.weave = Some(weave.clone());
        let said = try_write(post, &plan, &profile).unwrap_err().to_string();
        assert!(said.contains("[weave]"), "{said}");
        assert!(try_write(post, &plan, &profile.dry_run()).is_ok(), "a dry run has no arc to weave");
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
    let told =
        ["added", "PDispSet", "an offset"].iter().any(|word| program.notes.iter().any(|note| note.contains(word)));
    (format!("{:?}", program.totals()), told)
}

/// Layers have heights of their own to be added: 0 until somebody sets them, which our reader then tells.
#[test]
fn layers_can_be_lifted() {
    for (post, name, main, zero, lifted) in [
        ("krl", "cmt-al2319-kuka", "DEMO.src", "DEMO_DZ[2]=0.0", "DEMO_DZ[2]=0.5"),
        ("rapid", "cmt-steel-abb", "demo.mod", ":=[0,0,", ":=[0,0.5,"),
        ("fanuc", "cmt-steel-robots", "DEMO.ls", "PR[90,3]=0 ;", "PR[90,3]=0.5 ;"),
        ("urscript", "cmt-steel-robots", "demo.script", "layer_dz = [0.0, 0.0", "layer_dz = [0.0, 0.5"),
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
        assert!(totals(&files, main).1 || post == "urscript", "{post}: nothing told");
    }
    for (post, name) in [("inform", "cmt-steel-robots"), ("gcode", "plasma-304-cnc"), ("marlin", "fdm-abs-0.4")] {
        let (plan, mut profile) = plan_of(name);
        profile.program.layer_offsets = true;
        let said = try_write(post, &plan, &profile).unwrap_err().to_string();
        assert!(said.contains("program.layer_offsets"), "{said}");
    }
}
