//! The sheet that is filled in at the bench, as CSV that `bead fit` and `bead walls` read as it is.

use super::{BeadSize, Factor, Placed, Shape};
use crate::bead::library::{LibraryError, fields};
use bead_part::text::table::separator;

/// The sheet: a line for each trial in the order of welding, with empty cells for what is measured.
pub fn csv(title: &str, shape: Shape, factors: &[Factor], trials: &[Placed], length: f64) -> String {
    // What else belongs to a trial of this shape.
    let more = |trial: &Placed| -> Vec<(&'static str, String)> {
        match shape {
            Shape::Wall(layers) => vec![("length_mm", length.to_string()), ("layers", layers.to_string())],
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

/// The sheet with the width and height of the beads of plate `plate` (from 1), in the order of welding, filled in; beads
/// without a size keep their cells.
///
/// # Errors
/// [`SheetError`] if the text is no sheet of trials, or has another number of trials on that plate.
pub fn filled(sheet: &str, plate: usize, sizes: &[Option<BeadSize>]) -> Result<String, SheetError> {
    let mut lines = sheet.lines().enumerate().filter(|(_, line)| !line.trim().is_empty() && !line.starts_with('#'));
    let (at, head) = lines.next().ok_or(SheetError::Column("plate"))?;
    let between = separator(head);
    let columns = fields(head, between, at + 1)?;
    let column = |name: &'static str| columns.iter().position(|own| own == name).ok_or(SheetError::Column(name));
    let [plates, width, height] = [column("plate")?, column("width_mm")?, column("height_mm")?];
    let mut rows = Vec::new();
    for (number, line) in lines {
        let cells = fields(line, between, number + 1)?;
        if cells.get(plates).is_some_and(|own| own.parse() == Ok(plate)) {
            rows.push((number, cells));
        }
    }
    if rows.len() != sizes.len() {
        return Err(SheetError::Count { plate, sheet: rows.len(), plan: sizes.len() });
    }
    let mut text: Vec<String> = sheet.lines().map(str::to_owned).collect();
    for ((number, mut cells), size) in rows.into_iter().zip(sizes).filter_map(|(row, size)| Some((row, (*size)?))) {
        cells.resize(columns.len().max(cells.len()), String::new());
        let decimal = |value: f64| {
            let text = format!("{value:.2}");
            if between == ',' { text } else { text.replace('.', ",") }
        };
        (cells[width], cells[height]) = (decimal(size.width), decimal(size.height));
        let quoted = |cell: &String| {
            if cell.contains([between, '"']) { format!("\"{}\"", cell.replace('"', "\"\"")) } else { cell.clone() }
        };
        text[number] = cells.iter().map(quoted).collect::<Vec<_>>().join(&between.to_string());
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
