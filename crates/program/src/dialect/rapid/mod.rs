//! ABB RAPID.

mod data;
mod module;
mod names;
mod read;
mod review;
mod section;
mod write;

pub use section::{Rapid, RapidArc, RapidModules, RapidSeam, WireFeedUnit};

use super::Dialect;

/// The row in the table of dialects.
pub const DIALECT: Dialect = Dialect {
    name: "rapid",
    language: "RAPID",
    module_extensions: &["mod"],
    linear_axis: true,
    table: true,
    positioner: true,
    typical: read::typical,
    read: read::read,
};
