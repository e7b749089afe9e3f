//! The progress bar and Ctrl-C (or SIGTERM), both through the library's task handle.

use beadwright::task::Task;
use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};

static RUNNING: OnceLock<Task> = OnceLock::new();

/// A task that draws a bar when standard error is a terminal, and that Ctrl-C cancels.
pub(crate) fn task() -> anyhow::Result<(Task, ProgressBar)> {
    let bar = if std::io::stderr().is_terminal() { ProgressBar::new(1000) } else { ProgressBar::hidden() };
    bar.set_style(ProgressStyle::with_template("{msg:>8} {wide_bar} {percent:>3} %")?);
    let shown = bar.clone();
    let task = Task::with_progress(move |stage, fraction| {
        shown.set_message(stage.name());
        shown.set_position((fraction * 1000.0) as u64);
    });
    _ = RUNNING.set(task.clone());
    ctrlc::set_handler(stop)?;
    Ok((task, bar))
}

/// Asked once, stops the task; asked again, ends at once. What it leaves, the next run clears.
fn stop() {
    static ASKED: AtomicBool = AtomicBool::new(false);
    if ASKED.swap(true, Ordering::Relaxed) {
        std::process::exit(1);
    }
    cancel();
}

/// Stops the task, if one runs.
pub(crate) fn cancel() {
    RUNNING.get().into_iter().for_each(Task::cancel);
}
