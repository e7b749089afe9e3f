//! One handle for long calls: it reports progress and carries the request to cancel.

use serde::{Deserialize, Serialize};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// What a long call is doing.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Stage {
    /// Reading a model and repairing it.
    Import,
    /// Finding divisions of a part, each of which is planned for trial.
    Directions,
    /// Cutting a mesh into layers.
    Slice,
    /// Laying passes into layers.
    Plan,
    /// Computing what would be deposited.
    Deposit,
    /// Computing how warm the part is before each pass.
    Heat,
    /// Computing how plate and part bend.
    Distort,
}

impl Stage {
    /// A short word for a progress bar.
    pub fn name(self) -> &'static str {
        match self {
            Self::Import => "import",
            Self::Directions => "directions",
            Self::Slice => "slice",
            Self::Plan => "plan",
            Self::Deposit => "deposit",
            Self::Heat => "heat",
            Self::Distort => "distort",
        }
    }
}

/// The call was stopped through its [`Task`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("cancelled")]
pub struct Cancelled;

type Progress = dyn Fn(Stage, f64) + Send + Sync;

/// Progress out, cancellation in. Clones share both, so the caller can keep one.
#[derive(Clone, Default)]
pub struct Task {
    cancelled: Arc<AtomicBool>,
    progress: Option<Arc<Progress>>,
}

impl Task {
    /// A task that nobody watches; it can still be cancelled.
    pub fn new() -> Self {
        Self::default()
    }

    /// A task that calls `progress` with its stage and fraction (0 to 1), possibly from several threads.
    ///
    /// ```
    /// use bead_part::task::{Stage, Task};
    /// use std::sync::mpsc;
    ///
    /// let (sender, receiver) = mpsc::channel();
    /// let task = Task::with_progress(move |stage, fraction| drop(sender.send((stage, fraction))));
    /// task.step(Stage::Slice, 0.5)?;
    /// assert_eq!(receiver.recv()?, (Stage::Slice, 0.5));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn with_progress(progress: impl Fn(Stage, f64) + Send + Sync + 'static) -> Self {
        Self { progress: Some(Arc::new(progress)), ..Self::default() }
    }

    /// Asks the running call to stop; it returns [`Cancelled`] at its next check.
    ///
    /// ```
    /// use bead_part::task::Task;
    ///
    /// let task = Task::new();
    /// // A clone may be anywhere, such as behind a button.
    /// task.clone().cancel();
    /// assert!(task.check().is_err());
    /// ```
    pub fn cancel(&self) {
        self.cancelled.store(true, Ordering::Relaxed);
    }

    /// Reports the fraction of a stage that is done; [`Cancelled`] if the task was cancelled.
    pub fn step(&self, stage: Stage, fraction: f64) -> Result<(), Cancelled> {
        if let Some(progress) = &self.progress {
            progress(stage, fraction);
        }
        self.check()
    }

    /// [`Cancelled`] if the task was cancelled.
    pub fn check(&self) -> Result<(), Cancelled> {
        if self.cancelled.load(Ordering::Relaxed) { Err(Cancelled) } else { Ok(()) }
    }
}

impl std::fmt::Debug for Task {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Task").field("cancelled", &self.cancelled).finish_non_exhaustive()
    }
}
