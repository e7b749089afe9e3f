//! A long computation in the background: how far it has come, what came of it. It stops when it is dropped.

use crate::jobs::{self, Job};
use beadwright::task::{Stage, Task};
use eframe::egui::Context;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// Progress is shown this often.
const EVERY: Duration = Duration::from_millis(100);

/// How far a computation has come.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Progress {
    /// The fraction of all of it that is done.
    pub(crate) done: f64,
    /// What it is doing.
    pub(crate) stage: Stage,
}

/// A computation under way, or its result.
pub(crate) struct Computing<T> {
    task: Task,
    progress: Arc<Mutex<Progress>>,
    job: Option<Job<Result<T, String>>>,
    pub(crate) result: Option<Result<T, String>>,
}

impl<T: Send + 'static> Computing<T> {
    /// Starts it; the fraction that is done is that of `whole`, other stages being steps of it.
    pub(crate) fn start(
        ctx: &Context,
        whole: Stage,
        work: impl FnOnce(&Task) -> Result<T, String> + Send + 'static,
    ) -> Self {
        let progress = Arc::new(Mutex::new(Progress { done: 0.0, stage: whole }));
        let (shown, bell) = (progress.clone(), ctx.clone());
        let task = Task::with_progress(move |stage, fraction| {
            let mut now = shown.lock().unwrap_or_else(PoisonError::into_inner);
            now.stage = stage;
            if stage == whole {
                now.done = fraction;
            }
            bell.request_repaint_after(EVERY);
        });
        let of_job = task.clone();
        Self { task, progress, job: Some(Job::start(ctx, move || work(&of_job))), result: None }
    }
}

impl<T> Computing<T> {
    /// How far it has come, while it is under way.
    pub(crate) fn progress(&self) -> Option<Progress> {
        self.job.as_ref().map(|_| *self.progress.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// Takes the answer, if there is one.
    pub(crate) fn hear(&mut self) {
        if let Some(answer) = jobs::take(&mut self.job) {
            self.result = Some(answer.and_then(|answer| answer));
        }
    }

    /// What came of it, if it is done and nothing went wrong.
    pub(crate) fn found(&self) -> Option<&T> {
        self.result.as_ref()?.as_ref().ok()
    }
}

impl<T> Drop for Computing<T> {
    fn drop(&mut self) {
        self.task.cancel();
    }
}
