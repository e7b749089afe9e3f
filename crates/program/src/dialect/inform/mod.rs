//! Yaskawa INFORM.

mod read;
mod section;
mod write;

pub use section::{Inform, InformSpeed};

use super::Dialect;

/// The row in the table of dialects.
pub const DIALECT: Dialect = Dialect {
    name: "inform",
    language: "INFORM",
    module_extensions: &["jbi"],
    linear_axis: false,
    table: true,
    positioner: true,
    typical: read::typical,
    read: read::read,
};
