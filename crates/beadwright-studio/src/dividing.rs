//! Divisions of the part in the window: looked for, shown in 3-D, used, given up.

use crate::computing::Computing;
use crate::directions::{Dividing, Way, Ways};
use crate::known::Known;
use crate::studio::Studio;
use crate::view::{Mode, ViewState};
use crate::view3d::Scanned;
use beadwright::profile::{Profile, edit};
use beadwright::task::{Stage, Task};
use std::sync::Arc;

/// What a step that divides the part is about.
const BODIES: &str = "layers.bodies";

impl Studio {
    /// Looks for divisions of the part.
    pub(crate) fn begin_directions(&mut self) {
        self.stop_directions();
        let (Some(part), Some(profile)) = (self.plans.own.part.clone(), without_bodies(&self.project().profile)) else {
            return;
        };
        let (name, of_job) = (self.project().part(), (part.clone(), profile.clone()));
        let work = move |task: &Task| Ways::of(&name, &of_job.0, &of_job.1, task);
        let run = Computing::start(&self.window.ctx, Stage::Directions, work);
        self.jobs.dividing = Some(Dividing { part, profile, run });
    }

    /// Forgets what was found, or gives up looking for it.
    pub(crate) fn stop_directions(&mut self) {
        (self.jobs.dividing, self.view.division) = (None, None);
    }

    /// Forgets what was found with another profile.
    pub(crate) fn keep_directions(&mut self) {
        let Some(dividing) = &self.jobs.dividing else { return };
        if without_bodies(&self.project().profile).as_ref() != Some(&dividing.profile) {
            self.stop_directions();
        }
    }

    /// Takes what was found, and shows the chosen division in 3-D.
    pub(crate) fn hear_of_directions(&mut self) {
        if let Some(dividing) = &mut self.jobs.dividing {
            dividing.run.hear();
            // Another part may be in view.
            let own = &self.plans.own;
            if own.part.as_ref().is_some_and(|part| own.is_placed() && !Arc::ptr_eq(part, &dividing.part)) {
                self.stop_directions();
            }
        }
        let pieces = self.known().pieces(&self.view).cloned();
        self.plans.own.scene.show_pieces(pieces);
    }

    /// Writes a division into the profile.
    pub(crate) fn divide(&mut self, way: usize) {
        let Some(way) = self.known().ways().and_then(|ways| ways.ways.get(way)) else { return };
        let text = edit::with_bodies(&self.project().profile, &way.tried.clone().into_bodies());
        self.open.project.seal();
        self.set_profile(BODIES, text.map_err(|error| error.to_string()));
        self.open.project.seal();
        // The beads of the new plan are to be seen.
        self.view.division = None;
    }
}

/// A profile for a part that is not divided yet.
fn without_bodies(text: &str) -> Option<Profile> {
    let mut profile = Profile::parse(text).ok()?;
    profile.layers.bodies.clear();
    Some(profile)
}

impl<'a> Known<'a> {
    /// The divisions, once they are found.
    pub(crate) fn ways(self) -> Option<&'a Ways> {
        self.jobs.dividing.as_ref()?.run.found()
    }

    /// The division that is chosen.
    pub(crate) fn way(self, view: &ViewState) -> Option<&'a Way> {
        self.ways()?.ways.get(view.division?)
    }

    /// The part in the colours of the bodies of the chosen division, if that is shown in 3-D.
    pub(crate) fn pieces(self, view: &ViewState) -> Option<&'a Arc<Scanned>> {
        let shown = view.mode == Mode::Solid && !view.laying && self.bent(view).is_none();
        self.way(view).filter(|_| shown)?.pieces.as_ref()
    }

    /// Why no divisions can be looked for: the key of a text.
    pub(crate) fn undivided(self) -> Option<&'static str> {
        let own = &self.plans.own;
        let is_charted = |profile: &Profile| !profile.layers.chart.is_level();
        match own.part.as_ref().filter(|_| own.is_placed()) {
            None => Some("directions-wait"),
            Some(_) if self.project().preform => Some("directions-preform"),
            Some(part) if part.mesh().is_none() => Some("directions-curves"),
            Some(_) if self.parsed().is_some_and(|parsed| is_charted(&parsed.profile)) => Some("directions-chart"),
            Some(_) => None,
        }
    }
}
