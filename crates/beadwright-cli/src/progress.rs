//! The progress bar and Ctrl-C (or SIGTERM), both through the library's task handle; how long stages take and will take.

use crate::say::{Loudness, loudness};
use beadwright::task::{Stage, Task};
use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::time::{Duration, Instant};

static RUNNING: OnceLock<Task> = OnceLock::new();

/// After this time, a stage is asked how long it will still take.
const SOON: Duration = Duration::from_secs(5);
/// Remaining times of this length or more are reported.
const LONG: Duration = Duration::from_secs(60);

/// The bar and the clock of a command.
pub(crate) struct Bar {
    bar: ProgressBar,
    clock: Arc<Mutex<Clock>>,
}

/// A task that draws a bar when standard error is a terminal, and that Ctrl-C cancels.
pub(crate) fn task() -> anyhow::Result<(Task, Bar)> {
    let quiet = loudness() == Loudness::Quiet;
    let bar = drawn(1000);
    bar.set_style(ProgressStyle::with_template("{msg:>8} {wide_bar} {percent:>3} %")?);
    let clock = Arc::new(Mutex::new(Clock::new(Instant::now())));
    let (shown, ticking) = (bar.clone(), clock.clone());
    let task = Task::with_progress(move |stage, fraction| {
        shown.set_message(stage.name());
        shown.set_position((fraction * 1000.0) as u64);
        let reported = ticking.lock().unwrap_or_else(PoisonError::into_inner).step(stage, fraction, Instant::now());
        if let Some(reported) = reported.filter(|_| !quiet) {
            shown.suspend(|| eprintln!("{reported}"));
        }
    });
    stopped_by_ctrl_c(&task)?;
    Ok((task, Bar { bar, clock }))
}

/// A task for this number of parallel runs, which Ctrl-C cancels, and a bar that counts them.
pub(crate) fn counting(runs: usize) -> anyhow::Result<(Task, ProgressBar)> {
    let (task, bar) = (Task::new(), drawn(runs as u64));
    bar.set_style(ProgressStyle::with_template("{pos:>5} of {len} plans {wide_bar}")?);
    stopped_by_ctrl_c(&task)?;
    Ok((task, bar))
}

/// A bar that is shown only on a terminal, and not with `--quiet`.
fn drawn(length: u64) -> ProgressBar {
    let seen = std::io::stderr().is_terminal() && loudness() != Loudness::Quiet;
    if seen { ProgressBar::new(length) } else { ProgressBar::hidden() }
}

fn stopped_by_ctrl_c(task: &Task) -> anyhow::Result<()> {
    _ = RUNNING.set(task.clone());
    Ok(ctrlc::set_handler(stop)?)
}

impl Bar {
    /// Removes the bar, and with `--verbose` reports how long the stages took.
    pub(crate) fn finish_and_clear(&self) {
        self.bar.finish_and_clear();
        if loudness() == Loudness::Verbose {
            let mut clock = self.clock.lock().unwrap_or_else(PoisonError::into_inner);
            clock.stages(Instant::now()).iter().for_each(|line| eprintln!("{line}"));
        }
    }
}

/// Stages with the time spent in them.
struct Clock {
    begun: Instant,
    /// The stage, and since when it runs.
    now: Option<(Stage, Instant)>,
    spent: Vec<(Stage, Duration)>,
    /// The last stage whose remaining time was reported.
    reported: Option<Stage>,
}

impl Clock {
    fn new(begun: Instant) -> Self {
        Self { begun, now: None, spent: Vec::new(), reported: None }
    }

    /// Records a step; once per stage, returns a sentence if the stage will take long.
    fn step(&mut self, stage: Stage, fraction: f64, at: Instant) -> Option<String> {
        let since = match self.now {
            Some((current, since)) if current == stage => since,
            _ => {
                self.close(at);
                self.now = Some((stage, at));
                at
            }
        };
        let elapsed = at.saturating_duration_since(since);
        if elapsed < SOON || !(fraction > 0.0 && fraction < 1.0) || self.reported == Some(stage) {
            return None;
        }
        let rest = elapsed.mul_f64((1.0 - fraction) / fraction);
        if rest < LONG {
            return None;
        }
        self.reported = Some(stage);
        let minutes = (rest.as_secs_f64() / 60.0).ceil();
        Some(format!(
            "{}: {:.0} % done, about {minutes:.0} min to go. Ctrl-C stops it.",
            stage.name(),
            100.0 * fraction
        ))
    }

    /// Adds the time of the present stage to its sum.
    fn close(&mut self, at: Instant) {
        let Some((stage, since)) = self.now.take() else { return };
        let spent = at.saturating_duration_since(since);
        match self.spent.iter_mut().find(|(known, _)| *known == stage) {
            Some((_, sum)) => *sum += spent,
            None => self.spent.push((stage, spent)),
        }
    }

    /// The stages in their order, and the whole.
    fn stages(&mut self, at: Instant) -> Vec<String> {
        self.close(at);
        let line = |name: &str, spent: Duration| format!("{name:<8} {:>9.2} s", spent.as_secs_f64());
        let all = at.saturating_duration_since(self.begun);
        self.spent.iter().map(|(stage, spent)| line(stage.name(), *spent)).chain([line("all", all)]).collect()
    }
}

/// The first call stops the task, the second ends the process at once. The next run clears what it leaves.
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

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn a_long_rest_is_reported_once_a_stage() {
        let begun = Instant::now();
        let at = |seconds: u64| begun + Duration::from_secs(seconds);
        let mut clock = Clock::new(begun);
        assert_eq!(clock.step(Stage::Plan, 0.0, at(0)), None);
        // Too early to tell, then 95 s to go for 5 s of work.
        assert_eq!(clock.step(Stage::Plan, 0.04, at(4)), None);
        let reported = clock.step(Stage::Plan, 0.05, at(5)).unwrap();
        assert!(reported.starts_with("plan: 5 % done, about 2 min to go"), "{reported}");
        assert_eq!(clock.step(Stage::Plan, 0.06, at(6)), None);
        // The next stage has less than a minute to go.
        assert_eq!(clock.step(Stage::Deposit, 0.0, at(10)), None);
        assert_eq!(clock.step(Stage::Deposit, 0.5, at(20)), None);
        let lines = clock.stages(at(30));
        assert_eq!(lines, ["plan         10.00 s", "deposit      20.00 s", "all          30.00 s"]);
    }
}
