//! The rows of a batch as a table: for the terminal, as CSV, as JSON and as a page with pictures.

use super::row::{Planned, Row};
use crate::profile;
use beadwright::fill::StrategyName;
use beadwright::report::sheet::Sheet;
use serde_json::{Map, Value, json};
use std::collections::BTreeSet;
use std::path::PathBuf;

/// How a table is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Format {
    Csv,
    Json,
    Html,
}

/// Pages with more rows than this have no pictures of layers: browsers would take long to open them.
const MOST_PICTURES: usize = 60;

/// A file name, and the format that its extension stands for.
pub(super) fn parse_output(text: &str) -> Result<(PathBuf, Format), String> {
    let path = PathBuf::from(text);
    let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase());
    match ending.as_deref() {
        Some("csv") => Ok((path, Format::Csv)),
        Some("json") => Ok((path, Format::Json)),
        Some("html") => Ok((path, Format::Html)),
        _ => Err("the name must end in .csv, .json or .html".to_owned()),
    }
}

/// A figure to compare plans by.
struct Column {
    /// With its unit.
    name: &'static str,
    text: fn(&Planned) -> String,
}

/// The columns that people see; files for programs hold all totals.
const COLUMNS: [Column; 9] = [
    Column { name: "layers", text: |p| p.summary.metrics.layers.to_string() },
    Column { name: "arc starts", text: |p| p.summary.metrics.arc_starts.to_string() },
    Column { name: "beads m", text: |p| format!("{:.2}", p.summary.metrics.deposited_length_mm / 1e3) },
    Column { name: "travel m", text: |p| format!("{:.2}", p.summary.metrics.travel_length_mm / 1e3) },
    Column { name: "time min", text: |p| format!("{:.1}", p.summary.metrics.total_time_s / 60.0) },
    Column { name: "wire kg", text: |p| format!("{:.3}", p.summary.metrics.wire_mass_kg) },
    Column { name: "void %", text: |p| percent(p.figures.map(|f| f.void_percent())) },
    Column { name: "low %", text: |p| percent(p.figures.map(|f| f.low_percent())) },
    Column { name: "overfill %", text: |p| percent(p.figures.map(|f| f.overfill_percent())) },
];

fn percent(value: Option<f64>) -> String {
    value.map_or(String::new(), |value| format!("{value:.2}"))
}

/// The rows, with the headings of their swept keys.
pub(super) struct Table {
    rows: Vec<Row>,
    swept: Vec<String>,
}

impl Planned {
    /// What `metrics.json` of the same plan holds, except notes on programs, which are not written.
    fn metrics(&self) -> Value {
        self.summary.json(self.figures.as_ref())
    }
}

impl Row {
    fn strategy(&self) -> &'static str {
        match &self.planned {
            Ok(planned) => planned.strategy.name(),
            Err(_) => self.run.strategy.map_or("", StrategyName::name),
        }
    }

    /// Why the plan should not be welded, on one line; empty if nothing speaks against it.
    fn problem(&self) -> String {
        match &self.planned {
            Ok(planned) => planned.summary.forbidden.join(" "),
            Err(error) => error.split_whitespace().collect::<Vec<_>>().join(" "),
        }
    }

    /// What was planned, as words.
    fn names(&self) -> Vec<String> {
        let file = self.run.file.display().to_string();
        let swept = self.run.swept.iter().map(|(_, value)| value.clone());
        [file, self.run.profile.clone(), self.strategy().to_owned()].into_iter().chain(swept).collect()
    }

    /// Every number of `metrics.json` by its name, those of the deposit model as `deposit.void_percent`.
    fn numbers(&self) -> Map<String, Value> {
        let Ok(planned) = &self.planned else { return Map::new() };
        let Value::Object(metrics) = planned.metrics() else { return Map::new() };
        let deposit = metrics.get("deposit").and_then(Value::as_object).cloned().unwrap_or_default();
        let deposit = deposit.into_iter().map(|(name, value)| (format!("deposit.{name}"), value));
        metrics.into_iter().chain(deposit).filter(|(_, value)| value.is_number()).collect()
    }

    fn json(&self) -> Value {
        let swept: Map<String, Value> =
            self.run.swept.iter().map(|(key, value)| (key.clone(), value.clone().into())).collect();
        json!({
            "file": self.run.file.display().to_string(),
            "profile": self.run.profile,
            "strategy": self.strategy(),
            "set": swept,
            "metrics": self.planned.as_ref().ok().map(Planned::metrics),
            "error": self.planned.as_ref().err(),
        })
    }
}

impl Table {
    pub(super) fn new(rows: Vec<Row>) -> Self {
        let swept = rows.first().map(heads_of_swept).unwrap_or_default();
        Self { rows, swept }
    }

    /// The number of plans, how many of them failed, and how many should not be welded.
    pub(super) fn counts(&self) -> (usize, usize, usize) {
        let failed = self.rows.iter().filter(|row| row.planned.is_err()).count();
        let problems = self.rows.iter().filter(|row| !row.problem().is_empty()).count();
        (self.rows.len(), failed, problems - failed)
    }

