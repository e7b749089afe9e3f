//! `record.html`: what is doubtful first, then where it lies, the passes in figures, and how the logs were aligned.

use super::{FileHash, Finding, Log, Part, PassRow, Quantity, Scanned, Totals, Trust, heights};
use crate::number::{fixed, hours};
use crate::palette;
use crate::report::plot::{Curve, Plot};
use crate::report::sheet::{Row, Sheet};
use crate::report::sketch::Sketch;
use glam::{DVec2, DVec3};
use planar::Bounds;

/// Findings and passes that the page lists; the table holds all.
const MOST: usize = 500;
/// Points of the paths in a picture.
const MOST_POINTS: usize = 20_000;
/// A place as a picture shows it.
type View = fn(DVec3) -> DVec2;

/// The page; `chain` is the hash that covers all passes.
pub(super) fn page(part: &Part<'_>, chain: String) -> Sheet {
    let mut sheet = Sheet::new(&format!("Record: {}", part.header.part), &lead(part));
    findings(&mut sheet, part);
    pictures(&mut sheet, part);
    plots(&mut sheet, part);
    totals(&mut sheet, part);
    passes(&mut sheet, part);
    scans(&mut sheet, part.scans);
    logs(&mut sheet, &part.record.logs);
    trace(&mut sheet, part, &chain);
    sheet
}

/// What was found, and how much was welded.
pub(super) fn lead(part: &Part<'_>) -> String {
    let rows = &part.record.passes;
    let welded = rows.iter().filter(|row| row.time.is_some()).count();
    let of_part = part.record.findings.iter().filter(|finding| finding.kind.is_of_part()).count();
    let of_logs = part.record.findings.len() - of_part;
    let doubt = match (of_part, of_logs) {
        (0, 0) => "Nothing is doubtful.".to_owned(),
        (0, logs) => format!("No pass is doubtful; {} the logs.", of(logs, "about")),
        (part, 0) => format!("{} the part.", of(part, "about")),
        (part, logs) => format!("{} the part and {} the logs.", of(part, "about"), of(logs, "about")),
    };
    let recorded = Totals::recorded(part);
    format!(
        "{doubt} {welded} of {} planned passes were welded, with {} of arc within {}.",
        rows.len(),
        hours(recorded.arc_hours * 3600.0),
        hours(recorded.hours * 3600.0)
    )
}

fn of(count: usize, word: &str) -> String {
    let noun = if count == 1 { "finding" } else { "findings" };
    format!("{count} {noun} {word}")
}

fn plain(cells: impl IntoIterator<Item = String>) -> Row {
    cells.into_iter().map(|cell| (cell, false)).collect()
}

fn findings(sheet: &mut Sheet, part: &Part<'_>) {
    let all = &part.record.findings;
    if all.is_empty() {
        return;
    }
    sheet.heading("What is doubtful");
    let row = |finding: &Finding| {
        let pass = finding.pass.map(|pass| &part.record.passes[pass]);
        let number = |number: fn(&PassRow) -> usize| pass.map(|pass| number(pass).to_string()).unwrap_or_default();
        plain([
            finding.kind.name().to_owned(),
            number(|row| row.layer),
            number(|row| row.pass),
            finding.sentence.clone(),
        ])
    };
    let rows: Vec<Row> = all.iter().take(MOST).map(row).collect();
    sheet.table(&["kind", "layer", "pass", "what"], &rows);
    if all.len() > MOST {
        sheet.text(&format!("{} more are in record.json.", all.len() - MOST));
    }
}

/// The part from above and from the side, with what is doubtful marked.
fn pictures(sheet: &mut Sheet, part: &Part<'_>) {
    let points: usize = part.planned.iter().map(|pass| pass.path.len()).sum();
    let every = points.div_ceil(MOST_POINTS).max(1);
    let lines: Vec<Vec<DVec3>> =
        part.planned.iter().step_by(every).map(|pass| pass.path.iter().map(|place| place.at).collect()).collect();
    let stretch = |finding: &Finding| {
        let [from, to] = finding.planned?;
        Some(part.planned[finding.pass?].stretch(from, to))
    };
    let marked: Vec<Vec<DVec3>> = part.record.findings.iter().filter_map(stretch).collect();
    sheet.heading("Where it lies");
    // An oblique view: x to the right and back, y to the left and back, z upwards.
    let views: [(&str, View); 2] =
        [("In space", |p| DVec2::new(0.866 * (p.x - p.y), 0.5 * (p.x + p.y) + p.z)), ("From above", |p| p.truncate())];
    let pictures: Vec<(String, String)> = views
        .into_iter()
        .filter_map(|(name, view)| {
            let seen = |lines: &[Vec<DVec3>]| -> Vec<Vec<DVec2>> {
                lines.iter().map(|line| line.iter().map(|p| view(*p)).collect()).collect()
            };
            let (lines, marked) = (seen(&lines), seen(&marked));
            let bounds = Bounds::of(lines.iter().chain(&marked).flatten().copied())?;
            let size = bounds.size().max_element();
            let mut sketch = Sketch::new(bounds, name);
            lines.iter().for_each(|line| _ = sketch.line(line, false, palette::missing(false), size / 600.0));
            marked.iter().for_each(|line| _ = sketch.line(line, false, palette::mark(false), size / 120.0));
            Some((format!("{name}: planned paths, and in orange what is doubtful"), sketch.svg()))
        })
        .collect();
    sheet.svgs(&pictures);
}

