//! What a profile says of a positioner, and what times, checks and the report make of it.

use super::{axis, chuck, planned, read, tilting};
use crate::common::profile;
use crate::readers::Weld;
use beadwright::layer::Layer;
use beadwright::metrics::Metrics;
use beadwright::model::RepairReport;
use beadwright::profile::Profile;
use beadwright::program::{Instruction, MACHINES, Machine, Positioner, Turning};
use beadwright::report::Report;
use beadwright::task::Task;
use beadwright::{dialect, example, plan};
use glam::DVec3;
use std::collections::BTreeMap;

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
    let refused = dialect::write("marlin", &layers, &profile.job("demo")).unwrap_err().to_string();
    assert!(refused.contains("program.positioner") && refused.contains("krl"), "{refused}");
    (profile.dialects.krl.as_mut().unwrap().table_machine, profile.dialects.fanuc.as_mut().unwrap().table_group) =
        (None, None);
    profile.dialects.inform.as_mut().unwrap().station = None;
    let keys = [("krl", "krl.table_machine"), ("fanuc", "fanuc.table_group")];
    for (post, key) in keys.into_iter().chain([("inform", "inform.station"), ("urscript", "urscript.turn")]) {
        let refused = dialect::write(post, &layers, &profile.job("demo")).unwrap_err().to_string();
        assert!(refused.contains(key) && refused.contains("program.positioner"), "{refused}");
    }
}

/// What a Yaskawa and a Universal Robots cell must say of the axes that turn the part.
#[test]
fn a_cell_says_how_its_controller_turns_the_part() {
    let wrong = |change: fn(&mut Profile)| {
        let mut profile = profile("cmt-steel-robots");
        profile.program.positioner = Some(tilting(Turning::Follow));
        let inform = profile.dialects.inform.as_mut().unwrap();
        (inform.station, inform.station_pulses) = (Some("ST1".to_owned()), Some([1994.3, 1376.7]));
        inform.frame_turns = Some(true);
        change(&mut profile);
        Profile::parse(&profile.toml_text().unwrap()).map(drop).map_err(|error| error.to_string())
    };
    assert_eq!(wrong(|_| {}), Ok(()));
    let pulses = wrong(|p| p.dialects.inform.as_mut().unwrap().station_pulses = Some([1994.3, 0.0])).unwrap_err();
    assert!(pulses.contains("inform.station_pulses") && pulses.contains("2 axes"), "{pulses}");
    let frame = wrong(|p| p.dialects.inform.as_mut().unwrap().frame_turns = None).unwrap_err();
    assert!(frame.contains("inform.frame_turns"), "{frame}");
    let arcs = wrong(|p| (p.program.arcs, p.program.chord_tolerance) = (true, 0.05)).unwrap_err();
    assert!(arcs.contains("program.arcs"), "{arcs}");
    let turn = wrong(|p| p.dialects.urscript.as_mut().unwrap().turn = vec!["turn_part()".to_owned()]).unwrap_err();
    assert!(turn.contains("index-at-home"), "{turn}");
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
        ("yaskawa-d500", 380.0, 530.0),
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
