//! Trial beads: the files of each plate, and the page that shows what lies where.
//!
//! [`bead_plan::trial`] chooses and places the trials.

pub use bead_plan::trial::*;

use crate::dialect::{Chunk, DialectError};
use crate::files::{PlanFiles, Programs, Selection};
use crate::layer::Extent;
use crate::metrics::Metrics;
use crate::model::RepairReport;
use crate::number::fixed;
use crate::plan::{Header, Summary};
use crate::profile::Profile;
use crate::report::sheet::{Row, Sheet};
use crate::warning::Warnings;
use std::fmt::Write;

/// What the trials of a profile vary.
pub fn nominal(profile: &Profile) -> Nominal {
    Nominal { process: profile.process.clone(), width: profile.bead.width, height: profile.layers.height }
}

/// The plan of one plate: its layers, and the profile that welds them.
pub struct PlatePlan {
    /// Name of the plate, for files and programs.
    pub name: String,
    /// The profile with a row of `process.layers` for each trial whose wire feed or job differs.
    pub profile: Profile,
    layers: Vec<crate::layer::Layer>,
}

impl PlatePlan {
    /// The plan of plate `index`, from 0.
    pub fn new(series: &Series, index: usize, profile: &Profile) -> Self {
        let (layers, process) = series.layers(index);
        let mut profile = profile.clone();
        profile.process = process;
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
        let summary = Summary { metrics, warnings: Warnings::default(), notes: files.notes(), forbidden };
        chunks.extend(files.end(&summary, &RepairReport::default(), None)?);
        Ok(chunks)
    }
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
