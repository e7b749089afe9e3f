//! The post `rapid`: a small job as golden files, the variants of the profile, names, speeds, and the job read back.

use crate::common;

use crate::readers;
use common::profile;

use beadwright::dialect;
use beadwright::dialect::rapid::{RapidArc, RapidModules, WireFeedUnit};
use beadwright::dialect::reading::{ArcCodes, Options, ReadProgram, read};
use beadwright::layer::{Extent, Layer};
use beadwright::pass::PassKind;
use beadwright::pass::{Along, Pass};
use beadwright::profile::Profile;
use beadwright::program::Programmer;
use glam::DVec3;
use readers::distance;
use std::collections::BTreeMap;

type Files = BTreeMap<String, String>;

fn plain() -> Profile {
    let mut profile = profile("cmt-steel-abb");
    let rapid = profile.dialects.rapid.as_mut().unwrap();
    (rapid.arc, rapid.modules) = (RapidArc::Plain, RapidModules::Call);
    profile
}

/// Two layers: a frame, and a line whose bead grows wider.
fn job() -> Vec<Layer> {
    let layer = |index: usize| {
        let z = 1.4187 * (index + 1) as f64;
        let points = |xy: &[[f64; 2]]| xy.iter().map(|p| DVec3::new(p[0], p[1], z)).collect::<Vec<_>>();
        let frame = Pass {
            kind: PassKind::Contour,
            closed: true,
            points: points(&[[0.0, 0.0], [30.0, 0.0], [30.0, 20.0], [-0.0004, 20.0]]),
            width: Along::Same(4.5),
            pace: Along::Same(8.0),
            wait: 0.0,
        };
        let line = Pass {
            kind: PassKind::Infill,
            closed: false,
            points: points(&[[5.0, 10.0], [10.0, 10.0], [10.005, 10.0], [15.0, 10.0], [20.0, 10.5], [25.0, 10.0]]),
            width: Along::Each(vec![4.5; 6]),
            pace: Along::Each(vec![8.0, 7.95, 7.55, 7.14, 6.13, 6.13]),
            wait: 0.0,
        };
        Layer { index, z, height: 1.4187, passes: vec![frame, line], ..Layer::default() }
    };
    vec![layer(0), layer(1)]
}

fn written(part: &str, layers: &[Layer], count: usize, profile: &Profile) -> Files {
    let mut files = Files::new();
    let mut post = dialect::writer("rapid", &profile.job(part)).unwrap();
    let mut programmer = Programmer::new(profile.travel.clearance);
    let mut chunks = post.begin(&Extent { layers: count, ..Extent::default() });
    for layer in layers {
        chunks.extend(post.layer(&programmer.layer(layer)));
    }
    chunks.extend(post.end());
    for chunk in chunks {
        files.entry(chunk.file).or_default().push_str(&chunk.text);
    }
    files
}

#[test]
fn the_job_is_written_as_before() {
    readers::golden("rapid", &written("frame", &job(), 2, &profile("cmt-steel-abb")));
    readers::golden("rapid-plain", &written("frame", &job(), 2, &plain()));
}

#[test]
fn the_job_reads_back_as_planned() {
    let layers = job();
    let planned: f64 = layers.iter().flat_map(|l| &l.passes).map(Pass::length).sum();
    for (profile, output) in [(profile("cmt-steel-abb"), ""), (plain(), "doArc")] {
        let files = written("frame", &layers, 2, &profile);
        let motion = readers::rapid::run(&files, "frame", output);
        assert!((motion.weld_length() - planned).abs() < 0.01, "{} for {planned}", motion.weld_length());
        assert_eq!(motion.welds.len(), 4);
        for (weld, pass) in motion.welds.iter().zip(layers.iter().flat_map(|l| &l.passes)) {
            for p in pass.points.iter().map(|p| p.to_array()) {
                assert!(weld.points.iter().any(|&q| distance(p, q) < 0.01), "{p:?}");
            }
            for q in &weld.points {
                assert!(pass.points.iter().any(|p| distance(p.to_array(), *q) < 0.01), "{q:?}");
            }
        }
        // 8.0 and steps of 0.2 from there, the nearest to each; the short move was dropped.
        let speeds = &motion.welds[1].speeds;
        assert!(speeds.iter().zip([8.0, 7.6, 7.2, 6.2]).all(|(a, b)| (a - b).abs() < 1e-9), "{speeds:?}");

        let options = Options {
            arc: ArcCodes { on: vec!["SetDO doArc,1".to_owned()], off: vec!["SetDO doArc,0".to_owned()], alone: false },
            ..Options::default()
        };
        let mut find = |name: &str| files.get(&format!("{name}.mod")).cloned();
        let program: ReadProgram = read(&files["frame.mod"], &mut find, &options).unwrap();
        let totals = program.totals();
        assert_eq!(totals.arc_starts, 4);
        assert!((totals.deposited_length_mm - motion.weld_length()).abs() < 1e-6, "{}", totals.deposited_length_mm);
        assert!((totals.travel_length_mm - motion.travel).abs() < 1e-6, "{}", totals.travel_length_mm);
        assert!(program.notes.iter().all(|n| n.contains("MoveAbsJ")), "{:?}", program.notes);
    }
}

