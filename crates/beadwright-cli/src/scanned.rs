//! Scans that commands read, moved to where they lie on the part.

use crate::{file, reach};
use anyhow::Context;
use beadwright::adapt::Scan;
use beadwright::adapt::scan;
use beadwright::task::Task;
use std::path::Path;

/// Where a scanner stands.
#[derive(clap::Args)]
pub(crate) struct Scanner {
    /// The scan is in the coordinates of the scanner: the cell with the places of scanner (`calibrate scanner --write`) and part. Left
    /// out, it is in those of the part.
    #[arg(long, value_name = "CELL.toml")]
    scanner: Option<String>,
}

impl Scanner {
    /// The scan in a file; its unit, if the file does not give it, has this many mm.
    pub(crate) fn read(&self, path: &Path, millimetres: f64, task: &Task) -> anyhow::Result<Scan> {
        let mut scan = scan::read(&file::read(path)?, task).with_context(|| path.display().to_string())?;
        scan.points.iter_mut().for_each(|point| *point *= millimetres);
        let Some(name) = &self.scanner else { return Ok(scan) };
        let frame = reach::load_cell(name)?.part_from_scanner().with_context(|| {
            format!("{name}: the cell has no [scanner]. Write it with `beadwright calibrate scanner TARGETS.csv --write {name}`.")
        })?;
        scan.points.iter_mut().for_each(|point| *point = frame.apply(*point));
        Ok(scan)
    }
}
