//! Whether a printed table of process values is consistent.
//!
//! A wire melts nearly in proportion to the current, so bead area times speed per ampere is nearly the same in all rows
//! of one wire and gas. A row that differs is misprinted, or was not welded as the table says.

use super::{Columns, LibraryError, Measured};

/// A row of the table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PrintedRow {
    /// Area of a bead, mm²: width × height, divided by the number of layers if the table gives it.
    pub area: f64,
    /// Current, A.
    pub current: f64,
    /// Deposition speed, mm/s.
    pub speed: f64,
    /// Width, mm.
    pub width: f64,
    /// Metal per ampere and second, mm³/(A·s).
    pub metal: f64,
    /// The median of [`Self::metal`] over the other rows, mm³/(A·s).
    pub others: f64,
}

/// Rows that differ by more than this fraction contradict the others: melting grows a little faster than the current,
/// and printed figures are rounded.
const DIFFERS: f64 = 0.12;

impl PrintedRow {
    /// Whether the row contradicts the others.
    pub fn contradicts(&self) -> bool {
        (self.metal / self.others - 1.0).abs() > DIFFERS
    }

    /// The speed (mm/s), the width (mm) and the current (A) that would each, on its own, make the row agree with the
    /// others.
    pub fn agreeing(&self) -> (f64, f64, f64) {
        let factor = self.others / self.metal;
        (self.speed * factor, self.width * factor, self.current / factor)
    }
}

/// The rows of a table in CSV with the columns `current_a`, `speed_mm_s`, `width_mm`, `height_mm` and, for walls of one bead a
/// layer, `layers`; others are ignored.
///
/// ```
/// use bead_plan::bead::library::printed_rows;
///
/// // The four walls of Li et al.: the blade's wall of 3.5 mm lacks a fifth of its metal at 8 mm/s.
/// let rows = printed_rows(
///     "part,current_a,speed_mm_s,width_mm,height_mm,layers\n\
///      frame,129,8,4.5,26,18\nblade,119,8,3.5,100,74\ngourd,119,10,4,200,168\npot,119,10,4,80,66",
/// )?;
/// assert_eq!(rows.iter().map(|row| row.contradicts()).collect::<Vec<_>>(), [false, true, false, false]);
/// let (speed, width, _) = rows[1].agreeing();
/// assert!((speed - 10.0).abs() < 0.3 && (width - 4.4).abs() < 0.1);
/// # Ok::<(), bead_plan::bead::library::LibraryError>(())
/// ```
///
/// # Errors
/// The first line and column that cannot be used, and why; fewer than three rows.
pub fn printed_rows(text: &str) -> Result<Vec<PrintedRow>, LibraryError> {
    let inputs = |names: &[&str]| Columns {
        inputs: Some(names.iter().map(|name| (*name).to_owned()).collect()),
        ..Columns::default()
    };
    let by_layers = Measured::read(text, &inputs(&["current", "speed", "layers"]));
    let table = match by_layers {
        Err(LibraryError::Unknown { name, .. }) if name == "layers" => {
            Measured::read(text, &inputs(&["current", "speed"]))?
        }
        other => other?,
    };
    for (input, unit) in table.inputs.iter().zip(["A", "mm/s"]) {
        if input.unit != unit {
            let reason = format!("the column {} is in \"{}\"; {unit} is expected.", input.name, input.unit);
            return Err(LibraryError::Inputs { reason });
        }
    }
    let sizes = table.widths.iter().zip(&table.heights);
    let row = |(number, (values, (width, height))): (usize, (&Vec<f64>, (&f64, &f64)))| {
        let (current, speed, layers) = (values[0], values[1], values.get(2).copied().unwrap_or(1.0));
        if values.iter().any(|value| *value <= 0.0) {
            let reason = format!("row {}: current, speed and layers must be above 0.", number + 1);
            return Err(LibraryError::Inputs { reason });
        }
        let area = width * height / layers;
        Ok(PrintedRow { area, current, speed, width: *width, metal: area * speed / current, others: f64::NAN })
    };
    let mut rows: Vec<PrintedRow> = table.rows.iter().zip(sizes).enumerate().map(row).collect::<Result<_, _>>()?;
    if rows.len() < 3 {
        let reason = format!("{} rows cannot outvote each other: at least three are needed.", rows.len());
        return Err(LibraryError::Inputs { reason });
    }
    let metals: Vec<f64> = rows.iter().map(|row| row.metal).collect();
    for (k, row) in rows.iter_mut().enumerate() {
        row.others =
            median(metals.iter().enumerate().filter(|(other, _)| *other != k).map(|(_, metal)| *metal).collect());
    }
    Ok(rows)
}

/// The median of some values; NaN if there are none.
///
/// ```
/// use bead_plan::bead::library::median;
///
/// assert_eq!(median(vec![3.0, 1.0, 20.0]), 3.0);
/// assert_eq!(median(vec![3.0, 1.0, 20.0, 4.0]), 3.5);
/// ```
pub fn median(mut values: Vec<f64>) -> f64 {
    values.sort_unstable_by(f64::total_cmp);
    let half = values.len() / 2;
    if values.is_empty() {
        return f64::NAN;
    }
    if values.len() % 2 == 1 { values[half] } else { values[half - 1].midpoint(values[half]) }
}
