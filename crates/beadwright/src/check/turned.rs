//! How a positioner turns the part while a plan is welded.

use super::Subject;
use crate::layer::Layer;
use crate::program::Instruction;
use glam::DVec3;

/// A move with the arc on.
pub(super) struct Turned<'a> {
    pub(super) layer: &'a Layer,
    /// Index of the pass in its layer.
    pub(super) pass: usize,
    /// Where the move ends, on its layer, mm.
    pub(super) place: DVec3,
    /// How far the pool then leans, °.
    pub(super) off_level: f64,
    /// How fast each axis turns on the way, °/s.
    pub(super) rates: [f64; 2],
}

/// All moves with the arc on; none where nothing turns the part.
pub(super) fn moves<'a>(subject: &'a Subject<'_>) -> Vec<Turned<'a>> {
    let (mut programmer, mut found) = (subject.whole.programmer(), Vec::new());
    // The axes continue from where the earlier bodies left them.
    for layer in subject.earlier {
        programmer.layer(layer);
    }
    for layer in &subject.layers {
        let (mut at, mut pass, mut before) = (DVec3::ZERO, 0, None);
        let near = layer.passes.first().and_then(|pass| pass.start()).unwrap_or_default().truncate();
        let sheet = subject.settings.layers.sheet(layer);
        let on_layer = |p: DVec3| sheet.map_or(p, |sheet| sheet.coordinates(p, near));
        for instruction in programmer.layer(layer).instructions {
            match instruction {
                Instruction::PassStart { pass: number, .. } => pass = number - 1,
                Instruction::Weld { to, speed, attitude, .. } => {
                    let Some(held) = attitude.held else { continue };
                    let seconds = (at.distance(to) / speed).max(f64::MIN_POSITIVE);
                    let angles: [f64; 2] = before.unwrap_or(held.angles);
                    let rates = std::array::from_fn(|k| (held.angles[k] - angles[k]).abs() / seconds);
                    let off_level = (held.turn * attitude.layer * DVec3::Z).angle_between(DVec3::Z).to_degrees();
                    found.push(Turned { layer, pass, place: on_layer(to), off_level, rates });
                }
                _ => {}
            }
            before = instruction.attitude().and_then(|attitude| attitude.held).map(|held| held.angles).or(before);
            at = instruction.target().unwrap_or(at);
        }
    }
    found
}
