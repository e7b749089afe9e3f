//! The temperatures of a whole plan.

use super::build::{Build, LayerHeat};
use super::settings::HeatSettings;
use crate::layer::Layer;
use crate::weld::WeldSettings;
use bead_part::task::{Cancelled, Stage, Task};
use planar::Bounds;

/// Temperatures of all layers, and where the heat went.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct History {
    /// The layers in order.
    pub layers: Vec<LayerHeat>,
    /// Distance between the temperatures along a pass, mm.
    pub spacing: f64,
    /// Time of the build, s.
    pub seconds: f64,
    /// Heat that arc and preheating brought, J.
    pub supplied: f64,
    /// Heat that surroundings and table took, J.
    pub lost: f64,
    /// Heat still in part and plate at the end, J.
    pub held: f64,
    /// Number of voxels.
    pub voxels: usize,
    /// Their size seen from above, mm.
    pub voxel: f64,
}

impl History {
    /// The hottest start of a pass: index of layer and pass, °C.
    pub fn hottest_start(&self) -> Option<(usize, usize, f64)> {
        let starts = self.layers.iter().enumerate().flat_map(|(layer, heat)| {
            heat.passes.iter().enumerate().map(move |(pass, heat)| (layer, pass, heat.start))
        });
        starts.max_by(|a, b| a.2.total_cmp(&b.2))
    }

    fn of(layers: Vec<LayerHeat>, build: &Build) -> Self {
        let body = build.body();
        Self {
            layers,
            spacing: build.spacing(),
            seconds: build.seconds(),
            supplied: body.supplied(),
            lost: body.lost(),
            held: body.energy(),
            voxels: body.grid().len(),
            voxel: build.voxel(),
        }
    }

    /// This body, then another.
    fn followed_by(mut self, mut next: Self) -> Self {
        next.layers.iter_mut().for_each(|layer| layer.end += self.seconds);
        self.layers.append(&mut next.layers);
        Self {
            seconds: self.seconds + next.seconds,
            supplied: self.supplied + next.supplied,
            lost: self.lost + next.lost,
            held: self.held + next.held,
            voxels: self.voxels + next.voxels,
            voxel: self.voxel.max(next.voxel),
            ..self
        }
    }

    /// The hottest metal that a pass meets ahead of the torch: index of layer and pass, °C.
    pub fn hottest_ahead(&self) -> Option<(usize, usize, f64)> {
        let ahead = self.layers.iter().enumerate().flat_map(|(layer, heat)| {
            heat.passes.iter().enumerate().map(move |(pass, heat)| (layer, pass, heat.peak().1))
        });
        ahead.max_by(|a, b| a.2.total_cmp(&b.2))
    }

    /// Seconds for which the torch waits for metal to cool.
    pub fn waits(&self) -> f64 {
        self.layers.iter().map(LayerHeat::wait).sum()
    }
}

/// The plate before the first of these layers; `None` if there is nothing to build.
pub fn plate(layers: &[Layer], settings: &HeatSettings, weld: &WeldSettings) -> Option<Build> {
    let points = layers.iter().flat_map(|l| &l.passes).flat_map(|p| &p.points).map(|p| p.truncate());
    let outlines = layers.iter().flat_map(|l| &l.islands).flat_map(|i| i.outer.points()).copied();
    points.clone().next()?;
    // Programs without outlines have the extent of their passes.
    let bounds = settings.over.or_else(|| Bounds::of(outlines)).or_else(|| Bounds::of(points))?;
    let tops: Vec<(f64, f64)> = layers.iter().map(|layer| (layer.z, layer.height)).collect();
    Some(Build::new(settings, weld, &bounds, &tops))
}

/// Builds all layers; within the limits of the settings if they have some, which changes waits, order and starts of the
/// layers, and otherwise with the waits that they have. `None` if there is nothing to build. Where a part is welded as several
/// bodies, each begins on a plate of its own, which is cold.
///
/// # Errors
/// [`Cancelled`].
pub fn history(
    layers: &mut [Layer],
    settings: &HeatSettings,
    weld: &WeldSettings,
    task: &Task,
) -> Result<Option<History>, Cancelled> {
    let (count, mut done, mut all) = (layers.len(), 0, None::<History>);
    let several = layers.first().zip(layers.last()).is_some_and(|(first, last)| first.body != last.body);
    let settings = &HeatSettings { over: settings.over.filter(|_| !several), ..settings.clone() };
    for body in layers.chunk_by_mut(|a, b| a.body == b.body) {
        let Some(mut build) = plate(body, settings, weld) else { continue };
        let (mut heats, first) = (Vec::with_capacity(body.len()), if several { body[0].index } else { 0 });
        for layer in body {
            task.step(Stage::Heat, done as f64 / count as f64)?;
            // A body knows its own layers only.
            layer.index -= first;
            heats.push(build.layer_within_limits(layer));
            layer.index += first;
            done += 1;
        }
        let own = History::of(heats, &build);
        all = Some(all.map_or(own.clone(), |before| before.followed_by(own)));
    }
    Ok(all)
}
