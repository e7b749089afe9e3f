//! The way up in which a part costs least, found in the background.

use crate::jobs::Job;
use beadwright::model::{Part, Placement};
use beadwright::preform::orient;
use beadwright::profile::Profile;
use beadwright::task::Task;
use eframe::egui::Context;
use glam::DVec3;
use std::sync::Arc;

/// Finds the turn of a placed part, °: on the flat face with the least overhang, or with the cheapest preform by a profile.
pub fn orient(ctx: &Context, part: Arc<Part>, placement: Placement, preform: Option<Arc<Profile>>) -> Job<DVec3> {
    Job::start(ctx, move || turn(&part, &placement, preform.as_deref()))
}

/// The same, at once.
pub fn turn(part: &Part, placement: &Placement, preform: Option<&Profile>) -> DVec3 {
    let Part::Mesh(import) = part else { return placement.turn };
    let mesh = import.milled.as_ref().map_or(&import.mesh, |milled| &milled.mesh);
    let Some(profile) = preform else { return placement.least_overhang(mesh) };
    let found = orient::best(mesh, &profile.preform_settings(), &profile.preform_rates(), &Task::new());
    let best = found.ok().and_then(|found| found.first().map(|best| placement.turned_onto(best.down)));
    best.unwrap_or(placement.turn)
}
