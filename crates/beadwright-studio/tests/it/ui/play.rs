//! The torch runs as the program will.

use crate::window::{example, press, sees, slide};
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
