//! Programs for CNC controls, read by what each control knows: lengths, times and wire are those of the plan. LinuxCNC's
//! own interpreter can be asked too (`benches/linuxcnc.sh`).

use crate::common;
use crate::readers;
use beadwright::fill::StrategyName;

use beadwright::layer::Layer;
use beadwright::pass::{Along, Pass, PassKind};
use beadwright::plan::Plan;
use beadwright::profile::Profile;
use beadwright::program::Weave;
use common::{planned, profile};
use glam::DVec3;
use readers::cnc::{Control, Run, run};
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Passes with crater fills, waits between layers, and arcs.
fn welder(name: &str) -> Profile {
    let mut profile = profile(name);
    profile.fill.strategy = StrategyName::Contour;
    (profile.program.chord_tolerance, profile.program.arcs) = (0.05, true);
    (profile.start_stop.crater_fill_time, profile.start_stop.interpass_time) = (0.8, 12.5);
    profile
}

fn program(plan: &Plan, profile: &Profile) -> String {
    let files: BTreeMap<String, String> =
        beadwright::dialect::write("gcode", &plan.layers, &profile.job("cross")).unwrap();
    assert_eq!(files.len(), 1);
    files.into_values().next().unwrap()
}

/// mm; what the program travels: before what the plan counts, the torch comes down from the safe height.
fn travel(plan: &Plan, profile: &Profile) -> f64 {
    let down = profile.dialects.gcode.as_ref().unwrap().safe_z - plan.layers[0].z;
    plan.summary.metrics.travel_length_mm + down
}

fn close(a: f64, b: f64, what: &str) {
    println!("{what}: {a:.3} for {b:.3}, {:+.4} %", (a / b - 1.0) * 100.0);
    assert!((a / b - 1.0).abs() < 2e-3, "{what}: {a} for {b}");
}

#[test]
fn controls_run_what_was_planned() {
    for (name, control, arc) in [
        ("plasma-304-fanuc", Control::Fanuc, [3, 5]),
        ("plasma-304-siemens", Control::Siemens, [3, 5]),
        ("plasma-304-twincat", Control::TwinCat, [62, 63]),
    ] {
        for part in ["cross", "propeller"] {
            let profile = welder(name);
            let plan = planned(part, &profile);
            let m = &plan.summary.metrics;
            let Run { motion, arc_time, wire } = run(control, &program(&plan, &profile), arc);
            assert_eq!(motion.welds.len(), m.arc_starts, "{name}");
            assert!(motion.circles > 20, "{name}: {}", motion.circles);
            close(motion.weld_length(), m.deposited_length_mm, "deposited length");
            close(motion.travel, travel(&plan, &profile), "travel");
            // An axis of the wire fills craters by moving; the others wait.
            let crater = profile.start_stop.crater_fill_time * m.arc_starts as f64;
            let moving = m.arc_time_s - if control == Control::TwinCat { 0.0 } else { crater };
            close(arc_time, moving, "arc time");
            let whole = arc_time + motion.waits + m.travel_length_mm / profile.travel.speed;
            close(whole, m.total_time_s, "total time");
            if control == Control::TwinCat {
                close(wire / 1000.0, m.wire_length_m, "wire");
            } else {
                assert_eq!(wire, 0.0);
            }
        }
    }
}

/// An axis of the wire follows the wire feed: where it carries the bead's width, where a crater is filled with less.
#[test]
fn an_axis_of_the_wire_follows_the_wire_feed() {
    use beadwright::process::Follow;
    let mut profile = welder("plasma-304-twincat");
    profile.fill.strategy = StrategyName::Loop;
    (profile.process.follow, profile.start_stop.crater_power) = (Follow::WireFeed, 0.5);
    let plan = planned("cross", &profile);
    let run = run(Control::TwinCat, &program(&plan, &profile), [62, 63]);
    close(run.wire / 1000.0, plan.summary.metrics.wire_length_m, "wire");
    close(run.arc_time, plan.summary.metrics.arc_time_s, "arc time");
    let dry = profile.dry_run();
    let text = program(&plan, &dry);
    assert!(!text.contains("Q1=") && !text.contains("M62") && text.contains("DRY RUN"), "wire in a dry run");
}

#[test]
fn an_impossible_axis_of_the_wire_is_refused() {
    for axis in ["X", "Q1", "q1=", "", "QQ=", "F", "\u{e4}"] {
        let text = Profile::built_in_text("plasma-304-twincat").unwrap().replace("\"Q1=\"", &format!("{axis:?}"));
        let error = Profile::parse(&text).unwrap_err().to_string();
        assert!(error.contains("gcode.wire_axis"), "{axis}: {error}");
    }
}

