//! A log: rows in time, with the quantities that they measure and the events that they tell.
//!
//! A CSV file whose first line names the columns; a name ends in its unit (`current_a`) or carries it in brackets
//! (`current (A)`). `time` (or `timestamp`) holds seconds, milliseconds or ISO 8601. `event` with `layer`, `pass` and `note`
//! tells what a controller did and what its operator noted. `order` brings the rows in order.

mod order;

pub use order::Tally;
pub(crate) use order::longest_step;

use crate::error::RecordError;
use crate::quantity::Quantity;
use crate::time::{Style, number};
use bead_part::text::table::{name_and_unit, separator};
use csv::ByteRecord;
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io::BufRead;
use std::ops::Range;

/// Rows that a log may have.
pub const MOST_ROWS: usize = 200_000_000;

/// The mark with which some programs begin UTF-8.
const MARK: &[u8] = b"\xef\xbb\xbf";

/// Names of the column with the times.
const TIMES: [&str; 4] = ["time", "timestamp", "t", "date_time"];

/// Broken rows are reported up to this fraction of all, or this number, and refused beyond.
const BROKEN: (f64, usize) = (0.01, 10);

/// What happened at a time.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum What {
    /// The arc was switched on.
    ArcOn,
    /// The arc was switched off.
    ArcOff,
    /// The program began a pass.
    PassStart,
    /// It ended one.
    PassEnd,
    /// The log lost the connection to what it logs; the note says why.
    Interrupted,
    /// Anything else, in the words of the log.
    Other(String),
}

impl What {
    fn of(word: &str) -> Self {
        match word.to_lowercase().replace([' ', '-'], "_").as_str() {
            "arc_on" | "arc_start" => Self::ArcOn,
            "arc_off" | "arc_end" => Self::ArcOff,
            "pass_start" | "pass_begin" => Self::PassStart,
            "pass_end" => Self::PassEnd,
            "interrupted" => Self::Interrupted,
            _ => Self::Other(word.to_owned()),
        }
    }
}

/// An event in a row.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Event {
    /// What happened.
    pub what: What,
    /// Layer and pass, from 1, where the row names them.
    pub pass: Option<(usize, usize)>,
    /// What the operator noted; mostly empty.
    pub note: String,
}

/// A log in the order of its own clock.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Source {
    /// Its name, that of the file.
    pub name: String,
    /// Whether its times have a date, and are seconds since 1970.
    pub dated: bool,
    /// Time of each row by the clock of the log, s. They do not decrease within a run.
    pub times: Vec<f64>,
    /// The value of each quantity in each row; NaN where the cell is empty.
    pub columns: Vec<(Quantity, Vec<f32>)>,
    /// The events, by row.
    pub events: BTreeMap<usize, Event>,
    /// The first row of each run: the clock was set, or rows are missing before it. Begins with 0.
    pub runs: Vec<usize>,
    /// What was found wrong with the rows.
    pub tally: Tally,
}

impl Source {
    /// Reads a log. `called` gives columns other names, such as `current` for `I_ist`.
    ///
    /// ```
    /// use bead_record::{Quantity, Source};
    ///
    /// let text = "time (ms);I (A)\n0;0,5\n10;181,2\n";
    /// let source = Source::read("power.csv", text.as_bytes(), &[])?;
    /// assert_eq!((source.times[1], source.column(Quantity::Current)), (0.01, Some(&[0.5, 181.2][..])));
    /// # Ok::<(), bead_record::RecordError>(())
    /// ```
    ///
    /// # Errors
    /// [`RecordError`], which names the line.
    pub fn read(name: &str, mut text: impl BufRead, called: &[(Quantity, String)]) -> Result<Self, RecordError> {
        if text.fill_buf().is_ok_and(|start| start.starts_with(MARK)) {
            text.consume(MARK.len());
        }
        let between = {
            let start = text.fill_buf().map_err(|error| read_error(0, &error))?;
            let lines = start.split(|byte| *byte == b'\n').map(String::from_utf8_lossy);
            let head = lines.into_iter().find(|line| !line.trim().is_empty() && !line.starts_with('#'));
            separator(&head.unwrap_or(Cow::Borrowed("")))
        };
        let mut rows = csv::ReaderBuilder::new()
            .delimiter(between as u8)
            .comment(Some(b'#'))
            .flexible(true)
            .has_headers(false)
            .trim(csv::Trim::All)
            .from_reader(text);
        let mut row = ByteRecord::new();
        if !next(&mut rows, &mut row)? {
            return Err(RecordError::Empty("the file has no line with the names of the columns."));
        }
        let line = row.position().map_or(1, csv::Position::line);
        let header = Header::of(&row, called).map_err(|reason| RecordError::Header { line, reason })?;
        let mut log = Reader::new(header, between != ',');
        while next(&mut rows, &mut row)? {
            log.take(&row)?;
        }
        log.finish(name)
    }

