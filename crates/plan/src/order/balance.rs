//! An order that keeps the heat of a layer around the middle of the plate.
//!
//! Heat beside the middle bends the plate to one side (Zhao et al. 2025 rank deposition sequences by such a thermal eccentricity;
//! the formulas here are ours). Every mm of bead brings as much heat, which fades with the bead laid after it: to 1/e over
//! `fading`. Of several orders, the one is taken whose heat has the least first moment about the middle on the mean, and whose
//! travels are not much longer than those of the usual order. Islands are still finished one after another, and their stages in
//! order.

use super::tour::{Gate, gap};
use super::{OrderSettings, begin_at, begin_at_seam, direction, last_point};
use crate::fill::{Fill, Path};
use glam::DVec2;

/// Weights of the way to the next pass, against the moment, with which orders are tried.
const WEIGHTS: [f64; 5] = [0.0, 0.1, 0.3, 1.0, 3.0];

/// A layer with more passes keeps its usual order: finding another takes time that grows with the square of their number.
const MOST_PASSES: usize = 300;

/// Longest piece of a bead whose heat counts as laid at once, as a fraction of the length over which heat fades.
const PIECE: f64 = 0.05;

/// What a balanced order goes by.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Balance {
    /// Middle of the plate, mm.
    pub middle: DVec2,
    /// Length of bead over which heat fades to 1/e, mm.
    pub fading: f64,
    /// How much longer travels may become, in mm per mm of bead.
    pub detour: f64,
}

/// The heat of the beads laid so far.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Warmth {
    /// First moment about the middle of the plate, mm², for a heat of 1 per mm of bead.
    moment: DVec2,
    /// Sum of its size over the length laid, mm³.
    sum: f64,
}

impl Warmth {
    fn lay(&mut self, pass: &Path, balance: &Balance) {
        for ends in pass.path().windows(2) {
            let pieces = (ends[0].distance(ends[1]) / (PIECE * balance.fading)).ceil().max(1.0);
            let length = ends[0].distance(ends[1]) / pieces;
            for piece in 0..pieces as usize {
                self.heat(ends[0].lerp(ends[1], (piece as f64 + 0.5) / pieces), length, balance);
            }
        }
    }

    /// Heat of a length of bead (mm) at a place.
    fn heat(&mut self, place: DVec2, length: f64, balance: &Balance) {
        let kept = (-length / balance.fading).exp();
        self.moment = kept * self.moment + balance.fading * (1.0 - kept) * (place - balance.middle);
        self.sum += length * self.moment.length();
    }

    /// How far the middle of the heat would lie from that of the plate, mm, after these passes.
    fn after<'a>(mut self, passes: impl Iterator<Item = &'a Path>, balance: &Balance) -> f64 {
        passes.for_each(|pass| self.lay(pass, balance));
        self.moment.length() / balance.fading
    }
}

/// The passes of a layer, and what changed by laying them.
pub(super) struct Laid {
    pub(super) passes: Vec<Path>,
    pub(super) warmth: Warmth,
    /// Length of travels, mm.
    pub(super) travel: f64,
}

impl Laid {
    fn of(passes: Vec<Path>, from: DVec2, warmth: Warmth, balance: &Balance) -> Self {
        let mut laid = Self { passes, warmth: Warmth { sum: 0.0, ..warmth }, travel: 0.0 };
        let mut at = Some(from);
        for pass in &laid.passes {
            laid.warmth.lay(pass, balance);
            laid.travel += gap(at, pass.points.first().copied());
            at = last_point(pass).or(at);
        }
        laid
    }
}

/// The best order of a layer on the heat so far, and the length of travels of the `usual` order, which only travels little, mm.
pub(super) fn order(
    islands: &[Fill],
    usual: Vec<Path>,
    settings: &OrderSettings,
    balance: &Balance,
    from: DVec2,
    warmth: Warmth,
) -> (Laid, f64) {
    let usual = Laid::of(usual, from, warmth, balance);
    let (travel, length) = (usual.travel, usual.passes.iter().map(Path::length).sum::<f64>());
    let longest = travel + balance.detour * length;
    let weights = if usual.passes.len() <= MOST_PASSES { &WEIGHTS[..] } else { &[] };
    let balanced = weights.iter().map(|&weight| {
        let mut next = Next { settings, balance, weight, at: from, warmth };
        Laid::of(next.layer(islands.to_vec()), from, warmth, balance)
    });
    let short = balanced.filter(|laid| laid.travel <= longest);
    (short.fold(usual, |best, other| if other.warmth.sum < best.warmth.sum { other } else { best }), travel)
}

