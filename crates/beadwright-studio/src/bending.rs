//! The bent shape in the window: computed, shown in 3-D, given up.

use crate::computing::Computing;
use crate::distortion::{Distorted, Distorting};
use crate::known::Known;
use crate::studio::Studio;
use crate::view::{Mode, ViewState};
use crate::view3d::Bent;
use beadwright::task::{Stage, Task};
use std::sync::Arc;

impl Studio {
    /// Computes how plate and part bend on the chosen clamps.
    pub(crate) fn begin_distortion(&mut self) {
        let (own, clamps) = (&self.plans.own, self.view.bend.clamps);
        let Some(profile) = own.profile.clone() else { return };
        let (layers, drawn) = (own.layers.clone(), own.scene.layers().to_vec());
        let work = move |task: &Task| Distorted::of(&layers, &drawn, &profile, clamps, task);
        let run = Computing::start(&self.window.ctx, Stage::Distort, work);
        self.jobs.distortion = Some(Distorting { clamps, run });
    }

    /// Gives it up.
    pub(crate) fn stop_distortion(&mut self) {
        self.jobs.distortion = None;
        self.view.bend.shown = false;
    }

    /// Takes what was computed, and bends the beads in 3-D to what is to be shown.
    pub(crate) fn hear_of_distortion(&mut self) {
        if let Some(distortion) = &mut self.jobs.distortion {
            distortion.run.hear();
        }
        let times = self.view.bend.times.or(self.known().distorted().map(|distorted| distorted.times));
        let bent = self.known().bent(&self.view).cloned();
        self.plans.own.scene.bend(bent.as_ref().zip(times));
    }
}

impl<'a> Known<'a> {
    /// How plate and part bend, once it is computed.
    pub(crate) fn distorted(self) -> Option<&'a Distorted> {
        self.jobs.distortion.as_ref()?.run.found()
    }

    /// The bent shape that is shown in 3-D, if one is.
    pub(crate) fn bent(self, view: &ViewState) -> Option<&'a Arc<Bent>> {
        let shown = view.bend.shown && view.mode == Mode::Solid && !view.laying;
        let distorted = self.distorted().filter(|_| shown)?;
        Some(if view.bend.clamped { &distorted.clamped.bent } else { &distorted.released.bent })
    }
}
