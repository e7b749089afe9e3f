//! Scans that commands read, moved to where they lie on the part.

use crate::{file, reach};
use anyhow::Context;
use beadwright::adapt::Scan;
use beadwright::adapt::scan;
use beadwright::robot::{Frame, cell};
use beadwright::task::Task;
use std::path::{Path, PathBuf};

/// Where a scanner stands.
#[derive(clap::Args)]
pub(crate) struct Scanner {
    /// The scan is in the coordinates of the scanner: the cell that says where the scanner (`calibrate scanner --write`) and the part are.
    /// The part must have been scanned with turn table and linear axis at 0. Without it, the scan must be in the coordinates of the part.
    #[arg(long, value_name = "CELL.toml")]
    scanner: Option<String>,
}

/// The frame of the scanner in that of the part; none if scans are in the coordinates of the part.
pub(crate) struct Place(pub(crate) Option<Frame>);

impl Scanner {
    /// The file of the cell, if one is given.
    pub(crate) fn file(&self) -> Option<PathBuf> {
        self.scanner.as_ref().map(PathBuf::from)
    }

    /// Where the cell puts scans.
    pub(crate) fn place(&self) -> anyhow::Result<Place> {
        let Some(name) = &self.scanner else { return Ok(Place(None)) };
        let frame = reach::load_cell(name)?.part_from_scanner().with_context(|| without_scanner(name))?;
        Ok(Place(Some(frame)))
    }

    /// The scan in a file; its unit, if the file does not give it, has this many mm.
    pub(crate) fn read(&self, path: &Path, millimetres: f64, task: &Task) -> anyhow::Result<Scan> {
        self.place()?.read(path, millimetres, task)
    }
}

impl Place {
    /// The scan in a file; its unit, if the file does not give it, has this many mm.
    pub(crate) fn read(&self, path: &Path, millimetres: f64, task: &Task) -> anyhow::Result<Scan> {
        let mut scan = scan::read(&file::read(path)?, task).with_context(|| path.display().to_string())?;
        let moved = |point| self.0.map_or(point, |frame| frame.apply(point));
        scan.points.iter_mut().for_each(|point| *point = moved(*point * millimetres));
        Ok(scan)
    }
}

/// What to do with a cell that has no scanner.
fn without_scanner(name: &str) -> String {
    let calibrate = |cell: &str| format!("`beadwright calibrate scanner TARGETS.csv --write {cell}`");
    if cell::BUILT_IN.iter().any(|(built_in, _)| *built_in == name) {
        format!(
            "{name}: the built-in cell has no [scanner]. Save it with `beadwright reach --show {name} > cell.toml`, write the scanner into \
             it with {}, and give --scanner cell.toml.",
            calibrate("cell.toml")
        )
    } else {
        format!("{name}: the cell has no [scanner]. Write it with {}.", calibrate(name))
    }
}
