//! The background: work that breaks, work that is no longer wanted, work that is not done yet.

use crate::window::{example, sees, studio, wait};
use beadwright_studio::export::Export;
use beadwright_studio::jobs::{self, Job};
use beadwright_studio::planner::{Event, Failure, Planner};
use beadwright_studio::project::{Project, Source};
use eframe::egui::Context;
use egui_kittest::kittest::Queryable;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

const PATIENCE: Duration = Duration::from_secs(60);

/// What is heard until the plan is checked or fails.
fn last(planner: &mut Planner) -> Event {
    let start = Instant::now();
    while start.elapsed() < PATIENCE {
        let end = |event: &Event| matches!(event, Event::Failed(_) | Event::Checked(..));
        if let Some(event) = planner.events().into_iter().find(end) {
            return event;
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    panic!("the window would wait for ever");
}

#[test]
fn a_fault_in_the_planner_is_reported_and_it_plans_again() {
    // The bell is rung in the midst of the work.
    let broken = AtomicBool::new(false);
    let bell = move |_| assert!(broken.swap(true, Ordering::Relaxed), "the bell is cracked");
    let mut planner = Planner::new(bell);
    let project = Project { source: Some(Source::Example("cross".to_owned())), ..Project::default() };
    planner.plan(&project, 0);
    let Event::Failed(Failure::Sentence(text)) = last(&mut planner) else { panic!("the fault is not reported") };
    assert!(text.contains("the bell is cracked") && text.contains("report") && text.ends_with('.'), "{text}");
    planner.plan(&project, 0);
    assert!(matches!(last(&mut planner), Event::Checked(..)));
}

#[test]
fn a_fault_in_a_job_is_reported() {
    let ctx = Context::default();
    let mut job = Some(Job::<u32>::start(&ctx, || panic!("no {}", "luck")));
    let start = Instant::now();
    let answer = loop {
        if let Some(answer) = jobs::take(&mut job) {
            break answer;
        }
        assert!(start.elapsed() < PATIENCE, "the window would wait for ever");
    };
    assert!(answer.unwrap_err().contains("no luck") && job.is_none());
}

#[test]
fn a_plan_that_is_no_longer_wanted_stops() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = studio(folder.path());
    harness.state_mut().view().mode = beadwright_studio::view::Mode::Layer;
    // 120 mm of vase in layers of half a mm.
    harness.state_mut().set_value("layers.level", "false");
    harness.state_mut().set_value("layers.height", "0.5");
    harness.state_mut().open_example("vase");
    let start = Instant::now();
    while harness.state().plan().layers.len() < 3 {
        harness.run_steps(1);
        assert!(start.elapsed() < PATIENCE, "no layer comes");
    }
    assert_eq!(harness.state().plan().header.as_ref().unwrap().extent.layers, 240);
    assert!(harness.state().plan().is_busy(), "all is planned already: take a larger part");
    harness.state_mut().set_value("layers.height", "3.0");
    wait(&mut harness);
    let plan = harness.state().plan();
    assert!(plan.is_complete());
    assert_eq!((plan.layers.len(), plan.judgements.len()), (40, 40));
    assert_eq!(plan.scene.layers().len(), 40);
    for (i, layer) in plan.layers.iter().enumerate() {
        assert_eq!(layer.index, i);
        assert!((layer.height - 3.0).abs() < 1e-9, "layer {i} is {} mm high", layer.height);
    }
    assert_eq!(harness.state_mut().view().last, 39);
}

#[test]
fn a_plan_that_was_stopped_says_nothing_more() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = studio(folder.path());
    harness.state_mut().open_example("vase");
    harness.run_steps(1);
    harness.get_by_label("Stop").click();
    harness.run_steps(3);
    assert!(harness.state().is_idle() && !harness.state().plan().is_complete());
    let layers = harness.state().plan().layers.len();
    std::thread::sleep(Duration::from_millis(300));
    harness.run_steps(3);
    assert_eq!(harness.state().plan().layers.len(), layers);
    harness.key_press(eframe::egui::Key::F5);
    wait(&mut harness);
    assert!(harness.state().plan().is_complete() && sees(&harness, "Done"));
}

#[test]
fn what_belongs_to_the_request_before_is_not_written() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let mut harness = example(folder.path(), "cross");
    harness.state_mut().set_value("layers.height", "2.5");
    harness.state_mut().export(&Export::Program("krl".to_owned()), &out);
    let message = harness.state().messages().last().unwrap();
    assert!(message.error && !out.exists(), "{}", message.text);
    wait(&mut harness);
    harness.state_mut().export(&Export::Program("krl".to_owned()), &out);
    assert!(!harness.state().messages().last().unwrap().error && out.exists());

    // A part that cannot be planned is not written as the one before either.
    harness.state_mut().open(&folder.path().join("missing.stl"));
    wait(&mut harness);
    let plan = harness.state().plan();
    assert!(plan.failure.is_some() && plan.layers.is_empty() && plan.part.is_none() && plan.scene.mesh().is_none());
    let again = folder.path().join("again");
    harness.state_mut().export(&Export::Program("krl".to_owned()), &again);
    assert!(!again.exists());
}
