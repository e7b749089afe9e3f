//! Printers' G-code.

mod section;
mod write;

pub use section::{Bed, BedOrigin, Marlin};

use super::Dialect;

/// The row in the table of dialects.
pub const DIALECT: Dialect = Dialect {
    name: "marlin",
    language: "G-code",
    module_extensions: &[],
    linear_axis: false,
    table: false,
    positioner: false,
    // A printer's file is recognised as G-code.
    typical: |_| false,
    read: super::gcode::DIALECT.read,
};
