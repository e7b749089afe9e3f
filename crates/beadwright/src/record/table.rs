//! `record.parquet`: a row for each planned pass, with units in the names of the columns; NaN where nothing was planned or measured.

use super::{Part, PassRow, Quantity, heights};
use crate::export::parquet::{Field, Values, table as parquet};
use ::parquet::errors::ParquetError;
use std::ops::Range;

type Count = fn(&PassRow) -> usize;
type Number = Box<dyn Fn(&PassRow) -> Option<f64>>;

/// The columns of whole numbers.
const COUNTS: [(&str, Count); 5] = [
    ("layer", |row| row.layer),
    ("pass", |row| row.pass),
    ("arcs", |row| row.arcs),
    ("tries", |row| row.tries),
    ("findings", |row| row.findings),
];

/// The bytes of the file.
pub(super) fn table(part: &Part<'_>) -> Result<Vec<u8>, ParquetError> {
    let rows = &part.record.passes;
    let counts = COUNTS.into_iter().map(|(name, count)| {
        let values =
            move |range: Range<usize>| Values::Counts(rows[range].iter().map(|row| count(row) as i32).collect());
        Field { name, values: Box::new(values) }
    });
    let notes = |range: Range<usize>| {
        Values::Texts(rows[range].iter().map(|row| row.notes.join("; ").as_str().into()).collect())
    };
    let notes = Field { name: "notes", values: Box::new(notes) };
    let numbers = numbers();
    let numbers = numbers.iter().map(|(name, number)| {
        let values = move |range: Range<usize>| {
            Values::Numbers(rows[range].iter().map(|row| number(row).unwrap_or(f64::NAN)).collect())
        };
        Field { name, values: Box::new(values) }
    });
    let fields: Vec<Field<'_>> = counts.chain([notes]).chain(numbers).collect();
    parquet("passes", rows.len(), &fields)
}

/// The columns of numbers.
fn numbers() -> Vec<(String, Number)> {
    let mut columns: Vec<(String, Number)> = Vec::new();
    let mut add = |name: String, number: Number| columns.push((name, number));
    add("length (mm)".into(), Box::new(|row| Some(row.length)));
    add("start (s)".into(), Box::new(|row| row.time.map(|time| time[0])));
    add("end (s)".into(), Box::new(|row| row.time.map(|time| time[1])));
    add("burned (s)".into(), Box::new(|row| Some(row.burned)));
    for (which, end) in [(0, " planned"), (1, "")] {
        add(format!("time{end} (s)"), Box::new(move |row| row.seconds[which]));
        add(format!("wait{end} (s)"), Box::new(move |row| row.wait[which]));
        add(format!("heat input{end} (J/mm)"), Box::new(move |row| row.heat[which]));
        add(format!("temperature before{end} (°C)"), Box::new(move |row| row.before[which]));
    }
    add("temperature peak (°C)".into(), Box::new(|row| row.peak));
    for (name, unit, value, _) in heights::COLUMNS {
        add(format!("{name} ({unit})"), Box::new(value));
    }
    for quantity in Quantity::PLANNED {
        let name = |figure: &str| format!("{} {figure} ({})", quantity.word(), quantity.unit());
        add(name("planned"), Box::new(move |row| row.planned(quantity)));
        add(name("mean"), Box::new(move |row| row.measured(quantity).map(|measured| measured.mean)));
        add(name("min"), Box::new(move |row| row.measured(quantity).map(|measured| measured.min)));
        add(name("max"), Box::new(move |row| row.measured(quantity).map(|measured| measured.max)));
        add(name("deviation"), Box::new(move |row| row.measured(quantity).map(|measured| measured.deviation)));
    }
    columns
}
