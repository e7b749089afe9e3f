//! Measured single beads from CSV.
//!
//! The first line that is neither empty nor a comment (`#`) names the columns. A name ends in its unit, as in
//! `current_a`, `deposition_speed_mm_s`, or carries it in brackets, as in `current (A)`. Values are separated by commas,
//! semicolons or tabs, whichever the header uses; with the latter two a decimal comma is understood.

use super::{Input, LibraryError};
use bead_part::text::table::{name_and_unit, separator};

/// Which columns are which. `Default` takes `width` and `height` as the bead and all others as inputs.
#[derive(Debug, Clone, Default)]
pub struct Columns {
    /// Names of the input columns; `None` takes all but width and height.
    pub inputs: Option<Vec<String>>,
    /// Name of the column with the bead width; `None` takes `width`.
    pub width: Option<String>,
    /// Name of the column with the bead height; `None` takes `height`.
    pub height: Option<String>,
}

/// Measured beads.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Measured {
    /// Comment lines of the file, without their `#`.
    pub remarks: Vec<String>,
    /// The inputs with the range that was measured.
    pub inputs: Vec<Input>,
    /// The input values of every bead, in the order of `inputs`.
    pub rows: Vec<Vec<f64>>,
    /// Width of every bead, mm.
    pub widths: Vec<f64>,
    /// Height of every bead, mm.
    pub heights: Vec<f64>,
    /// Number of lines left out because width and height are empty: trials that were not welded, or not measured yet.
    pub unmeasured: usize,
}

/// Columns of a trial sheet that are no process parameters, and the beginning of others.
const BOOKKEEPING: [&str; 5] = ["bead", "plate", "block", "remarks", "measured"];

/// A column of the header.
struct Column {
    /// As written in the file.
    header: String,
    name: String,
    unit: String,
}

impl Column {
    fn is_bookkeeping(&self) -> bool {
        BOOKKEEPING.iter().any(|word| {
            self.name
                .strip_prefix(word)
                .is_some_and(|rest| rest.is_empty() || *word == "measured" && rest.starts_with('_'))
        })
    }
}

/// A line split into fields.
struct Record {
    line: usize,
    fields: Vec<String>,
}

impl Measured {
    /// Reads CSV text.
    ///
    /// # Errors
    /// The first line and column that cannot be used, and why.
    pub fn read(text: &str, columns: &Columns) -> Result<Self, LibraryError> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let remarks = text.lines().filter_map(|l| l.trim().strip_prefix('#')).map(|l| l.trim().to_owned()).collect();
        let (separator, records) = split(text)?;
        let Some((head, body)) = records.split_first() else {
            return Err(LibraryError::Empty { reason: "the file has no line with the names of the columns.".into() });
        };
        let header = header(head)?;
        let width = find(&header, columns.width.as_deref().unwrap_or("width"))?;
        let height = find(&header, columns.height.as_deref().unwrap_or("height"))?;
        let inputs = match &columns.inputs {
            Some(names) => names.iter().map(|n| find(&header, n)).collect::<Result<Vec<_>, _>>()?,
            None => (0..header.len()).filter(|&i| i != width && i != height && !header[i].is_bookkeeping()).collect(),
        };
        check_roles(&header, &inputs, width, height, head.line)?;
        if body.is_empty() {
            return Err(LibraryError::Empty { reason: "no line with values follows the names of the columns.".into() });
        }
        let mut measured = Self { remarks, ..Self::default() };
        for record in body {
            if [width, height].iter().all(|i| record.fields.get(*i).is_some_and(String::is_empty)) {
                measured.unmeasured += 1;
                continue;
            }
            let reader = Cells { header: &header, record, decimal_comma: separator != ',' };
            measured.rows.push(inputs.iter().map(|&i| reader.number(i)).collect::<Result<_, _>>()?);
            measured.widths.push(reader.length(width)?);
            measured.heights.push(reader.length(height)?);
        }
        if measured.rows.is_empty() {
            return Err(LibraryError::Empty { reason: "no bead has a width and a height yet.".into() });
        }
        let range = |k: usize| {
            let values = || measured.rows.iter().map(|r| r[k]);
            (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max))
        };
        let ranges: Vec<_> = (0..inputs.len()).map(range).collect();
        let described = inputs.iter().zip(ranges).map(|(&i, (min, max))| {
            let Column { name, unit, .. } = &header[i];
            Input { name: name.clone(), unit: unit.clone(), min, max }
        });
        measured.inputs = described.collect();
        Ok(measured)
    }
}

