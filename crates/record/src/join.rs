//! Plan and logs joined.

use crate::aligned::Aligned;
use crate::arc::Span;
use crate::error::RecordError;
use crate::figures::{self, Measured};
use crate::judge;
use crate::planned::{self, PlannedPass};
use crate::quantity::Quantity;
use crate::record::{Log, PassRow, Record};
use crate::settings::Settings;
use crate::source::{Event, Source, What};
use crate::welded::{Welded, Welding};

/// Joins a plan with the logs of its build.
///
/// ```
/// use bead_record::{Place, PlannedPass, Settings, Source, join};
/// use glam::DVec3;
///
/// let place = |x: f64, time: f64| Place { at: DVec3::X * x, time, feed: 8.0, speed: 8.0 };
/// let pass = |number: usize, begin: f64| PlannedPass {
///     layer: 1,
///     pass: number,
///     struck: begin,
///     out: begin + 10.0,
///     path: vec![place(0.0, begin), place(80.0, begin + 10.0)],
///     current: Some(180.0),
///     voltage: None,
///     temperature: None,
/// };
/// let log = "time_s,current_a\n0,0\n5,180\n15,0\n18,180\n28,0\n";
/// let log = Source::read("power.csv", log.as_bytes(), &[])?;
/// let record = join(&[pass(1, 0.0), pass(2, 13.0)], &[log], &Settings::default())?;
/// assert_eq!(record.passes[1].time, Some([18.0, 28.0]));
/// # Ok::<(), bead_record::RecordError>(())
/// ```
///
/// # Errors
/// [`RecordError`] of settings, of the plan, and where no log has anything in common with it.
pub fn join(passes: &[PlannedPass], sources: &[Source], settings: &Settings) -> Result<Record, RecordError> {
    settings.check()?;
    planned::check(passes)?;
    let (logs, reference) = Aligned::all(sources).ok_or(RecordError::NoArcs)?;
    let welding = Welding::of(passes, &logs, reference);
    if welding.passes.is_empty() {
        return Err(RecordError::NothingFits { seen: welding.arcs, planned: passes.len() });
    }
    let mut by_pass: Vec<Option<&Welded>> = vec![None; passes.len()];
    welding.passes.iter().for_each(|welded| by_pass[welded.planned] = Some(welded));
    let rows: Vec<PassRow> =
        (0..passes.len()).map(|index| row(passes, index, by_pass[index], &logs, settings)).collect();
    let mut record = Record { passes: rows, findings: Vec::new(), logs: logs.iter().map(Log::of).collect() };
    notes(&mut record, &welding.passes, &logs);
    record.findings = judge::all(&judge::Case {
        passes,
        welding: &welding,
        by_pass: &by_pass,
        rows: &record.passes,
        logs: &logs,
        known: &record.logs,
        reference,
        settings,
    });
    for finding in &record.findings {
        if let Some(row) = finding.pass.and_then(|pass| record.passes.get_mut(pass)) {
            row.findings += 1;
        }
    }
    Ok(record)
}

fn row(
    passes: &[PlannedPass],
    index: usize,
    welded: Option<&Welded>,
    logs: &[Aligned<'_>],
    settings: &Settings,
) -> PassRow {
    let pass = &passes[index];
    let steady = welded.map(|welded| figures::steady(welded, settings)).unwrap_or_default();
    let quantity = |quantity: Quantity| {
        let values = figures::values(logs, quantity, &steady).into_iter().map(|[_, value]| value);
        (quantity, pass.mean(quantity), Measured::of(values))
    };
    let length = pass.length();
    let power = pass.current.zip(pass.voltage).map(|(current, voltage)| current * voltage);
    let speed = pass.mean(Quantity::Speed).filter(|speed| *speed > 0.0);
    let quantities: Vec<(Quantity, Option<f64>, Option<Measured>)> = Quantity::PLANNED.map(quantity).to_vec();
    // Without a speed in a log, the robot was as much slower as the pass took longer.
    let paced = || welded.zip(speed).map(|(welded, speed)| speed * pass.seconds() / welded.span.seconds().max(1e-9));
    let went = quantities.iter().find_map(|(own, _, measured)| if *own == Quantity::Speed { *measured } else { None });
    let went = went.map(|measured| measured.mean).or_else(paced).filter(|speed| *speed > 0.0);
    let heat = |power: Option<f64>, speed: Option<f64>| Some(settings.efficiency * power? / speed?);
    let [before, peak] = welded.map(|welded| figures::temperatures(logs, welded)).unwrap_or_default();
    let planned_wait = index.checked_sub(1).map(|before| pass.struck - passes[before].out);
    PassRow {
        layer: pass.layer,
        pass: pass.pass,
        length,
        time: welded.map(|welded| [welded.span.start, welded.span.end]),
        seconds: [Some(pass.seconds()), welded.map(|welded| welded.span.seconds())],
        wait: [planned_wait, welded.and_then(|welded| Some(welded.span.start - welded.after?))],
        burned: welded.map_or(0.0, |welded| welded.burning.iter().map(Span::seconds).sum()),
        arcs: welded.map_or(0, |welded| welded.burning.len()),
        tries: welded.map_or(0, |welded| welded.tries),
        heat: [heat(power, speed), heat(figures::power(logs, &steady), went)],
        quantities,
        before: [pass.temperature, before],
        peak,
        height: [None; 2],
        off: None,
        scanned: None,
        notes: Vec::new(),
        findings: 0,
    }
}

/// Events of `beadwright listen`, whose notes are not those of an operator.
const OWN: [&str; 3] = ["resumed", "silent", "unreadable"];

/// Puts each note of an operator to the pass during or before which it was written.
fn notes(record: &mut Record, welded: &[Welded], logs: &[Aligned<'_>]) {
    for log in logs {
        let noted = |event: &Event| {
            let is_own = match &event.what {
                What::Interrupted => true,
                What::Other(word) => OWN.contains(&word.as_str()),
                _ => false,
            };
            !event.note.is_empty() && !is_own
        };
        for (row, event) in log.source.events.iter().filter(|(_, event)| noted(event)) {
            let time = log.time(*row);
            let pass =
                welded.iter().filter(|welded| welded.span.end >= time).min_by(|a, b| a.span.end.total_cmp(&b.span.end));
            if let Some(pass) = pass.or(welded.last()) {
                record.passes[pass.planned].notes.push(event.note.clone());
            }
        }
    }
}
