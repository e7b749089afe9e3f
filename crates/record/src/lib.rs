//! What was welded, pass by pass: a plan joined with the logs of its build.
//!
//! [`Source::read`] reads logs as CSV. [`join`] aligns their clocks by the arc, which each of them sees begin and end, finds the
//! planned pass of each arc, and gives figures of each pass and what is doubtful, with its place. [`chain`](fn@chain) shows whether
//! rows were changed later. Nothing here knows of profiles or file formats other than CSV; all times are in seconds, all lengths in
//! mm.
//!
//! | file | what it holds |
//! | --- | --- |
//! | `quantity`, `time` | what logs measure, in which units; how they write times |
//! | `source` | a log, read from CSV; doubled and late rows; runs between which the clock was set or rows are missing |
//! | `arc` | when the arc burned, as a log shows it |
//! | `sequence` | two sequences of arcs brought together |
//! | `clock`, `aligned` | clocks aligned by the arc: offsets, drift, where they were set |
//! | `planned` | what was planned: passes with their path in space and time |
//! | `welded` | which arcs belong to which pass, and where the torch was |
//! | `figures` | what was measured during a pass, stretches out of their window |
//! | `height` | heights of passes from scans, added to it |
//! | `record`, `join` | [`Record`]: all of it joined |
//! | `judge`, `finding` | what is doubtful, in sentences |
//! | `chain` | hashes of rows and files |

mod aligned;
mod arc;
mod chain;
mod clock;
mod error;
mod figures;
mod finding;
mod height;
mod join;
mod judge;
mod planned;
mod quantity;
mod record;
mod sequence;
mod settings;
mod source;
mod time;
mod welded;

pub use arc::Span;
pub use chain::{FileHash, chain, link, sha256};
pub use clock::Trust;
pub use error::RecordError;
pub use figures::Measured;
pub use finding::{Finding, Kind};
pub use height::{Heights, Top};
pub use join::join;
pub use planned::{Place, PlannedPass, Spot};
pub use quantity::Quantity;
pub use record::{Log, PassRow, Record};
pub use settings::Settings;
pub use source::{Event, MOST_ROWS, Source, Tally, What};
