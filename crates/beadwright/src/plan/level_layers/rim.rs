//! Wider beads stay inside the outline.
//!
//! A bead along the outline is laid half its planned width inside. With more metal than planned it becomes wider. If it
//! stayed in place, it would widen on both sides, with metal outside the part; if it moved inwards by the full excess,
//! it would pile up on its neighbour. So it moves by [`INWARDS`] of that excess.

use glam::DVec2;
use planar::{Region, Ring};
use rstar::RTree;
use rstar::primitives::Line;

/// A bead moves by this fraction of what would lie outside.
const INWARDS: f64 = 0.6;
/// Shorter distances count as none, mm.
const NOTHING: f64 = 1e-6;
/// In a corner a place is moved away from one side after the other, this many times.
const TURNS: usize = 4;
/// A place is moved only if that takes it away from the outline by at least this fraction of the intended distance: in
/// the middle of a wall it would only leave one side for the other.
const GAIN: f64 = 0.4;

/// The outline of the region that the beads of a layer fill.
pub(super) struct Rim(RTree<Line<[f64; 2]>>);

impl Rim {
    pub(super) fn of(region: &Region) -> Self {
        let edges = region.rings().flat_map(Ring::edges).map(|(a, b)| Line::new(a.to_array(), b.to_array()));
        Self(RTree::bulk_load(edges.collect()))
    }

    /// By how much a place of a bead that is laid wider than planned moves inwards, mm; zero where the bead stays
    /// inside the outline.
    pub(super) fn shift(&self, from: DVec2, planned: f64, laid: f64) -> DVec2 {
        let most = INWARDS * (laid - planned) / 2.0;
        if most <= NOTHING || !self.is_near(from, laid / 2.0) {
            return DVec2::ZERO;
        }
        let Some(foot) = self.foot(from) else { return DVec2::ZERO };
        let before = from.distance(foot);
        let wanted = (laid / 2.0 - before).min(most);
        let mut at = from;
        for _ in 0..TURNS {
            let Some(foot) = self.foot(at) else { break };
            let short = before + wanted - at.distance(foot);
            let Some(inwards) = (at - foot).try_normalize().filter(|_| short > NOTHING) else { break };
            at += short * inwards;
        }
        let gain = self.foot(at).map_or(0.0, |after| at.distance(after) - before);
        if gain > GAIN * wanted { at - from } else { DVec2::ZERO }
    }

    /// Whether the outline comes nearer to `p` than a distance, mm: quickly answered where it is far away.
    fn is_near(&self, p: DVec2, distance: f64) -> bool {
        self.0.locate_within_distance(p.to_array(), distance * distance).next().is_some()
    }

    /// The point of the outline nearest to `p`.
    fn foot(&self, p: DVec2) -> Option<DVec2> {
        let edge = self.0.nearest_neighbor(&p.to_array())?;
        Some(edge.nearest_point(&p.to_array()).into())
    }
}
