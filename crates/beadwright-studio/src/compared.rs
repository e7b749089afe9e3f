//! A scan compared with a part, in the background.

use crate::disk;
use crate::jobs::Job;
use beadwright::adapt::scan::{self, Scan};
use beadwright::deviation::{Deviation, deviation};
use beadwright::model::Part;
use beadwright::task::Task;
use eframe::egui::Context;
use std::path::Path;
use std::sync::Arc;

/// A scan compared with a part.
pub struct Compared {
    /// The name of its file.
    pub name: String,
    pub(crate) scan: Arc<Scan>,
    /// The part and the machining allowance (mm) that it was compared with.
    pub(crate) with: (Arc<Part>, f64),
    /// How far it lies from the part.
    pub deviation: Deviation,
}

/// Reads a scan from its file, or returns one that is already read.
pub(crate) type Source = Box<dyn FnOnce() -> Result<Arc<Scan>, String> + Send>;

/// Compares a scan with a part.
pub(crate) fn compare(
    ctx: &Context,
    name: String,
    source: Source,
    with: (Arc<Part>, f64),
) -> Job<Result<Compared, String>> {
    Job::start(ctx, move || {
        let scan = source()?;
        let mesh = with.0.mesh().ok_or("a part given by curves has no surface to compare a scan with.")?;
        let compared = deviation(mesh, &scan.points, with.1, &Task::new());
        let deviation = compared.map_err(|error| format!("{name}: {error}"))?;
        Ok(Compared { name, scan, with, deviation })
    })
}

/// Reads a scan.
pub(crate) fn read(path: &Path) -> Result<Arc<Scan>, String> {
    let scan = scan::read(&disk::read(path)?, &Task::new());
    scan.map(Arc::new).map_err(|error| format!("{}: {error}", path.display()))
}
