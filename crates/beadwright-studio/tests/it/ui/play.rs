//! The torch runs as the program will.

use crate::window::{example, has_adapter, press, sees, slide};
use beadwright_studio::shares::Shares;
use eframe::egui::Key;
use egui_kittest::kittest::Queryable;

/// Seconds between two frames of the harness.
const STEP: f64 = 0.25;

#[test]
fn the_torch_runs_to_the_end_in_the_time_of_the_metrics() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = example(folder.path(), "cross");
    let plan = harness.state().plan();
    let seconds = plan.summary.as_ref().unwrap().metrics.total_time_s;
    let end = plan.layers.last().unwrap().passes.last().unwrap().end().unwrap();
    let layers = plan.layers.len();
    slide(&mut harness, "Last layer", 1.0);
    // So that the way to the end takes 40 frames.
    let rate = (seconds / (40.0 * STEP)).round();
    slide(&mut harness, "Speed ×", rate);
    let rate = harness.state_mut().view().rate;
    harness.get_by_label_contains("Play").click();
    harness.run_steps(1);
    let (mut frames, mut seen) = (0, vec![0]);
    while harness.state_mut().view().playing {
        let before = harness.state_mut().view().clone();
        harness.run_steps(1);
        let now = harness.state_mut().view().clone();
        assert!(now.torch.is_some());
        // At the very end it is at rest, while the gas still flows.
        assert!(now.torch != before.torch || !now.playing, "the torch stands still");
        let passed = now.seconds - before.seconds;
        assert!(passed <= rate * STEP * 1.001 && (passed >= rate * STEP * 0.999 || !now.playing), "{passed} s");
        assert!(now.last >= before.last);
        seen.push(now.last);
        frames += 1;
        assert!(frames < 100, "it never ends");
    }
    seen.dedup();
    assert_eq!(seen, Vec::from_iter(0..layers));
    let view = harness.state_mut().view().clone();
    assert!((view.seconds - seconds).abs() < 1e-3 * seconds, "{} s, not {seconds} s", view.seconds);
    assert_eq!((view.last, view.progress), (layers - 1, 1.0));
    assert!(view.torch.unwrap().at.distance(end) < 1e-3);
    assert!((35..=45).contains(&frames), "{frames} frames");
}

#[test]
fn the_torch_waits_and_goes_on() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = example(folder.path(), "cross");
    slide(&mut harness, "Last layer", 3.0);
    harness.key_press(Key::Space);
    harness.run_steps(4);
    let view = harness.state_mut().view().clone();
    let before: f64 = harness.state().plan().scene.seconds_before(2);
    assert!(view.playing && view.last == 2 && view.seconds > before, "it begins with the layer in view");
    harness.key_press(Key::Space);
    harness.run_steps(4);
    let waits = harness.state_mut().view().clone();
    assert!(!waits.playing && sees(&harness, "▶ Play"));
    harness.run_steps(4);
    assert_eq!(harness.state_mut().view().seconds, waits.seconds);
    press(&mut harness, Key::Space);
    let view = harness.state_mut().view().clone();
    assert!(view.playing && view.seconds > waits.seconds && view.seconds < waits.seconds + 60.0);
    // Who looks at another layer stops it.
    press(&mut harness, Key::PageDown);
    let view = harness.state_mut().view().clone();
    assert!(!view.playing && view.last == 1 && view.torch.is_none());
}

#[test]
fn the_clock_takes_the_torch_to_any_time_of_the_program() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = example(folder.path(), "cross");
    let total = harness.state().plan().scene.total_seconds();
    assert!(harness.query_by_label_contains("left: 0:00:00").is_some(), "all of it is shown");
    for part in [0.0, 0.31, 0.77, 1.0] {
        slide(&mut harness, "Program time", part * total);
        let view = harness.state_mut().view().clone();
        let wanted = harness.state().plan().scene.at_time(view.seconds).unwrap();
        assert!((view.seconds - part * total).abs() < 1e-3 * total && !view.playing);
        assert_eq!(view.last, wanted.layer);
        assert!(view.torch.unwrap().at.distance(wanted.torch.at) < 1e-6);
        let left = (total.round() - view.seconds.round()) as u64;
        let left = format!("left: 0:{:02}:{:02}", left / 60, left % 60);
        assert!(harness.query_by_label_contains(&left).is_some(), "{left} is not shown");
    }
    // Play goes on from there.
    slide(&mut harness, "Program time", 0.5 * total);
    press(&mut harness, Key::Space);
    assert!(harness.state_mut().view().seconds > 0.5 * total);
    // The clock follows what is shown.
    slide(&mut harness, "Last layer", 3.0);
    let view = harness.state_mut().view().clone();
    let scene = &harness.state().plan().scene;
    let (seconds, now) = (scene.seconds_before(3), view.now(scene));
    assert!((now - seconds).abs() < 1e-6, "{now} s, not {seconds} s");
    if has_adapter() {
        let path = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("clock.png");
        harness.render().unwrap().save(path).unwrap();
    }
}

#[test]
fn the_shares_of_the_time_are_those_of_the_metrics() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = example(folder.path(), "cross");
    harness.state_mut().set_value("start_stop.interpass_time", "30.0");
    harness.state_mut().set_value("fill.strategy", "\"compound\"");
    crate::window::wait(&mut harness);
    let plan = harness.state().plan();
    let metrics = &plan.summary.as_ref().unwrap().metrics;
    let shares = Shares::of(&plan.scene, metrics);
    let arc: f64 = shares.arc.iter().map(|(_, seconds)| seconds).sum();
    assert_eq!((shares.wait, shares.starts), (metrics.dwell_time_s, metrics.start_stop_time_s));
    assert!(
        (arc + shares.starts + shares.travel + shares.wait - metrics.total_time_s).abs() < 1e-6 * metrics.total_time_s
    );
    // Without craters, the torch moves as long as the arc is on; travels take what their length takes.
    assert!((arc / metrics.arc_time_s - 1.0).abs() < 1e-4, "{arc} of {} s", metrics.arc_time_s);
    let travel = metrics.travel_length_mm / plan.profile.as_ref().unwrap().travel.speed;
    assert!((shares.travel / travel - 1.0).abs() < 0.02, "{} of {travel} s", shares.travel);
    assert!(shares.arc.len() > 1, "{:?}", shares.arc);
    let wait = format!("wait {:.0} %", 100.0 * shares.wait / shares.total);
    assert!(harness.query_by_label_contains(&wait).is_some() && shares.wait > 0.0, "{wait} is not shown");
}
