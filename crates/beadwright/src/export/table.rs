//! The columns that all tables of pieces have: names with units, and values.

use super::{Beads, Piece};

/// A column of numbers.
pub(super) struct Column {
    /// Its name with the unit.
    pub(super) name: &'static str,
    /// Decimals in texts.
    pub(super) decimals: usize,
    pub(super) value: fn(&Piece) -> f64,
}

/// A column of whole numbers: its name and its values.
pub(super) type Count = (&'static str, fn(&Piece) -> usize);

/// The columns of whole numbers, counted from 1; the kind of the pass follows them.
pub(super) const COUNTS: [Count; 2] = [("layer", |p| p.layer), ("pass", |p| p.pass)];

/// The name of the column with the kinds of passes.
pub(super) const KIND: &str = "kind";

/// The columns of measures; normals only where layers are not level, temperatures only where they were computed.
pub(super) fn measures(beads: &Beads<'_>) -> Vec<&'static Column> {
    let normals = NORMALS.iter().filter(|_| !beads.profile.layers.are_level());
    MEASURES.iter().chain(normals).chain(beads.heat.map(|_| &TEMPERATURE)).collect()
}

const TEMPERATURE: Column = measure("temperature (°C)", |p| p.temperature);

const NORMALS: [Column; 3] =
    [measure("normal x", |p| p.normal.x), measure("normal y", |p| p.normal.y), measure("normal z", |p| p.normal.z)];

const MEASURES: [Column; 13] = [
    place("x0 (mm)", |p| p.from.x),
    place("y0 (mm)", |p| p.from.y),
    place("z0 (mm)", |p| p.from.z),
    place("x1 (mm)", |p| p.to.x),
    place("y1 (mm)", |p| p.to.y),
    place("z1 (mm)", |p| p.to.z),
    measure("width (mm)", |p| p.width),
    measure("height (mm)", |p| p.height),
    measure("speed (mm/s)", |p| p.speed),
    measure("pace (mm/s)", |p| p.pace),
    measure("wire feed (ratio)", |p| p.feed),
    measure("start (s)", |p| p.start),
    measure("time (s)", |p| p.seconds),
];

const fn place(name: &'static str, value: fn(&Piece) -> f64) -> Column {
    Column { name, decimals: 4, value }
}

const fn measure(name: &'static str, value: fn(&Piece) -> f64) -> Column {
    Column { name, decimals: 6, value }
}
