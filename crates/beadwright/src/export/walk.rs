//! The torch's walk over a plan: what each pass becomes when it is welded, with times and waits.

use super::Piece;
use crate::chart::Sheet;
use crate::layer::Layer;
use crate::pass::Pass;
use crate::plan::charted;
use crate::profile::LayersSection;
use crate::program::Tilt;
use crate::weld::{Torch, path};
use glam::{DVec2, DVec3};

/// A pass as it is welded.
pub(super) struct Run<'a> {
    pub(super) layer: &'a Layer,
    pub(super) pass: &'a Pass,
    /// Its straight pieces, with overlap, hot start and lead-out.
    pub(super) pieces: Vec<Piece>,
    /// The torch's lean at each end of a piece, one more than there are pieces; empty where it stays upright.
    pub(super) leans: Vec<DVec2>,
    /// Wait before the arc is struck: between layers, s.
    pub(super) pause: f64,
    /// Time for gas and arc start before the torch moves, s.
    pub(super) before: f64,
    /// Time for the crater, arc end and gas after the torch has stopped, s.
    pub(super) after: f64,
    /// Time of the travel to its start, s.
    pub(super) travel: f64,
}

/// The passes of layers in the order in which they are welded, by a torch that `tilt` makes lean, if it does; `lie` says how
/// the layers lie in space.
pub(super) fn runs<'a>(layers: &'a [Layer], torch: Torch, tilt: Option<Tilt>, lie: &LayersSection) -> Vec<Run<'a>> {
    let mut walk = Walk { torch, tilt, now: 0.0 };
    let mut found = Vec::new();
    // The way up belongs to the pass that ends, but is travelled before the next one.
    let mut travel = 0.0;
    for layer in layers.iter().filter(|layer| !layer.passes.is_empty()) {
        walk.tilt.iter_mut().for_each(|tilt| tilt.enter(layer));
        let begun = walk.torch.begin_layer(layer, 0);
        travel += begun.transfer.map_or(0.0, |way| way.moving);
        let mut of_layer = begun.pause;
        for (number, pass) in (1..).zip(&layer.passes) {
            let Some(start) = pass.start() else { continue };
            let pauses = [of_layer.take(), walk.torch.wait(pass.wait)];
            let pauses = || pauses.iter().flatten();
            travel += pauses().map(|pause| pause.moving).sum::<f64>() + walk.torch.approach(start).moving;
            let pause = pauses().map(|pause| pause.seconds).sum::<f64>();
            walk.now += travel + pause;
            let run = walk.run(layer, number, pass, lie.sheet(layer));
            found.push(Run { travel, pause, ..run });
            travel = walk.torch.retract().moving;
        }
    }
    found
}

/// Where the torch is on its walk.
struct Walk {
    torch: Torch,
    /// `None` where the torch stays upright.
    tilt: Option<Tilt>,
    /// Time since the build began, s.
    now: f64,
}

impl Walk {
    /// Welds a pass from its start.
    fn run<'a>(&mut self, layer: &'a Layer, number: usize, pass: &'a Pass, sheet: Option<Sheet<'_>>) -> Run<'a> {
        let (mut moves, wide) = (path(pass, self.torch.ends()), pass.width.max());
        if self.tilt.is_some() {
            moves = Tilt::divided(moves, wide);
        }
        if let Some(sheet) = sheet {
            moves = followed(moves, &sheet);
        }
        let leans = self.tilt.as_ref().map(|tilt| tilt.leans(&moves, wide)).unwrap_or_default();
        let welded = self.torch.weld(pass.kind, &moves);
        let steady: f64 = moves.windows(2).map(|w| w[0].0.distance(w[1].0) / self.torch.speed_at(w[1].1)).sum();
        // Acceleration and deceleration are spread over the pass.
        let slower = if steady > 0.0 { welded.moving / steady } else { 1.0 };
        let (mut start, mut way, widths) = (self.now + welded.before, 0.0, widths(pass));
        let mut pieces = Vec::with_capacity(moves.len());
        for pair in moves.windows(2) {
            let (from, (to, pace)) = (pair[0].0, pair[1]);
            let (speed, feed) = (self.torch.speed_at(pace), self.torch.feed_at(pace));
            let seconds = from.distance(to) / speed * slower;
            let width = widths.iter().find(|(end, _)| way < end - 1e-9).or(widths.last()).map_or(0.0, |w| w.1);
            let normal = sheet.map_or(DVec3::Z, |sheet| sheet.at(from.midpoint(to)).normal);
            let (layer, height, kind) = (layer.index + 1, layer.height, pass.kind);
            pieces.push(Piece {
                layer,
                pass: number,
                kind,
                from,
                to,
                normal,
                width,
                height,
                speed,
                pace,
                feed,
                start,
                seconds,
                temperature: f64::NAN,
            });
            way += from.distance(to);
            start += seconds;
        }
        let after = welded.crater + welded.after;
        self.now += welded.before + welded.moving + after;
        Run { layer, pass, pieces, leans, pause: 0.0, before: welded.before, after, travel: 0.0 }
    }
}

/// Moves close enough together that the straight pieces between them follow their layer.
fn followed(moves: Vec<(DVec3, f64)>, sheet: &Sheet<'_>) -> Vec<(DVec3, f64)> {
    let points: Vec<DVec3> = moves.iter().map(|(to, _)| *to).collect();
    let pace = |piece: usize| moves[(piece + 1).min(moves.len() - 1)].1;
    let mut before = 0;
    let followed = charted::followed(&points, false, sheet).into_iter().map(|(to, piece)| {
        let own = std::mem::replace(&mut before, piece);
        (to, pace(own))
    });
    followed.collect()
}

/// How far along a pass each width reaches, mm, and the width, mm; all of it twice, for the overlap of a closed pass.
fn widths(pass: &Pass) -> Vec<(f64, f64)> {
    let mut way = 0.0;
    let mut once: Vec<(f64, f64)> = Vec::new();
    for segment in pass.segments() {
        way += segment.length();
        once.push((way, segment.width));
    }
    let again: Vec<(f64, f64)> = once.iter().map(|(end, width)| (end + way, *width)).collect();
    once.extend(again);
    once
}
