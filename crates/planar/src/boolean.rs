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
    ///
    /// ```
    /// use planar::{DVec2, Polygon, Region, Ring};
    ///
    /// // Two squares that share an edge become one rectangle.
    /// let square = |x: f64| {
    ///     let corners = [(x, 0.0), (x + 5.0, 0.0), (x + 5.0, 5.0), (x, 5.0)].map(DVec2::from);
    ///     Region::from(Polygon::simple(Ring::new(corners.to_vec())))
    /// };
    /// let both = square(0.0).union(&square(5.0));
    /// assert_eq!((both.polygons().len(), both.area(), both.perimeter()), (1, 50.0, 30.0));
    /// ```
    pub fn union(&self, other: &Self) -> Self {
        combine(self, other, OverlayRule::Union)
    }

    /// What lies in `self` and not in `other`.
    ///
    /// ```
    /// use planar::{DVec2, Polygon, Region, Ring};
    ///
    /// let square = |low: f64, high: f64| {
    ///     let corners = [(low, low), (high, low), (high, high), (low, high)].map(DVec2::from);
    ///     Region::from(Polygon::simple(Ring::new(corners.to_vec())))
    /// };
    /// let frame = square(0.0, 10.0).difference(&square(4.0, 6.0));
    /// assert_eq!(frame.polygons()[0].holes.len(), 1);
    /// assert_eq!((frame.area(), frame.euler()), (96.0, 0));
    /// ```
    pub fn difference(&self, other: &Self) -> Self {
        combine(self, other, OverlayRule::Difference)
    }

    /// What lies in both.
    ///
    /// ```
    /// use planar::{DVec2, Polygon, Region, Ring};
    ///
    /// // Squares of side 10, one moved by 6 along x and y: they share a square of side 4.
    /// let square = |at: f64| {
    ///     let corners = [(at, at), (at + 10.0, at), (at + 10.0, at + 10.0), (at, at + 10.0)].map(DVec2::from);
    ///     Region::from(Polygon::simple(Ring::new(corners.to_vec())))
    /// };
    /// assert!((square(0.0).intersection(&square(6.0)).area() - 16.0).abs() < 0.01);
    /// assert!(square(0.0).intersection(&square(20.0)).is_empty());
    /// ```
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

/// The result where the bounding boxes do not meet; `None` where they do.
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

/// The result where boundaries cross but nowhere touch; `None` where they touch.
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
        // If every winding number is 0 or 1, all rules agree.
        FillRule::EvenOdd => region_within(in_mm(&distinct(&rings)), 1, 0..=1),
        // If no winding number is negative, the other two rules agree.
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
