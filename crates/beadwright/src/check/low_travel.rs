//! Travels through metal that is already there.

use super::{Check, Finding, Subject};
use crate::layer::Layer;
use crate::program::Instruction;
use glam::DVec3;
use std::collections::HashMap;

pub(super) const CHECK: Check = Check {
    name: "low-travel",
    what: "travels that pass less than half of travel.clearance above metal laid before",
    why: "a travel rises above its own two ends only; the nozzle hits anything higher on the way",
    example: "layer 4, pass 1, x 5.0 y 0.0 z 12.00 mm: the travel to it runs 6.0 mm below metal that is already there.",
    remedy: "keep the layers in order, build tall parts last, or raise travel.clearance",
    find,
};

/// A travel this close to the metal below, as a share of the clearance, is too low.
const TOO_CLOSE: f64 = 0.5;

fn find(subject: &Subject<'_>) -> Vec<Finding> {
    let (clearance, mut standing) =
        (subject.settings.weld.travel.clearance, Standing::new(subject.settings.bead_width));
    let sound = |layer: &Layer| layer.passes.iter().flat_map(|p| &p.points).all(|p| p.is_finite());
    // Without clearance all travels are too low, which a separate check reports.
    if clearance <= 0.0 {
        return Vec::new();
    }
    let (mut programmer, mut at, mut findings) =
        (subject.settings.programmer().unfitted().unplaced(), None, Vec::new());
    for layer in subject.layers.iter().copied().filter(|layer| sound(layer)) {
        let (mut pass, mut reported) = (0, false);
        for instruction in programmer.layer(layer).instructions {
            match instruction {
                Instruction::Approach { to } | Instruction::Travel { to } | Instruction::Retract { to } => {
                    let lowest = at.and_then(|from| standing.lowest_gap(from, to));
                    if let Some((gap, place)) = lowest.filter(|(gap, _)| !reported && *gap < TOO_CLOSE * clearance) {
                        findings.push(CHECK.of_pass(layer, pass, Some(place), sentence(gap)));
                        reported = true;
                    }
                    at = Some(to);
                }
                Instruction::Weld { to, .. } => {
                    standing.lay(at.unwrap_or(to), to);
                    at = Some(to);
                }
                // Numbers count from 1 and `pass` from 0, so the number is the index of the next pass.
                Instruction::ArcOff { pass: number } => pass = number,
                Instruction::PassStart { .. }
                | Instruction::Turn { .. }
                | Instruction::Above
                | Instruction::PassEnd
                | Instruction::ArcOn { .. }
                | Instruction::WireFeed { .. }
                | Instruction::Crater { .. }
                | Instruction::Dwell { .. } => {}
            }
        }
    }
    findings
}

fn sentence(gap: f64) -> String {
    let how = if gap < 0.0 { format!("{:.1} mm below", -gap) } else { format!("only {gap:.1} mm above") };
    format!("the travel to it runs {how} metal that is already there.")
}

/// Height of the metal, on a grid of one bead width.
struct Standing {
    width: f64,
    tops: HashMap<[i64; 2], f64>,
}

impl Standing {
    fn new(width: f64) -> Self {
        Self { width, tops: HashMap::new() }
    }

    fn lay(&mut self, from: DVec3, to: DVec3) {
        for place in self.places(from, to) {
            let top = self.tops.entry(self.cell(place)).or_insert(f64::NEG_INFINITY);
            *top = top.max(place.z);
        }
    }

    /// The least height of a level move above the metal, mm, and where that is; `None` for moves up and down.
    fn lowest_gap(&self, from: DVec3, to: DVec3) -> Option<(f64, DVec3)> {
        let level = from.truncate().distance(to.truncate()) > self.width / 2.0;
        let gap = |place: DVec3| Some((place.z - self.tops.get(&self.cell(place))?, place));
        let gaps = self.places(from, to).into_iter().filter_map(gap).filter(|_| level);
        gaps.min_by(|a, b| a.0.total_cmp(&b.0))
    }

    fn cell(&self, place: DVec3) -> [i64; 2] {
        (place.truncate() / self.width).floor().as_i64vec2().to_array()
    }

    /// Places along the way, half a bead apart.
    fn places(&self, from: DVec3, to: DVec3) -> Vec<DVec3> {
        // No part is large enough to need more.
        let steps = (2.0 * from.distance(to) / self.width).ceil().clamp(1.0, 1e5) as usize;
        (0..=steps).map(|k| from.lerp(to, k as f64 / steps as f64)).collect()
    }
}
