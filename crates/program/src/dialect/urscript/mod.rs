//! URScript of Universal Robots.

mod read;
mod section;
mod write;

pub use section::Urscript;

use super::Dialect;

/// The row in the table of dialects.
pub const DIALECT: Dialect = Dialect {
    name: "urscript",
    language: "URScript",
    module_extensions: &[],
    linear_axis: false,
    table: false,
    positioner: true,
    typical: read::typical,
    read: read::read,
};
