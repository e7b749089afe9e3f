//! The record of a part: its plan joined with the logs of its build, as a page, a table and a file that shows later changes.
//!
//! [`bead_record`] aligns the logs, finds the pass of each arc and judges it.
//!
//! | file | what it holds |
//! | --- | --- |
//! | `planned` | layers and profile as planned passes with their times; the limits of a profile |
//! | `heights` | a scan of a layer as heights along its passes |
//! | `totals` | hours, wire, gas and cost, planned and recorded |
//! | `page` | `record.html` |
//! | `table` (feature `parquet`) | `record.parquet`, a row for each pass |
//! | `sealed` | `record.json` with its chain of hashes, and whether it still holds |
//! | `learnt` | what records say about the values of a profile |

mod heights;
mod learnt;
mod page;
mod planned;
mod sealed;
#[cfg(feature = "parquet")]
mod table;
mod totals;

pub use bead_record::*;
pub use heights::{HeightsError, Shown, heights, scannable};
pub use learnt::{AsWelded, Estimate, Learnt, Lesson, as_welded};
pub use planned::{planned, settings};
pub use sealed::{Broken, Sealed, other_inputs, verify};
pub use totals::Totals;

use crate::layer::Layer;
use crate::plan::Header;
use crate::profile::Profile;
use crate::robot::Frame;
use serde::Serialize;

/// Name of the file that holds the record with its hashes.
pub const JSON: &str = "record.json";
/// Name of its page.
pub const HTML: &str = "record.html";
/// Name of its table.
pub const PARQUET: &str = "record.parquet";

/// All that a record is written from.
#[derive(Debug, Clone, Copy)]
pub struct Part<'a> {
    /// Part, profile and strategy.
    pub header: &'a Header,
    /// The layers that were planned.
    pub layers: &'a [Layer],
    /// How they were to be welded.
    pub profile: &'a Profile,
    /// The passes that were planned.
    pub planned: &'a [PlannedPass],
    /// What was measured of them.
    pub record: &'a Record,
    /// Limits of the record.
    pub settings: &'a Settings,
    /// What else belongs to the part, such as the batch of the wire: name and value.
    pub trace: &'a [(String, String)],
    /// The scans that gave heights.
    pub scans: &'a [Scanned],
    /// Plan, logs and scans with their hashes.
    pub inputs: &'a [FileHash],
}

/// A scan that gave heights.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Scanned {
    /// Name of its file.
    pub file: String,
    /// Layer after which it was taken, from 1.
    pub after_layer: usize,
    /// How its points were moved from the coordinates of the scanner to those of the part; `None` if they were in the latter.
    pub part_from_scanner: Option<Moved>,
    /// What it shows.
    #[serde(flatten)]
    pub shown: Shown,
}

/// Where the frame of a scanner lies in that of the part.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Moved {
    /// Its origin, mm.
    pub position: [f64; 3],
    /// Its turns about z, the new y and the new x, °.
    pub rotation: [f64; 3],
}

impl From<Frame> for Moved {
    fn from(frame: Frame) -> Self {
        Self { position: frame.position.to_array(), rotation: frame.zyx() }
    }
}

/// Why the files of a record cannot be made.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FileError {
    /// A table cannot be made.
    #[cfg(feature = "parquet")]
    #[error("the table cannot be written: {0}")]
    Table(#[from] ::parquet::errors::ParquetError),
    /// Text cannot be made.
    #[error("the record cannot be written: {0}")]
    Json(#[from] serde_json::Error),
}

/// What belongs to a part, from TOML: each key with its value; those of tables after the name of the table.
///
/// # Errors
/// That of the parser.
pub fn trace(text: &str) -> Result<Vec<(String, String)>, toml::de::Error> {
    fn listed(table: &toml::Table, before: &str, found: &mut Vec<(String, String)>) {
        for (key, value) in table {
            let name = format!("{before}{key}");
            match value {
                toml::Value::Table(inner) => listed(inner, &format!("{name}."), found),
                toml::Value::String(text) => found.push((name, text.clone())),
                other => found.push((name, other.to_string())),
            }
        }
    }
    let mut found = Vec::new();
    listed(&text.parse()?, "", &mut found);
    Ok(found)
}

impl Part<'_> {
    /// What was welded and what is doubtful, in a sentence or two.
    pub fn summary(&self) -> String {
        page::lead(self)
    }

    /// The files of the record, by name.
    ///
    /// # Errors
    /// [`FileError`].
    pub fn files(&self) -> Result<Sealed, FileError> {
        let chained = sealed::Chained::of(self)?;
        let files = vec![
            (HTML.to_owned(), page::page(self, chained.last()).html().into_bytes()),
            #[cfg(feature = "parquet")]
            (PARQUET.to_owned(), table::table(self)?),
        ];
        Ok(chained.sealed(files)?)
    }
}