/// Inputs, width and height must be different columns, and the lengths in mm.
fn check_roles(
    header: &[Column],
    inputs: &[usize],
    width: usize,
    height: usize,
    line: usize,
) -> Result<(), LibraryError> {
    let mut taken = inputs.to_vec();
    taken.extend([width, height]);
    for (k, i) in taken.iter().enumerate() {
        if taken[..k].contains(i) {
            return Err(LibraryError::Inputs {
                reason: format!("the column \"{}\" is named twice among inputs, width and height.", header[*i].header),
            });
        }
    }
    let foreign = |c: &&Column| !matches!(c.unit.as_str(), "mm" | "");
    if let Some(column) = [&header[width], &header[height]].into_iter().find(foreign) {
        let reason = format!("the bead is measured in mm, not in {}. Convert the column to mm.", column.unit);
        return Err(LibraryError::Cell { line, column: column.header.clone(), reason });
    }
    if inputs.is_empty() {
        return Err(LibraryError::Inputs {
            reason: "no column is left as an input: only width and height are present.".into(),
        });
    }
    Ok(())
}

/// Separator, and the lines that are neither empty nor comments.
fn split(text: &str) -> Result<(char, Vec<Record>), LibraryError> {
    let lines = || text.lines().enumerate().filter(|(_, l)| !l.trim().is_empty() && !l.trim_start().starts_with('#'));
    let separator = separator(lines().next().map_or("", |(_, l)| l));
    let records = lines().map(|(i, l)| Ok(Record { line: i + 1, fields: fields(l, separator, i + 1)? }));
    Ok((separator, records.collect::<Result<_, LibraryError>>()?))
}

/// The fields of a line, `number` of the file. A quoted field may hold separators; two quotes inside it stand for one.
pub(crate) fn fields(line: &str, separator: char, number: usize) -> Result<Vec<String>, LibraryError> {
    let (mut fields, mut field, mut quoted) = (Vec::new(), String::new(), false);
    let mut letters = line.chars().peekable();
    while let Some(letter) = letters.next() {
        match letter {
            '"' if quoted && letters.peek() == Some(&'"') => {
                letters.next();
                field.push('"');
            }
            '"' => quoted = !quoted,
            c if c == separator && !quoted => fields.push(std::mem::take(&mut field)),
            c => field.push(c),
        }
    }
    if quoted {
        return Err(LibraryError::Line { line: number, reason: "a quotation mark is not closed.".into() });
    }
    fields.push(field);
    Ok(fields.into_iter().map(|f| f.trim().to_owned()).collect())
}

fn header(head: &Record) -> Result<Vec<Column>, LibraryError> {
    let mut columns: Vec<Column> = Vec::new();
    for (i, field) in head.fields.iter().enumerate() {
        let (name, unit) = name_and_unit(field);
        let line = head.line;
        if name.is_empty() {
            return Err(LibraryError::Line { line, reason: format!("column {} has no name.", i + 1) });
        }
        if field.parse::<f64>().is_ok() {
            let reason = format!("{field} is where the name of a column belongs, such as current_a.");
            return Err(LibraryError::Line { line, reason });
        }
        if columns.iter().any(|c| c.name == name) {
            return Err(LibraryError::Line { line, reason: format!("two columns are named \"{name}\".") });
        }
        columns.push(Column { header: field.clone(), name, unit });
    }
    Ok(columns)
}

/// The column with a name, given with or without its unit.
fn find(header: &[Column], name: &str) -> Result<usize, LibraryError> {
    let bare = name_and_unit(name).0;
    header.iter().position(|c| c.header == name).or_else(|| header.iter().position(|c| c.name == bare)).ok_or_else(
        || LibraryError::Unknown {
            what: "column",
            name: name.to_owned(),
            known: header.iter().map(|c| c.header.as_str()).collect::<Vec<_>>().join(", "),
        },
    )
}

/// The values of one line.
struct Cells<'a> {
    header: &'a [Column],
    record: &'a Record,
    decimal_comma: bool,
}

impl Cells<'_> {
    fn number(&self, i: usize) -> Result<f64, LibraryError> {
        let (expect, found) = (self.header.len(), self.record.fields.len());
        if expect != found {
            let reason = format!("there are {found} values here, but the header names {expect} columns.");
            return Err(LibraryError::Line { line: self.record.line, reason });
        }
        let field = &self.record.fields[i];
        let text = if self.decimal_comma { field.replace(',', ".") } else { field.clone() };
        match text.parse::<f64>() {
            Ok(value) if value.is_finite() && value.abs() < 1e12 => Ok(value),
            _ if text.is_empty() => Err(self.refuse(i, "the value is missing.".into())),
            _ => Err(self.refuse(
                i,
                format!("\"{field}\" is not a number. To leave out a column that is not an input, name the inputs."),
            )),
        }
    }

    fn length(&self, i: usize) -> Result<f64, LibraryError> {
        let value = self.number(i)?;
        if value > 0.0 {
            Ok(value)
        } else {
            Err(self.refuse(i, format!("{value} mm is not the size of a bead: it must be above 0 mm.")))
        }
    }

    fn refuse(&self, i: usize, reason: String) -> LibraryError {
        LibraryError::Cell { line: self.record.line, column: self.header[i].header.clone(), reason }
    }
}

/// Whether `given`, with or without a unit, names `input`.
pub(super) fn is_named(input: &Input, given: &str) -> bool {
    input.name == given || input.name == name_and_unit(given).0
}