    /// The table in a format.
    pub(super) fn written(&self, format: Format) -> serde_json::Result<String> {
        Ok(match format {
            Format::Csv => self.csv(),
            Format::Json => serde_json::to_string_pretty(&self.rows.iter().map(Row::json).collect::<Vec<_>>())? + "\n",
            Format::Html => self.html(),
        })
    }

    /// Headings of the words that say what was planned.
    fn names(&self) -> Vec<String> {
        ["file", "profile", "strategy"].map(str::to_owned).into_iter().chain(self.swept.iter().cloned()).collect()
    }

    fn csv(&self) -> String {
        let numbers: Vec<Map<String, Value>> = self.rows.iter().map(Row::numbers).collect();
        let known: BTreeSet<&String> = numbers.iter().flat_map(Map::keys).collect();
        let head = self.names().into_iter().chain(known.iter().map(|name| (*name).clone()));
        let mut text = line(head.chain(["problem".to_owned()]));
        for (row, numbers) in self.rows.iter().zip(&numbers) {
            let number = |name: &&String| numbers.get(*name).map_or(String::new(), Value::to_string);
            text += &line(row.names().into_iter().chain(known.iter().map(number)).chain([row.problem()]));
        }
        text
    }

    /// Headings and cells as people read them.
    fn cells(&self) -> (Vec<String>, Vec<Vec<String>>) {
        let head = self.names().into_iter().chain(COLUMNS.iter().map(|column| column.name.to_owned())).collect();
        let figure = |row: &Row, column: &Column| row.planned.as_ref().map_or(String::new(), column.text);
        let cells = |row: &Row| row.names().into_iter().chain(COLUMNS.iter().map(|c| figure(row, c))).collect();
        (head, self.rows.iter().map(cells).collect())
    }

    /// The table with even columns; what speaks against a plan is listed below it.
    pub(super) fn terminal(&self) -> String {
        let (head, rows) = self.cells();
        let width = |column: usize| {
            let cells = rows.iter().chain([&head]).map(|cells| cells[column].chars().count());
            cells.max().unwrap_or(0)
        };
        let widths: Vec<usize> = (0..head.len()).map(width).collect();
        let line = |cells: &Vec<String>| {
            let cell = |(i, cell): (usize, &String)| match widths[i] {
                width if i < 3 => format!("{cell:<width$}"),
                width => format!("{cell:>width$}"),
            };
            let cells: Vec<String> = cells.iter().enumerate().map(cell).collect();
            format!("{}\n", cells.join("  ").trim_end())
        };
        let mut text = line(&head);
        for (row, cells) in self.rows.iter().zip(&rows) {
            text += &line(cells);
            let kind = if row.planned.is_err() { "error" } else { "should not be welded" };
            let problem = row.problem();
            if !problem.is_empty() {
                text += &format!("  {kind}: {problem}\n");
            }
        }
        text
    }

    fn html(&self) -> String {
        let (mut head, rows) = self.cells();
        head.push("problem".to_owned());
        let (plans, failed, unfit) = self.counts();
        let lead = format!(
            "{plans} plans, {failed} of them failed, {unfit} should not be welded. A click on a heading sorts the table."
        );
        let mut sheet = Sheet::new("Batch", &lead);
        let marked = |(cells, row): (Vec<String>, &Row)| {
            cells.into_iter().chain([row.problem()]).map(|cell| (cell, false)).collect()
        };
        let rows: Vec<Vec<(String, bool)>> = rows.into_iter().zip(&self.rows).map(marked).collect();
        sheet.table(&head.iter().map(String::as_str).collect::<Vec<_>>(), &rows);
        self.pictures(&mut sheet);
        sheet.html()
    }

    /// The layer in the middle of every plan.
    fn pictures(&self, sheet: &mut Sheet) {
        if self.rows.len() > MOST_PICTURES {
            sheet.text(&format!("Pages with more than {MOST_PICTURES} plans have no pictures of layers."));
            return;
        }
        let picture = |row: &Row| Some((row.names().join(", "), row.planned.as_ref().ok()?.picture.clone()?));
        sheet.svgs(&self.rows.iter().filter_map(picture).collect::<Vec<_>>());
    }
}

/// The swept keys, with the units that the profile gives them.
fn heads_of_swept(row: &Row) -> Vec<String> {
    let limits = profile::load(&row.run.profile, &[]).map(|profile| profile.limits()).unwrap_or_default();
    let head = |key: &String| {
        let unit = limits.iter().find(|limit| limit.key == key).map_or("", |limit| limit.unit);
        format!("{key} {unit}").trim_end().to_owned()
    };
    row.run.swept.iter().map(|(key, _)| head(key)).collect()
}

/// A line of a CSV file (RFC 4180, with plain line ends).
fn line(cells: impl Iterator<Item = String>) -> String {
    let quoted = |cell: String| {
        let plain = !cell.contains([',', '"', '\n', '\r']);
        if plain { cell } else { format!("\"{}\"", cell.replace('"', "\"\"")) }
    };
    cells.map(quoted).collect::<Vec<_>>().join(",") + "\n"
}
