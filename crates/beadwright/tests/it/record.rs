//! The record of an example part whose build is disturbed: every disturbance is found at its pass and place, and a record that was
//! changed later shows it.

#[path = "../../../record/tests/it/cell.rs"]
mod cell;

use crate::common;
use beadwright::export::Beads;
use beadwright::glam::{DVec2, DVec3};
use beadwright::record::{
    self, Broken, FileHash, Finding, HeightsError, Kind, Part, PlannedPass, Quantity, Record, Settings, join, planned,
    verify,
};
use beadwright::{Plan, Profile, StrategyName, Task, example, plan};
use cell::{Cell, Clock, Dice, Fault, log};

/// The cross in several passes a layer.
fn cross() -> (Plan, Profile) {
    let mut profile = Profile::built_in("cmt-al2319-kuka").unwrap();
    profile.fill.strategy = StrategyName::Contour;
    (profile.process.current, profile.process.voltage) = (Some(180.0), Some(20.0));
    let mesh = example::find("cross").unwrap().mesh();
    (plan("cross", &mesh, &profile, &Task::new()).unwrap(), profile)
}

fn passes((plan, profile): &(Plan, Profile)) -> Vec<PlannedPass> {
    planned(&Beads { header: &plan.header, layers: &plan.layers, profile, heat: None })
}

#[test]
fn planned_times_are_those_of_the_plan() {
    let cross = cross();
    let (plan, profile) = &cross;
    let passes = passes(&cross);
    assert_eq!(passes.len(), plan.summary.metrics.arc_starts);
    let length: f64 = passes.iter().map(PlannedPass::length).sum();
    assert!((length - plan.summary.metrics.deposited_length_mm).abs() < 1e-6 * length);
    let delays = profile.process.arc_start_delay * passes.len() as f64;
    let seconds: f64 = passes.iter().map(PlannedPass::seconds).sum();
    assert!((seconds - delays - plan.summary.metrics.arc_time_s).abs() < 1e-6 * seconds);
}

/// What is done to a build and its logs.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Disturbed {
    Feed,
    ArcLost,
    Drift,
    ClockSet,
    Doubled,
    Interrupted,
}

const ALL: [Disturbed; 6] = [
    Disturbed::Feed,
    Disturbed::ArcLost,
    Disturbed::Drift,
    Disturbed::ClockSet,
    Disturbed::Doubled,
    Disturbed::Interrupted,
];

/// A disturbed build: its record, the pass, and the places along it between which it was disturbed, mm.
struct Run {
    record: Record,
    pass: usize,
    along: [f64; 2],
    clock: Clock,
}

fn run(plan: &[PlannedPass], what: Disturbed, seed: u64) -> Run {
    let (mut cell, mut dice) = (Cell::new(plan, seed), Dice(seed + 1000));
    // Passes long enough for a place in the middle, not at the very ends of the build.
    let long: Vec<usize> = (3..plan.len() - 3).filter(|&k| plan[k].seconds() > 12.0).collect();
    let pass = long[dice.below(long.len())];
    let from = dice.between(0.2, 0.5);
    let part = [from, from + dice.between(2.5, 4.0) / plan[pass].seconds()];
    let fault = match what {
        Disturbed::ArcLost | Disturbed::Doubled => Some(Fault::Out),
        Disturbed::Interrupted => None,
        _ => Some(Fault::Feed(dice.between(0.5, 0.8))),
    };
    cell.faults.extend(fault.map(|fault| (pass, part, fault)));
    let done = cell.find(pass);
    let times = part.map(|part| done.start + part * (done.end - done.start));
    let mut clock = Clock::new(dice.between(-4000.0, 4000.0), dice.between(-5e-5, 5e-5));
    match what {
        Disturbed::Drift => clock.fast = dice.between(3e-4, 9e-4),
        // Somewhere before the fault, forward or back.
        Disturbed::ClockSet => {
            let step = dice.between(20.0, 4000.0) * if seed.is_multiple_of(2) { 1.0 } else { -1.0 };
            clock.set = Some((done.start * dice.between(0.3, 0.9), step));
        }
        _ => {}
    }
    let without = if what == Disturbed::Interrupted { vec![times] } else { Vec::new() };
    let mut power = cell.power_log(&clock, 50.0, &without);
    if what == Disturbed::Doubled {
        let lines: Vec<&str> = power.lines().collect();
        let at = 1 + dice.below(lines.len() - 900);
        let again = [&lines[..at + 800], &lines[at..]].concat();
        power = again.join("\n");
    }
    let logs = [
        log("power.csv", &power),
        log("controller.csv", &cell.controller_log(&Clock::new(50.0, 0.0), seed.is_multiple_of(3))),
    ];
    let record = join(plan, &logs, &Settings::default()).unwrap();
    let along = part.map(|part| plan[pass].spot(plan[pass].struck + part * plan[pass].seconds()).along);
    Run { record, pass, along, clock }
}

