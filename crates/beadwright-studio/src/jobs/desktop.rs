//! Threads, and the dialogs of the desktop.

use super::{Answer, Ask, Job, caught};
use eframe::egui::Context;
use std::sync::mpsc::channel;
use std::time::{Duration, Instant};

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

/// The shortest time in which somebody can read and close a dialog.
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
        Ask::OpenScan | Ask::OpenBuildScan => Box::pin(dialog.clone().pick_file()),
        Ask::Folder | Ask::BatchFolder => Box::pin(dialog.clone().pick_folder()),
        Ask::SaveProject => Box::pin(named("bwp").save_file()),
        Ask::SavePicture => Box::pin(named("png").save_file()),
    };
    let asked = Instant::now();
    Job::start(ctx, move || {
        let path = pollster::block_on(answer).map(|file| file.path().to_owned());
        Answer { what, path, seen: asked.elapsed() > QUICKEST }
    })
}
