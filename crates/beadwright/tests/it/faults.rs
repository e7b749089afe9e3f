//! Programs read as a welding programmer would before pressing start: what we write has nothing dangerous in it, and every
//! fault that is put into it is found, by the reader, by the check of a profile, or because the post refuses.

use crate::common;

use beadwright::check;
use beadwright::dialect::krl::KrlArc;
use beadwright::dialect::rapid::RapidArc;
use beadwright::dialect::reading::{Fault, read};
use beadwright::dialect::{self};
use beadwright::layer::Layer;
use beadwright::pass::{Along, Pass, PassKind};
use beadwright::profile::Profile;
use beadwright::program::Weave;
use common::{profile, with_all_dialects};
use glam::{DVec2, DVec3};
use std::collections::BTreeMap;
use std::f64::consts::TAU;

type Files = BTreeMap<String, String>;

/// Two layers: a ring, and a line that becomes faster.
fn job() -> Vec<Layer> {
    let layer = |index: usize| {
        let z = 1.4187 * (index + 1) as f64;
        let ring =
            (0..90).map(|k| (DVec2::new(3.0, 1.0) + 40.0 * DVec2::from_angle(TAU * f64::from(k) / 90.0)).extend(z));
        let line = [0.0, 30.0, 60.0].map(|x| DVec3::new(x, 70.0, z));
        let pass = |kind, closed, points, pace| Pass { kind, closed, points, width: Along::Same(4.5), pace, wait: 0.0 };
        let passes = vec![
            pass(PassKind::Contour, true, ring.collect(), Along::Same(8.0)),
            pass(PassKind::Infill, false, line.to_vec(), Along::Each(vec![8.0, 10.4, 10.4])),
        ];
        Layer { index, z, height: 1.4187, passes, ..Layer::default() }
    };
    vec![layer(0), layer(1)]
}

/// A profile with all dialects; arcs are fitted.
fn base() -> Profile {
    let mut all = with_all_dialects("cmt-steel-robots");
    (all.program.chord_tolerance, all.program.arcs) = (0.05, true);
    all.dialects.rapid.as_mut().unwrap().speed_step = 0.1;
    all
}

fn written(post: &str, profile: &Profile) -> Files {
    dialect::write(post, &job(), &profile.job("demo")).unwrap()
}

/// The file that calls the others.
fn main_of(files: &Files) -> &str {
    let programs = files.keys().filter(|file| !file.ends_with(".dat") && !file.ends_with(".pgf"));
    programs.min_by_key(|file| file.len()).unwrap()
}

/// What the reader finds in a program, whose main file may have another name.
fn faults_named(post: &str, profile: &Profile, files: &Files, name: &str) -> Vec<Fault> {
    let mut find = |name: &str| {
        let names = ["", ".src", ".mod", ".ls", ".jbi"].map(|end| format!("{name}{end}"));
        names.iter().find_map(|name| files.get(name)).cloned()
    };
    let options = profile.reading_options(Some(name), Some(post));
    read(&files[main_of(files)], &mut find, &options).unwrap().faults
}

fn faults(post: &str, profile: &Profile, files: &Files) -> Vec<Fault> {
    faults_named(post, profile, files, main_of(files))
}

/// Sets what a program is asked for.
type Ask = fn(&mut Profile);

