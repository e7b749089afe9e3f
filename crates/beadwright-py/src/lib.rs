//! The core of the Python package `beadwright`: the library's values and long calls, as Python sees them.
//!
//! | file | what it does |
//! | --- | --- |
//! | `array` | the library's numbers as arrays that are not copied |
//! | `running` | long calls: without the interpreter's lock, with progress, ended by Ctrl-C |
//! | `error` | errors of the library as `BeadwrightError`, with place and remedy |
//! | `part`, `profile` | what is planned, and how |
//! | `plan`, `layer` | the plan, its layers and passes |
//! | `save` | the files of a plan, byte for byte those of the command |
//!
//! Files are read by the Python around it (`python/beadwright`), which is also what users see; no name here is meant for them.

mod array;
mod error;
mod layer;
mod part;
mod plan;
mod profile;
mod running;
mod save;

use pyo3::prelude::*;

#[pymodule]
mod _core {
    #[pymodule_export]
    use crate::array::Array;
    #[pymodule_export]
    use crate::layer::{Layer, Pass};
    #[pymodule_export]
    use crate::part::Part;
    #[pymodule_export]
    use crate::plan::{Plan, plan};
    #[pymodule_export]
    use crate::profile::{Profile, profile_names, strategy_names};

    /// Version of the library.
    #[pymodule_export]
    const VERSION: &str = env!("CARGO_PKG_VERSION");
}
