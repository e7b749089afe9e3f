//! Union, difference and intersection of regions, exact on the grid of the crate.

use crate::grid::{GridPoint, region_from_grid, region_to_grid, ring_to_grid};
use crate::{FillRule, Region, Ring};
use i_overlay::core::fill_rule::FillRule as IntFillRule;
use i_overlay::core::overlay::Overlay;
use i_overlay::core::overlay_rule::OverlayRule;

impl Region {
    /// What lies in either region.
    pub fn union(&self, other: &Self) -> Self {
        combine(self, other, OverlayRule::Union)
    }

    /// What lies in `self` and not in `other`.
    pub fn difference(&self, other: &Self) -> Self {
        combine(self, other, OverlayRule::Difference)
    }

    /// What lies in both.
    pub fn intersection(&self, other: &Self) -> Self {
        combine(self, other, OverlayRule::Intersect)
    }
}

fn combine(subject: &Region, clip: &Region, rule: OverlayRule) -> Region {
    let (subject, clip) = (region_to_grid(subject), region_to_grid(clip));
    region_from_grid(Overlay::from_subj_and_clip(&subject, &clip).overlay(rule, IntFillRule::NonZero))
}

pub(crate) fn unite_rings(rings: &[Ring], rule: FillRule) -> Region {
    let rings: Vec<Vec<GridPoint>> = rings.iter().map(ring_to_grid).collect();
    let rule = match rule {
        FillRule::EvenOdd => IntFillRule::EvenOdd,
        FillRule::NonZero => IntFillRule::NonZero,
        FillRule::Positive => IntFillRule::Positive,
    };
    region_from_grid(Overlay::from_subj(&rings).overlay(OverlayRule::Subject, rule))
}