/// Measured against planned, pass by pass.
fn plots(sheet: &mut Sheet, part: &Part<'_>) {
    let rows = &part.record.passes;
    let mut plot = |title: &str,
                    unit: &str,
                    planned: &dyn Fn(&PassRow) -> Option<f64>,
                    measured: &dyn Fn(&PassRow) -> Option<f64>| {
        let curve = |name: &str, value: &dyn Fn(&PassRow) -> Option<f64>| {
            let point = |(k, row): (usize, &PassRow)| Some(DVec2::new((k + 1) as f64, value(row)?));
            Curve { name: name.to_owned(), points: rows.iter().enumerate().filter_map(point).collect() }
        };
        let curves = [curve("planned", planned), curve("measured", measured)];
        if curves[1].points.is_empty() {
            return;
        }
        let drawn = Plot {
            title: title.to_owned(),
            x: "pass".to_owned(),
            y: unit.to_owned(),
            curves: curves.into_iter().filter(|curve| !curve.points.is_empty()).collect(),
            ..Plot::default()
        };
        sheet.svg(&drawn.svg());
    };
    for quantity in Quantity::PLANNED {
        let title = format!("Mean {} of each pass", quantity.word());
        plot(&title, quantity.unit(), &|row| row.planned(quantity), &|row| row.measured(quantity).map(|m| m.mean));
    }
    plot("Heat input of each pass", "J/mm", &|row| row.heat[0], &|row| row.heat[1]);
    plot("Temperature before each pass", "°C", &|row| row.before[0], &|row| row.before[1]);
    plot("Height of each pass where it was scanned", "mm", &|row| row.height[0], &|row| row.height[1]);
    plot("Wait before each pass", "s", &|row| row.wait[0], &|row| row.wait[1]);
}

fn totals(sheet: &mut Sheet, part: &Part<'_>) {
    let (planned, recorded) = (Totals::planned(part), Totals::recorded(part));
    let currency = &part.profile.cost.currency;
    let row = |name: &str, value: &dyn Fn(&Totals) -> Option<String>| {
        let cell = |totals| value(totals).unwrap_or_default();
        plain([name.to_owned(), cell(&planned), cell(&recorded)])
    };
    let mut rows = vec![
        row("arc time", &|totals| Some(hours(totals.arc_hours * 3600.0))),
        row("total time", &|totals| Some(hours(totals.hours * 3600.0))),
        row("wire kg", &|totals| totals.wire_kg.map(|kg| fixed(kg, 3))),
        row("gas m³", &|totals| Some(fixed(totals.gas_m3, 3))),
    ];
    if planned.cost.is_some() {
        rows.push(row(&format!("cost {currency}"), &|totals| totals.cost.map(|cost| fixed(cost, 2))));
    }
    if planned.energy_kwh.is_some() || recorded.energy_kwh.is_some() {
        rows.push(row("energy kWh", &|totals| totals.energy_kwh.map(|kwh| fixed(kwh, 2))));
    }
    if planned.co2_kg.is_some() {
        rows.push(row("CO₂e kg", &|totals| totals.co2_kg.map(|kg| fixed(kg, 2))));
    }
    sheet.heading("In all").table(&["", "planned", "recorded"], &rows);
}