impl Run {
    fn kinds(&self) -> Vec<Kind> {
        let mut kinds: Vec<Kind> = self.record.findings.iter().map(|finding| finding.kind).collect();
        kinds.dedup();
        kinds
    }

    fn find(&self, kind: Kind) -> &Finding {
        let found: Vec<&Finding> = self.record.findings.iter().filter(|finding| finding.kind == kind).collect();
        assert_eq!(found.len(), 1, "{kind:?}: {:?}", self.record.findings);
        found[0]
    }

    /// The finding lies at the pass, and begins and ends within `near` mm of the disturbance.
    fn lies(&self, kind: Kind, near: f64) {
        let finding = self.find(kind);
        let found = finding.place.unwrap().map(|spot| spot.along);
        let off = [0, 1].map(|end| (found[end] - self.along[end]).abs());
        assert!(finding.pass == Some(self.pass) && off.iter().all(|off| *off < near), "{off:?}: {finding:?}");
    }
}

#[test]
fn sixty_disturbances_are_found_at_their_pass_and_place() {
    let plan = passes(&cross());
    let current = Kind::OutOfWindow(Quantity::Current);
    let feed = Kind::OutOfWindow(Quantity::Feed);
    for seed in 0..60 {
        let what = ALL[seed as usize % ALL.len()];
        eprintln!("seed {seed}: {what:?}");
        let run = run(&plan, what, seed);
        let expected: &[Kind] = match what {
            Disturbed::Feed => &[feed, current],
            Disturbed::ArcLost => &[Kind::ArcLost, Kind::StruckAgain],
            Disturbed::Drift => &[feed, current, Kind::ClockDrift],
            Disturbed::ClockSet => &[feed, current, Kind::ClockSet],
            Disturbed::Doubled => &[Kind::ArcLost, Kind::StruckAgain, Kind::Rows],
            Disturbed::Interrupted => &[Kind::NotLogged, Kind::Gap],
        };
        assert_eq!(run.kinds(), expected, "{:?}", run.record.findings);
        match what {
            Disturbed::ArcLost | Disturbed::Doubled => run.lies(Kind::ArcLost, 3.0),
            Disturbed::Interrupted => run.lies(Kind::NotLogged, 3.0),
            _ => run.lies(feed, 4.0),
        }
        let known = &run.record.logs[0];
        if what == Disturbed::Drift {
            assert!((known.drift + 1e6 * run.clock.fast).abs() < 30.0, "{known:?}");
        }
        if let Some((_, step)) = run.clock.set {
            assert!((known.set[0][1] - step).abs() < 0.3, "{known:?} {step}");
        }
        if what == Disturbed::Doubled {
            assert_eq!((known.tally.doubled, known.tally.set_back), (800, 0));
        }
    }
}