/// Ways to write with what programs may be asked for.
fn asked() -> Vec<(String, &'static str, Profile)> {
    let mut all = Vec::new();
    let ways: [(&str, Ask); 7] = [
        ("plain", |_| {}),
        ("table", |p| p.program.table_side = Some(-90.0)),
        ("restart", |p| p.program.restart = true),
        ("offsets", |p| p.program.layer_offsets = true),
        ("tilt", |p| (p.program.follow_wall, p.program.travel_angle) = (1.0, 8.0)),
        ("weave", |p| p.weave = Some(Weave { length: 4.0, amplitude: 1.5, dwell: 0.1, file: 1, layers: Vec::new() })),
        ("ends", |p| (p.start_stop.crater_fill_time, p.start_stop.interpass_time) = (0.5, 20.0)),
    ];
    for (what, ask) in ways {
        for (post, kind) in [
            ("krl", ""),
            ("krl", "arctech"),
            ("rapid", ""),
            ("rapid", "plain"),
            ("fanuc", ""),
            ("inform", ""),
            ("urscript", ""),
            ("gcode", "plasma-304-cnc"),
            ("gcode", "plasma-304-fanuc"),
            ("gcode", "plasma-304-siemens"),
            ("gcode", "plasma-304-twincat"),
        ] {
            let mut profile = base();
            match kind {
                "arctech" => profile.dialects.krl.as_mut().unwrap().arc = KrlArc::Arctech,
                "plain" => profile.dialects.rapid.as_mut().unwrap().arc = RapidArc::Plain,
                "" => {}
                name => profile.dialects.gcode = common::profile(name).dialects.gcode,
            }
            ask(&mut profile);
            all.push((format!("{what} {post} {kind}"), post, profile));
        }
    }
    all
}

#[test]
fn nothing_dangerous_is_written() {
    let mut written = 0;
    for (case, post, profile) in asked() {
        let Ok(files) = dialect::write(post, &job(), &profile.job("demo")) else { continue };
        let found: Vec<String> = faults(post, &profile, &files).iter().map(Fault::to_string).collect();
        assert!(found.is_empty(), "{case}: {found:?}");
        written += 1;
    }
    assert!(written > 50, "{written}");
    for (name, _) in beadwright::profile::BUILT_IN {
        let found = check::rehearse(&profile(name));
        assert!(found.is_empty(), "{name}: {found:?}");
    }
}

/// Every built-in profile says what the cell must supply.
#[test]
fn every_profile_says_what_the_cell_must_supply() {
    for (name, _) in beadwright::profile::BUILT_IN {
        assert!(profile(name).safety.supplies.len() > 1, "{name}");
    }
}

/// A fault put into a program: its dialect, how the program is asked for, a text and what takes its place, and the kind that
/// must be found.
type Seed = (&'static str, Ask, &'static str, &'static str, &'static str);

fn as_it_is(_: &mut Profile) {}

fn table(profile: &mut Profile) {
    profile.program.table_side = Some(-90.0);
}

fn standing_table(profile: &mut Profile) {
    profile.program.table_angle = Some(-35.0);
}

/// A wait for the arc as it is written in a hurry.
fn endless(profile: &mut Profile) {
    let lines = ["def wait_for_arc():", "  while not get_standard_digital_in(0):", "    sync()", "  end", "end"];
    let hooks = &mut profile.dialects.urscript.as_mut().unwrap().hooks;
    let thread = hooks.watch_routines.iter().position(|line| line.starts_with("thread ")).unwrap();
    hooks.watch_routines.splice(..thread, lines.map(str::to_owned));
}

/// An arc that is struck while the robot goes past the start.
fn advanced(profile: &mut Profile) {
    profile.dialects.krl.as_mut().unwrap().arc_on = ["CONTINUE", "$OUT[2] = TRUE"].map(str::to_owned).to_vec();
}

fn plain(profile: &mut Profile) {
    profile.dialects.rapid.as_mut().unwrap().arc = RapidArc::Plain;
}

fn arctech(profile: &mut Profile) {
    profile.dialects.krl.as_mut().unwrap().arc = KrlArc::Arctech;
}

fn weave(profile: &mut Profile) {
    profile.weave = Some(Weave { length: 4.0, amplitude: 1.5, dwell: 0.1, file: 1, layers: Vec::new() });
}

fn offsets(profile: &mut Profile) {
    profile.program.layer_offsets = true;
}

