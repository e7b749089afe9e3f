//! One layer planned ahead of the others, to look at while the rest is planned.

use super::centre_lines::{centre_lines, weld_curves};
use super::emitter::Emitter;
use super::filled::{Filled, fill_planned};
use super::support::Support;
use super::warm::{Heat, Warmth};
use super::{PlanError, Sink, charted, levels, scan_lines, slabs_at};
use crate::layer::Layer;
use crate::metrics::Metrics;
use crate::model::{Mesh, Part};
use crate::order::Memory;
use crate::profile::{Profile, RasterTurn};
use crate::slice::{BATCH, Slab, Slicer};
use crate::task::Task;
use crate::warning::Warnings;
use std::convert::Infallible;

/// Layer `index` of a part's plan (from 0; the top one if there are fewer), planned as if the torch began with it. It
/// may differ from the same layer in the whole plan only in start points and order, in what heat changes, and in the
/// metal that level layers get for what the layers below have built.
///
/// # Errors
/// [`PlanError`].
pub fn preview(
    part: &Part,
    profile: &Profile,
    index: usize,
    task: &Task,
) -> Result<Option<Layer>, PlanError<Infallible>> {
    let filled = match part {
        Part::Mesh(import) => of_mesh(&*charted::unrolled(&import.mesh, profile, task)?, profile, index, task)?,
        Part::Curves { curves, height, .. } => {
            let curves = &*centre_lines(curves, profile)?;
            let slabs = levels::of_curves(curves, *height, &profile.single_wall()?, &Warmth::default());
            let index = index.min(slabs.len().saturating_sub(1));
            slabs.get(index).map(|slab| weld_curves(curves, index, *slab, profile))
        }
    };
    let mut last = Last(None);
    let (metrics, warnings) = (Metrics::new(profile), Warnings::default());
    let (low, high) = part.bounds();
    // The layers below are assumed to be there.
    let built = f64::INFINITY;
    let mut emitter = Emitter {
        profile,
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
        before: Vec::new(),
        below_middle: 0.0,
        built,
        points: 0,
        has_helix: false,
        metrics,
        warnings,
    };
    filled.map(|filled| emitter.emit(filled)).transpose().map_err(PlanError::Sink)?;
    Ok(last.0)
}

fn of_mesh(mesh: &Mesh, profile: &Profile, index: usize, task: &Task) -> Result<Option<Filled>, PlanError<Infallible>> {
    let (strategy, slabs) = (profile.fill.strategy.strategy(), slabs_at(&Warmth::default(), mesh, profile, task)?);
    let index = index.min(slabs.len().saturating_sub(1));
    let window = window(&slabs, index, profile);
    let slicer = Slicer::of_slabs(mesh, window.slabs.to_vec(), profile.slice_options(), task)?
        .on(&profile.layers.chart)
        .no_thicker_than(profile.layers.window().1);
    // Slices are numbered within the window; a sparse infill depends on its neighbours there.
    let planned = scan_lines::planned(0, &slicer, strategy, profile, task)?;
    let layer = planned.into_iter().nth(index - window.first).map(|mut layer| {
        layer.slice.index = index;
        layer.slice.warnings.iter_mut().for_each(|warning| warning.layer = index);
        fill_planned(&layer, strategy, profile, super::middle(mesh))
    });
    Ok(layer)
}

struct Window<'a> {
    first: usize,
    slabs: &'a [Slab],
}

/// The layers that a layer's fill depends on, from an even index on, since best angles are chosen for pairs.
fn window<'a>(slabs: &'a [Slab], index: usize, profile: &Profile) -> Window<'a> {
    // The lower layer of a pair is filled up by the next one.
    let pair = usize::from(profile.fill.raster_turn == RasterTurn::Best || profile.layers.chart.has_wedges());
    let solid = if profile.fill.infill_density < 1.0 { profile.fill.solid_layers as usize } else { 0 };
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
