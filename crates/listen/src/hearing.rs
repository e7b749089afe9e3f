//! What was heard of a source: its log, what was lost, and who is silent.

use crate::error::ListenError;
use crate::log::Log;
use crate::source::Source;
use crate::watch::Watch;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// What was heard of a source, when listening has ended.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Heard {
    /// Name of the source.
    pub name: String,
    /// Its log.
    pub path: PathBuf,
    /// Rows that were written.
    pub rows: u64,
    /// Times that the connection was lost.
    pub interruptions: u64,
    /// Messages that could not be read.
    pub unreadable: u64,
    /// Topics or nodes from which nothing came.
    pub nothing_from: Vec<String>,
}

/// A source that is being listened to.
pub(crate) struct Hearing<'a> {
    pub(crate) source: &'a Source,
    log: Log,
    watch: &'a Watch<'a>,
    /// Since when the connection is lost.
    lost: Option<Instant>,
    interruptions: u64,
    unreadable: u64,
    places: BTreeMap<&'a str, Place>,
    synced: Instant,
}

/// A topic or a node.
struct Place {
    last: Instant,
    messages: u64,
    unreadable: u64,
    is_silent: bool,
}

/// How often the log is made safe from power cuts.
const SYNC: Duration = Duration::from_secs(1);

impl<'a> Hearing<'a> {
    pub(crate) fn new(source: &'a Source, log: Log, watch: &'a Watch<'a>) -> Self {
        let now = Instant::now();
        let place = || Place { last: now, messages: 0, unreadable: 0, is_silent: false };
        let places = source.places().into_iter().map(|name| (name, place())).collect();
        Self { source, log, watch, lost: None, interruptions: 0, unreadable: 0, places, synced: now }
    }

    /// Says that listening has begun.
    pub(crate) fn begun(&self) {
        self.say(&format!("listening to {}, writing to {}", self.source.url, self.log.path().display()));
    }

    /// Adds a row.
    pub(crate) fn row(&mut self, time: &str, cells: &[String]) -> Result<(), ListenError> {
        self.log.row(time, cells)
    }

    /// Whether an earlier time of listening ended with such a row.
    pub(crate) fn has(&self, time: &str, cells: &[String]) -> bool {
        self.log.has(time, cells)
    }

    /// Notes that a topic or node was heard.
    pub(crate) fn heard(&mut self, place: &str) {
        self.watch.heard();
        if let Some(place) = self.places.get_mut(place) {
            place.messages += 1;
            (place.last, place.is_silent) = (Instant::now(), false);
        }
    }

    /// Counts a message that cannot be read; the first of each topic or node is reported.
    pub(crate) fn unreadable(&mut self, name: &str, reason: &str) -> Result<(), ListenError> {
        self.unreadable += 1;
        let Some(place) = self.places.get_mut(name) else { return Ok(()) };
        place.unreadable += 1;
        if place.unreadable > 1 {
            return Ok(());
        }
        let sentence = format!("{name}: {reason}");
        self.say(&sentence);
        self.log.event("unreadable", &sentence)
    }

    /// Notes that the connection was lost, or could not be made again.
    pub(crate) fn interrupted(&mut self, reason: &str) -> Result<(), ListenError> {
        if self.lost.is_some() {
            return Ok(());
        }
        self.lost = Some(Instant::now());
        self.interruptions += 1;
        let sentence = format!("The connection to {} was lost: {reason}", self.source.url);
        self.say(&sentence);
        self.log.interrupted(&sentence)
    }

    /// Notes that it was made again; `kept` says what became of what was sent meanwhile.
    pub(crate) fn resumed(&mut self, kept: &str) {
        let Some(lost) = self.lost.take() else { return };
        let seconds = lost.elapsed().as_secs_f64();
        let sentence = format!("The connection to {} was restored after {seconds:.1} s. {kept}", self.source.url);
        self.say(&sentence);
        self.log.resumed(&sentence);
        self.places.values_mut().for_each(|place| place.last = Instant::now());
    }

    /// Notes that rows are missing though the connection holds.
    pub(crate) fn missing(&mut self, reason: &str) -> Result<(), ListenError> {
        self.say(reason);
        self.log.event("interrupted", reason)
    }

    /// Whether the connection is lost.
    pub(crate) fn is_lost(&self) -> bool {
        self.lost.is_some()
    }

    /// Does what is due now and then; whether to end.
    pub(crate) fn tick(&mut self) -> Result<bool, ListenError> {
        if self.synced.elapsed() >= SYNC {
            self.log.sync()?;
            self.synced = Instant::now();
        }
        Ok(self.watch.is_over())
    }

    /// Whether listening ends because another source has failed.
    pub(crate) fn is_failed(&self) -> bool {
        self.watch.is_failed()
    }

    /// Reports the topics that have become silent.
    pub(crate) fn report_silence(&mut self) -> Result<(), ListenError> {
        if self.lost.is_some() || self.source.silent == 0.0 {
            return Ok(());
        }
        let mut silent = Vec::new();
        for (name, place) in &mut self.places {
            if !place.is_silent && place.last.elapsed().as_secs_f64() >= self.source.silent {
                place.is_silent = true;
                silent.push(*name);
            }
        }
        for name in silent {
            let sentence = format!("{name}: nothing was heard for {} s.", self.source.silent);
            self.say(&sentence);
            self.log.event("silent", &sentence)?;
        }
        Ok(())
    }

    pub(crate) fn refused(&self, reason: String) -> ListenError {
        ListenError::Refused { url: self.source.url.clone(), reason }
    }

    /// Ends the log.
    pub(crate) fn end(mut self) -> Result<Heard, ListenError> {
        self.log.sync()?;
        let nothing = self.places.iter().filter(|(_, place)| place.messages == 0);
        Ok(Heard {
            name: self.source.name.clone(),
            path: self.log.path().to_owned(),
            rows: self.log.rows(),
            interruptions: self.interruptions,
            unreadable: self.unreadable,
            nothing_from: nothing.map(|(name, _)| (*name).to_owned()).collect(),
        })
    }

    fn say(&self, sentence: &str) {
        self.watch.say(&format!("{}: {sentence}", self.source.name));
    }
}
