//! What is doubtful about a part and its logs.

use crate::aligned::Aligned;
use crate::arc::Span;
use crate::clock::Trust;
use crate::figures;
use crate::finding::{Finding, Kind, stretch};
use crate::planned::PlannedPass;
use crate::quantity::Quantity;
use crate::record::{Log, PassRow};
use crate::settings::Settings;
use crate::welded::{Welded, Welding};
use jiff::Timestamp;

/// All that is judged.
pub(crate) struct Case<'a> {
    pub(crate) passes: &'a [PlannedPass],
    pub(crate) welding: &'a Welding,
    pub(crate) by_pass: &'a [Option<&'a Welded>],
    pub(crate) rows: &'a [PassRow],
    pub(crate) logs: &'a [Aligned<'a>],
    pub(crate) known: &'a [Log],
    pub(crate) reference: usize,
    pub(crate) settings: &'a Settings,
}

/// Shortest time for which the arc is out that is reported, s.
const OUT: f64 = 0.2;
/// The arc may burn this much later and shorter than it is commanded, s.
const IGNITION: f64 = 0.6;
/// Clocks of good loggers drift by less, in millionths.
const DRIFT: f64 = 100.0;
/// Passes shorter than this, s, are too short for their pace to be judged.
const JUDGED: f64 = 3.0;

/// The findings, the gravest first; those of a kind in the order of welding.
pub(crate) fn all(case: &Case<'_>) -> Vec<Finding> {
    let mut found: Vec<Finding> = (0..case.passes.len()).flat_map(|index| case.of_pass(index)).collect();
    found.extend(case.welding.extra.iter().map(|span| case.extra(span)));
    for log in case.known {
        found.extend(of_log(log, &case.known[case.reference].name, &|time| case.moment(time)));
    }
    found.sort_by_key(|finding| finding.kind);
    found
}

