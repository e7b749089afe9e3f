//! How far layers lean from level under the torch, computed in the background.

use crate::jobs::Job;
use crate::view3d::LayerBeads;
use beadwright::layer::Layer;
use beadwright::profile::Profile;
use beadwright::robot::Stop;
use eframe::egui::Context;
use glam::DVec3;
use std::sync::Arc;

/// For each layer, how far it leans in the middle of each of its segments, °.
pub type Leans = Vec<Arc<[f32]>>;

/// The layers as they are drawn; `None` for those not there yet.
pub type Drawn = [Option<Arc<LayerBeads>>];

/// Computes how far the layers lean while the positioner holds the part.
pub fn level(
    ctx: &Context,
    layers: Vec<Arc<Layer>>,
    drawn: Vec<Option<Arc<LayerBeads>>>,
    profile: Arc<Profile>,
) -> Job<Leans> {
    Job::start(ctx, move || leans(&layers, &drawn, &profile))
}

/// The same, at once.
pub fn leans(layers: &[Arc<Layer>], drawn: &Drawn, profile: &Profile) -> Leans {
    let held = profile.program.positioner.is_some();
    let stops = if held { profile.track(layers).stops } else { Vec::new() };
    let of_layer = |(index, beads): (usize, &Option<Arc<LayerBeads>>)| match beads {
        Some(beads) if held => {
            (0..beads.passes().len()).flat_map(|pass| of_pass(&stops, (index, pass), beads)).collect()
        }
        Some(beads) => beads.beads().iter().map(|bead| off(bead.up().as_dvec3()) as f32).collect(),
        None => Arc::default(),
    };
    drawn.iter().enumerate().map(of_layer).collect()
}

/// How far a direction leans from straight up, °.
fn off(up: DVec3) -> f64 {
    up.angle_between(DVec3::Z).to_degrees()
}

/// How far the layer leans at a stop, °.
fn lean(stop: &Stop) -> f64 {
    off(stop.turned_table().rotation * (stop.attitude.layer * DVec3::Z))
}

/// The leans along a pass; NaN where the program has no stops for it.
fn of_pass(stops: &[Stop], key: (usize, usize), beads: &LayerBeads) -> Vec<f32> {
    let begin = stops.partition_point(|stop| (stop.layer, stop.pass) < key);
    let end = stops.partition_point(|stop| (stop.layer, stop.pass) <= key);
    let welds: Vec<&Stop> = stops[begin..end].iter().filter(|stop| stop.arc).collect();
    let start =
        stops[begin..end].iter().position(|stop| stop.arc).and_then(|first| stops.get((begin + first).checked_sub(1)?));
    let (mut at, mut length) = (start.map(|stop| stop.at), 0.0);
    let known: Vec<(f64, f64)> = welds
        .iter()
        .map(|stop| {
            length += at.replace(stop.at).map_or(0.0, |at| at.distance(stop.at));
            (length, lean(stop))
        })
        .collect();
    let (mut laid, mut next) = (0.0, 0);
    let segments = beads.passes().get(key.1).map(|pass| pass.segments.clone()).unwrap_or_default();
    let of_segment = |bead: &crate::view3d::Bead| {
        let middle = laid + bead.length() / 2.0;
        laid += bead.length();
        while next + 1 < known.len() && known[next].0 < middle {
            next += 1;
        }
        known.get(next).map_or(f32::NAN, |(_, lean)| *lean as f32)
    };
    beads.beads()[segments].iter().map(of_segment).collect()
}
