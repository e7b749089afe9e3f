//! Other speeds for some layers: the beads stay the same, and programs set speed, wire feed and job where they change.

use crate::common;
use beadwright::fill::StrategyName;

use beadwright::dialect;
use beadwright::layer::Layer;
use beadwright::process::{Follow, LayerProcess};
use beadwright::profile::Profile;
use common::{flat, planned, profile, read_back};

/// The first two layers at 1.25 times the speed, with job 7.
fn faster(mut profile: Profile) -> Profile {
    let speed = 1.25 * profile.process.deposition_speed;
    profile.process.layers =
        vec![LayerProcess { from: 1, to: 2, deposition_speed: speed, current: None, job: Some(7) }];
    profile
}

#[test]
fn the_beads_stay_the_same_and_take_less_time() {
    for follow in [Follow::Speed, Follow::WireFeed] {
        let mut profile = profile("cmt-al2319-kuka");
        (profile.process.follow, profile.fill.strategy) = (follow, StrategyName::Contour);
        let [plain, other] = [profile.clone(), faster(profile)].map(|profile| planned("cross", &profile));
        assert_eq!(plain.layers, other.layers);
        let [a, b] = [&plain.summary.metrics, &other.summary.metrics];
        assert!(
            (a.wire_length_m / b.wire_length_m - 1.0).abs() < 1e-12 && a.deposited_volume_mm3 == b.deposited_volume_mm3
        );
        // Two of the layers take a fifth less time with the arc on.
        let arc = |layers: usize| -> f64 {
            let seconds = |s: beadwright::pass::Segment| s.length() / plain_speed(follow, s.pace);
            plain.layers[..layers].iter().flat_map(|l| &l.passes).flat_map(|p| p.segments()).map(seconds).sum()
        };
        let saved = a.arc_time_s - b.arc_time_s;
        assert!((saved - 0.2 * arc(2)).abs() < 1e-6 * a.arc_time_s, "{saved} s of {}", arc(2));
    }
}

fn plain_speed(follow: Follow, pace: f64) -> f64 {
    if follow == Follow::Speed { pace } else { profile("cmt-al2319-kuka").process.deposition_speed }
}

#[test]
fn programs_set_speed_feed_and_job() {
    let mut profile = flat(profile("cmt-al2319-kuka"));
    profile.fill.strategy = StrategyName::Contour;
    let nominal = profile.process.deposition_speed;
    let krl = profile.dialects.krl.as_mut().unwrap();
    krl.wire_feed = vec!["$ANOUT[1] = {{wire_feed_ratio}}".to_owned()];
    krl.layer_start = vec!["JOB( {{job}} )".to_owned()];
    let plan = planned("cross", &faster(profile.clone()));
    let files = dialect::write("krl", &plan.layers, &faster(profile.clone()).job("demo")).unwrap();
    for (layer, rate, job) in [(1, 1.25, 7), (2, 1.25, 7), (3, 1.0, 1)] {
        let text = &files[&format!("DEMO_L00{layer}.src")];
        assert!(text.contains(&format!("JOB( {job} )")) && text.contains(&format!("$ANOUT[1] = {rate:.4}")), "{text}");
        assert!(text.contains(&format!("$VEL.CP = {:.6}", nominal * rate / 1000.0)), "{text}");
    }
    // Nothing that is not sent to the cell.
    let refused = |change: fn(&mut Profile)| {
        let mut profile = faster(profile.clone());
        change(&mut profile);
        dialect::write("krl", &plan.layers, &profile.job("demo")).unwrap_err().to_string()
    };
    let said = refused(|p| p.dialects.krl.as_mut().unwrap().wire_feed.clear());
    assert!(said.contains("krl.wire_feed") && said.contains("[[process.layers]]"), "{said}");
    let said = refused(|p| p.dialects.krl.as_mut().unwrap().layer_start.clear());
    assert!(said.contains("{{job}}"), "{said}");
}

#[test]
fn rows_that_make_no_sense_are_refused() {
    let text = Profile::built_in_text("cmt-al2319-kuka").unwrap();
    for (row, about) in [
        ("from = 0, to = 3, deposition_speed = 12.0", "count from 1"),
        ("from = 4, to = 3, deposition_speed = 12.0", "count from 1"),
        ("from = 1, to = 3, deposition_speed = 100.0", "five times"),
        ("from = 1, to = 3, deposition_speed = 12.0, current = 0.0", "current"),
    ] {
        let text = text.replace("[process]\n", &format!("[process]\nlayers = [{{ {row} }}]\n"));
        let error = Profile::parse(&text).unwrap_err().to_string();
        assert!(error.contains("process.layers") && error.contains(about), "{error}");
    }
}

/// A program read back is judged with the wire feed of each layer: the same beads as in the plan.
#[test]
fn a_program_read_back_has_the_same_beads() {
    let mut profile = profile("cmt-al2319-kuka");
    profile.fill.strategy = StrategyName::Contour;
    let krl = profile.dialects.krl.as_mut().unwrap();
    krl.wire_feed = vec!["$ANOUT[1] = {{wire_feed_ratio}}".to_owned()];
    krl.layer_start = vec!["JOB( {{job}} )".to_owned()];
    let profile = faster(profile);
    let plan = planned("cross", &profile);
    let program = read_back(&dialect::write("krl", &plan.layers, &profile.job("demo")).unwrap(), "DEMO.src").unwrap();
    let settings = beadwright::plan::deposit_settings(&profile);
    let read = beadwright::simulate::layers(&program, &settings, &profile.bead.law, &profile.process, None);
    for (read, plan) in read.iter().zip(&plan.layers) {
        let metal = |layer: &Layer| -> f64 {
            layer.passes.iter().flat_map(|p| p.segments()).map(|s| s.length() / s.pace).sum()
        };
        assert!((metal(read) / metal(plan) - 1.0).abs() < 3e-3, "layer {}", plan.index + 1);
    }
}
