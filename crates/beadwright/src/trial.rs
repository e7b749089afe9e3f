//! Trial beads: the files of each plate, and the page that shows what lies where.
//!
//! [`bead_plan::trial`] chooses and places the trials.

pub use bead_plan::trial::*;

use crate::bead::library::Estimate;
use crate::dialect::{Chunk, DialectError};
use crate::files::{PlanFiles, Programs, Selection};
use crate::layer::Extent;
use crate::metrics::Metrics;
use crate::model::RepairReport;
use crate::number::fixed;
use crate::plan::{Header, Summary};
use crate::process::Process;
use crate::profile::Profile;
use crate::program::{LayerWeave, Weave};
use crate::report::sheet::{Row, Sheet};
use crate::warning::Warnings;
use std::fmt::Write;

/// What the trials of a profile vary.
pub fn nominal(profile: &Profile) -> Nominal {
    Nominal {
        process: profile.process.clone(),
        ends: profile.start_stop.clone(),
        amplitude: profile.weave.as_ref().map(|weave| weave.amplitude),
        width: profile.bead.width,
        height: profile.layers.height,
    }
}

/// The plan of one plate: its layers, and the profile that welds them.
pub struct PlatePlan {
    /// Name of the plate, for files and programs.
    pub name: String,
    /// The profile with a row of `process.layers`, `start_stop.layers` and `weave.layers` for each trial that differs in them.
    pub profile: Profile,
    layers: Vec<crate::layer::Layer>,
}

impl PlatePlan {
    /// The plan of plate `index`, from 0.
    pub fn new(series: &Series, index: usize, profile: &Profile) -> Self {
        let (layers, spans) = series.layers(index);
        let mut profile = profile.clone();
        (profile.process.layers, profile.start_stop.layers) = (series.processes(&spans), series.ends(&spans));
        // Rows hold for single layers, and no trial is a helix.
        profile.wall.helix = false;
        if let Some(weave) = &mut profile.weave {
            weave.layers = spans.iter().filter_map(|span| row_of_weave(series, span)).collect();
        }
        Self { name: Self::name(index), profile, layers }
    }

    /// Name of plate `index`, from 0.
    pub fn name(index: usize) -> String {
        format!("trial_{}", index + 1)
    }

    /// Totals: arc time, wire, starts.
    pub fn metrics(&self) -> Metrics {
        let mut metrics = Metrics::new(&self.profile);
        self.layers.iter().for_each(|layer| metrics.add(layer));
        metrics
    }

    /// All files of the plate: programs, plan.json, metrics.json, report.html.
    ///
    /// # Errors
    /// [`DialectError`] of a post that cannot write the plate, such as one that cannot change the wire feed.
    pub fn files(&self, programs: Programs) -> Result<Vec<Chunk>, DialectError> {
        let header = Header {
            part: self.name.clone(),
            profile: self.profile.name.clone(),
            strategy: "trial".to_owned(),
            extent: Extent::of(&self.layers),
        };
        let (mut files, mut chunks) = PlanFiles::begin(&header, &self.profile, programs, Selection::default())?;
        self.layers.iter().for_each(|layer| chunks.extend(files.layer(layer, None)));
        let (metrics, forbidden) = (self.metrics(), self.profile.forbidden());
        let (warnings, notes) = (Warnings::default(), files.notes());
        let summary = Summary { metrics, warnings, notes, forbidden, blocked: Vec::new(), grown: None };
        chunks.extend(files.end(&summary, &RepairReport::default(), None)?);
        Ok(chunks)
    }
}

/// How a trial weaves, if that is varied.
fn row_of_weave(series: &Series, &Span { from, to, trial }: &Span<'_>) -> Option<LayerWeave> {
    let value = |parameter| series.value(&trial.values, parameter);
    let usual = LayerWeave { from, to, ..LayerWeave::default() };
    let row = LayerWeave {
        length: value(Parameter::WeaveLength),
        amplitude: value(Parameter::WeaveAmplitude),
        dwell: value(Parameter::WeaveDwell),
        file: value(Parameter::WeaveFile).map(|file| file as u32),
        ..usual.clone()
    };
    (row != usual).then_some(row)
}

