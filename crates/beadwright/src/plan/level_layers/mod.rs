//! Level layers: layers as high as their metal fills them, and metal where the slice needs it.
//!
//! Beads that overlap as the profile says fill a wide layer. At its rim no neighbour overlaps them, so the beads of a
//! narrow part hold less metal than its slices: n beads at a stepover of ρ widths fill n ρ / ((n − 1) ρ + 1) of them,
//! which is 0.83 for two and 0.96 for ten with ρ = 0.715. A small part, on the other hand, rises faster than its metal
//! fills it, since its corners and its rim stay rounded. [`slabs`] takes sample slices of the part, lays each
//! repeatedly on itself in the model, and makes layers as high as their beads fill them; a wide layer is
//! `layers.height` high. Within a layer [`share`] then shifts metal from beads with neighbours to those without,
//! through the pace: every piece of a pass fills the strip of the slice that lies nearest to it, from the metal below
//! as the model builds it, and beads that become wider at the outline move inwards ([`rim`]).

mod rim;
mod share;

pub(super) use share::{Sharing, share};

use super::filled::{Filled, Filling, fill_planned};
use super::scan_lines::Planned;
use super::settings::PlanSettings;
use super::{MAX_LAYERS, middle};
use crate::deposit::Stack;
use crate::fill::{Fill, Strategy};
use crate::layer::{self, Layer};
use crate::model::Mesh;
use crate::slice::{BATCH, Slab, Slice};
use crate::task::{Cancelled, Task};
use glam::DVec2;
use planar::{Polygon, Region, Ring};
use rayon::prelude::*;

/// Maximum number of heights at which a part is examined.
const HEIGHTS: usize = 24;
/// Limits of a layer's thickness, as multiples of layers.height.
const THICKNESS: std::ops::RangeInclusive<f64> = 0.5..=1.25;

/// The layers of a mesh placed on z = 0, each as high as its metal fills its slice.
///
/// # Errors
/// [`Cancelled`].
pub(super) fn slabs(
    mesh: &Mesh,
    sharing: &Sharing,
    settings: &PlanSettings,
    task: &Task,
) -> Result<Vec<Slab>, Cancelled> {
    let (top, height) = (mesh.bounds().1.z.max(0.0), sharing.height);
    let count = ((top / height) as usize).clamp(1, HEIGHTS);
    let apart = top / count as f64;
    // Each slice is cut in the middle of its slab.
    let looked_at = (0..count).map(|k| Slab { z: (k as f64 + 0.5) * apart + 0.5 * height, height }).collect();
    let slicer = settings.slicing.slicer(mesh, looked_at, task)?;
    const { assert!(HEIGHTS <= BATCH) };
    let slices = slicer.batch(0, task)?;
    let alike: Vec<usize> =
        (0..count).map(|k| (0..k).find(|&other| are_alike(&slices[other], &slices[k])).unwrap_or(k)).collect();
    let (strategy, middle) = (settings.strategy.strategy(), middle(mesh));
    let filled = |(k, slice): (usize, Slice)| -> Result<Option<f64>, Cancelled> {
        task.check()?;
        Ok((alike[k] == k).then(|| rise(filled(slice, strategy, &settings.filling, middle), sharing)).flatten())
    };
    let rises = slices.into_par_iter().enumerate().map(filled).collect::<Result<Vec<_>, _>>()?;
    let known: Vec<(f64, f64)> =
        alike.iter().enumerate().filter_map(|(k, &like)| Some(((k as f64 + 0.5) * apart, rises[like]?))).collect();
    Ok(stacked(top, height, |z| between(&known, z).unwrap_or(height)))
}

/// Slices whose areas and outlines differ by less than this fraction are filled alike.
const LIKE: f64 = 0.02;

/// Whether two slices need not both be filled to know how high their layers are.
fn are_alike(a: &Slice, b: &Slice) -> bool {
    let near = |a: f64, b: f64| (a - b).abs() <= LIKE * a.max(b);
    let outline = |slice: &Slice| slice.islands.iter().flat_map(Polygon::rings).map(Ring::length).sum::<f64>();
    near(a.area(), b.area()) && near(outline(a), outline(b))
}

/// A slice with its passes. The direction of scan lines hardly matters for the metal.
fn filled(slice: Slice, strategy: &dyn Strategy, filling: &Filling, middle: DVec2) -> Layer {
    let turn = filling.turn(&slice);
    let planned = Planned { slice, raster_angle: None, solid: None };
    let Filled { slice, fills, .. } = fill_planned(&planned, strategy, filling, middle);
    let laid = slice.islands.into_iter().zip(&fills).filter(|(_, fill)| !fill.is_empty());
    let once = |(island, fill)| filling.unrolling.fill_once(fill, &island, turn).into_owned();
    let (islands, fills): (Vec<Polygon>, Vec<Fill>) =
        laid.map(|(island, fill)| (island.clone(), once((island, fill)))).unzip();
    let paths = fills.into_iter().flat_map(|fill| fill.stages.into_iter().flatten()).collect();
    let height = filling.height;
    let passes = filling.laying.lifted(paths, slice.index, (0.0, height));
    Layer { height, islands, passes, ..Layer::default() }
}

