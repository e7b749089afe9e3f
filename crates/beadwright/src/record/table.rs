//! `record.parquet`: a row for each planned pass, with units in the names of the columns; NaN where nothing was planned or measured.

use super::{Part, PassRow, Quantity};
use crate::export::parquet::{Field, Values, table as parquet};
use ::parquet::errors::ParquetError;
use std::ops::Range;

type Number = Box<dyn Fn(&PassRow) -> Option<f64>>;

/// The bytes of the file.
pub(super) fn table(part: &Part<'_>) -> Result<Vec<u8>, ParquetError> {
    let rows = &part.record.passes;
    let counts: [(&str, fn(&PassRow) -> usize); 5] = [
        ("layer", |row| row.layer),
        ("pass", |row| row.pass),
        ("arcs", |row| row.arcs),
        ("tries", |row| row.tries),
        ("findings", |row| row.findings),
    ];
    let counts = counts.into_iter().map(|(name, count)| {
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
    let mut add = |name: &str, number: Number| columns.push((name.to_owned(), number));
    add("length (mm)", Box::new(|row| Some(row.length)));
    add("start (s)", Box::new(|row| row.time.map(|time| time[0])));
    add("end (s)", Box::new(|row| row.time.map(|time| time[1])));
    add("burned (s)", Box::new(|row| Some(row.burned)));
    let pairs: [(&str, &str, fn(&PassRow) -> [Option<f64>; 2]); 4] = [
        ("time", "s", |row| row.seconds),
        ("wait", "s", |row| row.wait),
        ("heat input", "J/mm", |row| row.heat),
        ("temperature before", "°C", |row| row.before),
    ];
    for (name, unit, pair) in pairs {
        add(&format!("{name} planned ({unit})"), Box::new(move |row| pair(row)[0]));
        add(&format!("{name} ({unit})"), Box::new(move |row| pair(row)[1]));
    }
    add("temperature peak (°C)", Box::new(|row| row.peak));
    for quantity in Quantity::PLANNED {
        let (word, unit) = (quantity.word(), quantity.unit());
        add(&format!("{word} planned ({unit})"), Box::new(move |row| row.planned(quantity)));
        let figures: [(&str, fn(&super::Measured) -> f64); 4] =
            [("mean", |m| m.mean), ("min", |m| m.min), ("max", |m| m.max), ("deviation", |m| m.deviation)];
        for (figure, value) in figures {
            add(&format!("{word} {figure} ({unit})"), Box::new(move |row| row.measured(quantity).map(value)));
        }
    }
    columns
}