/// A value of a profile that trials show.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Lesson {
    /// Its key.
    pub key: &'static str,
    /// The value of the profile.
    pub before: f64,
    /// What the trials say; settings that were chosen have no interval.
    pub after: f64,
    /// Half the width of the interval in which the next bead is expected with 95 % probability; `None` for settings.
    pub plus_minus: Option<f64>,
}

/// What trials say of a profile.
#[derive(Debug, Clone, PartialEq, Default, serde::Serialize)]
pub struct Learnt {
    /// Values for the profile.
    pub lessons: Vec<Lesson>,
    /// What no value can express, as sentences.
    pub notes: Vec<String>,
}

/// What trials of starts and ends say of a profile: the settings with which hump and crater are least, and the keys with which the
/// deposit model lays what is left of them. Hot start and lead-out change the metal there, so that their part is taken off.
///
/// # Errors
/// [`FoundError`] if the profile's process lies outside what was tried.
pub fn ends_learnt(found: &Found, profile: &Profile) -> Result<Learnt, FoundError> {
    let nominal = nominal(profile);
    let best = found.best(|parameter| set(&profile.process, profile.weave.as_ref(), parameter))?;
    let mut ends = profile.start_stop.clone();
    let Learnt { mut lessons, mut notes } = Learnt::default();
    // What the trials have in common is a part of what was measured.
    let held = found.held.iter().copied().filter(|(own, value)| nominal.end(*own) != Some(*value));
    for (parameter, value) in held.chain(best.settings) {
        let (Some(key), Some(before)) = (parameter.key(), nominal.end(parameter)) else { continue };
        match parameter {
            Parameter::LeadInLength => ends.lead_in_length = value,
            Parameter::LeadInPower => ends.lead_in_power = value,
            Parameter::LeadOutLength => ends.lead_out_length = value,
            Parameter::LeadOutPower => ends.lead_out_power = value,
            _ => {}
        }
        lessons.push(Lesson { key, before, after: value, plus_minus: None });
    }
    let ([hump, crater], [hump_length, crater_length]) = (best.left, found.lengths);
    let (height, own) = (profile.bead.height, &profile.start_stop);
    let known = [
        ("start_stop.hump_height", own.hump_height, Some((ends.hump_of(hump.value, height), hump.plus_minus))),
        ("start_stop.hump_length", own.hump_length, hump_length.map(|length| (length.value, length.plus_minus))),
        ("start_stop.crater_depth", own.crater_depth, Some((ends.crater_of(crater.value, height), crater.plus_minus))),
        ("start_stop.crater_length", own.crater_length, crater_length.map(|length| (length.value, length.plus_minus))),
    ];
    for (key, before, after) in known {
        let Some((value, within)) = after else { continue };
        if value < -within {
            notes
                .push(format!("{key} is taken as 0: {value:.2} mm would fit, and the deposit model has none below 0."));
        }
        lessons.push(Lesson { key, before, after: value.max(0.0), plus_minus: Some(within) });
    }
    Ok(Learnt { lessons, notes })
}

/// The value that a profile has for what trials of ends and overlaps vary besides.
fn set(process: &Process, weave: Option<&Weave>, parameter: Parameter) -> Option<f64> {
    match parameter {
        Parameter::DepositionSpeed => Some(process.deposition_speed),
        Parameter::WireFeedSpeed => Some(process.wire_feed_speed),
        Parameter::WeaveLength => weave.map(|weave| weave.length),
        Parameter::WeaveAmplitude => weave.map(|weave| weave.amplitude),
        Parameter::WeaveDwell => weave.map(|weave| weave.dwell),
        _ => None,
    }
}

/// Depth of the valleys that may remain between beads, as a fraction of their height, if nothing else is said.
const VALLEY: f64 = 0.1;

