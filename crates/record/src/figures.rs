//! What was measured during a pass.

use crate::aligned::Aligned;
use crate::arc::Span;
use crate::planned::PlannedPass;
use crate::quantity::Quantity;
use crate::settings::Settings;
use crate::welded::Welded;

/// Figures of a quantity over the time that the arc burned steadily.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Measured {
    /// Mean.
    pub mean: f64,
    /// Least value.
    pub min: f64,
    /// Greatest value.
    pub max: f64,
    /// Standard deviation.
    pub deviation: f64,
    /// Number of values.
    pub values: usize,
}

impl Measured {
    /// The figures of some values; `None` without any.
    pub fn of(values: impl Iterator<Item = f64>) -> Option<Self> {
        // Welford 1962: one pass, no loss of digits.
        let (mut count, mut mean, mut squares) = (0_usize, 0.0, 0.0);
        let (mut min, mut max) = (f64::INFINITY, f64::NEG_INFINITY);
        for value in values.filter(|value| value.is_finite()) {
            count += 1;
            let apart = value - mean;
            mean += apart / count as f64;
            squares += apart * (value - mean);
            (min, max) = (min.min(value), max.max(value));
        }
        let deviation = (squares / count.max(1) as f64).sqrt();
        (count > 0).then_some(Self { mean, min, max, deviation, values: count })
    }
}

/// The stretches of a pass during which the arc burned steadily.
pub(crate) fn steady(welded: &Welded, settings: &Settings) -> Vec<Span> {
    let settle = settings.settle;
    let trimmed = |arc: &Span| {
        // Of a short arc, its middle third.
        let off = settle.min(arc.seconds() / 3.0);
        let start = (arc.start + off).max(welded.span.start);
        let end = (arc.end - off).min(welded.span.end);
        (end > start).then(|| Span::new(start, end))
    };
    welded.burning.iter().filter_map(trimmed).collect()
}

/// The values of a quantity in these stretches: time, s, and value, from the first log that has any.
pub(crate) fn values(logs: &[Aligned<'_>], quantity: Quantity, stretches: &[Span]) -> Vec<[f64; 2]> {
    let of_log = |log: &Aligned<'_>| -> Option<Vec<[f64; 2]>> {
        let column = log.column(quantity)?;
        let rows = stretches.iter().flat_map(|span| log.rows(span.start, span.end));
        let value = |row: usize| (!column[row].is_nan()).then(|| [log.time(row), f64::from(column[row])]);
        let values: Vec<[f64; 2]> = rows.filter_map(value).collect();
        (!values.is_empty()).then_some(values)
    };
    logs.iter().find_map(of_log).unwrap_or_default()
}

/// Mean power of the arc in these stretches, W: of products where one log has both, or else the product of the means.
pub(crate) fn power(logs: &[Aligned<'_>], stretches: &[Span]) -> Option<f64> {
    let of_log = |log: &Aligned<'_>| {
        let (current, voltage) = (log.column(Quantity::Current)?, log.column(Quantity::Voltage)?);
        let rows = stretches.iter().flat_map(|span| log.rows(span.start, span.end));
        Measured::of(rows.map(|row| f64::from(current[row]) * f64::from(voltage[row]))).map(|power| power.mean)
    };
    let mean = |quantity| Measured::of(values(logs, quantity, stretches).into_iter().map(|[_, value]| value));
    let of_means = || Some(mean(Quantity::Current)?.mean * mean(Quantity::Voltage)?.mean);
    logs.iter().find_map(of_log).or_else(of_means)
}

/// Temperatures from the first to the second time before a pass count, s: later ones may be of the arc already.
const BEFORE: [f64; 2] = [5.0, 0.5];

/// Temperature just before a pass, and the greatest during it, °C.
pub(crate) fn temperatures(logs: &[Aligned<'_>], welded: &Welded) -> [Option<f64>; 2] {
    let Span { start, end, .. } = welded.span;
    let before = values(logs, Quantity::Temperature, &[Span::new(start - BEFORE[0], start - BEFORE[1])]);
    let during = values(logs, Quantity::Temperature, &[Span::new(start, end)]);
    let peak = Measured::of(during.into_iter().map(|[_, value]| value)).map(|measured| measured.max);
    [before.last().map(|[_, value]| *value), peak]
}

/// A stretch during which a quantity was out of its window.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Outside {
    pub(crate) from: f64,
    pub(crate) to: f64,
    /// Measured and planned value where they differ most.
    pub(crate) worst: [f64; 2],
}

/// The stretches in which a quantity is out of its window of ± `percent`; `values` are times and values of one pass.
pub(crate) fn outside(
    values: &[[f64; 2]],
    pass: &PlannedPass,
    welded: &Welded,
    (quantity, percent): (Quantity, f64),
    settings: &Settings,
) -> Vec<Outside> {
    let compared = values.iter().filter_map(|[time, value]| {
        let planned = pass.value(quantity, welded.planned_time(*time)).filter(|planned| *planned > 0.0)?;
        Some([*time, *value, planned])
    });
    let compared: Vec<[f64; 3]> = compared.collect();
    let mut found: Vec<Outside> = Vec::new();
    let (mut first, mut after) = (0, 0);
    let mut sums = [0.0, 0.0];
    for &[time, ..] in &compared {
        // The mean over `least` around this row.
        while let Some([_, value, planned]) = compared.get(after).filter(|row| row[0] <= time + settings.least / 2.0) {
            sums = [sums[0] + value, sums[1] + planned];
            after += 1;
        }
        while compared[first][0] < time - settings.least / 2.0 {
            sums = [sums[0] - compared[first][1], sums[1] - compared[first][2]];
            first += 1;
        }
        let worst = sums.map(|sum| sum / (after - first).max(1) as f64);
        if (worst[0] / worst[1] - 1.0).abs() <= percent / 100.0 {
            continue;
        }
        match found.last_mut() {
            Some(last) if time - last.to <= settings.least => {
                last.to = time;
                if (worst[0] / worst[1] - 1.0).abs() > (last.worst[0] / last.worst[1] - 1.0).abs() {
                    last.worst = worst;
                }
            }
            _ => found.push(Outside { from: time, to: time, worst }),
        }
    }
    found.retain(|stretch| stretch.to - stretch.from >= settings.least);
    found
}
