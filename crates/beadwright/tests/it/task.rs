//! Progress and cancelling of the long calls.

use crate::solids;
use beadwright::fill::StrategyName;

use beadwright::directions::{Settings, tried};
use beadwright::example;
use beadwright::model::{ImportError, Mesh, Model, Placement, import};
use beadwright::plan::{self, PlanError};
use beadwright::profile::Profile;
use beadwright::slice::{SliceOptions, Slicer};
use beadwright::task::{Cancelled, Stage, Task};
use solids::{ascii, binary, facets_of, sphere};
use std::sync::{Arc, Mutex, OnceLock};
use std::time::{Duration, Instant};

type Steps = Arc<Mutex<Vec<(Stage, f64)>>>;

/// A task that writes down its steps and is cancelled from within by the step number `at`, from 0.
fn watched(at: Option<usize>) -> (Task, Steps) {
    let steps = Steps::default();
    let (seen, own) = (Arc::clone(&steps), Arc::new(OnceLock::<Task>::new()));
    let inner = Arc::clone(&own);
    let task = Task::with_progress(move |stage, fraction| {
        let mut seen = seen.lock().unwrap();
        if at == Some(seen.len()) {
            inner.get().unwrap().cancel();
        }
        seen.push((stage, fraction));
    });
    own.set(task.clone()).unwrap();
    (task, steps)
}

/// The call reports its last stage, forward and within 0 to 1; cancelled before it or at any of its steps it stops there.
fn check(name: &str, stage: Stage, call: impl Fn(&Task) -> Result<(), Cancelled>) {
    let (task, steps) = watched(None);
    call(&task).unwrap();
    let steps = steps.lock().unwrap().clone();
    let own: Vec<f64> = steps.iter().filter(|s| s.0 == stage).map(|s| s.1).collect();
    assert!(own.len() > 1, "{name} reports its progress");
    assert!(steps.iter().all(|s| (0.0..=1.0).contains(&s.1)), "{name}: {steps:?}");
    assert!(own.is_sorted(), "{name}: {own:?}");

    let cancelled = Task::new();
    cancelled.cancel();
    assert_eq!(call(&cancelled), Err(Cancelled), "{name} cancelled before");
    for at in 0..steps.len() {
        let (task, seen) = watched(Some(at));
        let start = Instant::now();
        assert_eq!(call(&task), Err(Cancelled), "{name} cancelled at step {at}");
        assert_eq!(seen.lock().unwrap().len(), at + 1, "{name}: no step after it was cancelled");
        assert!(start.elapsed() < Duration::from_secs(5), "{name}: cancelled promptly");
    }
}

fn ball() -> Mesh {
    solids::imported(&sphere(40.0, 40)).mesh
}

fn import_of(bytes: &[u8], task: &Task) -> Result<(), Cancelled> {
    match import(bytes, task) {
        Ok(_) => Ok(()),
        Err(ImportError::Cancelled(cancelled)) => Err(cancelled),
        Err(other) => panic!("{other}"),
    }
}

#[test]
fn import_can_be_watched_and_stopped() {
    // More than one report's worth of triangles.
    let facets = sphere(40.0, 190);
    assert!(facets.len() > 65_536 * 2);
    let bytes = binary(b"", &facets);
    check("binary", Stage::Import, |task| import_of(&bytes, task));
    let text = ascii("", &sphere(40.0, 20));
    check("ascii", Stage::Import, |task| import_of(text.as_bytes(), task));
}

#[test]
fn the_search_for_directions_can_be_watched_and_stopped() {
    let profile = Profile::built_in("cmt-steel-abb").unwrap();
    let hub = Model::read(&example::find("hub").unwrap().stl(), &Task::new()).unwrap();
    let hub = hub.place(&Placement::default(), None, profile.bead.width).unwrap();
    let settings = Settings::usual(profile.bead.width);
    let call = |task: &Task| match tried("hub", &hub, &profile, false, settings, task) {
        Ok(found) => Ok(found.divisions[0].is_planned()),
        Err(PlanError::Cancelled(cancelled)) => Err(cancelled),
        Err(other) => panic!("{other}"),
    };
    let (task, steps) = watched(None);
    assert_eq!(call(&task), Ok(true));
    let steps = steps.lock().unwrap().clone();
    let whole = |at: &usize| steps[*at].0 == Stage::Directions;
    let done: Vec<f64> = (0..steps.len()).filter(whole).map(|at| steps[at].1).collect();
    assert!(done.len() > 1 && done.is_sorted() && done.iter().all(|done| (0.0..1.0).contains(done)), "{done:?}");
    // Before it begins, before a division is planned, and while one is.
    for at in (0..steps.len()).filter(whole).chain([steps.len() / 2]) {
        assert_eq!(call(&watched(Some(at)).0), Err(Cancelled), "at step {at}");
    }
}

#[test]
fn slicing_can_be_watched_and_stopped() {
    let mesh = ball();
    check("slice", Stage::Slice, |task| {
        let options = SliceOptions { layer_height: 0.5, close_gap: 0.5, simplify: 0.01 };
        Slicer::new(&mesh, options, task)?.all(task).map(|layers| assert_eq!(layers.len(), 160))
    });
}

#[test]
fn planning_can_be_watched_and_stopped() {
    let (mesh, mut profile) = (ball(), Profile::built_in("plasma-304-cnc").unwrap());
    profile.layers.height = 0.5;
    profile.layers.level = false;
    // Loops of that many layers take longer than the test waits.
    profile.fill.strategy = StrategyName::Compound;
    check("plan", Stage::Plan, |task| match plan::plan("ball", &mesh, &profile, task) {
        Ok(plan) => {
            assert_eq!(plan.layers.len(), 160);
            Ok(())
        }
        Err(PlanError::Cancelled(cancelled)) => Err(cancelled),
        Err(other) => panic!("{other}"),
    });
}

#[test]
fn a_finished_import_has_reported_everything() {
    let (task, steps) = watched(None);
    let bytes = binary(b"", &facets_of(&example::find("cross").unwrap().mesh()));
    import(&bytes, &task).unwrap();
    let steps = steps.lock().unwrap();
    assert_eq!((steps.first(), steps.last()), (Some(&(Stage::Import, 0.0)), Some(&(Stage::Import, 1.0))));
}

#[test]
fn a_thread_can_cancel_what_another_runs() {
    let mesh = ball();
    let mut profile = Profile::built_in("plasma-304-cnc").unwrap();
    // Far more layers than can be planned in the time.
    profile.layers.height = 0.01;
    let task = Task::new();
    let stop = task.clone();
    let stopper = std::thread::spawn(move || {
        std::thread::sleep(Duration::from_millis(100));
        stop.cancel();
        Instant::now()
    });
    let result = plan::plan("ball", &mesh, &profile, &task);
    let late = Instant::now() - stopper.join().unwrap();
    assert!(matches!(result, Err(PlanError::Cancelled(_))), "{:?}", result.map(|p| p.header));
    assert!(late < Duration::from_secs(2), "{late:?} after it was cancelled");
}

#[test]
fn names_are_words() {
    assert_eq!([Stage::Import, Stage::Slice, Stage::Plan].map(Stage::name), ["import", "slice", "plan"]);
    assert_eq!(Cancelled.to_string(), "cancelled");
}
