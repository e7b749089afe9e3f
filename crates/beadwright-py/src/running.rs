//! Long calls. They run on threads of their own without the interpreter's lock, so that other Python threads go on;
//! meanwhile the calling thread hands progress to Python and checks for Ctrl-C.

use crate::error::{exception, raise};
use beadwright::Task;
use beadwright::task::Stage;
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::error::Error;
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::thread::{ScopedJoinHandle, scope};
use std::time::Duration;

/// How often Ctrl-C is checked for.
const ASKED: Duration = Duration::from_millis(50);

/// Maximum number of threads of a call.
const MOST_THREADS: usize = 1024;

/// How a long call runs.
pub(crate) struct Running<'py> {
    threads: Option<usize>,
    progress: Option<Bound<'py, PyAny>>,
}

enum Event {
    Step(Stage, f64),
    Done,
}

impl<'py> Running<'py> {
    /// With this many threads (all of the machine's if not given), and a callable that takes stage and fraction.
    pub(crate) fn new(threads: Option<usize>, progress: Option<Bound<'py, PyAny>>) -> Self {
        Self { threads, progress }
    }

    /// Does the work and returns its result.
    pub(crate) fn run<T: Send, E: Error + Send + 'static>(
        self,
        py: Python<'py>,
        place: Option<&str>,
        work: impl FnOnce(&Task) -> Result<T, E> + Send,
    ) -> PyResult<T> {
        let pool = self.pool()?;
        let (sender, events) = channel();
        let steps = sender.clone();
        // Nobody reads steps without a callable.
        let task = match self.progress {
            Some(_) => Task::with_progress(move |stage, fraction| drop(steps.send(Event::Step(stage, fraction)))),
            None => Task::new(),
        };
        let progress = self.progress.map(Bound::unbind);
        let outcome = py.detach(|| {
            // Only one thread listens.
            let events = events;
            scope(|threads| {
                let worker = threads.spawn(|| {
                    let result = pool.install(|| work(&task));
                    _ = sender.send(Event::Done);
                    result
                });
                let stopped = watch(&worker, &events, progress.as_ref()).inspect_err(|_| task.cancel());
                let result = worker.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
                stopped.map(|()| result)
            })
        })?;
        outcome.map_err(|error| exception(&error, place))
    }

    /// Separate threads for each call: two calls share none, and forked processes lack none.
    fn pool(&self) -> PyResult<ThreadPool> {
        let threads = self.threads.unwrap_or(0);
        if self.threads == Some(0) || threads > MOST_THREADS {
            let message = format!("threads = {threads} is impossible; 1 to {MOST_THREADS} are possible.");
            return Err(raise(&message, Some("threads"), None));
        }
        let pool = ThreadPoolBuilder::new().num_threads(threads).build();
        pool.map_err(|error| raise(&format!("no threads can be started: {error}"), Some("threads"), None))
    }
}

/// Waits for the worker; fails with Ctrl-C and with what the callable raises.
fn watch<T>(worker: &ScopedJoinHandle<'_, T>, events: &Receiver<Event>, progress: Option<&Py<PyAny>>) -> PyResult<()> {
    loop {
        let step = match events.recv_timeout(ASKED) {
            Ok(Event::Step(stage, fraction)) => Some((stage.name(), fraction)),
            Ok(Event::Done) | Err(RecvTimeoutError::Disconnected) => return Ok(()),
            // After a panic nothing comes any more.
            Err(RecvTimeoutError::Timeout) if worker.is_finished() => return Ok(()),
            Err(RecvTimeoutError::Timeout) => None,
        };
        Python::attach(|py| {
            py.check_signals()?;
            progress.zip(step).map_or(Ok(()), |(progress, step)| progress.call1(py, step).map(drop))
        })?;
    }
}
