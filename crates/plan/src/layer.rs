//! A layer: the outlines of a slice, and the passes that fill it.

use crate::pass::Pass;
use bead_part::slice::{Half, middle};
use bead_part::warning::Warning;
use glam::{DVec2, DVec3};
use planar::{Bounds, Join, Polygon, Region};
use serde::{Deserialize, Serialize};
use std::borrow::Borrow;

/// Temperature of the metal on which a pass is laid, °C.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Temperature {
    /// Where the pass begins, just before, °C.
    pub start: f64,
    /// Just ahead of the torch, mean along the pass, °C.
    pub mean: f64,
}

/// Whether the arc stays lit between layers: the turns of a helix, each the only pass of its layer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct Lit {
    /// The pass continues that of the layer below.
    pub before: bool,
    /// It continues in the layer above.
    pub after: bool,
}

impl Lit {
    /// The least metal of a piece of a turn, as a fraction of a full bead: with less, the torch would be too fast.
    pub const LEAST: f64 = 0.5;

    /// Whether a layer is a turn of a helix.
    pub fn is_turn(self) -> bool {
        self.before || self.after
    }

    /// Sets `before` of every layer from `after` of the layer below, since files state only the latter.
    ///
    /// # Errors
    /// The index of a layer that would then have other than exactly one pass.
    pub fn join(layers: &mut [Layer]) -> Result<(), usize> {
        let goes_on: Vec<bool> = layers.iter().map(|layer| layer.lit.after).collect();
        for (layer, before) in layers.iter_mut().zip(std::iter::once(false).chain(goes_on)) {
            layer.lit.before = before;
            if layer.lit.is_turn() && layer.passes.len() != 1 {
                return Err(layer.index);
            }
        }
        Ok(())
    }
}

/// One layer, ready to be deposited.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Layer {
    /// Index from 0.
    pub index: usize,
    /// Index of the body that it belongs to, from 0: a part may be welded as several, one after another.
    pub body: usize,
    /// Top of the layer, mm.
    pub z: f64,
    /// Thickness, mm.
    pub height: f64,
    /// Whether it is one of two layers with the same underside, and which.
    pub half: Option<Half>,
    /// Outlines of the slice.
    pub islands: Vec<Polygon>,
    /// Areas around an axis beyond the edges at which the layer is cut open: metal there is not outside the part.
    pub beyond: Vec<Polygon>,
    /// Passes in deposition order; the arc is off between them.
    pub passes: Vec<Pass>,
    /// Whether the arc stays lit before and after its passes.
    pub lit: Lit,
    /// Temperatures of the metal below each pass; empty where they were not computed.
    pub temperatures: Vec<Temperature>,
    /// Area of the slice, mm².
    pub slice_area: f64,
    /// Area that beads cover, mm².
    pub planned_area: f64,
    /// What was lost or repaired here.
    pub warnings: Vec<Warning>,
}

impl Layer {
    /// Height of its middle, mm; for two layers with the same underside, the middle of the pair.
    pub fn middle(&self) -> f64 {
        middle(self.z, self.height, self.half)
    }
}

/// Number of layers and bounding box of a part.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Extent {
    /// Number of layers.
    pub layers: usize,
    /// Lowest coordinates, mm.
    pub low: DVec3,
    /// Highest coordinates, mm.
    pub high: DVec3,
}

impl Extent {
    /// The box around the part, seen from above.
    pub fn seen_from_above(&self) -> Bounds {
        Bounds { min: self.low.truncate(), max: self.high.truncate() }
    }

    /// The extent of the passes' points, without the width and height of their beads.
    pub fn of<L: Borrow<Layer>>(layers: &[L]) -> Self {
        let points = layers.iter().flat_map(|layer| &layer.borrow().passes).flat_map(|pass| &pass.points);
        let bounds = points.fold(None, |bounds: Option<(DVec3, DVec3)>, &p| {
            Some(bounds.map_or((p, p), |(low, high)| (low.min(p), high.max(p))))
        });
        let (low, high) = bounds.unwrap_or_default();
        Self { layers: layers.len(), low, high }
    }

    /// Length, width and height, mm.
    pub fn size(&self) -> DVec3 {
        self.high - self.low
    }
}

/// Bounds of layers seen from above: their passes and outlines.
pub fn bounds(layers: &[Layer]) -> Option<Bounds> {
    let points = layers.iter().flat_map(|l| &l.passes).flat_map(|p| &p.points).map(|p| p.truncate());
    let outlines = layers.iter().flat_map(|l| &l.islands).flat_map(|i| i.outer.points().iter().copied());
    Bounds::of(points.chain(outlines))
}

/// Where islands overhang those below by more than `reach` (mm): area (mm²) and a point; areas smaller than half of
/// `width` (mm, of a bead) squared do not count.
pub fn overhang(below: &[Polygon], above: &[Polygon], reach: f64, width: f64) -> Option<(f64, DVec2)> {
    /// Smaller areas do not count, in squared bead widths.
    const SMALLEST: f64 = 0.5;
    if below == above {
        return None;
    }
    let [below, above] = [below, above].map(|islands| Region::from_normalised(islands.to_vec()));
    let free = above.difference(&below.offset(reach, Join::ROUND));
    let large = free.polygons().iter().filter(|p| p.area() > SMALLEST * width * width);
    let area: f64 = large.clone().map(Polygon::area).sum();
    let place = *large.clone().next()?.outer.points().first()?;
    Some((area, place))
}
