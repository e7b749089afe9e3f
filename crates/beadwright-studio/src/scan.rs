//! The scan in the window: opened, compared with the part in view, closed.

use crate::compared::{Compared, compare, read};
use crate::jobs::{self, Job};
use crate::known::Known;
use crate::studio::Studio;
use crate::view::Mode;
use crate::view3d::Scanned;
use beadwright::model::Part;
use std::path::Path;
use std::sync::Arc;

impl Studio {
    /// Compares a scan with the part, as soon as the part is placed.
    pub fn open_scan(&mut self, path: &Path) {
        self.jobs.scan_wanted = Some(path.to_owned());
        self.view.scan = true;
        self.view.switch(Mode::Solid);
    }

    /// Closes the scan.
    pub(crate) fn close_scan(&mut self) {
        (self.jobs.scan, self.jobs.scan_job, self.jobs.scan_wanted) = (None, None, None);
        self.plans.own.show_stock();
    }

    /// The scan, if it has been compared with the part in view.
    pub fn scan(&self) -> Option<&Compared> {
        self.known().scan()
    }

    /// The part that a scan can be compared with, and its machining allowance, mm.
    fn scannable(&self) -> Option<(Arc<Part>, f64)> {
        let own = &self.plans.own;
        let part = own.part.clone().filter(|part| part.mesh().is_some())?;
        Some((part, own.profile.as_ref()?.fill.machining_allowance))
    }

    /// Takes what was compared; compares a new scan, or the open one after the part or its allowance has changed.
    pub(crate) fn hear_of_scan(&mut self) {
        match jobs::take(&mut self.jobs.scan_job) {
            Some(Ok(Ok(compared))) => {
                let (scan, distances) = (&compared.scan, &compared.deviation.distances);
                self.plans.own.scene.set_scan(Scanned::new(&scan.points, &scan.triangles, distances));
                self.jobs.scan = Some(compared);
            }
            Some(Ok(Err(error)) | Err(error)) => {
                self.close_scan();
                self.complain(error);
            }
            None => {}
        }
        match self.scannable() {
            Some(with) if self.jobs.scan_job.is_none() => self.jobs.scan_job = self.next_scan(with),
            None if self.jobs.scan_wanted.is_some() && !self.plans.own.is_busy() => {
                self.jobs.scan_wanted = None;
                self.complain(self.t("scan-needs-part"));
            }
            _ => {}
        }
    }

    /// What is to be compared next, if anything is.
    fn next_scan(&mut self, with: (Arc<Part>, f64)) -> Option<Job<Result<Compared, String>>> {
        if let Some(path) = self.jobs.scan_wanted.take() {
            let name = path.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
            return Some(compare(&self.window.ctx, name, Box::new(move || read(&path)), with));
        }
        let open = self.jobs.scan.as_ref()?;
        let same = Arc::ptr_eq(&open.with.0, &with.0) && open.with.1 == with.1 && self.scan().is_some();
        let (name, scan) = (open.name.clone(), open.scan.clone());
        (!same).then(|| compare(&self.window.ctx, name, Box::new(|| Ok(scan)), with))
    }
}

impl<'a> Known<'a> {
    /// The scan, if it has been compared with the part in view.
    pub(crate) fn scan(self) -> Option<&'a Compared> {
        let own = &self.plans.own;
        let (part, _) = (own.part.as_ref()?, own.scene.scan()?);
        self.jobs.scan.as_ref().filter(|scan| Arc::ptr_eq(&scan.with.0, part))
    }

    /// Whether the part in view is a preform, and no scan is open.
    pub(crate) fn has_stock(self) -> bool {
        let is_preform = self.plans.own.part.as_deref().is_some_and(|part| part.milled().is_some());
        is_preform && self.jobs.scan.is_none()
    }
}