fn passes(sheet: &mut Sheet, part: &Part<'_>) {
    let number = |value: Option<f64>, digits: usize| value.map(|value| fixed(value, digits)).unwrap_or_default();
    let scanned = if part.scans.is_empty() { &[][..] } else { &heights::COLUMNS };
    let rows = part.record.passes.iter().take(MOST).map(|row| {
        let mean = |quantity| row.measured(quantity).map(|measured| measured.mean);
        let own = [
            row.layer.to_string(),
            row.pass.to_string(),
            fixed(row.length, 1),
            number(row.wait[1], 1),
            number(row.seconds[0], 1),
            number(row.seconds[1], 1),
            row.arcs.to_string(),
            number(row.planned(Quantity::Feed), 2),
            number(mean(Quantity::Feed), 2),
            number(mean(Quantity::Current), 0),
            number(mean(Quantity::Voltage), 1),
            number(row.heat[1], 0),
            number(row.before[1], 0),
        ];
        let heights = scanned.iter().map(|(.., value, digits)| number(value(row), *digits));
        plain(own.into_iter().chain(heights).chain([row.findings.to_string(), row.notes.join("; ")]))
    });
    let head = [
        "layer",
        "pass",
        "length mm",
        "wait s",
        "planned s",
        "took s",
        "arcs",
        "feed planned m/min",
        "feed m/min",
        "current A",
        "voltage V",
        "heat input J/mm",
        "before °C",
    ];
    let scanned: Vec<String> = scanned.iter().map(|(name, unit, ..)| format!("{name} {unit}")).collect();
    let head: Vec<&str> =
        head.into_iter().chain(scanned.iter().map(String::as_str)).chain(["findings", "notes"]).collect();
    sheet.heading("Passes").table(&head, &rows.collect::<Vec<_>>());
    let all = part.record.passes.len();
    if all > MOST {
        sheet.text(&format!("{} more are in record.parquet and record.json.", all - MOST));
    }
}

/// The scans, and how much of their layers they show.
fn scans(sheet: &mut Sheet, scans: &[Scanned]) {
    if scans.is_empty() {
        return;
    }
    let row = |scan: &Scanned| {
        let [shown, of_layer] = scan.shown.passes;
        let moved = if scan.part_from_scanner.is_some() { "the scanner" } else { "the part" };
        plain([
            scan.file.clone(),
            scan.after_layer.to_string(),
            moved.to_owned(),
            scan.shown.points.to_string(),
            format!("{shown} of {of_layer}"),
            fixed(100.0 * scan.shown.covered, 0),
        ])
    };
    let head = ["scan", "after layer", "coordinates of", "points over the layer", "passes shown", "length shown %"];
    sheet.heading("Scans").table(&head, &scans.iter().map(row).collect::<Vec<_>>());
}

fn logs(sheet: &mut Sheet, logs: &[Log]) {
    let row = |log: &Log| {
        let trust = match log.trust {
            Trust::Reference => "reference",
            Trust::Arcs => "by arcs",
            Trust::Dates => "by its dates",
            Trust::Nothing => "not aligned",
        };
        let aligned = log.trust == Trust::Arcs;
        let shown = |value: String| if aligned { value } else { String::new() };
        plain([
            log.name.clone(),
            log.tally.rows.to_string(),
            log.arcs.to_string(),
            trust.to_owned(),
            shown(log.matched.to_string()),
            shown(fixed(log.offset, 2)),
            shown(fixed(log.drift, 0)),
            shown(fixed(log.within, 3)),
            log.set.len().to_string(),
            log.gaps.len().to_string(),
        ])
    };
    let head =
        ["log", "rows", "arcs", "aligned", "arcs matched", "offset s", "drift 10⁻⁶", "within s", "clock set", "gaps"];
    sheet.heading("Logs").table(&head, &logs.iter().map(row).collect::<Vec<_>>());
    sheet.text("Clocks are those of the reference plus offset and drift; arcs begin and end in both logs within the time given.");
}

fn trace(sheet: &mut Sheet, part: &Part<'_>, chain: &str) {
    sheet.heading("Traceability");
    let own = [
        ("profile", &part.header.profile),
        ("strategy", &part.header.strategy),
        ("gas", &part.profile.process.gas),
        ("wire", &part.profile.wire.material),
    ];
    let given = part.trace.iter().map(|(name, value)| plain([name.replace('_', " "), value.clone()]));
    let rows: Vec<Row> =
        own.iter().map(|(name, value)| plain([(*name).to_owned(), (*value).clone()])).chain(given).collect();
    sheet.table(&["what", "value"], &rows);
    let input = |file: &FileHash| plain([file.name.clone(), file.bytes.to_string(), file.sha256.clone()]);
    sheet.table(&["file read", "bytes", "SHA-256"], &part.inputs.iter().map(input).collect::<Vec<_>>());
    sheet.text(&format!(
        "Hash over all passes: {chain}. record.json holds one for each pass, so that a later change can be found."
    ));
}