/// A layer is laid on itself this many times to find its height.
const REPEATED: usize = 6;

/// Height of a layer on others like it, mm, at which its beads hold the metal that they need; `None` for one without
/// beads.
fn rise(mut layer: Layer, sharing: &Sharing) -> Option<f64> {
    let (region, bounds) = (share::region(&layer, sharing), layer::bounds(std::slice::from_ref(&layer))?);
    let mut below = Stack::new(&bounds, sharing.deposit.fitted_to(&bounds, REPEATED));
    let passes = layer.passes.clone();
    for _ in 0..REPEATED {
        let bottom = layer.z;
        layer.passes.clone_from(&passes);
        layer.z = bottom + layer.height;
        layer.height = needed(&layer, &below, &region, sharing)?;
        layer.z = bottom + layer.height;
        share::share(&mut layer, Some(&below), None, sharing);
        below.weld(&layer.passes);
    }
    Some(layer.height)
}

/// This fraction of a layer's metal may be in beads that need less than they hold as planned. With the median, the
/// other beads would be narrower and leave voids; layers that are a little too high have humps, which the next layer
/// remelts.
const FILLED: f64 = 0.35;

/// Height of a layer on the metal below, mm: halfway between the height to which most of its beads fill it ([`FILLED`])
/// and the lowest height at which no more metal is laid than needed, since a bead cannot hold less than 1 /
/// [`share::MOST`] of its own metal. If too much is laid at the former height, the layer is made higher, until it takes
/// up the surplus.
fn needed(layer: &Layer, below: &Stack, region: &Region, sharing: &Sharing) -> Option<f64> {
    let shares = share::shares(layer, Some(below), None, region, sharing);
    let mut pieces: Vec<(f64, f64)> =
        shares.iter().flat_map(|share| share.needs.iter().copied().zip(share.held.iter().copied())).collect();
    pieces.sort_by(|a, b| a.0.total_cmp(&b.0));
    let all: f64 = pieces.iter().map(|piece| piece.1).sum();
    let mut sum = 0.0;
    let &(filled, _) = pieces.iter().find(|piece| {
        sum += piece.1;
        sum >= FILLED * all
    })?;
    let (least, most) = (pieces.first()?.0, pieces.last()?.0);
    // Metal laid beyond what is needed, if the layer is so high that beads with the need `need` hold their planned
    // metal.
    let surplus = |need: f64| -> f64 {
        let laid = |needed: f64| (needed / need).clamp(share::MOST.recip(), share::MOST);
        pieces.iter().map(|(needed, held)| held * (laid(*needed) - needed / need)).sum()
    };
    let need = if surplus(filled) > 0.0 {
        root(surplus, least, filled)
    } else {
        (filled * root(surplus, filled, most)).sqrt()
    };
    let usual = sharing.height;
    Some((layer.height / need).clamp(THICKNESS.start() * usual, THICKNESS.end() * usual))
}

/// The zero of a rising function between two values, found by bisection.
fn root(rising: impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    for _ in 0..20 {
        let middle = 0.5 * (low + high);
        *(if rising(middle) > 0.0 { &mut high } else { &mut low }) = middle;
    }
    0.5 * (low + high)
}

/// The value at a height, interpolated between known ones; constant beyond the first and the last.
fn between(known: &[(f64, f64)], z: f64) -> Option<f64> {
    let behind = known.partition_point(|(at, _)| *at < z);
    match (behind.checked_sub(1).and_then(|i| known.get(i)), known.get(behind)) {
        (Some(a), Some(b)) => Some(a.1 + (b.1 - a.1) * (z - a.0) / (b.0 - a.0)),
        (a, b) => a.or(b).map(|known| known.1),
    }
}

/// Layers higher than usual by up to this factor still count as usual.
const USUAL: f64 = 1.03;
/// Rather than adding one more layer, usual ones are stretched over a remainder of up to this fraction of a layer,
const STRETCHED: f64 = 0.8;
/// and others over one of up to this fraction.
const STRETCHED_LESS: f64 = 0.3;

/// Layers of about `usual` height, each as high as `rise` gives for its middle, stretched or compressed to end at `top`
/// (all mm).
fn stacked(top: f64, usual: f64, rise: impl Fn(f64) -> f64) -> Vec<Slab> {
    let (mut slabs, mut z) = (Vec::new(), 0.0);
    while slabs.len() < MAX_LAYERS {
        let height = rise(z + usual / 2.0);
        // Layers of about the usual height are preferred: lower ones leave voids between their beads, higher ones are
        // overfilled.
        let is_usual = top <= USUAL * usual * slabs.len() as f64;
        let rest = if is_usual { STRETCHED } else { STRETCHED_LESS };
        if !slabs.is_empty() && z + rest * height >= top && THICKNESS.end() * z >= top {
            break;
        }
        z += height;
        slabs.push(Slab { z, height });
    }
    if top > 0.0 {
        let scale = top / z;
        slabs.iter_mut().for_each(|slab| *slab = Slab { z: slab.z * scale, height: slab.height * scale });
    }
    slabs
}
