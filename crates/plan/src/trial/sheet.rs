//! The sheet that is filled in at the bench, as CSV that `bead fit` and `bead walls` read as it is.

use super::{BeadSize, Parameter, Placed, Series, Shape};
use crate::bead::library::{LibraryError, fields};
use bead_part::text::table::separator;

/// The sheet: a line for each trial in the order of welding, with empty cells for what is measured.
pub fn csv(title: &str, series: &Series) -> String {
    let Series { factors, shape, trials, .. } = series;
    // What else belongs to a trial of this shape.
    let more = |trial: &Placed| -> Vec<(&'static str, String)> {
        match shape {
            Shape::Wall(layers) => vec![("length_mm", series.length().to_string()), ("layers", layers.to_string())],
            Shape::Ends => series.held().into_iter().map(|(own, value)| (own.column(), value.to_string())).collect(),
            Shape::Overlap(_) => {
                let apart = trial.paths.get(1).map_or(0.0, |second| second[0].distance(trial.paths[0][0]));
                vec![("distance_mm", format!("{apart:.2}"))]
            }
            Shape::Bead | Shape::Corner => Vec::new(),
        }
    };
    let names: Vec<&str> = trials.first().map(more).unwrap_or_default().into_iter().map(|(name, _)| name).collect();
    let head = ["bead", "plate", "block"]
        .into_iter()
        .chain(factors.iter().map(|factor| factor.parameter.column()))
        .chain(names)
        .chain(shape.measured().iter().copied())
        .chain(["measured_current_a", "measured_voltage_v", "remarks"]);
    let empty = shape.measured().len() + 3;
    let row = |trial: &Placed| -> String {
        let numbers = [trial.number, trial.plate + 1, trial.block + 1].map(|number| number.to_string());
        let cells = numbers.into_iter().chain(trial.values.iter().map(f64::to_string));
        let cells = cells.chain(more(trial).into_iter().map(|(_, value)| value)).chain(vec![String::new(); empty]);
        joined(cells.collect())
    };
    let head = joined(head.map(str::to_owned).collect());
    let rows: String = trials.iter().map(row).collect();
    format!("# {title}\n# Beads without measurements are left out of the fit.\n{head}{rows}")
}

fn joined(cells: Vec<String>) -> String {
    cells.join(",") + "\n"
}

/// The sheet with what a scan shows of the trials of plate `plate` (from 1), in the order of welding, filled in; trials
/// without a size keep their cells.
///
/// # Errors
/// [`SheetError`] if the text is no sheet of trials, or has another number of trials on that plate.
pub fn filled(sheet: &str, plate: usize, sizes: &[Option<BeadSize>]) -> Result<String, SheetError> {
    let cells = |size: &Option<BeadSize>| size.map(|size| size.cells()).unwrap_or_default();
    with_cells(sheet, plate, &sizes.iter().map(cells).collect::<Vec<_>>())
}

/// How a trial was welded, where that was measured.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TrialWelded {
    /// Wire feed speed, m/min.
    pub feed: Option<f64>,
    /// Speed of the torch, mm/s.
    pub speed: Option<f64>,
    /// Current, A.
    pub current: Option<f64>,
    /// Voltage, V.
    pub voltage: Option<f64>,
}

/// The sheet with the feeds and speeds that were measured in place of those that were set, for the trials of plate `plate` (from 1) in the
/// order of welding. What was not measured, or not varied, stays.
///
/// # Errors
/// [`SheetError`] as [`filled`].
pub fn as_measured(sheet: &str, plate: usize, trials: &[TrialWelded]) -> Result<String, SheetError> {
    let cells = |welded: &TrialWelded| {
        let known = [
            (Parameter::WireFeedSpeed.column(), welded.feed),
            (Parameter::DepositionSpeed.column(), welded.speed),
            ("measured_current_a", welded.current),
            ("measured_voltage_v", welded.voltage),
        ];
        known.into_iter().filter(|(_, value)| value.is_some()).collect()
    };
    with_cells(sheet, plate, &trials.iter().map(cells).collect::<Vec<_>>())
}

/// The number of plates on which the trials of a sheet are welded.
///
/// # Errors
/// [`SheetError`] if the text is no sheet of trials.
pub fn plates(sheet: &str) -> Result<usize, SheetError> {
    let table = Table::of(sheet)?;
    let plate = table.plate()?;
    let number = |(_, cells): &(usize, Vec<String>)| cells.get(plate)?.parse().ok();
    Ok(table.rows.iter().filter_map(number).max().unwrap_or(0))
}

/// The numbers of the trials of a sheet that are welded on plate `plate`, from 1.
///
/// # Errors
/// [`SheetError`] if the text is no sheet of trials.
pub fn numbers_on(sheet: &str, plate: usize) -> Result<Vec<String>, SheetError> {
    let table = Table::of(sheet)?;
    let (plates, number) = (table.plate()?, table.column("bead").ok_or(SheetError::Column("bead"))?);
    let of = |(_, cells): &(usize, Vec<String>)| cells.get(number).cloned().unwrap_or_default();
    Ok(table.on_plate(plates, plate).map(of).collect())
}

/// What was measured with the trials of a sheet.
pub(super) struct Readings {
    /// What was varied.
    pub(super) factors: Vec<Parameter>,
    /// The values of the factors and of the columns that were asked for, `None` where a cell is empty.
    pub(super) trials: Vec<(Vec<f64>, Vec<Option<f64>>)>,
}

