//! Rings parallel to the boundary, one stepover apart, until nothing is left.

use super::thin;
use super::{Fill, FillSettings, Path, Strategy};
use planar::{Join, Polygon, Region};

/// Contour-parallel rings.
pub struct Contour;

impl Strategy for Contour {
    fn name(&self) -> &'static str {
        "contour"
    }

    fn repeats(&self) -> bool {
        true
    }

    fn fill(&self, island: &Polygon, settings: &FillSettings) -> Fill {
        thin::around(island, settings, rings_only)
    }
}

/// The rings alone, without beads along walls too thin for them: they stay inside and cross nothing by construction.
pub fn rings_only(island: &Polygon, settings: &FillSettings) -> Fill {
    let (rings, _) = rings(settings.outermost(island), settings, u32::MAX);
    Fill { stages: settings.ordered(rings), fixed_order: false }
}

/// Up to `count` rings from `outermost` inwards, and the region that the innermost ones bound.
pub(super) fn rings(outermost: Region, settings: &FillSettings, count: u32) -> (Vec<Vec<Path>>, Region) {
    let mut levels = levels(outermost, settings, count);
    let ring = |ring: &planar::Ring| Path::contour(ring.clone(), settings.bead.width);
    let stages = levels.iter().map(|level| level.rings().map(ring).collect()).collect();
    (stages, levels.pop().unwrap_or_default())
}

/// The regions that up to `count` rings bound, from `outermost` inwards until nothing is left.
pub(super) fn levels(outermost: Region, settings: &FillSettings, count: u32) -> Vec<Region> {
    let inwards = |region: &Region| Some(region.offset(-settings.stepover, Join::ROUND)).filter(|r| !r.is_empty());
    std::iter::successors(Some(outermost), inwards).take(count as usize).collect()
}
