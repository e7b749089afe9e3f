//! Lines of x, y, z: CSV with or without a header, XYZ, touched points. Further columns, such as colours, are skipped.
//!
//! A header names the columns `x`, `y`, `z` in any order, with their unit if that is not mm: `x_m`, `z (in)`. Values
//! are separated by commas, semicolons, tabs or spaces; a decimal comma is understood with any separator but the comma.
//! A first line with a single number, the number of points, is skipped.

use super::{ScanError, lines, number};
use glam::DVec3;

/// Units of columns, and their length in mm.
const UNITS: [(&str, f64); 7] =
    [("", 1.0), ("mm", 1.0), ("cm", 10.0), ("m", 1e3), ("um", 1e-3), ("µm", 1e-3), ("in", 25.4)];

/// The points; heights that were not measured are NaN.
pub(super) fn read(text: &str) -> Result<Vec<DVec3>, ScanError> {
    let mut lines = lines(text).peekable();
    let Some(&(_, first)) = lines.peek() else { return Ok(Vec::new()) };
    if number(first).is_some() {
        lines.next();
    }
    let Some(&(line, head)) = lines.peek() else { return Ok(Vec::new()) };
    let split = Split::of(head);
    let mut columns = Columns { at: [0, 1, 2], millimetres: [1.0; 3] };
    if split.fields(head).first().is_some_and(|field| number(field).is_none()) {
        columns = Columns::named(&split.fields(head)).map_err(|reason| ScanError::Line { line, reason })?;
        lines.next();
    }
    // The separator of the header may be another one.
    let split = lines.peek().map_or(split, |(_, line)| Split::of(line));
    lines
        .map(|(line, text)| columns.point(&split.fields(text)).map_err(|reason| ScanError::Line { line, reason }))
        .collect()
}

/// How lines are split into values.
#[derive(Clone, Copy)]
enum Split {
    Semicolons,
    Commas,
    Spaces,
}

impl Split {
    fn of(line: &str) -> Self {
        let words = || line.split_whitespace();
        if line.contains(';') {
            Self::Semicolons
        } else if words().count() >= 3 && !words().any(|word| word.ends_with(',')) {
            Self::Spaces
        } else {
            Self::Commas
        }
    }

    fn fields(self, line: &str) -> Vec<String> {
        let point = |field: &str| field.trim().replace(',', ".");
        match self {
            Self::Semicolons => line.split(';').map(point).collect(),
            Self::Commas => line.split(',').map(|field| field.trim().to_owned()).collect(),
            Self::Spaces => line.split_whitespace().map(point).collect(),
        }
    }
}

/// Which columns hold x, y and z, and in which unit.
struct Columns {
    at: [usize; 3],
    millimetres: [f64; 3],
}

impl Columns {
    fn named(fields: &[String]) -> Result<Self, String> {
        let mut columns = Self { at: [0; 3], millimetres: [1.0; 3] };
        for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
            let found = fields.iter().enumerate().find_map(|(at, field)| Some((at, unit(field, name)?)));
            let (at, unit) =
                found.ok_or_else(|| format!("no column is named {name}. The header names {}", fields.join(", ")))?;
            let known = UNITS.iter().find(|(known, _)| *known == unit);
            let (_, millimetres) =
                known.ok_or_else(|| format!("\"{unit}\" is not a unit of {name}: use mm, cm, m, um or in"))?;
            (columns.at[axis], columns.millimetres[axis]) = (at, *millimetres);
        }
        Ok(columns)
    }

    fn point(&self, fields: &[String]) -> Result<DVec3, String> {
        let mut point = DVec3::ZERO;
        for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
            let field = fields.get(self.at[axis]).ok_or_else(|| format!("{name} is missing"))?;
            let value = number(field).ok_or_else(|| format!("\"{field}\" is not a number for {name} in mm"))?;
            point[axis] = value * self.millimetres[axis];
        }
        Ok(point)
    }
}

/// The unit of a column with this name: `x_mm`, `X [mm]` and `x` are named x.
fn unit(field: &str, name: &str) -> Option<String> {
    let lower = field.trim().trim_matches('"').to_lowercase();
    let rest = lower.strip_prefix(name)?;
    let unit = rest.trim_matches([' ', '_', '(', ')', '[', ']', '/']);
    (rest.is_empty() || !rest.starts_with(char::is_alphanumeric)).then(|| unit.to_owned())
}
