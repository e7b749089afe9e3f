//! A log on the time of the reference.

use crate::arc::{Arcs, Signal, Span};
use crate::clock::Clock;
use crate::quantity::Quantity;
use crate::source::Source;
use std::ops::Range;

/// A log with its clock.
pub(crate) struct Aligned<'a> {
    pub(crate) source: &'a Source,
    pub(crate) arcs: Option<Arcs>,
    pub(crate) clock: Clock,
}

impl<'a> Aligned<'a> {
    /// All logs on the time of one of them: of that with events, or else of the one that saw most arcs whole. `None` if none saw any.
    pub(crate) fn all(sources: &'a [Source]) -> Option<(Vec<Self>, usize)> {
        let arcs: Vec<Option<Arcs>> = sources.iter().map(Arcs::of).collect();
        let rank = |index: &usize| {
            let own = arcs[*index].as_ref().filter(|arcs| !arcs.spans.is_empty() && arcs.is_exact());
            own.map(|own| (own.signal == Signal::Events && own.known() > 1, own.known(), std::cmp::Reverse(*index)))
        };
        let best = (0..sources.len()).filter(|index| rank(index).is_some()).max_by_key(rank)?;
        let reference = arcs[best].clone()?;
        let align = |(index, (source, arcs)): (usize, (&'a Source, Option<Arcs>))| {
            let clock = match index == best {
                true => Clock::reference(reference.spans.len()),
                false => Clock::aligned((&sources[best], &reference), source, arcs.as_ref()),
            };
            Self { source, arcs, clock }
        };
        Some((sources.iter().zip(arcs).enumerate().map(align).collect(), best))
    }

    /// Time of a row, s.
    pub(crate) fn time(&self, row: usize) -> f64 {
        self.clock.at(self.source, row)
    }

    /// The rows from one time to another, s.
    pub(crate) fn rows(&self, from: f64, to: f64) -> Range<usize> {
        let first = self.first_after(|time| time >= from);
        first..self.first_after(|time| time > to).max(first)
    }

    /// The first row whose time is such, where all after it are too.
    fn first_after(&self, such: impl Fn(f64) -> bool) -> usize {
        let (mut low, mut high) = (0, self.source.times.len());
        while low < high {
            let middle = low + (high - low) / 2;
            if such(self.time(middle)) { high = middle } else { low = middle + 1 }
        }
        low
    }

    /// The arcs of the log.
    pub(crate) fn spans(&self) -> Vec<Span> {
        let Some(arcs) = &self.arcs else { return Vec::new() };
        let span = |(span, rows): (&Span, &Range<usize>)| Span {
            start: self.time(rows.start),
            end: self.time(rows.end),
            ..*span
        };
        arcs.spans.iter().zip(&arcs.rows).map(span).collect()
    }

    /// The times of which the log has rows.
    pub(crate) fn covers(&self) -> Vec<Span> {
        let last = self.source.times.len() - 1;
        if self.source.columns.is_empty() || self.arcs.as_ref().is_some_and(|arcs| arcs.only_burning) {
            return vec![Span::new(self.time(0), self.time(last))];
        }
        self.source.run_rows().map(|run| Span::new(self.time(run.start), self.time(run.end - 1))).collect()
    }

    /// Whether its arcs are measured, not commanded.
    pub(crate) fn measures_arcs(&self) -> bool {
        self.arcs.as_ref().is_some_and(|arcs| arcs.signal != Signal::Events && arcs.is_exact())
    }

    /// The values of a quantity, if the log has it.
    pub(crate) fn column(&self, quantity: Quantity) -> Option<&'a [f32]> {
        self.source.column(quantity)
    }
}