/// What was measured in some columns; `None` if the sheet lacks one of them.
///
/// # Errors
/// [`SheetError`] if the text is no sheet of trials, or for the first cell that is not a number.
pub(super) fn readings(sheet: &str, columns: &[&str]) -> Result<Option<Readings>, SheetError> {
    let table = match Table::of(sheet) {
        // Nothing but comments.
        Err(SheetError::Column(_)) => return Ok(None),
        table => table?,
    };
    let at = |name: &str| table.column(name);
    let Some(wanted) = columns.iter().map(|name| at(name)).collect::<Option<Vec<usize>>>() else { return Ok(None) };
    let (factors, places): (Vec<Parameter>, Vec<usize>) =
        Parameter::all().filter_map(|factor| Some((factor, at(factor.column())?))).unzip();
    let row = |(line, cells): &(usize, Vec<String>)| {
        let wrong = |place: usize| SheetError::Cell { line: line + 1, column: table.columns[place].clone() };
        let number = |place: &usize| match cells.get(*place).map(|cell| cell.replace(',', ".")).unwrap_or_default() {
            empty if empty.is_empty() => Ok(None),
            cell => cell.parse().ok().filter(|value: &f64| value.is_finite()).map(Some).ok_or_else(|| wrong(*place)),
        };
        let set = places.iter().map(|place| number(place)?.ok_or_else(|| wrong(*place))).collect::<Result<_, _>>()?;
        Ok((set, wanted.iter().map(number).collect::<Result<_, _>>()?))
    };
    let trials = table.rows.iter().map(row).collect::<Result<_, SheetError>>()?;
    Ok(Some(Readings { factors, trials }))
}

/// A sheet, cell by cell.
struct Table {
    between: char,
    columns: Vec<String>,
    /// The cells of each trial, with the number of its line, from 0.
    rows: Vec<(usize, Vec<String>)>,
}

impl Table {
    fn of(sheet: &str) -> Result<Self, SheetError> {
        let mut lines = sheet.lines().enumerate().filter(|(_, line)| !line.trim().is_empty() && !line.starts_with('#'));
        let (at, head) = lines.next().ok_or(SheetError::Column("plate"))?;
        let between = separator(head);
        let columns = fields(head, between, at + 1)?;
        let cells = |(number, line)| Ok((number, fields(line, between, number + 1)?));
        let rows = lines.map(cells).collect::<Result<_, LibraryError>>()?;
        Ok(Self { between, columns, rows })
    }

    fn column(&self, name: &str) -> Option<usize> {
        self.columns.iter().position(|own| own == name)
    }

    /// The lines of a plate, given the column with the plates.
    fn on_plate(&self, column: usize, plate: usize) -> impl Iterator<Item = &(usize, Vec<String>)> {
        self.rows.iter().filter(move |(_, cells)| cells.get(column).is_some_and(|own| own.parse() == Ok(plate)))
    }

    /// The column with the plates, of a sheet for beads.
    fn plate(&self) -> Result<usize, SheetError> {
        let missing = |name: &'static str| self.column(name).ok_or(SheetError::Column(name));
        let plate = missing("plate")?;
        missing("width_mm").and(missing("height_mm")).and(Ok(plate))
    }
}

/// The sheet with other numbers in some columns of the trials of a plate; columns that it lacks are left out.
fn with_cells(sheet: &str, plate: usize, trials: &[Vec<(&'static str, Option<f64>)>]) -> Result<String, SheetError> {
    let table = Table::of(sheet)?;
    let rows: Vec<&(usize, Vec<String>)> = table.on_plate(table.plate()?, plate).collect();
    let (between, columns) = (table.between, &table.columns);
    if rows.len() != trials.len() {
        return Err(SheetError::Count { plate, sheet: rows.len(), plan: trials.len() });
    }
    let mut text: Vec<String> = sheet.lines().map(str::to_owned).collect();
    let decimal = |value: f64| {
        let text = format!("{value:.2}");
        if between == ',' { text } else { text.replace('.', ",") }
    };
    let quoted = |cell: &String| {
        if cell.contains([between, '"']) { format!("\"{}\"", cell.replace('"', "\"\"")) } else { cell.clone() }
    };
    for ((number, cells), changed) in rows.into_iter().zip(trials).filter(|(_, changed)| !changed.is_empty()) {
        let mut cells = cells.clone();
        cells.resize(columns.len().max(cells.len()), String::new());
        let placed = changed.iter().filter_map(|(name, value)| Some((table.column(name)?, *value)));
        placed.for_each(|(place, value)| cells[place] = value.map(decimal).unwrap_or_default());
        text[*number] = cells.iter().map(quoted).collect::<Vec<_>>().join(&between.to_string());
    }
    Ok(text.join("\n") + "\n")
}

/// Why a sheet cannot be filled in.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SheetError {
    /// No sheet of `bead trial`.
    #[error("there is no column \"{0}\": the sheet that `beadwright bead trial` wrote for beads is expected.")]
    Column(&'static str),
    /// A line that is not CSV.
    #[error(transparent)]
    Line(#[from] LibraryError),
    /// A cell without a number.
    #[error("line {line}, column \"{column}\": a number is expected.")]
    Cell {
        /// Number of the line, from 1.
        line: usize,
        /// Name of the column.
        column: String,
    },
    /// A sheet of another series.
    #[error("the sheet has {sheet} trials on plate {plate}, and its plan {plan}: they do not belong together.")]
    Count {
        /// Number of the plate, from 1.
        plate: usize,
        /// Trials of the sheet.
        sheet: usize,
        /// Trials of the plan.
        plan: usize,
    },
}