/// Goes from pass to pass, each time to the one after which the heat lies best.
struct Next<'a> {
    settings: &'a OrderSettings,
    balance: &'a Balance,
    /// Weight of the way to a pass.
    weight: f64,
    at: DVec2,
    warmth: Warmth,
}

impl Next<'_> {
    fn layer(&mut self, mut islands: Vec<Fill>) -> Vec<Path> {
        direction::settle_open(&mut islands, self.settings);
        islands.retain(|fill| !fill.is_empty());
        let mut ordered = Vec::new();
        while let Some(fill) = take_best(&mut islands, |fill| (self.cost_of_island(fill), ())).map(|(fill, ())| fill) {
            for stage in fill.stages {
                ordered.extend(if fill.fixed_order { self.fixed(stage) } else { self.stage(stage) });
            }
        }
        direction::turn_closed(&mut ordered, self.settings);
        ordered
    }

    fn cost_of_island(&self, fill: &Fill) -> f64 {
        let first = fill.stages.iter().flatten().next();
        let way = first.map_or(0.0, |pass| {
            self.gates(pass).map(|gate| self.at.distance(gate.enter)).fold(f64::INFINITY, f64::min)
        });
        self.warmth.after(fill.stages.iter().flatten(), self.balance) + self.weight * way
    }

    fn fixed(&mut self, stage: Vec<Path>) -> Vec<Path> {
        let stage: Vec<Path> = stage.into_iter().map(|pass| begin_at_seam(pass, self.settings)).collect();
        stage.iter().for_each(|pass| self.go(pass));
        stage
    }

    fn stage(&mut self, mut stage: Vec<Path>) -> Vec<Path> {
        let mut ordered = Vec::with_capacity(stage.len());
        while let Some((pass, gate)) = take_best(&mut stage, |pass| self.best_gate(pass)) {
            let pass = begin_at(pass, gate.enter);
            self.go(&pass);
            ordered.push(pass);
        }
        ordered
    }

    fn go(&mut self, pass: &Path) {
        self.warmth.lay(pass, self.balance);
        self.at = last_point(pass).unwrap_or(self.at);
    }

    /// Where a pass may begin: at either end of an open one, where a closed one is nearest.
    fn gates(&self, pass: &Path) -> impl Iterator<Item = Gate> {
        let stop = self.settings.stop(pass);
        let nearest = pass.closed.then(|| stop.best_gate(Some(self.at), None));
        let ends: Vec<Gate> = if pass.closed { Vec::new() } else { stop.gates().collect() };
        nearest.into_iter().chain(ends)
    }

    /// The better way to lay a pass, and its cost, mm.
    fn best_gate(&self, pass: &Path) -> (f64, Gate) {
        let cost = |gate: Gate| {
            let begun = begin_at(pass.clone(), gate.enter);
            let apart = self.warmth.after(std::iter::once(&begun), self.balance);
            (apart + self.weight * self.at.distance(gate.enter), gate)
        };
        let nowhere = (f64::INFINITY, Gate { enter: self.at, leave: self.at });
        self.gates(pass).map(cost).fold(nowhere, |best, other| if other.0 < best.0 { other } else { best })
    }
}

/// Takes the item with the least cost out of a list, the first of several.
fn take_best<T, V>(items: &mut Vec<T>, cost: impl Fn(&T) -> (f64, V)) -> Option<(T, V)> {
    let costs = items.iter().map(cost).enumerate();
    let (index, (_, value)) = costs.min_by(|a, b| a.1.0.total_cmp(&b.1.0))?;
    Some((items.remove(index), value))
}
