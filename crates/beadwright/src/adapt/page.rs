//! The page of a scan: predicted, measured and difference, side by side.

use super::see::Seen;
use super::surface::{Spread, Surface};
use crate::deposit::Picture;
use crate::deposit::picture::{EMPTY, FIRST_HEIGHT};
use crate::number::fixed;
use crate::report::sheet::{Row, Sheet};

/// Pictures have at most about this many pixels along a side.
const PIXELS: usize = 400;

/// Heights of a grid as a picture: 0 in the middle of the colour scale, ±`most` (mm) at its ends; blank where there is
/// none. Large grids are thinned out.
pub(crate) fn relief(surface: &Surface, most: f64, height: impl Fn(usize) -> Option<f64>) -> Picture {
    let grid = surface.grid();
    let steps = f64::from(u8::MAX - FIRST_HEIGHT);
    let value = |height: f64| FIRST_HEIGHT + ((height / most + 1.0) / 2.0 * steps).round().clamp(0.0, steps) as u8;
    let every = grid.columns.max(grid.rows).div_ceil(PIXELS).max(1);
    let rows = (0..grid.rows).step_by(every);
    let point = |row: usize, column: usize| height(row * grid.columns + column).map_or(EMPTY, value);
    let values = rows.flat_map(|row| (0..grid.columns).step_by(every).map(move |column| (row, column)));
    Picture {
        low: grid.place(0, 0) - grid.step / 2.0,
        pixel: every as f64 * grid.step,
        width: grid.columns.div_ceil(every),
        height: grid.rows.div_ceil(every),
        values: values.map(|(row, column)| point(row, column)).collect(),
    }
}

/// Heights as cells of a table: mean, root mean square, lowest, highest.
pub(crate) fn cells(spread: &Spread) -> Row {
    [spread.mean, spread.rms, spread.low, spread.high].map(|height| (format!("{height:+.2}"), false)).into()
}

/// The heights of a scan and of its plan as pictures: what is as planned has the middle of the colours.
#[derive(Debug, Clone)]
pub struct Reliefs {
    /// What the ends of the colours stand for, mm.
    pub most: f64,
    /// What the plan predicts, above the planned top.
    pub predicted: Picture,
    /// What was measured, above the planned top.
    pub measured: Picture,
    /// Measured minus predicted.
    pub difference: Picture,
}

impl Reliefs {
    /// The pictures of a scan.
    pub fn of(seen: &Seen) -> Self {
        let error = |i: usize| seen.surface.error(i);
        let measured = |i: usize| Some(seen.predicted[i]? + error(i)?);
        let most = [seen.error.low, seen.error.high].into_iter().fold(0.1, |most: f64, error| most.max(error.abs()));
        Self {
            most,
            predicted: relief(&seen.surface, most, |i| seen.predicted[i]),
            measured: relief(&seen.surface, most, measured),
            difference: relief(&seen.surface, most, error),
        }
    }
}

/// The page of layer `number`, from 1, whose top is planned at `z` (mm), of a part.
pub fn page(part: &str, number: usize, z: f64, seen: &Seen, sentences: &[String]) -> Sheet {
    let lead = format!(
        "Layer {number}, planned top {} mm: what the plan predicts, what was measured, and the difference.",
        fixed(z, 2)
    );
    let mut sheet = Sheet::new(&format!("Height: {part}"), &lead);
    sentences.iter().for_each(|sentence| {
        sheet.text(sentence);
    });
    let head = ["mean mm", "RMS mm", "lowest mm", "highest mm"];
    sheet.heading("Measured minus predicted").table(&head, &[cells(&seen.error)]);
    let Reliefs { most, predicted, measured, difference } = Reliefs::of(seen);
    let pictures = [
        ("predicted, above the planned top", &predicted),
        ("measured, above the planned top", &measured),
        ("measured minus predicted", &difference),
    ];
    let columns: Vec<_> = pictures.iter().map(|(name, picture)| ((*name).to_owned(), vec![Some(*picture)])).collect();
    sheet.heading("Pictures").heights(most, &[format!("layer {number}")], &columns);
    sheet
}