/// What trials of beads side by side say of a profile: the widest stepover whose valleys are at most `deepest` mm deep; if left out, a
/// tenth of the bead's height. It belongs into `fill.stepover`, with `fill.overlap = "free"`.
///
/// # Errors
/// [`FoundError`] if the profile's process lies outside what was tried, or all valleys are deeper.
pub fn stepover_learnt(found: &Found, profile: &Profile, deepest: Option<f64>) -> Result<Learnt, FoundError> {
    let deepest = deepest.unwrap_or(VALLEY * profile.bead.height);
    let widest = found.widest(deepest, |parameter| set(&profile.process, profile.weave.as_ref(), parameter))?;
    let after = widest.stepover * profile.bead.width;
    let Estimate { value, plus_minus } = widest.valley;
    let mut notes = vec![format!(
        "valleys of {:.2} ± {plus_minus:.2} mm remain, and {deepest:.2} mm are allowed; the beads are {:.2} ± {:.2} mm high.",
        value.max(0.0),
        widest.height.value,
        widest.height.plus_minus,
    )];
    if widest.is_last {
        notes.push("no wider stepover was tried: wider ones may do as well.".to_owned());
    }
    let (rise, height) = (profile.bead().rise(after), profile.layers.height);
    notes.push(format!(
        "at this stepover the metal of a bead raises a layer by {rise:.2} mm; layers.height is {height:.2} mm."
    ));
    Ok(Learnt {
        lessons: vec![Lesson { key: "fill.stepover", before: profile.stepover(), after, plus_minus: None }],
        notes,
    })
}

/// The page for the bench: a map of each plate and its trials.
pub fn page(title: &str, series: &Series, plate: Plate) -> Sheet {
    let lead = "Each trial is numbered in the order of welding. Fill in sheet.csv, and fit it as it is.";
    let mut sheet = Sheet::new(title, lead);
    let parameters: Vec<String> = series
        .factors
        .iter()
        .map(|factor| format!("{} {}", factor.parameter.name().replace('_', " "), factor.parameter.unit()))
        .collect();
    let measured =
        series.shape.measured().iter().map(|column| column.trim_end_matches("_mm").replace('_', " ") + " mm");
    let head: Vec<String> =
        ["number", "block"].map(str::to_owned).into_iter().chain(parameters).chain(measured).collect();
    let head: Vec<&str> = head.iter().map(String::as_str).collect();
    for index in 0..series.plates() {
        let own: Vec<&Placed> = series.trials.iter().filter(|trial| trial.plate == index).collect();
        sheet.heading(&format!("Plate {}", index + 1)).svg(&map(&own, plate));
        let row = |trial: &&Placed| -> Row {
            let cells = [trial.number, trial.block + 1].map(|number| number.to_string()).into_iter();
            let cells = cells.chain(trial.values.iter().map(f64::to_string));
            let cells = cells.chain(vec![String::new(); series.shape.measured().len()]);
            cells.map(|cell| (cell, false)).collect()
        };
        sheet.table(&head, &own.iter().map(row).collect::<Vec<_>>());
    }
    sheet
}

/// A plate from above, y upwards.
fn map(trials: &[&Placed], plate: Plate) -> String {
    let (length, width) = (plate.length, plate.width);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {length} {width}\" role=\"img\" aria-label=\"map of the plate\" \
         style=\"max-width:{length}mm\"><rect width=\"{length}\" height=\"{width}\" fill=\"none\" stroke=\"currentColor\"/>"
    );
    let (x, y) = (|x: f64| fixed(x, 1), |y: f64| fixed(width - y, 1));
    for trial in trials {
        for path in &trial.paths {
            let points: Vec<String> = path.iter().map(|p| format!("{},{}", x(p.x), y(p.y))).collect();
            // Writing to text cannot fail.
            let _ = write!(
                svg,
                "<polyline points=\"{}\" fill=\"none\" stroke=\"currentColor\" stroke-width=\"4\" stroke-linecap=\"round\" \
                 stroke-opacity=\"0.5\"/>",
                points.join(" ")
            );
        }
        let _ = write!(
            svg,
            "<text x=\"{}\" y=\"{}\" font-size=\"16\" fill=\"currentColor\">{}</text>",
            x(trial.label.x),
            y(trial.label.y),
            trial.number
        );
    }
    svg + "</svg>"
}
