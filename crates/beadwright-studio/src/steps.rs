//! How a strategy arrives at the passes of a layer: pockets and skeleton regions of the hybrid, rings and flips of the
//! loop.

use crate::jobs::{self, Job};
use beadwright::fill::{StrategyName, hybrid, one_loop};
use beadwright::layer::Layer;
use beadwright::profile::Profile;
use eframe::egui::Context;
use glam::DVec2;
use std::sync::Arc;

/// The steps of one island.
pub enum Steps {
    /// Pockets and skeleton regions.
    Hybrid(hybrid::Steps),
    /// Rings and flips relative to the middle of the island, and that middle, mm.
    Loop(Box<one_loop::Steps>, DVec2),
}

impl Steps {
    /// The steps of every island of a layer; none for strategies that have no such steps.
    fn of(layer: &Layer, profile: &Profile) -> Vec<Self> {
        let (settings, islands) = (profile.fill_settings(layer.index), layer.islands.iter());
        match profile.fill.strategy {
            StrategyName::Hybrid => islands.map(|island| Self::Hybrid(hybrid::Steps::of(island, &settings))).collect(),
            StrategyName::Loop => islands
                .flat_map(|island| one_loop::steps(island, &settings))
                .map(|(steps, middle)| Self::Loop(Box::new(steps), middle))
                .collect(),
            _ => Vec::new(),
        }
    }
}

/// The steps of one layer of a plan, computed when they are asked for.
#[derive(Default)]
pub struct Looked {
    job: Option<Job<(usize, Vec<Steps>)>>,
    known: Option<(usize, Vec<Steps>)>,
}

impl Looked {
    /// Forgets them, including those under way.
    pub fn forget(&mut self) {
        *self = Self::default();
    }

    /// Whether they are being computed.
    pub fn is_busy(&self) -> bool {
        self.job.is_some()
    }

    /// Whether the steps of a layer are there or under way.
    pub fn knows(&self, layer: usize) -> bool {
        self.is_busy() || self.known.as_ref().is_some_and(|(of, _)| *of == layer)
    }

    /// Begins with a layer, in the background; does nothing if the plan has not got that far.
    pub fn begin(&mut self, ctx: &Context, layer: Option<&Arc<Layer>>, profile: Option<&Arc<Profile>>) {
        let (Some(layer), Some(profile)) = (layer.cloned(), profile.cloned()) else { return };
        if !self.knows(layer.index) {
            self.job = Some(Job::start(ctx, move || (layer.index, Steps::of(&layer, &profile))));
        }
    }

    /// Receives them once they are there.
    ///
    /// # Errors
    /// A sentence if they could not be computed.
    pub fn hear(&mut self) -> Result<(), String> {
        if let Some(found) = jobs::take(&mut self.job) {
            // A layer without islands has no steps; an empty list is kept so that they are not computed again.
            self.known = Some(found?);
        }
        Ok(())
    }

    /// The steps of a layer; empty before they are there.
    pub fn of(&self, layer: usize) -> &[Steps] {
        self.known.as_ref().filter(|(of, _)| *of == layer).map_or(&[], |(_, steps)| steps)
    }
}