/// The example wall, welded, with points of a scan after layer 20 that leans in x and y.
fn scanned_wall() -> (Plan, Profile, Vec<DVec3>) {
    let profile = Profile::built_in("cmt-steel-abb").unwrap();
    let plan = plan("wall", &example::find("wall").unwrap().mesh(), &profile, &Task::new()).unwrap();
    let z = plan.layers[19].z;
    let point = |k: u32| DVec2::new(f64::from(k / 17) * 0.25 - 59.0, f64::from(k % 17) * 0.25 - 2.0);
    let points = (0..473 * 17).map(point).map(|at| at.extend(z + lean(at))).collect();
    (plan, profile, points)
}

/// Above the planned top, mm.
fn lean(at: DVec2) -> f64 {
    0.3 + 0.004 * at.x + 0.05 * at.y
}

#[test]
fn measured_heights_are_those_of_the_scan_and_planned_ones_those_of_the_top() {
    let (mut plan, profile, points) = scanned_wall();
    // A torch that follows what lies below says nothing of the planned top.
    plan.layers[19].passes.iter_mut().flat_map(|pass| &mut pass.points).for_each(|point| point.z += 0.7);
    let own = (plan, profile);
    let (passes, (plan, profile)) = (passes(&own), &own);
    let shown = record::heights(&plan.layers, profile, &passes, &points, 20).unwrap();
    let [own] = &shown.heights[..] else { panic!("{shown:?}") };
    assert_eq!((passes[own.pass].layer, shown.passes), (20, [1, 1]));
    assert!(own.share > 0.8 && (shown.covered - own.share).abs() < 1e-9, "{shown:?}");
    for top in &own.tops {
        let scanned = plan.layers[19].z + lean(top.spot.at.truncate());
        assert!((top.measured - scanned).abs() < 0.03, "{top:?} {scanned}");
        assert!((top.planned - plan.layers[19].z).abs() < 0.3 * plan.layers[19].height, "{top:?}");
    }
    let away = own.tops.iter().map(|top| top.spot.along);
    assert!(away.clone().zip(away.skip(1)).all(|(a, b)| b > a), "in the order of welding");
    // Half of the scan: half of the length, and nothing of the other half.
    let half: Vec<DVec3> = points.iter().copied().filter(|point| point.x > 0.0).collect();
    let shown = record::heights(&plan.layers, profile, &passes, &half, 20).unwrap();
    assert!((0.4..0.55).contains(&shown.covered), "{}", shown.covered);
    assert!(shown.heights[0].tops.iter().all(|top| top.spot.at.x > -0.5 * profile.bead.width), "{shown:?}");
}

#[test]
fn scans_of_layers_that_cannot_be_compared_are_refused_with_their_reason() {
    let (plan, profile, points) = scanned_wall();
    let own = (plan, profile);
    let (passes, (plan, profile)) = (passes(&own), &own);
    let of = |passes: &[PlannedPass], number| {
        record::heights(&plan.layers, profile, passes, &points, number).unwrap_err().to_string()
    };
    let layers = plan.layers.len();
    for number in [0, layers + 1] {
        assert!(of(&passes, number).contains(&format!("the plan has the layers 1 to {layers}")));
    }
    assert!(of(&passes, 40).contains("The plan is that high after layer 20"));
    assert!(of(&passes[..19], 20).contains("the scan shows none of the passes of layer 20"));
}

#[test]
fn a_turn_of_a_helix_is_refused_for_every_layer() {
    let mut profile = common::profile_by("cmt-al2319-kuka", "wall");
    profile.wall.helix = true;
    let plan = common::planned_once("tube", &common::tube(40.0, 7.54, 40.0, 0.0), &profile).unwrap();
    let planned = planned(&Beads { header: &plan.header, layers: &plan.layers, profile: &profile, heat: None });
    assert_eq!(planned.len(), 1, "all turns are one pass");
    let points = [DVec3::new(40.0, 0.0, 20.0); 3];
    for number in 1..=plan.layers.len() {
        let error = record::heights(&plan.layers, &profile, &planned, &points, number).unwrap_err();
        assert_eq!(error, HeightsError::Helix { number });
        assert!(error.to_string().starts_with(&format!("layer {number} is a turn of a helix")), "{error}");
    }
}

