//! Where the layers of a part along a guide lie, so that none is thinner or thicker than a bead can be.

use crate::chart::Chart;
use crate::model::Mesh;
use crate::profile::LayersSection;
use crate::slice::{BATCH, Slab, Slice, SliceOptions, Slicer};
use crate::task::{Cancelled, Task};
use crate::wedge::{THINNEST, TOLERANCE};
use glam::DVec2;

/// The layers of a part along a guide: as thick as planned if all of a layer is then within its window, thinner or
/// thicker if that helps, and otherwise in two parts on the outer side of the bend.
///
/// # Errors
/// [`Cancelled`].
pub(super) fn slabs(
    slabs: Vec<Slab>,
    mesh: &Mesh,
    layers: &LayersSection,
    options: SliceOptions,
    task: &Task,
) -> Result<Vec<Slab>, Cancelled> {
    if !layers.chart.has_wedges() || slabs.is_empty() {
        return Ok(slabs);
    }
    let slicer = Slicer::of_slabs(mesh, slabs.clone(), options, task)?;
    let mut planned = Vec::with_capacity(slabs.len());
    for batch in 0..slabs.len().div_ceil(BATCH) {
        let known = |slice: Slice| Known {
            slab: Slab { z: slice.z, height: slice.height },
            corners: slice.islands.iter().flat_map(|island| island.outer.points()).copied().collect(),
        };
        planned.extend(slicer.batch(batch, task)?.into_iter().map(known));
    }
    Ok(within(&planned, layers))
}

/// The planned layer at a height, and the corners of its outline.
struct Known {
    slab: Slab,
    corners: Vec<DVec2>,
}

impl Known {
    /// The least and the greatest rise on a layer whose middle is at this height, mm.
    fn rises(&self, middle: f64, chart: &Chart) -> (f64, f64) {
        let sheet = chart.sheet(middle);
        let rises = self.corners.iter().map(|p| sheet.rise(*p));
        let (low, high) = rises.fold((f64::INFINITY, 0.0_f64), |(low, high), rise| (low.min(rise), high.max(rise)));
        if low <= high { (low.max(THINNEST), high) } else { (1.0, 1.0) }
    }
}

/// Layers within their window, made from the planned ones and ending at the same top.
fn within(planned: &[Known], layers: &LayersSection) -> Vec<Slab> {
    let Some(top) = planned.last().map(|last| last.slab.z) else { return Vec::new() };
    let (thinnest, thickest) = layers.window();
    let at = |z: f64| &planned[planned.partition_point(|known| known.slab.z <= z).min(planned.len() - 1)];
    let fitting = |z: f64, middle: f64| {
        let usual = at(z).slab.height;
        let (low, high) = at(middle).rises(middle, &layers.chart);
        let (least, most) = (thinnest / low, thickest / high);
        // In two layers where it is thickest, if necessary.
        if least > most { usual.min(2.0 * most).max(least) } else { usual.clamp(least, most) }
    };
    // The middle of a layer depends on its height, and the two may lie on opposite sides of a bend's end.
    let height = |z: f64| {
        let first = fitting(z, z + at(z).slab.height / 2.0);
        let second = fitting(z, z + first / 2.0);
        let third = fitting(z, z + second / 2.0);
        if (third - second).abs() < TOLERANCE * second { second } else { first }
    };
    let mut slabs: Vec<Slab> = Vec::new();
    let mut z = 0.0;
    while slabs.is_empty() || z + height(z) / 2.0 < top {
        let height = height(z);
        z += height;
        slabs.push(Slab { z, height });
    }
    let halved = |slab: Slab| {
        let (z, height) = (slab.z * top / z, slab.height * top / z);
        let middle = z - height / 2.0;
        let is_thick = height * at(middle).rises(middle, &layers.chart).1 > thickest * (1.0 + TOLERANCE);
        let lower = is_thick.then_some(Slab { z: middle, height: height / 2.0 });
        lower.into_iter().chain([Slab { z, height }])
    };
    slabs.into_iter().flat_map(halved).collect()
}