#[rustfmt::skip]
const SEEDS: &[Seed] = &[
    // A frame that stands below a table that turns, and axes that are missing.
    ("krl", table, "EK(MACHINE_DEF[2].ROOT,MACHINE_DEF[2].MECH_TYPE,BASE_DATA[1])", "BASE_DATA[1]", "static-frame"),
    ("krl", table, "A6 0.0,E1 0.0000}", "A6 0.0}", "missing-axis"),
    ("krl", standing_table, ",E1 -35.0000} C_DIS", "} C_DIS", "missing-axis"),
    ("rapid", standing_table, "[-35.0000,9E+09,9E+09,9E+09,9E+09,9E+09]],vTravel,smBead", "[9E+09,9E+09,9E+09,9E+09,9E+09,9E+09]],vTravel,smBead", "missing-axis"),
    ("rapid", table, "[FALSE,FALSE,\"STN1\",", "[FALSE,TRUE,\"\",", "static-frame"),
    ("rapid", table, "30.000,0.000],[0.0000,", "30.000,0.000],[9E+09,", "missing-axis"),
    // The watch over the arc.
    ("krl", as_it_is, "WAIT SEC 0\r\n", "", "unwatched-end"),
    ("krl", as_it_is, "INTERRUPT ON 11\r\nINTERRUPT ON 12\r\nDEMO_ARC( )\r\n", "DEMO_ARC( )\r\nINTERRUPT ON 11\r\n", "unwatched-start"),
    ("krl", as_it_is, "INTERRUPT ON 11\r\nINTERRUPT ON 12\r\n", "", "unwatched-arc"),
    ("krl", as_it_is, "INTERRUPT ON 12\r\nDEMO_ARC( )\r\nEND", "INTERRUPT ON 12\r\nWAIT FOR $IN[1]\r\nEND", "endless-wait"),
    ("krl", as_it_is, "WAIT SEC 5\r\n$OUT[1] = FALSE\r\nHALT", "HALT", "left-on"),
    ("krl", as_it_is, "INTERRUPT DECL 2 WHEN $STOPMESS==TRUE DO ARC_STOP( )\r\n", "", "stop-leaves-on"),
    ("rapid", plain, "WaitTime \\InPos,0;\r\n    IDelete iArc;", "IDelete iArc;", "unwatched-end"),
    ("rapid", plain, "    WatchArc;\r\n    ArcBurns;\r\n", "    ArcBurns;\r\n    WatchArc;\r\n", "unwatched-start"),
    ("rapid", plain, "    WatchArc;\r\n", "", "unwatched-arc"),
    ("rapid", plain, "    ArcBurns;\r\n    StartMove;", "    WaitDI diArc,1;\r\n    StartMove;", "endless-wait"),
    ("rapid", plain, "    SetDO doGas,0;\r\n    TPWrite \"The arc is out", "    TPWrite \"The arc is out", "left-on"),
    ("rapid", plain, "    TriggStopProc rdArc\\DO1:=doArc,doShadow;\r\n", "", "stop-leaves-on"),
    ("urscript", as_it_is, "    watch = run watch_arc()\n", "", "unwatched-arc"),
    ("urscript", endless, "sync()", "sync()", "endless-wait"),
    ("urscript", as_it_is, "          set_standard_digital_out(0, False)\n          popup", "          popup", "left-on"),
    ("urscript", as_it_is, "to_value(1, 1)", "to_value(1, 4)", "stop-leaves-on"),
    ("urscript", as_it_is, "  set_runstate_standard_digital_output_to_value(0, 1)\n", "", "stop-leaves-on"),
    ("gcode", as_it_is, " M65 P0\n", " G4 P0\n", "left-on"),
    // How the torch is held and the arc is switched.
    ("urscript", as_it_is, "mode=0", "mode=1", "turning-torch"),
    ("krl", as_it_is, "$CIRC_TYPE = #BASE", "$CIRC_TYPE = #PATH", "turning-torch"),
    ("krl", advanced, "180.0000}\r\n; pass 1 contour\r\n", "180.0000} C_DIS\r\n", "blended-switch"),
    ("rapid", plain, ",vTravel,fine,tTorch\\WObj:=wPart;\r\n    ! pass 1 contour\r\n    WaitTime \\InPos,0;\r\n    WaitDI diArc,0;\r\n    SetDO doGas,1;\r\n    WaitTime \\InPos,0.5;", ",vTravel,zBead,tTorch\\WObj:=wPart;\r\n    SetDO doGas,1;", "blended-switch"),
    ("fanuc", as_it_is, "100.0mm/sec FINE ;\r\n   6:  !pass", "100.0mm/sec CNT50 ;\r\n   6:  !pass", "blended-switch"),
    ("inform", as_it_is, "V=100.0 PL=0\r\n'PASS", "V=100.0 PL=1\r\n'PASS", "blended-switch"),
    ("gcode", as_it_is, " G1 X", " G0 X", "rapid-with-arc"),
    ("gcode", as_it_is, "M3 S1", "M3", "no-output"),
    ("krl", arctech, "PTP XHOME\r\nEND", "$OUT[2] = FALSE\r\nPTP XHOME\r\nEND", "two-switches"),
    ("rapid", as_it_is, "    MoveAbsJ jHome,vHome,fine,tTorch\\WObj:=wPart;\r\n  ENDPROC", "    SetDO doArc,0;\r\n  ENDPROC", "two-switches"),
    // Halts, waits and ends that nobody expects.
    ("krl", as_it_is, "WAIT SEC 0\r\n", "HALT\r\n", "left-on"),
    ("krl", as_it_is, "WAIT SEC 0\r\n", "WAIT FOR $IN[7]\r\n", "endless-wait"),
    ("krl", as_it_is, "$OUT[1] = FALSE", "$OUT[3] = FALSE", "left-on"),
    ("rapid", as_it_is, ",fine,tTorch\\WObj:=wPart;", ",z5,tTorch\\WObj:=wPart;", "blended-switch"),
    ("urscript", as_it_is, "v=0.010400)\n    kill watch", "v=0.010400, r=0.0005)\n    kill watch", "unwatched-end"),
    ("fanuc", as_it_is, "  Weld End", "  PAUSE ;\r\n   9:  Weld End", "left-on"),
    ("fanuc", as_it_is, "  Weld End", "  WAIT DI[3]=ON ;\r\n   9:  Weld End", "endless-wait"),
    ("inform", as_it_is, "ARCOF", "PAUSE\r\nARCOF", "left-on"),
    ("inform", as_it_is, "ARCOF", "WAIT IN#(3)=ON\r\nARCOF", "endless-wait"),
    // Postures, weaves, shifts.
    ("rapid", as_it_is, "    ConfJ \\Off;\r\n", "", "configuration"),
    ("rapid", as_it_is, "    ConfL \\Off;\r\n", "", "configuration"),
    ("fanuc", weave, "Weave Sine[2.6Hz", "Weave Sine[2.0Hz", "weave-pitch"),
    ("rapid", weave, "0,1.040,0,1.040,", "0,0.800,0,0.800,", "weave-pitch"),
    ("fanuc", weave, "  Weave End ;\r\n", "  !Weave ;\r\n", "weave-left-on"),
    ("inform", weave, "WVOF\r\n", "", "weave-left-on"),
    ("inform", offsets, "SFTOF\r\n", "", "weave-left-on"),
];