#[test]
fn a_change_of_any_byte_is_found() {
    let cross = cross();
    let passes = passes(&cross);
    let (plan, profile) = &cross;
    let build = run(&passes, Disturbed::Feed, 6);
    let settings = Settings::default();
    let trace = [("wire_batch".to_owned(), "4711 <A>".to_owned())];
    // Two logs have the same name.
    let inputs = ["rows", "others"].map(|text| FileHash::of("power.csv", text.as_bytes()));
    let part = Part {
        header: &plan.header,
        layers: &plan.layers,
        profile,
        planned: &passes,
        record: &build.record,
        settings: &settings,
        trace: &trace,
        scans: &[],
        inputs: &inputs,
    };
    let sealed = part.files().unwrap();
    assert_eq!(sealed, part.files().unwrap(), "the same input gives the same bytes");
    let found = |name: &str| sealed.files.iter().find(|(own, _)| own == name).map(|(_, bytes)| bytes.clone());
    let bytes = |name: &str| found(name).unwrap();
    let text = String::from_utf8(bytes(record::JSON)).unwrap();
    let whole: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(whole["passes"].as_array().unwrap().len(), passes.len());
    assert_eq!(whole["trace"][0]["value"], "4711 <A>");
    let page = String::from_utf8(bytes(record::HTML)).unwrap();
    assert!(page.contains("4711 &lt;A&gt;") && page.contains("What is doubtful") && page.contains("wire feed reached"));
    let check = |text: &str, seal: Option<&str>| verify(text, seal, &mut |name| found(name));
    assert_eq!(check(&text, Some(&sealed.seal)), []);
    // Any byte, here a spread of some hundred.
    for at in (0..text.len()).step_by(text.len() / 400).chain(text.len() - 70..text.len()) {
        let mut changed = text.clone().into_bytes();
        changed[at] = if changed[at] == b'7' { b'8' } else { b'7' };
        assert_ne!(check(&String::from_utf8(changed).unwrap(), None), [], "byte {at}");
    }
    // A value of a row names its pass, and no other.
    let line = text.lines().position(|line| line.contains("\"layer\":4,\"pass\":1,")).unwrap();
    let rows: Vec<String> = text
        .lines()
        .enumerate()
        .map(|(k, row)| if k == line { row.replacen("\"burned\":", "\"burned\":1", 1) } else { row.to_owned() })
        .collect();
    let broken = check(&(rows.join("\n") + "\n"), None);
    assert_eq!(broken, [Broken::Seal, Broken::Row { line: line + 1, pass: Some((4, 1)) }]);
    // Other files, and a record that was sealed anew.
    let missing = verify(&text, None, &mut |name| (name != record::HTML).then(|| bytes(name)));
    assert_eq!(missing, [Broken::Missing(record::HTML.to_owned())]);
    let other = verify(&text, None, &mut |name| Some(if name == record::HTML { b"x".to_vec() } else { bytes(name) }));
    assert_eq!(other, [Broken::Changed(record::HTML.to_owned())]);
    assert_eq!(check(&text, Some("00")), [Broken::OtherSeal("00".to_owned())]);
    assert_eq!(check("{}", None), [Broken::Form]);
    let others = |given: &[&str]| {
        let given: Vec<FileHash> = given.iter().map(|text| FileHash::of("power.csv", text.as_bytes())).collect();
        record::other_inputs(&text, &given).len()
    };
    assert_eq!([others(&["rows", "others"]), others(&["others", "rows"]), others(&["others"]), others(&[])], [0; 4]);
    assert_eq!([others(&["row2"]), others(&["rows", "other"]), others(&["a", "b"])], [1, 1, 2]);
    assert_eq!(record::other_inputs(&text, &[FileHash::of("robot.csv", b"rows")]), []);
    let changed = record::other_inputs(&text, &[FileHash::of("power.csv", b"row2")]);
    assert_eq!(changed, [Broken::Changed("power.csv".to_owned())]);
}
