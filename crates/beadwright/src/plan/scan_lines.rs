//! What the scan lines of a layer depend on besides its own islands: the layer it is paired with, and the layers above
//! and below.

use crate::fill::{self, Strategy};
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

/// A batch of slices, ready to be filled.
pub(super) fn planned(
    batch: usize,
    slicer: &Slicer,
    strategy: &dyn Strategy,
    profile: &Profile,
    task: &Task,
) -> Result<Vec<Planned>, Cancelled> {
    let slices = slicer.batch(batch, task)?;
    let angles = raster_angles(&slices, strategy, profile);
    let solid = solid_regions(batch, &slices, slicer, profile, task)?;
    let planned = slices.into_iter().zip(angles.into_iter().zip(solid));
    Ok(planned.map(|(slice, (raster_angle, solid))| Planned { slice, raster_angle, solid }).collect())
}

/// The best raster angle of each layer, where the profile asks for it.
fn raster_angles(slices: &[Slice], strategy: &dyn Strategy, profile: &Profile) -> Vec<Option<f64>> {
    // Batches are even, so pairs of layers do not straddle them.
    const { assert!(BATCH.is_multiple_of(2)) };
    if profile.fill.raster_turn != RasterTurn::Best {
        return vec![None; slices.len()];
    }
    let pair = |pair: &[Slice]| {
        let islands: Vec<&[Polygon]> = pair.iter().map(|s| &s.islands[..]).collect();
        let angle = fill::angle::best(strategy, &islands, &profile.fill_settings(0));
        (0..pair.len()).map(|i| angle.map(|a| a + FRAC_PI_2 * i as f64)).collect::<Vec<_>>()
    };
    slices.par_chunks(2).flat_map_iter(pair).collect()
}

/// Where the infill of each layer is solid; `None` where all of it is. That is where one of the next `solid_layers`
/// layers above or below does not cover the layer.
fn solid_regions(
    batch: usize,
    slices: &[Slice],
    slicer: &Slicer,
    profile: &Profile,
    task: &Task,
) -> Result<Vec<Option<Region>>, Cancelled> {
    let (count, reach) = (slicer.layer_count(), profile.fill.solid_layers as usize);
    if profile.fill.infill_density >= 1.0 {
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
        // Grown, so that the solid infill holds on to the sparse infill around it.
        Some(bare.offset(2.0 * profile.bead.width, Join::ROUND))
    };
    Ok((0..slices.len()).into_par_iter().map(solid).collect())
}
