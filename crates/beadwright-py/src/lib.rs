//! The core of the Python package `beadwright`: the library's values and long calls, as Python sees them.
//!
//! | file | what it does |
//! | --- | --- |
//! | `array` | the library's numbers as arrays that are not copied |
//! | `running` | long calls: without the interpreter's lock, with progress, ended by Ctrl-C |
//! | `error` | errors of the library as `BeadwrightError`, with place and remedy |
//! | `part`, `profile` | what is planned, and how |
//! | `plan`, `planned`, `layer` | the plan, what it holds, its layers and passes |
//! | `save` | the files of a plan, byte for byte those of the command |
//! | `program` | programs from any source, read back as layers |
//! | `judge` | what layers would build: height fields, comparisons |
//! | `scan`, `build` | scans compared with the part and followed by layers; plans welded in the height model |
//! | `heat`, `distort`, `reach` | how warm the metal becomes, how it bends, and whether a robot can weld it |
//! | `bead_library` | measured beads |
//!
//! Files are read by the Python around it (`python/beadwright`), which is also what users see; no name here is meant for them.

mod array;
mod bead_library;
mod build;
mod distort;
mod error;
mod heat;
mod judge;
mod layer;
mod part;
mod plan;
mod planned;
mod profile;
mod program;
mod reach;
mod running;
mod save;
mod scan;

use pyo3::prelude::*;

#[pymodule]
mod _core {
    #[pymodule_export]
    use crate::array::Array;
    #[pymodule_export]
    use crate::bead_library::{BeadLibrary, demonstration_csv};
    #[pymodule_export]
    use crate::build::{Builds, build};
    #[pymodule_export]
    use crate::distort::{Distortion, distort};
    #[pymodule_export]
    use crate::heat::{Heat, heat};
    #[pymodule_export]
    use crate::judge::{Judged, compare, height_field, judge, page};
    #[pymodule_export]
    use crate::layer::{Layer, Pass};
    #[pymodule_export]
    use crate::part::{Part, example_names, example_stl};
    #[pymodule_export]
    use crate::plan::{Plan, plan};
    #[pymodule_export]
    use crate::profile::{Profile, profile_names, strategy_names};
    #[pymodule_export]
    use crate::program::{faults, language, may_be_module, named_profile, simulate};
    #[pymodule_export]
    use crate::reach::{Reach, cell_names, cell_text, reach};
    #[pymodule_export]
    use crate::scan::{Adapted, Deviation, Scan, adapt, built_deviation, deviation};

    /// Version of the library.
    #[pymodule_export]
    const VERSION: &str = env!("CARGO_PKG_VERSION");
}
