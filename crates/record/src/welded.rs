//! Which arcs belong to which planned pass, and where the torch was meanwhile.

use crate::aligned::Aligned;
use crate::arc::{Signal, Span};
use crate::planned::PlannedPass;
use crate::sequence::{self, Rules, offset};
use crate::source::{Source, What};
use std::collections::HashMap;
use std::ops::Range;

/// A planned pass as it was welded; times are those of the reference, s.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Welded {
    /// Index of the planned pass.
    pub(crate) planned: usize,
    /// From the beginning of its first arc to the end of its last.
    pub(crate) span: Span,
    /// Time, and the planned time of the place where the torch was; both increase.
    pub(crate) knots: Vec<[f64; 2]>,
    /// Stretches during which the arc burned.
    pub(crate) burning: Vec<Span>,
    /// Stretches of which no log says whether it burned.
    pub(crate) unseen: Vec<Span>,
    /// Earlier beginnings of the same pass, given up.
    pub(crate) tries: usize,
    /// When the arc of the pass that was welded before went out.
    pub(crate) after: Option<f64>,
}

/// All passes that were welded, in order, and arcs that belong to none.
pub(crate) struct Welding {
    pub(crate) passes: Vec<Welded>,
    pub(crate) extra: Vec<Span>,
    /// Stretches of which no log says whether the arc burned.
    pub(crate) unseen: Vec<Span>,
    /// Arcs in all.
    pub(crate) arcs: usize,
}

/// The robot takes as long as planned within this, s and fraction, unless it stops.
const PACE: (f64, f64) = (0.7, 0.05);

/// Ends of commanded and of measured arcs differ by up to this, s.
const LAG: f64 = 0.5;

