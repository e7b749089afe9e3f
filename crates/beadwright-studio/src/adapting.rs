//! What follows a scan in the window: the scan chosen, compared, the layers that follow taken over.

use crate::adaptation::{Adaptation, Adapting, Follows, Scanned};
use crate::computing::Computing;
use crate::known::Known;
use crate::project::Project;
use crate::studio::Studio;
use crate::view::{Side, ViewState};
use beadwright::task::{Stage, Task};
use std::path::Path;

/// What a step that adapts what is left is about.
const ADAPTED: &str = "adapted";

impl Studio {
    /// Compares a scan of the unfinished build with the plan, taken after the layer in view until another is chosen.
    pub fn open_build_scan(&mut self, path: &Path) {
        let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        let layers = self.plans.own.layer_count();
        let layer = (self.view.last + 1).min(layers.saturating_sub(1)).max(1);
        let before = self.view.adapt.take();
        let chosen = before.map(|before| Adaptation { scan: path.clone(), ..before });
        self.view.adapt = Some(chosen.unwrap_or_else(|| Adaptation::of(path, layer)));
        self.jobs.adapting = None;
        self.view.side = Side::Adapt;
    }

    /// Takes the layers that follow in place of those planned, as one step.
    pub(crate) fn adapt(&mut self) {
        let Some(settings) = self.view.adapt.clone() else { return };
        self.open.project.seal();
        self.change(ADAPTED, |project| project.adapted = Some(settings));
        self.open.project.seal();
    }

    /// Puts the scan away; layers that follow it give way to those planned, as one step.
    pub(crate) fn close_build_scan(&mut self) {
        (self.view.adapt, self.jobs.adapting) = (None, None);
        if self.project().adapted.is_some() {
            self.open.project.seal();
            self.change(ADAPTED, |project| project.adapted = None);
            self.open.project.seal();
        }
    }

    /// Takes what was compared; compares what is chosen, and shows the layers that follow where they are taken over.
    pub(crate) fn hear_of_adapting(&mut self) {
        if let Some(adapting) = &mut self.jobs.adapting {
            adapting.run.hear();
        }
        let own = &self.plans.own;
        let Some(wanted) = self.known().adaptation(&self.view).cloned() else { return };
        if !own.is_complete() || own.adapted.is_some() {
            return;
        }
        match &mut self.jobs.adapting {
            Some(adapting) if adapting.settings == wanted => {
                let takes = self.open.project.now().adapted.is_some();
                match &adapting.run.result {
                    Some(Ok(follows)) if takes => {
                        self.plans.own.follow(follows);
                        (self.view.chosen, self.view.pin) = (None, None);
                    }
                    Some(Err(error)) if takes && !adapting.reported => {
                        adapting.reported = true;
                        let error = error.clone();
                        self.view.side = Side::Adapt;
                        self.complain(error);
                    }
                    _ => {}
                }
            }
            // A value that is being dragged is not final.
            _ if self.window.ctx.input(|input| input.pointer.any_down()) => {}
            _ => self.begin_adapting(wanted),
        }
    }

    fn begin_adapting(&mut self, settings: Adaptation) {
        let own = &self.plans.own;
        let (Some(header), Some(profile)) = (own.header.clone(), own.profile.clone()) else { return };
        let plan = Scanned { header, layers: own.layers.clone(), profile };
        let known = self.jobs.adapting.as_ref().and_then(|adapting| adapting.scan_of(&settings));
        let of_job = settings.clone();
        let work = move |task: &Task| Follows::of(&of_job, known, &plan, task);
        let run = Computing::start(&self.window.ctx, Stage::Import, work);
        self.jobs.adapting = Some(Adapting { settings, run, reported: false });
    }
}

impl Project {
    /// The same without what was adapted if anything else has changed: what is welded cannot be planned anew.
    pub(crate) fn without_stale(mut self, before: &Self) -> Self {
        let plain = |project: &Self| Self { adapted: None, ..project.clone() };
        if self.adapted == before.adapted && plain(&self) != plain(before) {
            self.adapted = None;
        }
        self
    }
}

impl<'a> Known<'a> {
    /// The scan whose layers are taken over, or the one that is looked at.
    pub(crate) fn adaptation(self, view: &'a ViewState) -> Option<&'a Adaptation> {
        self.project().adapted.as_ref().or(view.adapt.as_ref())
    }

    /// Why no scan of the build can be compared: the key of a text.
    pub(crate) fn unadaptable(self) -> Option<&'static str> {
        let own = &self.plans.own;
        if !own.is_complete() {
            return Some("adapt-waits");
        }
        let is_level = own.profile.as_ref().is_some_and(|profile| profile.layers.are_level());
        if !is_level || self.prints() {
            return Some("adapt-not-level");
        }
        None
    }
}