#[test]
fn every_fault_that_is_put_in_is_found() {
    let (mut found, mut missed) = (BTreeMap::<&str, usize>::new(), Vec::new());
    for &(post, ask, old, new, kind) in SEEDS {
        let mut profile = base();
        ask(&mut profile);
        let files = written(post, &profile);
        if !files.values().any(|text| text.contains(old)) {
            missed.push(format!("{post}: no {old:?} in the program"));
            continue;
        }
        let broken: Files = files.iter().map(|(name, text)| (name.clone(), text.replace(old, new))).collect();
        let kinds: Vec<&str> = faults(post, &profile, &broken).iter().map(|fault| fault.kind.name).collect();
        if kinds.contains(&kind) {
            *found.entry(kind).or_default() += 1;
        } else {
            missed.push(format!("{post}: {old:?} became {new:?}, and {kind} is not among {kinds:?}"));
        }
    }
    println!("{found:?}");
    assert!(missed.is_empty(), "{}", missed.join("\n"));
    assert!(found.values().sum::<usize>() >= 30, "{found:?}");
}

/// What is right in programs of other hands is not found.
#[test]
fn what_is_right_is_not_found() {
    for (post, ask, old, new) in [
        ("krl", arctech as Ask, "PTP XHOME\r\nEND", "$OUT[40] = TRUE\r\nPTP XHOME\r\nEND"),
        ("krl", as_it_is, "A6 0.0}", "A6 0.0,E1 0.0,E2 0.0,E3 0.0,E4 0.0,E5 0.0,E6 0.0}"),
        ("rapid", plain, "SetDO doArc,1;", "SetDO doArc,1;\r\n    SetDO doLamp,low;"),
        ("rapid", as_it_is, "    MoveAbsJ jHome", "    SetDO doLamp,high;\r\n    MoveAbsJ jHome"),
        ("fanuc", weave, "  Weave End ;\r\n", ""),
    ] {
        let mut profile = base();
        ask(&mut profile);
        let files = written(post, &profile);
        assert!(files.values().any(|text| text.contains(old)), "{post}: {old}");
        let changed = |text: &String| match post {
            // The weave ends behind the arc.
            "fanuc" => {
                let lines: Vec<&str> = text.split_inclusive('\n').filter(|line| !line.contains(old)).collect();
                let ended = |line: &&str| line.contains("Weld End");
                lines
                    .iter()
                    .flat_map(|line| [Some(*line), ended(line).then_some("   0:  Weave End ;\r\n")])
                    .flatten()
                    .collect()
            }
            _ => text.replace(old, new),
        };
        let files: Files = files.iter().map(|(name, text)| (name.clone(), changed(text))).collect();
        let found: Vec<String> = faults(post, &profile, &files).iter().map(Fault::to_string).collect();
        assert!(found.is_empty(), "{post}: {found:?}");
    }
}