impl Welding {
    /// Finds the planned pass of each arc; `reference` is the log with the events, or that which saw most arcs.
    pub(crate) fn of(planned: &[PlannedPass], logs: &[Aligned<'_>], reference: usize) -> Self {
        let (burning, unseen) = burning(logs);
        let leader = &logs[reference];
        let commanded = leader.arcs.as_ref().is_some_and(|arcs| arcs.signal == Signal::Events);
        let measured = logs.iter().any(Aligned::measures_arcs);
        let spans = if commanded || !measured { leader.spans() } else { burning.clone() };
        let labels = if commanded { labels(leader.source, leader, planned) } else { None };
        let of_pass = match &labels {
            Some(labels) => labelled(labels),
            None => by_times(planned, &spans),
        };
        let of_pass = of_pass
            .into_iter()
            .flat_map(|(index, seen)| tries(&planned[index], &spans, seen).into_iter().map(move |seen| (index, seen)));
        let mut passes: Vec<Welded> = Vec::new();
        let mut taken = vec![false; spans.len()];
        for (index, seen) in of_pass {
            seen.clone().for_each(|at| taken[at] = true);
            let near = passes.last().map(|last: &Welded| last.knots[0][0] - last.knots[0][1]);
            let tries = passes.last().filter(|last| last.planned == index).map(|last| last.tries + 1);
            if tries.is_some() {
                passes.pop();
            }
            let welded = Welded::new(index, &planned[index], &spans[seen], near);
            let after = passes.last().map(|last| last.span.end);
            passes.push(Welded { tries: tries.unwrap_or_default(), after, ..welded });
        }
        let arcs = if measured { &burning } else { &spans };
        for pass in &mut passes {
            pass.sees(arcs, if measured { &unseen } else { &[] });
        }
        let extra = spans.iter().zip(&taken).filter(|(_, taken)| !**taken).map(|(span, _)| *span).collect();
        Self { passes, extra, unseen: if measured { unseen } else { Vec::new() }, arcs: spans.len() }
    }
}

/// When the arc burned by all logs that measure it, the best first, and when none has rows.
fn burning(logs: &[Aligned<'_>]) -> (Vec<Span>, Vec<Span>) {
    let mut order: Vec<&Aligned<'_>> = logs.iter().filter(|log| log.measures_arcs()).collect();
    order.sort_by_key(|log| log.arcs.as_ref().map(|arcs| (arcs.signal, std::cmp::Reverse(arcs.known()))));
    let (mut spans, mut covered): (Vec<Span>, Vec<Span>) = (Vec::new(), Vec::new());
    for log in order {
        let free = gaps(&covered);
        spans.extend(log.spans().iter().flat_map(|span| clipped(span, &free)));
        covered.extend(log.covers().iter().flat_map(|cover| clipped(cover, &free)).collect::<Vec<_>>());
        covered.sort_by(|a, b| a.start.total_cmp(&b.start));
    }
    spans.sort_by(|a, b| a.start.total_cmp(&b.start));
    (joined(spans), gaps(&covered))
}

/// Arcs that two logs saw one after the other without a break.
fn joined(spans: Vec<Span>) -> Vec<Span> {
    let mut all: Vec<Span> = Vec::with_capacity(spans.len());
    for span in spans {
        match all.last_mut() {
            Some(last) if !last.end_known && !span.start_known && span.start - last.end < LAG => {
                (last.end, last.end_known) = (span.end, span.end_known);
            }
            _ => all.push(span),
        }
    }
    all
}

/// What lies between these stretches, before and after them.
fn gaps(covered: &[Span]) -> Vec<Span> {
    let mut from = f64::NEG_INFINITY;
    let mut free = Vec::new();
    for span in covered {
        if span.start > from {
            free.push(Span::new(from, span.start));
        }
        from = from.max(span.end);
    }
    free.push(Span::new(from, f64::INFINITY));
    free
}

/// The parts of a span in these stretches.
fn clipped<'a>(span: &'a Span, free: &'a [Span]) -> impl Iterator<Item = Span> + 'a {
    let first = free.partition_point(|free| free.end <= span.start);
    free[first..].iter().take_while(|free| free.start < span.end).map(|free| Span {
        start: span.start.max(free.start),
        end: span.end.min(free.end),
        start_known: span.start_known && span.start >= free.start,
        end_known: span.end_known && span.end <= free.end,
    })
}

/// The planned pass of each commanded arc by the layer and pass that the controller names; `None` if it names none.
fn labels(source: &Source, log: &Aligned<'_>, planned: &[PlannedPass]) -> Option<Vec<Option<usize>>> {
    let index: HashMap<(usize, usize), usize> =
        planned.iter().enumerate().map(|(index, pass)| ((pass.layer, pass.pass), index)).collect();
    let rows = &log.arcs.as_ref()?.rows;
    let label = |first: usize| {
        let before = source
            .events
            .range(..=first)
            .rev()
            .take_while(|(row, event)| **row == first || event.what != What::PassEnd);
        before.filter_map(|(_, event)| event.pass).next().and_then(|pass| index.get(&pass).copied())
    };
    let labels: Vec<Option<usize>> = rows.iter().map(|rows| label(rows.start)).collect();
    let named = labels.iter().flatten().count();
    (2 * named > labels.len()).then_some(labels)
}

/// Arcs by their labels.
fn labelled(labels: &[Option<usize>]) -> Vec<(usize, Range<usize>)> {
    let (mut found, mut begin) = (Vec::new(), 0);
    for run in labels.chunk_by(|a, b| a == b) {
        found.extend(run[0].map(|index| (index, begin..begin + run.len())));
        begin += run.len();
    }
    found
}

/// The arcs of a pass: all together, or each as a try of its own where only the last one is as long as the pass.
fn tries(pass: &PlannedPass, spans: &[Span], seen: Range<usize>) -> Vec<Range<usize>> {
    let own = &spans[seen.clone()];
    let (first, last) = (&own[0], &own[own.len() - 1]);
    let together = as_planned(pass, last.end - first.start) || as_planned(pass, own.iter().map(Span::seconds).sum());
    if together || !as_planned(pass, last.seconds()) { vec![seen] } else { seen.map(|at| at..at + 1).collect() }
}

/// Whether a pass may take so long, s.
fn as_planned(pass: &PlannedPass, seconds: f64) -> bool {
    let length = pass.seconds();
    (seconds - length).abs() <= PACE.0 + PACE.1 * length
}

/// The planned pass of each arc by lengths and times alone.
fn by_times(planned: &[PlannedPass], spans: &[Span]) -> Vec<(usize, Range<usize>)> {
    let expected: Vec<Span> = planned.iter().map(|pass| Span::new(pass.struck, pass.out)).collect();
    let rules = Rules { length: (0.4, 0.04), offset: (1.0, 0.1), missing: 0.3, extra: 0.6, about: None };
    sequence::pairs(&expected, spans, &rules).into_iter().map(|pair| (pair.expected, pair.seen)).collect()
}

impl Welded {
    /// A pass for which these arcs were seen; `near` is how much later than planned the pass before was, s.
    fn new(index: usize, pass: &PlannedPass, seen: &[Span], near: Option<f64>) -> Self {
        let (first, last) = (seen[0], seen[seen.len() - 1]);
        let span = Span { end: last.end, end_known: last.end_known, ..first };
        let knots = knots(pass, seen, near);
        Self { planned: index, span, knots, burning: Vec::new(), unseen: Vec::new(), tries: 0, after: None }
    }

    /// Takes the arcs that burned during the pass, and what no log says of it.
    fn sees(&mut self, arcs: &[Span], unseen: &[Span]) {
        let own = Span::new(self.span.start - LAG, self.span.end + LAG);
        let first = arcs.partition_point(|arc| arc.end <= own.start);
        let during = arcs[first..].iter().take_while(|arc| arc.start < own.end);
        // An arc of the pass before or after may reach into the tolerance.
        self.burning = during.filter(|arc| arc.shared(&self.span) > 0.5 * arc.seconds().min(LAG)).copied().collect();
        self.unseen = clipped(&self.span, unseen).collect();
    }

    /// The planned time of the place where the torch was.
    pub(crate) fn planned_time(&self, time: f64) -> f64 {
        let next = self.knots.partition_point(|knot| knot[0] <= time).clamp(1, self.knots.len() - 1);
        let [[t0, p0], [t1, p1]] = [self.knots[next - 1], self.knots[next]];
        if t1 > t0 { p0 + (p1 - p0) * ((time - t0) / (t1 - t0)).clamp(0.0, 1.0) } else { p0 }
    }
}

/// Times and planned times of the places where the torch was.
fn knots(pass: &PlannedPass, seen: &[Span], near: Option<f64>) -> Vec<[f64; 2]> {
    let (from, to) = (seen[0].start, seen[seen.len() - 1].end);
    let (begin, end, length) = (pass.struck, pass.out, pass.seconds());
    if as_planned(pass, to - from) {
        return vec![[from, begin], [to, end]];
    }
    // The torch waited while the arc was out.
    let burned: f64 = seen.iter().map(Span::seconds).sum();
    if seen.len() > 1 && as_planned(pass, burned) {
        let mut at = begin;
        let ends = seen.iter().flat_map(|arc| {
            let before = at;
            at = (at + arc.seconds() / burned * length).min(end);
            [[arc.start, before], [arc.end, at]]
        });
        return ends.collect();
    }
    // Cut short or drawn out: whichever end comes as late as the pass before.
    let late = offset(&Span::new(begin, end), seen);
    let apart = |offset: f64| near.map_or(0.0, |near| (offset - near).abs());
    let by_end = !seen[0].start_known || apart(to - end) + PACE.0 < apart(late);
    if by_end {
        vec![[from, (end - (to - from)).max(begin)], [to, end]]
    } else {
        vec![[from, begin], [to, (begin + to - from).min(end)]]
    }
}
