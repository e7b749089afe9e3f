//! Union, difference and intersection of regions, exact on the grid of the crate.

use crate::grid::{GRID_MM, GridPoint, from_grid, region_from_grid, region_to_grid, ring_to_grid};
use crate::winding::region_within;
use crate::{FillRule, Region, Ring};
use glam::DVec2;
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
    if let Some(apart) = combine_apart(subject, clip, rule) {
        return apart;
    }
    let (subject, clip) = (region_to_grid(subject), region_to_grid(clip));
    combine_by_winding(&subject, &clip, rule).unwrap_or_else(|| {
        region_from_grid(Overlay::from_subj_and_clip(&subject, &clip).overlay(rule, IntFillRule::NonZero))
    })
}

/// Regions whose boxes do not meet.
fn combine_apart(subject: &Region, clip: &Region, rule: OverlayRule) -> Option<Region> {
    let meet = match (subject.bounds(), clip.bounds()) {
        (Some(a), Some(b)) => a.min.cmple(b.max + GRID_MM).all() && b.min.cmple(a.max + GRID_MM).all(),
        _ => false,
    };
    match rule {
        _ if meet => None,
        OverlayRule::Union => Some(Region::from_normalised([subject.polygons(), clip.polygons()].concat())),
        OverlayRule::Difference => Some(subject.clone()),
        OverlayRule::Intersect => Some(Region::default()),
        _ => None,
    }
}

/// Regions whose boundaries cross, but touch nowhere.
fn combine_by_winding(subject: &[Vec<GridPoint>], clip: &[Vec<GridPoint>], rule: OverlayRule) -> Option<Region> {
    let (level, allowed) = match rule {
        OverlayRule::Union => (1, 0..=2),
        OverlayRule::Intersect => (2, 0..=2),
        OverlayRule::Difference => (1, -1..=1),
        _ => return None,
    };
    let mut rings = in_mm(&[subject, clip].concat());
    if rule == OverlayRule::Difference {
        rings[subject.len()..].iter_mut().for_each(|ring| ring.reverse());
    }
    region_within(rings, level, allowed)
}

pub(crate) fn unite_rings(rings: &[Ring], rule: FillRule) -> Region {
    let rings: Vec<Vec<GridPoint>> = rings.iter().map(ring_to_grid).collect();
    let by_winding = match rule {
        // Where everything is wound around once or not at all, all rules agree.
        FillRule::EvenOdd => region_within(in_mm(&distinct(&rings)), 1, 0..=1),
        // Where nothing is wound around clockwise, the other two rules agree.
        FillRule::NonZero => region_within(in_mm(&distinct(&rings)), 1, 0..),
        FillRule::Positive => region_within(in_mm(&distinct(&rings)), 1, ..),
    };
    by_winding.unwrap_or_else(|| unite_by_overlay(&rings, rule))
}

fn in_mm(rings: &[Vec<GridPoint>]) -> Vec<Vec<DVec2>> {
    rings.iter().map(|ring| ring.iter().map(|&p| from_grid(p)).collect()).collect()
}

/// Rings without repeated points; rings of fewer than three points are left out.
fn distinct(rings: &[Vec<GridPoint>]) -> Vec<Vec<GridPoint>> {
    let ring = |ring: &Vec<GridPoint>| {
        let mut points = ring.clone();
        points.dedup();
        while points.len() > 1 && points.first() == points.last() {
            points.pop();
        }
        points
    };
    rings.iter().map(ring).filter(|ring| ring.len() >= 3).collect()
}

fn unite_by_overlay(rings: &[Vec<GridPoint>], rule: FillRule) -> Region {
    let rule = match rule {
        FillRule::EvenOdd => IntFillRule::EvenOdd,
        FillRule::NonZero => IntFillRule::NonZero,
        FillRule::Positive => IntFillRule::Positive,
    };
    region_from_grid(Overlay::from_subj(rings).overlay(OverlayRule::Subject, rule))
}