/// The calls of LinuxCNC's interpreter as it runs a program; `BEADWRIGHT_RS274` is its command. M428 and M429 set an output, as in
/// its examples of tilting tables.
pub(crate) fn canon(program: &str) -> String {
    static RUNS: AtomicUsize = AtomicUsize::new(0);
    let command = std::env::var("BEADWRIGHT_RS274").expect("BEADWRIGHT_RS274 is the path of rs274");
    let run = RUNS.fetch_add(1, Ordering::Relaxed);
    let folder = std::env::temp_dir().join(format!("beadwright-rs274-{}-{run}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let mut ini = "[RS274NGC]\nSUBROUTINE_PATH = .\n".to_owned();
    for (code, value) in [(428, 1), (429, 0)] {
        ini.push_str(&format!("REMAP = M{code} modalgroup=10 ngc=to{code}\n"));
        let lines = format!("o<to{code}> sub\nM68 E3 Q{value}\nM66 E0 L0\no<to{code}> endsub\nM2\n");
        std::fs::write(folder.join(format!("to{code}.ngc")), lines).unwrap();
    }
    for (name, text) in [("part.ngc", program), ("tool.tbl", "T1 P1 D1 Z0\n"), ("machine.ini", &ini)] {
        std::fs::write(folder.join(name), text).unwrap();
    }
    let mut run = std::process::Command::new(&command);
    let run = run.args(["-g", "-t", "tool.tbl", "-i", "machine.ini", "part.ngc"]).current_dir(&folder);
    let output = run.output().unwrap();
    std::fs::remove_dir_all(&folder).unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

fn interpreted(program: &str) -> readers::linuxcnc::Totals {
    readers::linuxcnc::run(&canon(program))
}

/// The interpreter's calls: lengths and times are those of the plan, and arc, gas and wire are on along beads and nowhere else.
#[test]
#[ignore = "needs LinuxCNC's rs274: run benches/linuxcnc.sh"]
fn linuxcnc_runs_what_was_planned() {
    // A program that can begin at any pass, or whose layers can be raised, does the same from its beginning.
    for (part, strategy) in [("cross", "contour"), ("blade", "wall"), ("propeller", "contour")] {
        for way in ["plain", "restart", "offsets", "weave"] {
            let mut profile = welder("plasma-304-cnc");
            profile.fill.strategy = strategy.parse().unwrap();
            (profile.program.restart, profile.program.layer_offsets) = (way == "restart", way == "offsets");
            let plan = planned(part, &profile);
            let weave = Weave { length: 4.0, amplitude: 1.5, dwell: 0.0, file: 1, layers: Vec::new() };
            profile.weave = (way == "weave").then_some(weave);
            println!("{part}, {way}");
            compare(&plan, &profile);
        }
    }
}

fn compare(plan: &Plan, profile: &Profile) {
    let m = &plan.summary.metrics;
    let text = program(plan, profile);
    let found = interpreted(&text);
    assert_eq!(found.arc_starts, m.arc_starts);
    close(found.travel, travel(plan, profile), "travel");
    let crater = profile.start_stop.crater_fill_time * m.arc_starts as f64;
    close(found.arc_time, m.arc_time_s - crater, "arc time");
    close(found.arc_time + found.waits + m.travel_length_mm / profile.travel.speed, m.total_time_s, "total time");
    println!("beads for {:.0} s, all outputs on; {:.0} mm of travel, all off", found.arc_time, found.travel);
    let heights = |raised: i64| {
        let of = |(i, layer): (usize, &Layer)| (layer.z * 1e3).round() as i64 + if i == 1 { raised } else { 0 };
        plan.layers.iter().enumerate().map(of).collect()
    };
    assert_eq!(found.heights, heights(0));
    if profile.weave.is_none() {
        close(found.weld_length, m.deposited_length_mm, "deposited length");
    }
    if profile.program.layer_offsets {
        let (first, rest) = text.split_once("Z0.000\n").unwrap();
        let raised = format!("{first}Z0.000\n{}", rest.replacen("G52 X0.0 Y0.0 Z0.000", "G52 X0.0 Y0.0 Z0.700", 1));
        assert_eq!(interpreted(&raised).heights, heights(700));
    }
}

/// What LinuxCNC's HAL does with the lines of `examples/cells/linuxcnc-arc.hal`; `BEADWRIGHT_HALRUN` is the path of halrun.
#[test]
#[ignore = "needs LinuxCNC's halrun: run benches/linuxcnc.sh where it is installed"]
fn hal_ends_the_arc_where_it_is_lost_and_where_no_program_runs() {
    let command = std::env::var("BEADWRIGHT_HALRUN").expect("BEADWRIGHT_HALRUN is the path of halrun");
    let lines = std::fs::read_to_string(common::docs().join("../examples/cells/linuxcnc-arc.hal")).unwrap();
    // Signals stand in for motion, the interpreter and the cell.
    let own = |line: &&str| !["spindle.", "motion.", "halui."].iter().any(|pin| line.contains(pin));
    let head = "loadrt threads name1=servo-thread period1=1000000 fp1=1".to_owned();
    let outputs = ["arc-output", "wire-output", "gas-output", "arc-lost"];
    // What is set, after how long it is looked, and what is then on of arc, wire and gas, and whether the feed is held.
    let steps: &[(&[&str], f64, [bool; 4])] = &[
        (&["program-runs 1", "gas-commanded 1"], 0.1, [false, false, true, false]),
        (&["arc-commanded 1"], 0.1, [true, false, true, false]),
        (&["arc-current 1", "wire-commanded 1"], 0.1, [true, true, true, false]),
        // A flicker is no lost arc; a lost arc ends all, gas 5 s later, and does not come back by itself.
        (&["arc-current 0"], 0.04, [true, true, true, false]),
        (&[], 0.3, [false, false, true, true]),
        (&["arc-current 1"], 5.5, [false, false, false, true]),
        // An abort ends the spindle, and leaves the outputs: no later program or MDI command feeds wire before M65 P1.
        (&["arc-current 0", "arc-commanded 0", "program-runs 0"], 0.2, [false, false, false, true]),
        (&["program-runs 1"], 0.2, [false, false, false, true]),
        (&["wire-commanded 0"], 0.2, [false, false, true, false]),
        (&["arc-commanded 1"], 0.2, [true, false, true, false]),
        (&["arc-current 1", "wire-commanded 1"], 0.2, [true, true, true, false]),
        // The spindle is stopped by hand: wire without an arc.
        (&["arc-commanded 0", "arc-current 0"], 0.3, [false, false, true, true]),
        (&["wire-commanded 0", "arc-commanded 1"], 0.2, [true, false, true, false]),
        (&["arc-current 1", "wire-commanded 1"], 0.2, [true, true, true, false]),
        // A pause: arc and wire end, gas later.
        (&["program-runs 0"], 0.05, [false, false, true, false]),
    ];
    let mut script = vec![head];
    script.extend(lines.lines().filter(own).map(str::to_owned));
    script.push("start".to_owned());
    for (set, seconds, _) in steps {
        script.extend(set.iter().map(|set| format!("sets {set}")));
        script.push(format!("loadusr -w sleep {seconds}"));
        script.extend(outputs.iter().map(|output| format!("gets {output}")));
    }
    let file = std::env::temp_dir().join(format!("beadwright-{}.hal", std::process::id()));
    std::fs::write(&file, script.join("\n") + "\n").unwrap();
    let output = std::process::Command::new(&command).arg("-f").arg(&file).output().unwrap();
    std::fs::remove_file(&file).unwrap();
    let said = String::from_utf8(output.stdout).unwrap();
    let values: Vec<bool> = said.lines().filter_map(|line| line.trim().to_lowercase().parse().ok()).collect();
    assert_eq!(values.len(), steps.len() * outputs.len(), "{said}{}", String::from_utf8_lossy(&output.stderr));
    for ((set, _, wanted), found) in steps.iter().zip(values.chunks(outputs.len())) {
        println!("{set:?}: arc, wire, gas, held: {found:?}");
        assert_eq!(found, wanted, "after {set:?}");
    }
}

/// A jump of Fanuc's macros finds no block behind N99999.
#[test]
fn restart_with_too_many_passes_is_refused() {
    let mut profile = profile("plasma-304-fanuc");
    profile.program.restart = true;
    let points = vec![DVec3::ZERO, DVec3::new(40.0, 0.0, 0.0)];
    let (width, pace) = (Along::Same(5.0), Along::Same(4.0));
    let pass = Pass { kind: PassKind::Infill, closed: false, points, width, pace, wait: 0.0 };
    let layer = |index| Layer { index, passes: vec![pass.clone(); 500], ..Layer::default() };
    let layers: Vec<Layer> = (0..70).map(layer).collect();
    assert!(beadwright::dialect::write("gcode", &layers[..60], &profile.job("part")).is_ok());
    let error = beadwright::dialect::write("gcode", &layers, &profile.job("part")).unwrap_err().to_string();
    assert!(
        error.contains("program.restart")
            && error.contains("N99999")
            && error.contains("the layer and pass that come next"),
        "{error}"
    );
}