impl Case<'_> {
    fn of_pass(&self, index: usize) -> Vec<Finding> {
        let Some(welded) = self.by_pass[index] else { return vec![self.not_welded(index)] };
        let mut found = self.outages(welded);
        found.extend(self.windows(welded));
        found.extend(self.manner(welded));
        found
    }

    fn not_welded(&self, index: usize) -> Finding {
        let pass = &self.passes[index];
        let whole = [pass.spot(pass.struck), pass.spot(pass.out)];
        let name = self.name(index);
        let unseen = self
            .about(index)
            .is_some_and(|time| self.welding.unseen.iter().any(|gap| gap.start <= time && time <= gap.end));
        let (kind, sentence) = match unseen {
            true => (Kind::NotLogged, format!("{name}: no log has rows of it.")),
            false => (Kind::NotWelded, format!("{name}: no arc burned for it, {:.0} mm long.", pass.length())),
        };
        Finding {
            kind,
            pass: Some(index),
            time: None,
            planned: Some([pass.struck, pass.out]),
            place: Some(whole),
            sentence,
        }
    }

    /// About when the middle of a pass would have been welded, by its neighbours.
    fn about(&self, index: usize) -> Option<f64> {
        let middle = |index: usize| (self.passes[index].struck + self.passes[index].out) / 2.0;
        let before = (0..index).rev().find_map(|index| self.by_pass[index]);
        let after = (index + 1..self.passes.len()).find_map(|index| self.by_pass[index]);
        let ends = |welded: &Welded| (welded.span, &self.passes[welded.planned]);
        match (before.map(ends), after.map(ends)) {
            (Some((own, last)), Some((next, first))) => {
                let part = (middle(index) - last.out) / (first.struck - last.out).max(1e-9);
                Some(own.end + part * (next.start - own.end))
            }
            (Some((own, last)), None) => Some(own.end + middle(index) - last.out),
            (None, Some((next, first))) => Some(next.start - (first.struck - middle(index))),
            (None, None) => None,
        }
    }

    /// Stretches of a pass in which the arc was out, or in which no log says whether it burned.
    fn outages(&self, welded: &Welded) -> Vec<Finding> {
        let pass = &self.passes[welded.planned];
        let mut found = Vec::new();
        // The beginning or end that the arcs do not reach.
        let [first, last] = [welded.knots[0], welded.knots[welded.knots.len() - 1]];
        let mut stretches = vec![[pass.struck, first[1]], [last[1], pass.out]];
        for [from, to] in outs(welded) {
            stretches.push([welded.planned_time(from), welded.planned_time(to)]);
        }
        stretches.retain(|[from, to]| to - from >= OUT);
        if welded.burning.is_empty() && welded.unseen.is_empty() {
            stretches = vec![[pass.struck, pass.out]];
        }
        for planned in stretches {
            let place = planned.map(|time| pass.spot(time));
            if place[1].along - place[0].along <= 0.0 && pass.length() > 0.0 {
                continue;
            }
            let sentence = format!("{}: the arc was out {}.", self.name(welded.planned), stretch(&place));
            found.push(self.finding(Kind::ArcLost, welded, None, Some(planned), sentence));
        }
        for gap in welded.unseen.iter().filter(|gap| gap.seconds() >= OUT) {
            let planned = [gap.start, gap.end].map(|time| welded.planned_time(time));
            let place = planned.map(|time| pass.spot(time));
            let sentence = format!("{}: no log has rows {}.", self.name(welded.planned), stretch(&place));
            found.push(self.finding(Kind::NotLogged, welded, Some([gap.start, gap.end]), Some(planned), sentence));
        }
        found
    }

    fn windows(&self, welded: &Welded) -> Vec<Finding> {
        let (pass, steady) = (&self.passes[welded.planned], figures::steady(welded, self.settings));
        let mut found = Vec::new();
        for &(quantity, percent) in &self.settings.windows {
            let values = figures::values(self.logs, quantity, &steady);
            for outside in figures::outside(&values, pass, welded, (quantity, percent), self.settings) {
                let time = [outside.from, outside.to];
                let planned = time.map(|time| welded.planned_time(time));
                let ([measured, wanted], unit) = (outside.worst, quantity.unit());
                let sentence = format!(
                    "{}: the {} reached {measured:.1} {unit} where {wanted:.1} {unit} was planned ({:+.0} %), {}.",
                    self.name(welded.planned),
                    quantity.word(),
                    100.0 * (measured / wanted - 1.0),
                    stretch(&planned.map(|time| pass.spot(time)))
                );
                found.push(self.finding(Kind::OutOfWindow(quantity), welded, Some(time), Some(planned), sentence));
            }
        }
        found
    }

    /// How the pass began and went on.
    fn manner(&self, welded: &Welded) -> Vec<Finding> {
        let (pass, row, name) = (&self.passes[welded.planned], &self.rows[welded.planned], self.name(welded.planned));
        let mut found = Vec::new();
        let mut say = |kind, sentence| found.push(self.finding(kind, welded, row.time, None, sentence));
        if let (Some(hottest), Some(before)) = (self.settings.hottest, row.before[1])
            && before > hottest
        {
            say(Kind::TooHot, format!("{name}: it began on metal of {before:.0} °C; {hottest:.0} °C is allowed."));
        }
        let within = |[from, to]: &[f64; 2]| *from > welded.span.start && *to < welded.span.end;
        let struck = if welded.burning.len() > 1 { outs(welded).iter().filter(|out| within(out)).count() } else { 0 };
        if struck > 0 {
            say(Kind::StruckAgain, format!("{name}: the arc was struck again {}.", times(struck)));
        }
        if welded.tries > 0 {
            say(Kind::Repeated, format!("{name}: it was begun {} before and given up.", times(welded.tries)));
        }
        let [wanted, went] = [pass.seconds(), welded.span.seconds()];
        let limit = self
            .settings
            .windows
            .iter()
            .find(|(quantity, _)| *quantity == Quantity::Speed)
            .map(|(_, percent)| percent / 100.0);
        let whole = welded.burning.len() == 1 && welded.span.start_known && welded.span.end_known && wanted >= JUDGED;
        let reached = welded.knots.first().zip(welded.knots.last()).is_some_and(|(a, b)| b[1] - a[1] >= 0.99 * wanted);
        if limit.is_some_and(|limit| whole && reached && (went / wanted - 1.0).abs() > limit) {
            say(Kind::Pace, format!("{name}: it took {went:.1} s where {wanted:.1} s was planned."));
        }
        if let [Some(planned), Some(waited)] = row.wait
            && waited - planned >= self.settings.stop
        {
            say(
                Kind::Stop,
                format!("{name}: the build stood still for {waited:.0} s before it; {planned:.0} s was planned."),
            );
        }
        found
    }

    fn extra(&self, span: &Span) -> Finding {
        let before = self.welding.passes.iter().rev().find(|welded| welded.span.start <= span.start);
        let place = before.map_or("before the first pass".to_owned(), |welded| {
            format!("after {}", small(&self.name(welded.planned)))
        });
        let sentence = format!(
            "An arc of {:.1} s at {} belongs to no planned pass; it burned {place}.",
            span.seconds(),
            self.moment(span.start)
        );
        Finding {
            kind: Kind::Extra,
            pass: None,
            time: Some([span.start, span.end]),
            planned: None,
            place: None,
            sentence,
        }
    }

    fn finding(
        &self,
        kind: Kind,
        welded: &Welded,
        time: Option<[f64; 2]>,
        planned: Option<[f64; 2]>,
        sentence: String,
    ) -> Finding {
        let pass = &self.passes[welded.planned];
        let place = planned.map(|planned| planned.map(|time| pass.spot(time)));
        Finding { kind, pass: Some(welded.planned), time, planned, place, sentence }
    }

    fn name(&self, index: usize) -> String {
        let pass = &self.passes[index];
        format!("Layer {}, pass {}", pass.layer, pass.pass)
    }

    /// A time of the reference, for people.
    fn moment(&self, time: f64) -> String {
        let dated = self.logs[self.reference].source.dated;
        let instant = dated.then(|| Timestamp::from_millisecond((time * 1e3).round() as i64).ok()).flatten();
        instant.map_or_else(|| format!("{time:.1} s"), |instant| instant.to_string())
    }
}

