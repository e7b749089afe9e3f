//! Work on the page itself, and the browser's file chooser.

use super::{Answer, Ask, Job, caught};
use crate::disk;
use eframe::egui::{Context, DroppedFileHandle};
use std::path::PathBuf;
use std::sync::mpsc::channel;
use wasm_bindgen_futures::spawn_local;

impl<T: 'static> Job<T> {
    /// Does the work at once.
    pub fn start(ctx: &Context, work: impl FnOnce() -> T) -> Self {
        let (sender, receiver) = channel();
        // The receiver is below.
        let _ = sender.send(caught(work));
        ctx.request_repaint();
        Self(receiver)
    }

    /// Waits for an answer of the browser; the page is drawn again when it has come.
    fn wait(ctx: &Context, answer: impl Future<Output = T> + 'static) -> Self {
        let (sender, receiver) = channel();
        let ctx = ctx.clone();
        spawn_local(async move {
            if sender.send(Ok(answer.await)).is_ok() {
                ctx.request_repaint();
            }
        });
        Self(receiver)
    }
}

/// Asks in the browser's file chooser. It does not ask where to write: what is written is downloaded.
pub fn ask(ctx: &Context, what: Ask, name: &str) -> Job<Answer> {
    let dialog = rfd::AsyncFileDialog::new();
    let models = ["stl", "igs", "iges", "bwp"];
    let dialog = match what {
        Ask::Open => dialog.add_filter("STL, IGES, BWP", &models),
        Ask::OpenProfile | Ask::OpenBeads => dialog.add_filter("TOML", &["toml"]),
        Ask::OpenScan | Ask::OpenBuildScan => dialog,
        Ask::Folder | Ask::BatchFolder => return answered(ctx, what, "Downloads".into()),
        Ask::SaveProject => return answered(ctx, what, format!("{name}.bwp").into()),
        Ask::SavePicture => return answered(ctx, what, format!("{name}.png").into()),
    };
    Job::wait(ctx, async move {
        let mut paths = Vec::new();
        for file in dialog.pick_files().await.unwrap_or_default() {
            let path = PathBuf::from(file.file_name());
            disk::hand_over(&path, Ok(file.read().await));
            paths.push(path);
        }
        Answer { what, path: opened(paths), seen: true }
    })
}

/// Reads files that were dropped on the page.
pub fn receive(ctx: &Context, files: Vec<DroppedFileHandle>) -> Job<Answer> {
    Job::wait(ctx, async move {
        let mut paths = Vec::new();
        for file in files {
            let path = file.path().to_owned();
            disk::hand_over(&path, file.bytes_async().await);
            paths.push(path);
        }
        Answer { what: Ask::Open, path: opened(paths), seen: true }
    })
}

fn answered(ctx: &Context, what: Ask, path: PathBuf) -> Job<Answer> {
    Job::start(ctx, move || Answer { what, path: Some(path), seen: true })
}

/// Of several files, the project, which names its model; otherwise the first.
fn opened(paths: Vec<PathBuf>) -> Option<PathBuf> {
    let is_project = |path: &&PathBuf| path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("bwp"));
    paths.iter().find(is_project).or(paths.first()).cloned()
}
