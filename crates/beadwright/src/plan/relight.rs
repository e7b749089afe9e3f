//! Passes too long for one program of a controller. No program may end while the arc burns, so the arc ends, the crater is
//! filled, and the next program strikes it again on the end of the bead.

use crate::layer::Layer;
use crate::pass::Pass;
use crate::program::Programmer;
use crate::warning::{Warning, WarningKind};

/// Passes of fewer moves than this are never cut; their instructions are not even counted.
const LEAST: usize = 10;

/// How passes are cut that are too long for a program.
#[derive(Debug, Clone)]
pub(super) struct Relighting {
    /// The most instructions that a pass may have; `None` where it may have any number.
    pub(super) most: Option<usize>,
    /// How far the pieces of a pass overlap, mm.
    pub(super) overlap: f64,
    /// Counts instructions.
    pub(super) programmer: Programmer,
}

/// Cuts the passes of a layer that have more moves than a program can hold, and warns of each.
pub(super) fn relight(layer: &mut Layer, settings: &Relighting) {
    let Some(most) = settings.most else { return };
    let cut = |pass: Pass| if pass.points.len() + LEAST <= most { vec![pass] } else { pieces(pass, most, settings) };
    for pieces in std::mem::take(&mut layer.passes).into_iter().map(cut) {
        if let Some(again) = pieces.get(1) {
            let (kind, place) = (WarningKind::Relit, again.start().unwrap_or_default().truncate());
            let size = (pieces.len() - 1) as f64;
            layer.warnings.push(Warning { kind, layer: layer.index, place, size });
        }
        layer.passes.extend(pieces);
    }
}

/// A pass in as few pieces of equal length as the programs need.
fn pieces(pass: Pass, most: usize, settings: &Relighting) -> Vec<Pass> {
    let fits = |pass: &Pass| instructions(pass, settings) <= most;
    if fits(&pass) {
        return vec![pass];
    }
    let most_pieces = pass.points.len();
    (2..most_pieces)
        .map(|count| equal_pieces(&pass, count, settings.overlap))
        .find(|pieces| pieces.iter().all(fits))
        .unwrap_or_else(|| vec![pass])
}

/// Number of instructions that a program needs for a pass.
fn instructions(pass: &Pass, settings: &Relighting) -> usize {
    let layer = Layer { passes: vec![pass.clone()], ..Layer::default() };
    settings.programmer.clone().layer(&layer).instructions.len()
}

/// A pass cut into open pieces of equal length, each of which begins `overlap` (mm) before the end of the one before;
/// the last piece of a closed pass ends that far beyond its start.
fn equal_pieces(pass: &Pass, count: usize, overlap: f64) -> Vec<Pass> {
    let (length, around) = (pass.length(), if pass.closed { overlap } else { 0.0 });
    let at = |k: usize| length * k as f64 / count as f64;
    let begin = |k: usize| if k == 0 { 0.0 } else { (at(k) - overlap).max(0.0) };
    let end = |k: usize| if k == count { length + around } else { at(k) };
    (0..count).map(|k| pass.stretch(begin(k), end(k + 1))).collect()
}
