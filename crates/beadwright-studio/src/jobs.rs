//! Small background jobs: each gives one answer, to be fetched when it is ready.

use beadwright::fill::hybrid::Steps;
use beadwright::layer::Layer;
use beadwright::profile::Profile;
use beadwright::robot::{self, Cell, Reach, Track};
use eframe::egui::Context;
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::time::{Duration, Instant};

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
    let reason = words.unwrap_or("no reason was given");
    format!(
        "Beadwright has a fault that stopped this work: {reason}. Please report it at {}/issues with the model and the \
         project; the program goes on.",
        env!("CARGO_PKG_REPOSITORY")
    )
}

impl<T: Send + 'static> Job<T> {
    /// Starts work on a thread of its own; the window is drawn again when it is done.
    pub fn start(ctx: &Context, work: impl FnOnce() -> T + Send + 'static) -> Self {
        let (sender, receiver) = channel();
        let ctx = ctx.clone();
        std::thread::spawn(move || {
            if sender.send(caught(work)).is_ok() {
                ctx.request_repaint();
            }
        });
        Self(receiver)
    }
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
}

/// What a dialog gave: the path, if there is one, and whether the dialog can have been on the screen at all.
pub struct Answer {
    /// What was asked for.
    pub what: Ask,
    /// The path; none if the user cancelled.
    pub path: Option<PathBuf>,
    /// Whether somebody can have seen it: a desktop without file dialogs answers at once.
    pub seen: bool,
}

/// Nobody reads and closes a dialog faster than this.
const QUICKEST: Duration = Duration::from_millis(350);

/// Asks in the system's own dialog.
pub fn ask(ctx: &Context, what: Ask, name: &str) -> Job<Answer> {
    let dialog = rfd::AsyncFileDialog::new();
    let named = |extension: &str| dialog.clone().set_file_name(format!("{name}.{extension}"));
    let models = ["stl", "STL", "igs", "iges", "IGS", "IGES", "bwp"];
    // The dialog is created here, because some systems require the main thread, and waited for on another thread.
    let answer: std::pin::Pin<Box<dyn Future<Output = Option<rfd::FileHandle>> + Send>> = match what {
        Ask::Open => Box::pin(dialog.clone().add_filter("STL, IGES, BWP", &models).pick_file()),
        Ask::OpenProfile | Ask::OpenBeads => Box::pin(dialog.clone().add_filter("TOML", &["toml"]).pick_file()),
        Ask::Folder => Box::pin(dialog.clone().pick_folder()),
        Ask::SaveProject => Box::pin(named("bwp").save_file()),
        Ask::SavePicture => Box::pin(named("png").save_file()),
    };
    let asked = Instant::now();
    Job::start(ctx, move || {
        let path = pollster::block_on(answer).map(|file| file.path().to_owned());
        Answer { what, path, seen: asked.elapsed() > QUICKEST }
    })
}

/// The steps of the hybrid on every island of a layer: pockets and skeleton regions.
pub fn steps(ctx: &Context, layer: Arc<Layer>, profile: Arc<Profile>) -> Job<(usize, Vec<Steps>)> {
    Job::start(ctx, move || {
        let settings = profile.fill_settings(layer.index);
        (layer.index, layer.islands.iter().map(|island| Steps::of(island, &settings)).collect())
    })
}

/// Checks with a robot cell whether a plan can be reached.
pub fn reach(
    ctx: &Context,
    cell: String,
    layers: Vec<Arc<Layer>>,
    profile: Arc<Profile>,
) -> Job<Result<Reach, String>> {
    Job::start(ctx, move || {
        let cell = Cell::built_in(&cell).map_err(|error| error.to_string())?;
        let track = Track::of(&layers, &profile);
        Ok(robot::reach(&cell, cell.part, &track))
    })
}