/// Sizes and names that a controller does not take.
#[test]
fn sizes_and_names_are_looked_at() {
    let mut profile = base();
    let kinds = |post: &str, profile: &Profile, files: &Files, name: &str| -> Vec<&str> {
        faults_named(post, profile, files, name).iter().map(|fault| fault.kind.name).collect()
    };
    let (krl, script) = (written("krl", &profile), written("urscript", &profile));
    assert_eq!(kinds("krl", &profile, &krl, "OTHER.src"), ["bad-name"]);
    profile.dialects.krl.as_mut().unwrap().max_megabytes = 0.002;
    profile.dialects.urscript.as_mut().unwrap().max_megabytes = 0.002;
    assert_eq!(kinds("krl", &profile, &krl, "DEMO.src"), ["too-large"]);
    assert_eq!(kinds("urscript", &profile, &script, "demo.script"), ["too-large"]);
    let long = |text: &str, head: &str, line: &str| -> String {
        text.replacen(head, &(head.to_owned() + &line.repeat(10_000)), 1)
    };
    let mut fanuc = written("fanuc", &profile);
    fanuc.values_mut().for_each(|text| *text = long(text, "/MN\r\n", "   1:  !long ;\r\n"));
    assert!(kinds("fanuc", &profile, &fanuc, "DEMO.ls").contains(&"too-large"));
    let mut inform = written("inform", &profile);
    inform.values_mut().for_each(|text| *text = long(text, "NOP\r\n", "'LONG\r\n"));
    assert!(kinds("inform", &profile, &inform, "DEMO.jbi").contains(&"too-large"));
    profile.dialects.gcode = common::profile("plasma-304-siemens").dialects.gcode;
    let siemens = written("gcode", &profile);
    assert_eq!(siemens.keys().collect::<Vec<_>>(), ["DEMO.MPF"]);
    assert_eq!(kinds("gcode", &profile, &siemens, "DEMO.MPF"), Vec::<&str>::new());
    for name in ["123.MPF", "a part.MPF", "con.mpf"] {
        assert_eq!(kinds("gcode", &profile, &siemens, name), ["bad-name"], "{name}");
    }
}