/// When the arc was out between the beginning and the end of a pass, though logs have rows of it.
fn outs(welded: &Welded) -> Vec<[f64; 2]> {
    let mut outs = Vec::new();
    let mut since = welded.span.start;
    let unseen = welded.unseen.iter().map(|gap| (*gap, false));
    let mut known: Vec<(Span, bool)> = welded.burning.iter().map(|arc| (*arc, true)).chain(unseen).collect();
    known.sort_by(|a, b| a.0.start.total_cmp(&b.0.start));
    for (span, _) in &known {
        outs.push([since, span.start]);
        since = since.max(span.end);
    }
    outs.push([since, welded.span.end]);
    let (first, last) = (welded.span.start, welded.span.end);
    // Arcs are struck a little later than they are commanded.
    outs.retain(|[from, to]| to - from >= if *from <= first || *to >= last { IGNITION } else { OUT });
    outs
}

fn times(count: usize) -> String {
    match count {
        1 => "once".to_owned(),
        2 => "twice".to_owned(),
        count => format!("{count} times"),
    }
}

fn small(name: &str) -> String {
    name.replacen('L', "l", 1)
}

/// What is doubtful about a log.
fn of_log(log: &Log, reference: &str, moment: &dyn Fn(f64) -> String) -> Vec<Finding> {
    let (name, mut found) = (&log.name, Vec::new());
    let mut say =
        |kind, time, sentence| found.push(Finding { kind, pass: None, time, planned: None, place: None, sentence });
    for &[from, to] in &log.gaps {
        say(
            Kind::Gap,
            Some([from, to]),
            format!("{name}: rows of {:.1} s are missing from {} on.", to - from, moment(from)),
        );
    }
    for (at, note) in &log.interruptions {
        let note = if note.is_empty() { "The connection was lost." } else { note };
        say(Kind::Interrupted, Some([*at, *at]), format!("{name}: interrupted at {}. {note}", moment(*at)));
    }
    for &[at, step] in &log.set {
        let (way, step) = (if step < 0.0 { "back" } else { "forward" }, step.abs());
        say(
            Kind::ClockSet,
            Some([at, at]),
            format!("{name}: against {reference}, its clock was set {way} by {step:.1} s at {}.", moment(at)),
        );
    }
    if log.drift.abs() >= DRIFT {
        let way = if log.drift > 0.0 { "slow" } else { "fast" };
        say(
            Kind::ClockDrift,
            None,
            format!(
                "{name}: its clock runs {way} by {:.0} millionths ({:.2} s an hour) against {reference}.",
                log.drift.abs(),
                log.drift.abs() * 3.6e-3
            ),
        );
    }
    let unaligned = match log.trust {
        Trust::Dates => Some("its clock is taken as it is, since its arcs were not recognised"),
        Trust::Nothing => {
            Some("its clock could not be aligned; it was put where it begins together with the reference")
        }
        Trust::Reference | Trust::Arcs => None,
    };
    if let Some(reason) = unaligned {
        say(Kind::ClockUnknown, None, format!("{name}: {reason}."));
    }
    let tally = log.tally;
    let counts = [(tally.broken, "cannot be read"), (tally.doubled, "are doubled"), (tally.late, "came late")];
    let faults: Vec<String> =
        counts.iter().filter(|(count, _)| *count > 0).map(|(count, what)| format!("{count} {what}")).collect();
    if !faults.is_empty() {
        say(Kind::Rows, None, format!("{name}: of {} rows, {}.", tally.rows, faults.join(", ")));
    }
    found
}
