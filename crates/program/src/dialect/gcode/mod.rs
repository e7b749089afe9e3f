//! CNC G-code.

mod block;
mod branches;
mod control;
mod hints;
mod positioner;
mod read;
mod review;
mod section;
pub(super) mod write;

pub use control::GcodeControl;
pub use positioner::GcodePositioner;
pub use section::{Gcode, GcodeComments};

use super::Dialect;

/// The row in the table of dialects.
pub const DIALECT: Dialect = Dialect {
    name: "gcode",
    language: "G-code",
    module_extensions: &[],
    linear_axis: false,
    table: false,
    positioner: true,
    typical: read::typical,
    read: read::read,
};
