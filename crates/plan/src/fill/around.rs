//! One helix on an island that goes all the way around an axis: rings side by side, with a short step from each to the
//! next, so that the arc starts once and the part always turns the same way.

use super::{FillSettings, Path};
use crate::pass::{Along, PassKind};
use glam::DVec2;
use planar::{Bounds, Polygon, Ring};
use serde::{Deserialize, Serialize};

/// How islands that go all around an axis are filled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Around {
    /// Cut open, and filled by the strategy.
    Open,
    /// With one helix where both edges are rings, otherwise like `open`.
    Helix,
}

/// Data of a layer that continues turn after turn around an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Turn {
    /// Length of a turn, mm.
    pub length: f64,
    /// Most turns of the part in one pass.
    pub most: f64,
}

/// An edge counts as a ring if it deviates by at most this, in bead widths.
const EVEN: f64 = 0.05;
/// Tolerance for two ends of an island being one turn apart, mm: they overlap slightly.
const TURN: f64 = 0.01;
/// Length of the step from one ring to the next, in bead widths.
const STEP: f64 = 1.5;

/// The bounding box of an island that goes all the way around between two edges that are rings; `turn` is the length of
/// a turn, mm, `width` that of a bead; `None` for other islands.
pub fn band(island: &Polygon, turn: f64, width: f64) -> Option<Bounds> {
    let bounds = Bounds::of(island.outer.points().iter().copied())?;
    let off = |p: &DVec2| {
        let [x, y] = [[p.x, bounds.min.x, bounds.max.x], [p.y, bounds.min.y, bounds.max.y]];
        let [x, y] = [x, y].map(|[at, low, high]| (at - low).min(high - at));
        x.min(y)
    };
    let is_even = island.outer.points().iter().all(|p| off(p) <= EVEN * width);
    let fills = |ring: &Ring| ring.area().abs() >= bounds.size().x * (bounds.size().y - 2.0 * EVEN * width);
    let is_band = island.holes.is_empty() && (bounds.size().x - turn).abs() <= TURN && is_even && fills(&island.outer);
    is_band.then_some(bounds)
}

/// One path with as many turns as there are rings, unrolled along x; `None` if the island is not a band between two
/// rings, beads would be too narrow or too wide, or the part cannot turn that often.
///
/// The first ring and the last one are complete, so the first step starts on metal and the last ring ends on it.
pub fn helix(island: &Polygon, settings: &FillSettings<'_>) -> Option<Path> {
    let Turn { length: turn, most } = settings.turn.filter(|_| settings.infill_density >= 1.0)?;
    let bounds = band(island, turn, settings.bead.width)?;
    let high = bounds.size().y + 2.0 * settings.machining_allowance;
    let part = settings.stepover / settings.bead.width;
    // The number of rings of nominal width, and the width at which a whole number of them fills the island.
    let rings = ((high / settings.bead.width - 1.0) / part).round().max(0.0);
    let width = high / (1.0 + rings * part);
    let (narrowest, widest) = settings.one_loop.width_limits;
    let turns = if rings > 0.0 { rings + 1.0 + STEP * width / turn } else { 1.0 };
    if !(narrowest..=widest).contains(&width) || turns > most {
        return None;
    }
    let (first, apart, step) = (bounds.min.y - settings.machining_allowance + width / 2.0, part * width, STEP * width);
    // The helix climbs in the opposite direction on every other layer.
    let ring = |k: f64| first + apart * if settings.layer.is_multiple_of(2) { k } else { rings - k };
    let at = |x: f64, k: f64| DVec2::new(bounds.min.x + x, ring(k));
    let rings = rings as usize;
    let mut points = vec![at(0.0, 0.0)];
    for (k, turns) in (0..=rings).map(|k| (k as f64, k as f64 + 1.0)) {
        points.push(at(turns * turn, k));
        if rings > 0 {
            points.push(at(turns * turn + step, (k + 1.0).min(rings as f64)));
        }
    }
    let (kind, width) = (PassKind::Contour, Along::Same(width));
    Some(Path { kind, closed: false, points, width, reversible: false })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_goes_all_around_between_two_rings_is_a_band() {
        let rectangle = |length: f64| {
            let corners = [(0.0, 0.0), (length, 0.0), (length, 30.0), (0.0, 30.0)];
            Polygon::simple(Ring::new(corners.map(DVec2::from).to_vec()))
        };
        assert!(band(&rectangle(200.0), 200.0, 7.0).is_some());
        assert!(band(&rectangle(200.0), 201.0, 7.0).is_none());
        let mut notched = rectangle(200.0);
        notched.holes.push(Ring::new([(90.0, 10.0), (90.0, 20.0), (110.0, 20.0)].map(DVec2::from).to_vec()));
        assert!(band(&notched, 200.0, 7.0).is_none());
        let slanted = [(0.0, 0.0), (200.0, 0.0), (200.0, 30.0), (0.0, 20.0)].map(DVec2::from).to_vec();
        assert!(band(&Polygon::simple(Ring::new(slanted)), 200.0, 7.0).is_none());
    }
}
