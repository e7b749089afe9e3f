//! Zigzag inside, perimeters outside (Liu et al. 2022). The infill lies closer to the innermost perimeter (0.591 w)
//! than its scan lines lie to each other; otherwise pores remain where the zigzag turns.
//!
//! The infill may be sparse inside the part; near a top or a bottom it stays solid.

use super::contour::rings;
use super::thin;
use super::zigzag::{zigzag, zigzag_spaced};
use super::{Fill, FillSettings, Path, Strategy};
use planar::scan::Spacing;
use planar::{Join, Polygon, Region};

/// Perimeters with a zigzag core.
pub struct Compound;

impl Strategy for Compound {
    fn name(&self) -> &'static str {
        "compound"
    }

    fn repeats(&self) -> bool {
        true
    }

    fn fill(&self, island: &Polygon, settings: &FillSettings) -> Fill {
        thin::around(island, settings, thick)
    }

    fn infill(&self, island: &Polygon, settings: &FillSettings) -> Region {
        let (_, innermost) = rings(settings.outermost(island), settings, settings.perimeters);
        core(&innermost, settings)
    }

    fn lines(&self, region: &Region, settings: &FillSettings) -> Fill {
        Fill { stages: vec![infill(region, settings)], fixed_order: false }
    }
}

fn thick(part: &Polygon, settings: &FillSettings) -> Fill {
    within_perimeters(part, settings, |core| infill(core, settings))
}

/// Perimeters, and the fill that `infill` lays in the core inside them.
pub(super) fn within_perimeters(
    part: &Polygon,
    settings: &FillSettings,
    infill: impl Fn(&Region) -> Vec<Path>,
) -> Fill {
    let outermost = settings.outermost(part);
    if outermost.is_empty() {
        return Fill::default();
    }
    let (perimeters, innermost) = rings(outermost, settings, settings.perimeters);
    let mut stages = settings.ordered(perimeters);
    let infill = infill(&core(&innermost, settings));
    stages.insert(if settings.perimeters_first { stages.len() } else { 0 }, infill);
    Fill { stages, fixed_order: false }
}

fn core(innermost: &Region, settings: &FillSettings) -> Region {
    innermost.offset(-settings.contour_gap, Join::ROUND)
}

fn infill(core: &Region, settings: &FillSettings) -> Vec<Path> {
    let Some(near_surface) = settings.solid else { return zigzag(core, settings) };
    let solid = core.intersection(near_surface);
    // Solid and sparse infill stay a stepover apart, so they do not overlap.
    let sparse = core.difference(&solid.offset(settings.stepover, Join::ROUND));
    let mut passes = zigzag(&solid, settings);
    passes.extend(zigzag_spaced(&sparse, settings, Spacing::AtMost(settings.stepover / settings.infill_density)));
    passes
}