    /// The values of a quantity, one for each row.
    pub fn column(&self, quantity: Quantity) -> Option<&[f32]> {
        self.columns.iter().find(|(own, _)| *own == quantity).map(|(_, values)| &values[..])
    }

    /// The rows of each run.
    pub fn run_rows(&self) -> impl Iterator<Item = Range<usize>> + '_ {
        let ends = self.runs.iter().skip(1).copied().chain([self.times.len()]);
        self.runs.iter().zip(ends).map(|(begin, end)| *begin..end)
    }
}

fn read_error(line: u64, error: &dyn std::fmt::Display) -> RecordError {
    RecordError::Read { line, reason: error.to_string() }
}

fn next<R: BufRead>(rows: &mut csv::Reader<R>, row: &mut ByteRecord) -> Result<bool, RecordError> {
    rows.read_byte_record(row).map_err(|error| read_error(rows.position().line(), &error))
}

/// Where the header puts what is read.
struct Header {
    time: (usize, String),
    /// Quantity, column, scale and shift.
    quantities: Vec<(Quantity, usize, (f64, f64))>,
    event: Option<usize>,
    layer: Option<usize>,
    pass: Option<usize>,
    note: Option<usize>,
}

impl Header {
    fn of(row: &ByteRecord, called: &[(Quantity, String)]) -> Result<Self, String> {
        let cells: Vec<String> = row.iter().map(|cell| text(cell).into_owned()).collect();
        let columns: Vec<(String, String)> = cells.iter().map(|cell| name_and_unit(cell)).collect();
        let find = |names: &[&str]| columns.iter().position(|(name, _)| names.contains(&name.as_str()));
        let Some(time) = find(&TIMES) else {
            return Err(format!("no column is named time. The header names {}.", cells.join(", ")));
        };
        let mut quantities: Vec<(Quantity, usize, (f64, f64))> = Vec::new();
        for (at, (name, unit)) in columns.iter().enumerate() {
            let other = called.iter().find(|(_, other)| cells[at] == *other || *other == *name).map(|(own, _)| *own);
            // A column that was named takes the place of one with the usual name.
            let usual = || Quantity::named(name).filter(|usual| called.iter().all(|(own, _)| own != usual));
            let Some(quantity) = other.or_else(usual) else { continue };
            let Some(scale) = quantity.from_unit(unit) else {
                return Err(format!("column \"{}\": {} in {unit} is not understood.", cells[at], quantity.word()));
            };
            if quantities.iter().any(|(own, ..)| *own == quantity) {
                return Err(format!("two columns hold the {}: leave one out.", quantity.word()));
            }
            quantities.push((quantity, at, scale));
        }
        let [event, layer, pass, note] =
            [["event"; 2], ["layer"; 2], ["pass"; 2], ["note", "remarks"]].map(|names| find(&names));
        if quantities.is_empty() && event.is_none() && note.is_none() {
            let known = Quantity::ALL.map(Quantity::name).join(", ");
            return Err(format!(
                "no column is known. Known: {known}, event, layer, pass, note. The header names {}.",
                cells.join(", ")
            ));
        }
        Ok(Self { time: (time, columns[time].1.clone()), quantities, event, layer, pass, note })
    }
}

fn text(cell: &[u8]) -> Cow<'_, str> {
    String::from_utf8_lossy(cell)
}

