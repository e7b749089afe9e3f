//! A layer: the outlines of a slice, and the passes that fill it.

use crate::pass::Pass;
use crate::warning::Warning;
use glam::{DVec2, DVec3};
use planar::{Bounds, Join, Polygon, Region};
use serde::{Deserialize, Serialize};
use std::borrow::Borrow;

/// How warm the metal is on which a pass is laid, °C.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Temperature {
    /// Where the pass begins, just before.
    pub start: f64,
    /// Just ahead of the torch, mean along the pass.
    pub mean: f64,
}

/// One layer, ready to be deposited.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Layer {
    /// Index from 0.
    pub index: usize,
    /// Top of the layer, mm.
    pub z: f64,
    /// Thickness, mm.
    pub height: f64,
    /// Outlines of the slice.
    pub islands: Vec<Polygon>,
    /// Passes in deposition order; the arc is off between them.
    pub passes: Vec<Pass>,
    /// Temperatures of the metal below each pass; empty where they were not computed.
    pub temperatures: Vec<Temperature>,
    /// Area of the slice, mm².
    pub slice_area: f64,
    /// Area that beads cover, mm².
    pub planned_area: f64,
    /// What was lost or mended here.
    pub warnings: Vec<Warning>,
}

/// How many layers a part has, and where it lies.
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

    /// That of passes alone, without what their beads take beside and below them.
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

/// What layers cover, seen from above: their passes and outlines.
pub fn bounds(layers: &[Layer]) -> Option<Bounds> {
    let points = layers.iter().flat_map(|l| &l.passes).flat_map(|p| &p.points).map(|p| p.truncate());
    let outlines = layers.iter().flat_map(|l| &l.islands).flat_map(|i| i.outer.points().iter().copied());
    Bounds::of(points.chain(outlines))
}

/// Where islands hang farther than `reach` (mm) beyond those below: area (mm²) and a place; smaller areas than half a bead's
/// `width` squared do not count.
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
