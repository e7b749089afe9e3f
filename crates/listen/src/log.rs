//! The log: rows of CSV, written line by line, so that whatever ends this program leaves whole lines.

use crate::error::ListenError;
use crate::source::{Column, Source, TIME};
use std::collections::HashSet;
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufRead, BufReader, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// A log being written.
pub(crate) struct Log {
    path: PathBuf,
    file: File,
    columns: Vec<Column>,
    /// Time of the last row, as it was written.
    last: Option<String>,
    /// The last lines of an earlier time of listening.
    earlier: HashSet<Vec<u8>>,
    /// An event that gets the time of the next row.
    waiting: Option<[String; 2]>,
    /// Whether an earlier time of listening has ended, which is said once there is a row.
    is_continued: bool,
    rows: u64,
    dirty: bool,
}

/// The end of the last whole line is looked for in this many bytes.
const TAIL: u64 = 1 << 16;

impl Log {
    /// Begins the log of a source, or goes on with it.
    pub(crate) fn open(source: &Source, folder: &Path) -> Result<Self, ListenError> {
        let path = folder.join(format!("{}.csv", source.name));
        let error = |reason: String| ListenError::Log { path: path.clone(), reason };
        let titles = [TIME].into_iter().chain(source.columns.iter().map(|column| column.title.as_str()));
        let header = line(titles).map_err(|why| error(why.to_string()))?;
        fs::create_dir_all(folder).map_err(|why| error(why.to_string()))?;
        let (file, lines) = opened(&path, &header).map_err(|why| error(why.to_string()))?;
        let time = lines.last().and_then(|line| line.split(|byte| *byte == b',').next());
        let last = time.map(|time| String::from_utf8_lossy(time).into_owned());
        let earlier = lines.into_iter().collect();
        let columns = source.columns.clone();
        let is_continued = last.is_some();
        Ok(Self { path, file, columns, last, earlier, waiting: None, is_continued, rows: 0, dirty: true })
    }

    /// Whether an earlier time of listening ended with such a row.
    pub(crate) fn has(&self, time: &str, cells: &[String]) -> bool {
        let whole = [time].into_iter().chain(cells.iter().map(String::as_str));
        line(whole).is_ok_and(|line| self.earlier.contains(line.trim_ascii_end()))
    }

    /// Adds a row; cells are those of the columns, in order.
    pub(crate) fn row(&mut self, time: &str, cells: &[String]) -> Result<(), ListenError> {
        let mut bytes = Vec::new();
        if std::mem::take(&mut self.is_continued) {
            let last = self.last.as_deref().unwrap_or(time);
            bytes = self.said(last, "interrupted", "Listening was stopped.")?;
            bytes.extend(self.said(time, "resumed", "Listening began again.")?);
        }
        if let Some([event, note]) = self.waiting.take() {
            bytes.extend(self.said(time, &event, &note)?);
        }
        let whole = [time].into_iter().chain(cells.iter().map(String::as_str));
        bytes.extend(line(whole).map_err(|why| self.error(&why))?);
        self.last = Some(time.to_owned());
        self.rows += 1;
        self.write(&bytes)
    }

    /// Says that the connection was lost, at the time of the last row. Without any row, nothing is missing.
    pub(crate) fn interrupted(&mut self, note: &str) -> Result<(), ListenError> {
        // A connection that is lost again before anything was heard is the same interruption.
        if self.waiting.take().is_some() {
            return Ok(());
        }
        self.event("interrupted", note)
    }

    /// Says that it was made again, at the time of the next row.
    pub(crate) fn resumed(&mut self, note: &str) {
        if self.last.is_some() && !self.is_continued {
            self.waiting = Some(["resumed".to_owned(), note.to_owned()]);
        }
    }

    /// Adds an event at the time of the last row, if listening has written one: a start that fails leaves the log as it is.
    pub(crate) fn event(&mut self, event: &str, note: &str) -> Result<(), ListenError> {
        let Some(time) = self.last.clone().filter(|_| !self.is_continued) else { return Ok(()) };
        let bytes = self.said(&time, event, note)?;
        self.write(&bytes)
    }

    /// Rows so far, without the events of the listener.
    pub(crate) fn rows(&self) -> u64 {
        self.rows
    }

    /// The file.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Makes what was written safe from a power cut.
    pub(crate) fn sync(&mut self) -> Result<(), ListenError> {
        if std::mem::take(&mut self.dirty) {
            self.file.sync_data().map_err(|why| self.error(&why))?;
        }
        Ok(())
    }

    /// A row with an event of the listener.
    fn said(&self, time: &str, event: &str, note: &str) -> Result<Vec<u8>, ListenError> {
        let cell = |column: &Column| match column.name.as_str() {
            "event" => event.to_owned(),
            "note" => note.to_owned(),
            _ => String::new(),
        };
        let cells: Vec<String> = [time.to_owned()].into_iter().chain(self.columns.iter().map(cell)).collect();
        line(cells.iter().map(String::as_str)).map_err(|why| self.error(&why))
    }

    /// Writes whole lines in one piece.
    fn write(&mut self, bytes: &[u8]) -> Result<(), ListenError> {
        self.dirty = true;
        self.file.write_all(bytes).map_err(|why| self.error(&why))
    }

    fn error(&self, why: &dyn std::fmt::Display) -> ListenError {
        ListenError::Log { path: self.path.clone(), reason: format!("the log cannot be written: {why}") }
    }
}

/// A line of CSV.
fn line<'a>(cells: impl Iterator<Item = &'a str>) -> Result<Vec<u8>, csv::Error> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(cells)?;
    writer.into_inner().map_err(|why| why.into_error().into())
}

/// Opens a log to be gone on with, and its last lines. What follows its last whole line is cut off.
fn opened(path: &Path, header: &[u8]) -> io::Result<(File, Vec<Vec<u8>>)> {
    // Not for appending: Windows would then not let us cut it.
    let mut file = OpenOptions::new().read(true).write(true).create(true).truncate(false).open(path)?;
    let length = file.metadata()?.len();
    let mut first = Vec::new();
    BufReader::new(&file).take(TAIL).read_until(b'\n', &mut first)?;
    if !first.ends_with(b"\n") && header.starts_with(&first) {
        file.set_len(0)?;
        file.seek(SeekFrom::Start(0))?;
        file.write_all(header)?;
        return Ok((file, Vec::new()));
    }
    if first != header {
        return Err(io::Error::other("the log has other columns than the source names. Give another folder."));
    }
    let from = length.saturating_sub(TAIL).max(first.len() as u64);
    file.seek(SeekFrom::Start(from))?;
    let mut tail = Vec::new();
    file.read_to_end(&mut tail)?;
    let whole = tail.iter().rposition(|byte| *byte == b'\n').map_or(0, |at| at + 1);
    file.set_len(from + whole as u64)?;
    file.seek(SeekFrom::End(0))?;
    let lines = tail[..whole].split(|byte| *byte == b'\n').map(<[u8]>::trim_ascii_end);
    Ok((file, lines.filter(|line| !line.is_empty()).map(<[u8]>::to_vec).collect()))
}
