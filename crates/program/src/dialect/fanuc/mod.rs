//! FANUC TP.

mod read;
mod section;
mod write;

pub use section::{Fanuc, FanucSpeed};

use super::Dialect;

/// The row in the table of dialects.
pub const DIALECT: Dialect = Dialect {
    name: "fanuc",
    language: "FANUC TP",
    module_extensions: &["ls"],
    linear_axis: false,
    table: true,
    positioner: true,
    typical: read::typical,
    read: read::read,
};