#[test]
fn every_layer_declares_the_few_speeds_that_it_uses() {
    let files = written("frame", &job(), 2, &profile("cmt-steel-abb"));
    for layer in ["frame_L001.mod", "frame_L002.mod"] {
        assert_eq!(files[layer].matches("LOCAL PERS welddata ").count(), 4, "{}", files[layer]);
    }
    let mut coarse = profile("cmt-steel-abb");
    coarse.dialects.rapid.as_mut().unwrap().speed_step = 50.0;
    let files = written("frame", &job(), 2, &coarse);
    assert_eq!(files["frame_L001.mod"].matches(" wd1:=[8.000,0,[1,7,").count(), 1);
    assert!(!files["frame_L001.mod"].contains("wd2"));
    // A step too coarse for slow beads does not stop them.
    let mut slow = job();
    slow[0].passes[1].pace = Along::Same(0.05);
    let motion = readers::rapid::run(&written("frame", &slow, 2, &profile("cmt-steel-abb")), "frame", "");
    assert!(motion.welds[1].speeds.iter().all(|s| *s == 0.05 || *s == 0.2), "{:?}", motion.welds[1].speeds);
}

#[test]
fn long_and_strange_names_stay_legal_and_distinct() {
    for part in [&*"w".repeat(60), "fine", "7-segment display", "Gr\u{fc}n", "tTorch", "MODULE", "", "layer001", "wd1"]
    {
        let mut profile = profile("cmt-steel-abb");
        profile.dialects.rapid.as_mut().unwrap().folder = format!("HOME:/{}", "f".repeat(34));
        for count in [2, 20_000] {
            let files = written(part, &job(), count, &profile);
            let main = files.keys().min_by_key(|k| k.len()).unwrap().strip_suffix(".mod").unwrap();
            readers::rapid::run(&files, main, "");
        }
    }
}

#[test]
fn exact_stops_without_a_zone_and_no_list_where_none_is_wanted() {
    let mut profile = profile("cmt-steel-abb");
    let rapid = profile.dialects.rapid.as_mut().unwrap();
    (rapid.zone, rapid.pgf, rapid.wire_feed_unit) = (0.0, false, WireFeedUnit::MillimetresPerSecond);
    rapid.orientation = [0.0, 0.7072, 0.0, 0.7072];
    let files = written("frame", &job(), 2, &profile);
    assert!(!files.contains_key("frame.pgf") && files.values().all(|text| !text.contains("zBead")));
    // 2.71 m/min is 45.167 mm/s.
    assert!(files["frame_L001.mod"].contains("[8.000,0,[1,7,0.000,45.167,0.000,129.000,0,0,0],"));
    readers::rapid::run(&files, "frame", "");
    assert!(files["frame_L001.mod"].contains("[0.0000000,0.7071068,0.0000000,0.7071068]"));
}

#[test]
fn data_of_the_controller_are_not_declared_again() {
    let mut profile = profile("cmt-steel-abb");
    let rapid = profile.dialects.rapid.as_mut().unwrap();
    (rapid.tool_frame, rapid.part_frame) = (None, None);
    let main = &written("frame", &job(), 2, &profile)["frame.mod"];
    assert!(!main.contains("tooldata") && !main.contains("wobjdata") && main.contains("tTorch\\WObj:=wPart"));
}

#[test]
fn the_test_reader_refuses_what_a_controller_would() {
    let good = written("frame", &job(), 2, &profile("cmt-steel-abb"));
    let taken = |files: &Files| std::panic::catch_unwind(|| readers::rapid::run(files, "frame", "")).is_ok();
    assert!(taken(&good));
    for (file, old, new) in [
        ("frame_L001.mod", "ArcLEnd", "ArcL"),
        ("frame_L001.mod", "    ArcL ", "    MoveL "),
        ("frame_L001.mod", "smBead,wd1,fine", "smBead,wd1,zBead"),
        ("frame_L001.mod", "smBead,wd1,zBead", "smBead,wd9,zBead"),
        ("frame_L001.mod", ",[0,0,0,0,0,0,0,0,0]];", ",[0,0,0,0,0,0,0,0]];"),
        ("frame_L001.mod", "0.0000000,1.0000000", "0.0000000,0.9999000"),
        ("frame_L001.mod", "  LOCAL PERS welddata wd2", "  LOCAL PERS welddata wd1"),
        ("frame_L001.mod", "PROC Layer001", "PROC main"),
        ("frame_L001.mod", "fine,tTorch\\WObj:=wPart;\r\n", "fine,tTorch\\WObj:=wPart\r\n"),
        ("frame_L002.mod", "  ENDPROC\r\n", "  ENDPROC\r\n  CONST speeddata vX:=[1,1,1,1];\r\n"),
        ("frame.mod", "TASK PERS seamdata", "TASK PERS welddata"),
        ("frame.mod", "vTravel:=[100.000,500.000,5000,1000]", "vTravel:=[100.000,500.000,5000]"),
        ("frame.mod", "[4.500,", "[0.000,"),
        ("frame.mod", "zBead", "z5"),
        ("frame.mod", "UnLoad \"HOME:/part/frame_L001.mod\";", "Load \\Dynamic,\"HOME:/part/frame_L001.mod\";"),
        ("frame.mod", "  PROC main()\r\n", "  PROC main()\n"),
    ] {
        let mut bad = good.clone();
        let text = bad.get_mut(file).unwrap();
        *text = text.replacen(old, new, 1);
        assert_ne!(*text, good[file], "{old:?} does not stand in {file}");
        assert!(!taken(&bad), "{old:?} became {new:?} in {file}, and the reader took it");
    }
}
