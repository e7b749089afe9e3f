//! The temperatures of a whole plan.

use super::build::{Build, LayerHeat};
use super::course::{Moment, Watch};
use super::frame::Site;
use super::settings::HeatSettings;
use crate::layer::Layer;
use crate::pass::Pass;
use crate::weld::WeldSettings;
use bead_part::chart::Chart;
use bead_part::task::{Cancelled, Stage, Task};
use glam::DVec3;
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
    /// Heat supplied by arc and preheating, J.
    pub supplied: f64,
    /// Heat lost to surroundings and table, J.
    pub lost: f64,
    /// Heat still in part and plate at the end, J.
    pub held: f64,
    /// Number of voxels.
    pub voxels: usize,
    /// Voxel size seen from above, mm.
    pub voxel: f64,
}

impl History {
    /// The hottest start of a pass: index of layer and pass, and its temperature, °C.
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

    /// The hottest metal ahead of the torch in any pass: index of layer and pass, and its temperature, °C.
    pub fn hottest_ahead(&self) -> Option<(usize, usize, f64)> {
        let ahead = self.layers.iter().enumerate().flat_map(|(layer, heat)| {
            heat.passes.iter().enumerate().map(move |(pass, heat)| (layer, pass, heat.peak().1))
        });
        ahead.max_by(|a, b| a.2.total_cmp(&b.2))
    }

    /// Time for which the torch waits for metal to cool, s.
    pub fn waits(&self) -> f64 {
        self.layers.iter().map(LayerHeat::wait).sum()
    }
}

/// The state before the first of these layers; `None` if there is nothing to build.
pub fn plate(layers: &[Layer], settings: &HeatSettings, weld: &WeldSettings) -> Option<Build> {
    let points = layers.iter().flat_map(|l| &l.passes).flat_map(|p| &p.points).map(|p| p.truncate());
    let outlines = layers.iter().flat_map(|l| &l.islands).flat_map(|i| i.outer.points()).copied();
    points.clone().next()?;
    if !weld.is_level() || weld.charts.len() > 1 {
        return Some(Build::in_space(settings, weld, &sites(layers, &weld.charts, settings.bead_width / 2.0)));
    }
    // Programs without outlines use the extent of their passes.
    let bounds = settings.over.or_else(|| Bounds::of(outlines)).or_else(|| Bounds::of(points))?;
    let tops: Vec<(f64, f64)> = layers.iter().map(|layer| (layer.z, layer.height)).collect();
    Some(Build::new(settings, weld, &bounds, &tops))
}

/// The sites of the bodies of these layers; their beads extend `beyond` their centre-lines, mm.
fn sites(layers: &[Layer], charts: &[Chart], beyond: f64) -> Vec<Option<Site>> {
    let site = |(body, chart): (usize, &Chart)| {
        let own = layers.iter().filter(|layer| layer.body.min(charts.len() - 1) == body);
        Site::of(chart, &own.flat_map(|layer| places(layer, chart)).collect::<Vec<_>>(), beyond)
    };
    charts.iter().enumerate().map(site).collect()
}

/// Chord tolerance, mm, and greatest turn of normals from point to point, rad.
const FOLLOWED: (f64, f64) = (0.2, 0.3);

/// Points in space along the passes of a layer, at its mid-height.
fn places(layer: &Layer, chart: &Chart) -> Vec<DVec3> {
    let (middle, (tolerance, angle)) = (layer.middle(), FOLLOWED);
    let sheet = chart.sheet(middle);
    let starts = layer.passes.iter().filter_map(Pass::start);
    let segments = layer.passes.iter().flat_map(Pass::segments);
    let along = segments.flat_map(|s| sheet.divided(s.from, s.to, tolerance, angle));
    starts.chain(along).map(|p| p.with_z(middle)).collect()
}

/// Builds all layers: within the limits of the settings, if there are any, which changes waits, order and starts of the
/// passes; otherwise with the waits that they have. `None` if there is nothing to build.
///
/// # Errors
/// [`Cancelled`].
pub fn history(
    layers: &mut [Layer],
    settings: &HeatSettings,
    weld: &WeldSettings,
    task: &Task,
) -> Result<Option<History>, Cancelled> {
    let Some(mut build) = plate(layers, settings, weld) else { return Ok(None) };
    let (count, mut heats) = (layers.len(), Vec::with_capacity(layers.len()));
    for (done, layer) in layers.iter_mut().enumerate() {
        task.step(Stage::Heat, done as f64 / count as f64)?;
        heats.push(build.layer_within_limits(layer));
    }
    Ok(Some(History::of(heats, &build)))
}

/// Where the heat lies while layers are built with the waits that they have, at most every `every` seconds; nothing if there is
/// nothing to build. Limits between passes are left aside, since waits for them are already in the passes.
///
/// # Errors
/// [`Cancelled`].
pub fn course(
    layers: &[Layer],
    settings: &HeatSettings,
    weld: &WeldSettings,
    every: f64,
    task: &Task,
) -> Result<Vec<Moment>, Cancelled> {
    let settings = HeatSettings { interpass: None, ..settings.clone() };
    let Some(mut build) = plate(layers, &settings, weld) else { return Ok(Vec::new()) };
    build.watch = Some(Watch { every, moments: Vec::new() });
    for (done, layer) in layers.iter().enumerate() {
        task.step(Stage::Heat, done as f64 / layers.len() as f64)?;
        build.layer(layer);
    }
    Ok(build.watch.map_or_else(Vec::new, |watch| watch.moments))
}