/// What a profile cannot have is refused by a sentence that names its key.
#[test]
fn profiles_are_refused_where_they_would_be_dangerous() {
    let refused = |post: &str, ask: Ask| {
        let mut profile = base();
        ask(&mut profile);
        dialect::write(post, &job(), &profile.job("demo")).unwrap_err().to_string()
    };
    for (post, ask, key) in [
        (
            "krl",
            (|p| (p.program.table_side, p.dialects.krl.as_mut().unwrap().table_machine) = (Some(0.0), None)) as Ask,
            "krl.table_machine",
        ),
        (
            "rapid",
            |p| (p.program.table_angle, p.dialects.rapid.as_mut().unwrap().table_unit) = (Some(9.0), None),
            "rapid.table_unit",
        ),
        ("krl", |p| (arctech(p), offsets(p)).0, "layer_offsets"),
        ("gcode", |p| (p.program.restart, p.dialects.gcode.as_mut().unwrap().control) = (true, None), "gcode.control"),
    ] {
        let said = refused(post, ask);
        assert!(said.contains(key), "{said}");
    }
    for (text, key) in [
        (
            Profile::built_in_text("cmt-al2319-kuka").unwrap().replace("\"3.3.3.366\"", "\"3.6.4.420\""),
            "krl.arctech.version",
        ),
        (
            Profile::built_in_text("cmt-al2319-kuka").unwrap().replace("arc_tries = 3", "arc_tries = 0"),
            "safety.arc_tries",
        ),
        (
            Profile::built_in_text("cmt-al2319-kuka").unwrap().replace("# table_machine = 2 ", "table_machine = 1 "),
            "krl.table_machine",
        ),
        (
            Profile::built_in_text("cmt-steel-abb")
                .unwrap()
                .replace("# table_unit = \"STN1\"", "table_unit = \"STN 1\""),
            "rapid.table_unit",
        ),
    ] {
        let said = Profile::parse(&text).unwrap_err().to_string();
        assert!(said.contains(key), "{said}");
    }
}

/// The lines that older profiles have are found before anything is planned.
#[test]
fn the_check_of_a_profile_finds_dangerous_templates() {
    let changed = |name: &str, old: &str, new: &str| {
        let text = Profile::built_in_text(name).unwrap();
        assert!(text.contains(old), "{old}");
        check::rehearse(&Profile::parse(&text.replace(old, new)).unwrap())
    };
    for (name, old, new, kind) in [
        ("cmt-al2319-kuka", "\"WAIT SEC 0\", ", "", "unwatched-end"),
        ("cmt-al2319-kuka", "\"INTERRUPT ON 11\", ", "", "unwatched-arc"),
        ("cmt-steel-robots", "    \"set_runstate_standard_digital_output_to_value(1, 1)\",\n", "", "stop-leaves-on"),
        ("plasma-304-cnc", "\"M3 S1\"", "\"M3\"", "no-output"),
    ] {
        let kinds: Vec<&str> = changed(name, old, new).iter().map(|(_, fault)| fault.kind.name).collect();
        assert!(kinds.contains(&kind), "{name} without {old}: {kinds:?}");
    }
}
