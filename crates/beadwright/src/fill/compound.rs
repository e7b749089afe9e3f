//! Zigzag inside, perimeters outside (Liu et al. 2022). The infill keeps a smaller distance to the innermost
//! perimeter (0.591 w) than its lines keep among themselves, or pores remain where it turns.

use super::contour::rings;
use super::zigzag::zigzag;
use super::{Fill, FillSettings, Strategy};
use planar::{Join, Polygon};

/// Perimeters with a zigzag core; the core is laid first.
pub struct Compound;

impl Strategy for Compound {
    fn name(&self) -> &'static str {
        "compound"
    }

    fn fill(&self, island: &Polygon, settings: &FillSettings) -> Fill {
        let outermost = settings.outermost(island);
        if outermost.is_empty() {
            return Fill::default();
        }
        let (perimeters, innermost) = rings(outermost, settings, settings.perimeters);
        let core = innermost.offset(-settings.contour_gap, Join::ROUND);
        let mut stages = vec![zigzag(&core, settings)];
        stages.extend(settings.ordered(perimeters));
        Fill { stages, fixed_order: false }
    }
}
