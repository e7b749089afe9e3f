//! Small background jobs: each gives one answer, to be fetched when it is ready. On the desktop they have threads; in a
//! browser, where only planning has a worker, they block the page until they are done.

#[cfg(target_arch = "wasm32")]
#[path = "jobs/browser.rs"]
mod place;
#[cfg(not(target_arch = "wasm32"))]
#[path = "jobs/desktop.rs"]
mod place;

pub use place::ask;
#[cfg(target_arch = "wasm32")]
pub use place::receive;

use beadwright::layer::Layer;
use beadwright::profile::Profile;
use beadwright::robot::{self, Cell, Reach, Suggestion};
use eframe::egui::Context;
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, TryRecvError};

/// A background job that gives one answer.
pub struct Job<T>(Receiver<Result<T, String>>);

/// Does the work; if it panics, gives a sentence that asks the user to report it.
///
/// # Errors
/// The sentence.
pub fn caught<T>(work: impl FnOnce() -> T) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(work)).map_err(|panic| sentence(&*panic))
}

fn sentence(panic: &(dyn Any + Send)) -> String {
    let words = panic.downcast_ref::<String>().map(String::as_str).or_else(|| panic.downcast_ref::<&str>().copied());
    fault(words.unwrap_or("no reason was given"))
}

/// A sentence on a fault of this program.
pub fn fault(reason: &str) -> String {
    format!(
        "Beadwright has a fault that stopped this work: {reason}. Please report it at {}/issues with the model and the \
         project; the program continues.",
        env!("CARGO_PKG_REPOSITORY")
    )
}

/// Takes the answer of a finished job, or the sentence of one that panicked, and forgets the job.
pub fn take<T>(job: &mut Option<Job<T>>) -> Option<Result<T, String>> {
    match job.as_ref()?.0.try_recv() {
        Ok(answer) => {
            *job = None;
            Some(answer)
        }
        Err(TryRecvError::Empty) => None,
        Err(TryRecvError::Disconnected) => {
            *job = None;
            None
        }
    }
}

/// What a file dialog asks for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ask {
    /// A model or a project to open.
    Open,
    /// Where to write the project.
    SaveProject,
    /// A folder for the program.
    Folder,
    /// Where to write a picture.
    SavePicture,
    /// A profile to load.
    OpenProfile,
    /// A bead library to look at.
    OpenBeads,
    /// A scan to compare with the part.
    OpenScan,
    /// A folder of models to be planned one after another.
    BatchFolder,
    /// A scan of the unfinished build, to be followed.
    OpenBuildScan,
}

/// What a dialog returned: the path, if there is one, and whether the dialog can have been on the screen at all.
pub struct Answer {
    /// What was asked for.
    pub what: Ask,
    /// The path; `None` if the user cancelled.
    pub path: Option<PathBuf>,
    /// Whether somebody can have seen the dialog: a desktop without file dialogs answers at once.
    pub seen: bool,
}

/// Looks for a place of the part that a robot cell reaches better; `None` if there is none.
pub fn suggest(ctx: &Context, cell: Cell, layers: Vec<Arc<Layer>>, profile: Arc<Profile>) -> Job<Option<Suggestion>> {
    Job::start(ctx, move || robot::suggest(&cell, cell.part, &profile.track(&layers)))
}

/// Checks whether a robot cell can reach all of a plan.
pub fn reach(
    ctx: &Context,
    cell: String,
    layers: Vec<Arc<Layer>>,
    profile: Arc<Profile>,
) -> Job<Result<Reach, String>> {
    Job::start(ctx, move || {
        let cell = Cell::built_in(&cell).map_err(|error| error.to_string())?;
        let track = profile.track(&layers);
        Ok(robot::reach(&cell, cell.part, &track))
    })
}
