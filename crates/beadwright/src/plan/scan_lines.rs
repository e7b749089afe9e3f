//! What the scan lines of a layer depend on besides its own islands: the layer it is paired with, and the layers above
//! and below.

use super::filled::Filling;
use crate::fill::{self, FillSettings, Strategy};
use crate::layer::Layer;
use crate::profile::{Profile, RasterTurn};
use crate::slice::{BATCH, Slice, Slicer};
use crate::task::{Cancelled, Task};
use planar::{Join, Polygon, Region};
use rayon::prelude::*;
use std::f64::consts::FRAC_PI_2;

/// A slice, and what its fill depends on besides the slice itself.
pub(super) struct Planned {
    pub(super) slice: Slice,
    /// The best raster angle, radians, where the profile asks for it.
    pub(super) raster_angle: Option<f64>,
    /// Where the infill is solid; `None` where all of it is.
    pub(super) solid: Option<Region>,
}

/// A batch of slices ready to be filled.
pub(super) fn planned(
    batch: usize,
    slicer: &Slicer,
    strategy: &dyn Strategy,
    filling: &Filling,
    task: &Task,
) -> Result<Vec<Planned>, Cancelled> {
    let slices = slicer.batch(batch, task)?;
    let solid = solid_regions(batch, &slices, slicer, filling, task)?;
    let angles = raster_angles(&slices, &solid, strategy, filling);
    let planned = slices.into_iter().zip(angles.into_iter().zip(solid));
    Ok(planned.map(|(slice, (raster_angle, solid))| Planned { slice, raster_angle, solid }).collect())
}

/// The best raster angle of each layer, where the profile asks for it.
fn raster_angles(
    slices: &[Slice],
    solid: &[Option<Region>],
    strategy: &dyn Strategy,
    filling: &Filling,
) -> Vec<Option<f64>> {
    // Batches are even, so pairs of layers do not straddle them.
    const { assert!(BATCH.is_multiple_of(2)) };
    if filling.section.raster_turn != RasterTurn::Best {
        return vec![None; slices.len()];
    }
    let pair = |(pair, solid): (&[Slice], &[Option<Region>])| {
        let layers: Vec<ToFill> =
            pair.iter().zip(solid).map(|(s, solid)| ToFill { islands: &s.islands, solid: solid.as_ref() }).collect();
        let angle = filling.raster_angle(&layers, strategy);
        (0..pair.len()).map(|i| angle.map(|a| a + FRAC_PI_2 * i as f64)).collect::<Vec<_>>()
    };
    slices.par_chunks(2).zip(solid.par_chunks(2)).flat_map_iter(pair).collect()
}

/// What the scan lines of a layer fill.
#[derive(Debug, Clone, Copy)]
pub struct ToFill<'a> {
    /// Its islands.
    pub islands: &'a [Polygon],
    /// Where a sparse infill is nevertheless solid; `None` if all of the infill is.
    pub solid: Option<&'a Region>,
}

/// An earlier candidate is kept unless another angle would save more than this fraction of the time, so that the angle
/// does not change between layers for nothing.
const TIME_SLACK: f64 = 0.002;

/// An angle must lay at least this fraction of the metal that the fixed angle lays: it must not be fast by leaving more
/// bare.
const LEAST_METAL: f64 = 0.98;

/// The angle, radians, of the scan lines of two layers (the second is turned by 90°) at which their metal is laid in
/// the least time. The lines are laid and timed at the angles with few turns and at the profile's own angle, so the
/// result takes no more time for its metal than the latter, within 0.2 %. `None` where no scan lines are laid.
pub fn raster_angle(layers: &[ToFill], strategy: &dyn Strategy, profile: &Profile) -> Option<f64> {
    Filling::of(profile).raster_angle(layers, strategy)
}

impl Filling<'_> {
    /// The best raster angle of two layers, radians.
    fn raster_angle(&self, layers: &[ToFill], strategy: &dyn Strategy) -> Option<f64> {
        let settings = self.first;
        let infills: Vec<Vec<Region>> =
            layers.iter().map(|layer| fill::angle::infills(strategy, layer.islands, &settings)).collect();
        let laid = |angle: f64| {
            // Angles are compared by their own time, regardless of how a positioner happens to be turned.
            let (mut metrics, mut torch) = (self.still.clone(), None);
            for (i, (layer, infills)) in layers.iter().zip(&infills).enumerate() {
                let raster_angle = angle + FRAC_PI_2 * i as f64;
                let settings = FillSettings { raster_angle, solid: layer.solid, ..self.in_layer(i) };
                let fills = infills.iter().map(|region| strategy.lines(region, &settings)).collect();
                let passes = self.laying.passes(fills, i, (0.0, self.height), &mut torch);
                metrics.add(&Layer { passes, ..Layer::default() });
            }
            (metrics.total_time_s, metrics.deposited_volume_mm3)
        };
        let least_metal = LEAST_METAL * laid(settings.raster_angle).1;
        let timed = |angle: f64| {
            let (seconds, metal) = laid(angle);
            (metal > 0.0 && metal >= least_metal).then(|| (seconds / metal, angle))
        };
        let timed: Vec<(f64, f64)> =
            fill::angle::candidates(&infills, &settings).into_iter().filter_map(timed).collect();
        let least = timed.iter().map(|(time, _)| *time).fold(f64::INFINITY, f64::min);
        timed.into_iter().find(|(time, _)| *time <= least * (1.0 + TIME_SLACK)).map(|(_, angle)| angle)
    }
}

/// Areas that the layers above and below leave open count as top or bottom only from this width, in bead widths.
const SLIVER: f64 = 0.1;

/// Where the infill of each layer is solid: where one of the `solid_layers` layers next above or below does not cover
/// it. `None` if all of it is solid.
fn solid_regions(
    batch: usize,
    slices: &[Slice],
    slicer: &Slicer,
    filling: &Filling,
    task: &Task,
) -> Result<Vec<Option<Region>>, Cancelled> {
    let (count, reach) = (slicer.layer_count(), filling.section.solid_layers as usize);
    let width = filling.first.bead.width;
    if filling.first.infill_density >= 1.0 {
        return Ok(vec![None; slices.len()]);
    }
    let neighbour = |other: Option<usize>| match other.filter(|b| *b < slicer.batch_count()) {
        Some(other) => slicer.batch(other, task),
        None => Ok(Vec::new()),
    };
    let (below, above) = (neighbour(batch.checked_sub(1))?, neighbour(Some(batch + 1))?);
    let all: Vec<Region> =
        below.iter().chain(slices).chain(&above).map(|slice| Region::from_normalised(slice.islands.clone())).collect();
    let solid = |i: usize| {
        let (layer, own) = (slices[i].index, below.len() + i);
        if layer < reach || layer + reach >= count {
            return None;
        }
        let near = (own - reach..=own + reach).filter(|&other| other != own);
        let bare = near.fold(Region::default(), |bare, other| bare.union(&all[own].difference(&all[other])));
        // Slices of an upright wall differ by slivers, since its facets are cut at different places.
        let open = bare.into_polygons().into_iter().filter(|p| p.holds_disc(SLIVER * width / 2.0));
        // Enlarged, so that the solid infill is anchored in the sparse infill around it.
        Some(Region::from_normalised(open.collect()).offset(2.0 * width, Join::ROUND))
    };
    Ok((0..slices.len()).into_par_iter().map(solid).collect())
}