/// A log being read.
struct Reader {
    header: Header,
    decimal_comma: bool,
    style: Option<Style>,
    source: Source,
    rows: usize,
    first_broken: Option<(u64, String)>,
}

impl Reader {
    fn new(header: Header, decimal_comma: bool) -> Self {
        let columns = header.quantities.iter().map(|(quantity, ..)| (*quantity, Vec::new())).collect();
        let source = Source { columns, ..Source::default() };
        Self { header, decimal_comma, style: None, source, rows: 0, first_broken: None }
    }

    fn take(&mut self, row: &ByteRecord) -> Result<(), RecordError> {
        if row.iter().all(<[u8]>::is_empty) {
            return Ok(());
        }
        self.rows += 1;
        if self.rows > MOST_ROWS {
            return Err(RecordError::TooLong(MOST_ROWS));
        }
        if let Err(reason) = self.values(row) {
            self.source.tally.broken += 1;
            self.first_broken.get_or_insert((row.position().map_or(0, csv::Position::line), reason));
        }
        Ok(())
    }

    /// Takes a row whole or not at all.
    fn values(&mut self, row: &ByteRecord) -> Result<(), String> {
        let cell = |at: usize| row.get(at).and_then(|cell| std::str::from_utf8(cell).ok()).unwrap_or_default();
        let time = cell(self.header.time.0);
        let style = match self.style {
            Some(style) => style,
            None => *self.style.insert(Style::of(time, &self.header.time.1)?),
        };
        let seconds = style.seconds(time, self.decimal_comma).ok_or_else(|| format!("\"{time}\" is not a time."))?;
        let mut values = [f32::NAN; Quantity::ALL.len()];
        for ((quantity, at, (scale, shift)), value) in self.header.quantities.iter().zip(&mut values) {
            let word = cell(*at);
            if !word.is_empty() {
                let read = if *quantity == Quantity::Arc { switch(word) } else { None };
                let number = read.or_else(|| number(word, self.decimal_comma));
                let number = number.ok_or_else(|| format!("\"{word}\" is not a number ({}).", quantity.word()))?;
                *value = (scale * number + shift) as f32;
            }
        }
        let event = self.event(&|at| row.get(at).map(text).unwrap_or_default());
        self.source.events.extend(event.map(|event| (self.source.times.len(), event)));
        self.source.times.push(seconds);
        self.source.columns.iter_mut().zip(values).for_each(|((_, column), value)| column.push(value));
        Ok(())
    }

    fn event<'a>(&self, cell: &dyn Fn(usize) -> Cow<'a, str>) -> Option<Event> {
        let word = |at: Option<usize>| at.map(cell).unwrap_or_default();
        let (what, note) = (word(self.header.event), word(self.header.note));
        if what.is_empty() && note.is_empty() {
            return None;
        }
        let count = |at| word(at).parse::<usize>().ok();
        let pass = count(self.header.layer).zip(count(self.header.pass));
        Some(Event { what: What::of(&what), pass, note: note.into_owned() })
    }

    fn finish(self, name: &str) -> Result<Source, RecordError> {
        let Self { mut source, rows, first_broken, .. } = self;
        let broken = source.tally.broken;
        if let Some((line, reason)) = first_broken
            && (source.times.is_empty() || broken > BROKEN.1.max((BROKEN.0 * rows as f64) as usize))
        {
            return Err(RecordError::Rows { broken, rows, line, reason });
        }
        if source.times.is_empty() {
            return Err(RecordError::Empty("no row follows the names of the columns."));
        }
        source.name = name.to_owned();
        source.dated = self.style == Some(Style::Iso);
        source.tally.rows = rows;
        source.times.shrink_to_fit();
        source.columns.iter_mut().for_each(|(_, values)| values.shrink_to_fit());
        order::clean(&mut source);
        Ok(source)
    }
}

/// A word that says whether something is on.
fn switch(word: &str) -> Option<f64> {
    match word.to_lowercase().as_str() {
        "on" | "true" | "yes" => Some(1.0),
        "off" | "false" | "no" => Some(0.0),
        _ => None,
    }
}
