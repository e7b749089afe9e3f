//! Temperatures of a plan that was made without them, computed in the background.

use crate::jobs::Job;
use beadwright::heat::{self, HeatSettings};
use beadwright::layer::Layer;
use beadwright::profile::Profile;
use beadwright::task::Task;
use eframe::egui::Context;
use std::sync::Arc;

/// For each layer, the temperature of the metal where each of its passes begins, °C.
pub type Temperatures = Vec<Arc<[f32]>>;

/// Computes how warm the metal is where passes begin, with the waits and the order that the plan has.
pub fn heat(ctx: &Context, layers: Vec<Arc<Layer>>, profile: Arc<Profile>) -> Job<Result<Temperatures, String>> {
    Job::start(ctx, move || temperatures(&layers, &profile))
}

/// The same, at once.
///
/// # Errors
/// A sentence where the profile lacks a section.
pub fn temperatures(layers: &[Arc<Layer>], profile: &Profile) -> Result<Temperatures, String> {
    let settings = profile.heat_settings().map_err(|error| error.to_string())?;
    let settings = HeatSettings { interpass: None, ..settings };
    let mut layers: Vec<Layer> = layers.iter().map(|layer| (**layer).clone()).collect();
    let history = heat::history(&mut layers, &settings, &profile.weld_settings(), &Task::new());
    let history = history.map_err(|_| "computing the temperatures was cancelled.".to_owned())?;
    let of_layer = |heat: &heat::LayerHeat| heat.passes.iter().map(|pass| pass.start as f32).collect();
    Ok(history.map(|history| history.layers.iter().map(of_layer).collect()).unwrap_or_default())
}
