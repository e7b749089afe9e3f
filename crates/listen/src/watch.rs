//! When to end.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// How long to listen.
#[derive(Clone, Copy)]
pub struct Until<'a> {
    /// For so long, s; without end if `None`.
    pub seconds: Option<f64>,
    /// Until no source has sent anything for this long, s.
    pub idle: Option<f64>,
    /// Until this is true, which is asked ten times a second.
    pub stopped: &'a (dyn Fn() -> bool + Sync),
}

/// How often it is asked whether to end.
pub(crate) const TICK: Duration = Duration::from_millis(100);

/// What all sources share.
pub(crate) struct Watch<'a> {
    until: Until<'a>,
    say: &'a (dyn Fn(&str) + Sync),
    begun: Instant,
    /// When something was last heard, ms since the beginning.
    heard: AtomicU64,
    ended: AtomicBool,
}

impl<'a> Watch<'a> {
    pub(crate) fn new(until: Until<'a>, say: &'a (dyn Fn(&str) + Sync)) -> Self {
        Self { until, say, begun: Instant::now(), heard: AtomicU64::new(0), ended: AtomicBool::new(false) }
    }

    pub(crate) fn say(&self, sentence: &str) {
        (self.say)(sentence);
    }

    /// Notes that something was heard.
    pub(crate) fn heard(&self) {
        self.heard.store(self.begun.elapsed().as_millis() as u64, Ordering::Relaxed);
    }

    /// Ends listening to all sources, of which one has failed.
    pub(crate) fn end(&self) {
        self.ended.store(true, Ordering::Relaxed);
    }

    /// Whether another source has failed.
    pub(crate) fn is_failed(&self) -> bool {
        self.ended.load(Ordering::Relaxed)
    }

    /// Whether to end.
    pub(crate) fn is_over(&self) -> bool {
        let elapsed = self.begun.elapsed().as_secs_f64();
        let quiet = elapsed - self.heard.load(Ordering::Relaxed) as f64 / 1000.0;
        let past = |limit: Option<f64>, seconds: f64| limit.is_some_and(|limit| seconds >= limit);
        self.is_failed() || past(self.until.seconds, elapsed) || past(self.until.idle, quiet) || (self.until.stopped)()
    }
}
