//! One layer planned ahead of the others, to look at while the rest is planned.

use super::centre_lines::{centre_lines, weld_curves};
use super::emitter::Emitter;
use super::filled::{Filled, Filling, fill_planned};
use super::settings::PlanSettings;
use super::support::Support;
use super::warm::{Heat, Warmth};
use super::{PlanError, Sink, charted, levels, scan_lines, slabs_at};
use crate::layer::Layer;
use crate::model::{Mesh, Part};
use crate::order::Memory;
use crate::profile::{Profile, RasterTurn};
use crate::slice::{BATCH, Slab};
use crate::task::Task;
use crate::warning::Warnings;
use std::convert::Infallible;

/// Layer `index` of a part's plan (from 0; the top one if there are fewer), planned as if the torch began with it. It
/// may differ from the same layer in the whole plan only in start points and order, in what heat changes, and in the
/// metal that level layers get for what the layers below have built. `None` for a part without layers, and for one that is welded as
/// several bodies.
///
/// # Errors
/// [`PlanError`].
pub fn preview(
    part: &Part,
    profile: &Profile,
    index: usize,
    task: &Task,
) -> Result<Option<Layer>, PlanError<Infallible>> {
    // Which layer of which body it is shows only in the plan.
    if !profile.layers.bodies.is_empty() {
        return Ok(None);
    }
    let settings = &PlanSettings::of(profile);
    let filled = match part {
        Part::Mesh(import) => {
            of_mesh(&*charted::unrolled(&import.mesh, settings.slicing.chart, task)?, settings, index, task)?
        }
        Part::Curves { curves, height, .. } => {
            let curves = &*centre_lines(curves, settings.curves, settings.bead_width)?;
            let slabs = levels::of_curves(curves, *height, &settings.curve_wall?, &Warmth::default());
            let index = index.min(slabs.len().saturating_sub(1));
            slabs.get(index).map(|slab| weld_curves(curves, index, *slab, &settings.filling))
        }
    };
    let mut last = Last(None);
    let (low, high) = part.bounds();
    // The layers below are assumed to be there.
    let built = f64::INFINITY;
    let mut emitter = Emitter {
        settings,
        sink: &mut last,
        middle: low.midpoint(high).truncate(),
        torch: None,
        heat: &mut Heat::default(),
        memory: Memory::default(),
        // A single layer cannot be a turn of a helix.
        helix: None,
        no_turn: None,
        support: Support::default(),
        grown: None,
        below: Vec::new(),
        asks_how_it_grows: false,
        before: Vec::new(),
        below_middle: 0.0,
        built,
        points: 0,
        has_helix: false,
        metrics: settings.metrics.clone(),
        warnings: Warnings::default(),
    };
    filled.map(|filled| emitter.emit(filled)).transpose().map_err(PlanError::Sink)?;
    Ok(last.0)
}

fn of_mesh(
    mesh: &Mesh,
    settings: &PlanSettings,
    index: usize,
    task: &Task,
) -> Result<Option<Filled>, PlanError<Infallible>> {
    let (strategy, slabs) = (settings.strategy.strategy(), slabs_at(&Warmth::default(), mesh, settings, task)?);
    let index = index.min(slabs.len().saturating_sub(1));
    let window = window(&slabs, index, settings);
    let slicer = settings.slicing.filled(mesh, window.slabs.to_vec(), task)?;
    // Slices are numbered within the window; a sparse infill depends on its neighbours there.
    let planned = scan_lines::planned(0, &slicer, strategy, &settings.filling, task)?;
    let layer = planned.into_iter().nth(index - window.first).map(|mut layer| {
        layer.slice.index = index;
        layer.slice.warnings.iter_mut().for_each(|warning| warning.layer = index);
        fill_planned(&layer, strategy, &settings.filling, super::middle(mesh))
    });
    Ok(layer)
}

struct Window<'a> {
    first: usize,
    slabs: &'a [Slab],
}

/// The layers that a layer's fill depends on, from an even index on, since best angles are chosen for pairs.
fn window<'a>(slabs: &'a [Slab], index: usize, settings: &PlanSettings) -> Window<'a> {
    let Filling { section, first, .. } = &settings.filling;
    // The lower layer of a pair is filled up by the next one.
    let pair = usize::from(section.raster_turn == RasterTurn::Best || settings.slicing.chart.has_wedges());
    let solid = if first.infill_density < 1.0 { section.solid_layers as usize } else { 0 };
    let reach = solid.min(BATCH / 2 - 1);
    let first = index.saturating_sub(reach) & !1;
    let last = (index + reach.max(pair)).min(slabs.len().saturating_sub(1));
    Window { first, slabs: slabs.get(first..=last).unwrap_or_default() }
}

struct Last(Option<Layer>);

impl Sink for Last {
    type Error = Infallible;

    fn begin(&mut self, _: &super::Header) -> Result<(), Infallible> {
        Ok(())
    }

    fn layer(&mut self, layer: Layer) -> Result<(), Infallible> {
        self.0 = Some(layer);
        Ok(())
    }
}
