//! A plan as the record sees it.

use super::{Place, PlannedPass, Settings};
use crate::export::{Beads, Piece};
use crate::pass::PassKind;
use crate::process::{Process, StartStop};
use crate::profile::Profile;
use std::collections::HashSet;

/// The passes of a plan with the times at which they are welded. The turns of a helix are one pass, that of its first layer.
pub fn planned(beads: &Beads<'_>) -> Vec<PlannedPass> {
    let going_on: HashSet<usize> =
        beads.layers.iter().filter(|layer| layer.lit.before).map(|layer| layer.index + 1).collect();
    let mut passes: Vec<PlannedPass> = Vec::new();
    for pieces in beads.pieces().chunk_by(|a, b| (a.layer, a.pass) == (b.layer, b.pass)) {
        let pass = pass(pieces, &beads.profile.process, &beads.profile.start_stop);
        match passes.last_mut().filter(|_| going_on.contains(&pass.layer)) {
            Some(helix) => {
                helix.path.extend(pass.path);
                helix.out = pass.out;
            }
            None => passes.push(pass),
        }
    }
    passes
}

fn pass(pieces: &[Piece], process: &Process, ends: &StartStop) -> PlannedPass {
    let (first, last) = (&pieces[0], &pieces[pieces.len() - 1]);
    let process = process.at_layer(first.layer - 1);
    let place =
        |piece: &Piece, at, time| Place { at, time, feed: piece.feed * process.wire_feed_speed, speed: piece.speed };
    let end = last.start + last.seconds;
    let path = pieces.iter().map(|piece| place(piece, piece.from, piece.start)).chain([place(last, last.to, end)]);
    let ends = ends.at_layer(first.layer - 1);
    let crater = if first.kind == PassKind::Spot { 0.0 } else { ends.crater_fill_time };
    PlannedPass {
        layer: first.layer,
        pass: first.pass,
        struck: first.start - process.arc_start_delay,
        out: end + crater,
        path: path.collect(),
        current: process.current,
        voltage: process.voltage,
        temperature: (!first.temperature.is_nan()).then_some(first.temperature),
    }
}

/// The limits of a record as a profile suggests them: the efficiency of its arc, and its limit between passes.
pub fn settings(profile: &Profile) -> Settings {
    let usual = Settings::default();
    Settings {
        efficiency: profile.heat.as_ref().map_or(usual.efficiency, |heat| heat.arc_efficiency),
        height: Some(profile.layers.height / 2.0),
        hottest: profile.interpass.as_ref().map(|limits| limits.max_temperature),
        ..usual
    }
}
