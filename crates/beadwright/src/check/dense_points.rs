//! Points that come faster than the controller reads them.

use super::{Check, Finding, Subject};
use crate::program::Instruction;
use glam::DVec3;

pub(super) const CHECK: Check = Check {
    name: "dense-points",
    what: "points too dense: three or more consecutive moves that each take less than program.min_point_time",
    why: "the controller cannot look ahead far enough, slows down, and the bead becomes thick there",
    example: "layer 3: points too dense: 14 of its 250 moves take less than 0.012 s, the shortest 0.0040 s.",
    remedy: "raise program.chord_tolerance, fit arcs, or raise program.speed_tolerance where speeds change often",
    find,
};

/// Controllers cope with fewer short moves in a row than this.
const IN_A_ROW: usize = 3;

fn find(subject: &Subject<'_>) -> Vec<Finding> {
    let least = subject.settings.program.min_point_time;
    if least <= 0.0 {
        return Vec::new();
    }
    let mut programmer = subject.settings.programmer();
    let sound = |layer: &&&crate::layer::Layer| layer.passes.iter().flat_map(|p| &p.points).all(|p| p.is_finite());
    let finding = |layer: &&crate::layer::Layer| {
        let times = seconds(&programmer.layer(layer).instructions);
        let short = |time: &f64| *time < least;
        let dense = times.iter().any(|pass| pass.windows(IN_A_ROW).any(|w| w.iter().all(short)));
        let moves = || times.iter().flatten().copied();
        let shortest = moves().fold(f64::INFINITY, f64::min);
        let text = format!(
            "points too dense: {} of its {} moves take less than {least} s, the shortest {shortest:.4} s.",
            moves().filter(short).count(),
            moves().count()
        );
        dense.then(|| CHECK.of_layer(layer, None, text))
    };
    subject.layers.iter().filter(sound).filter_map(finding).collect()
}

/// Time of each weld move, pass by pass, s.
fn seconds(instructions: &[Instruction]) -> Vec<Vec<f64>> {
    let (mut times, mut at) = (Vec::<Vec<f64>>::new(), DVec3::ZERO);
    for instruction in instructions {
        match *instruction {
            Instruction::Approach { to } | Instruction::Travel { to } | Instruction::Retract { to } => at = to,
            Instruction::ArcOn { .. } => times.push(Vec::new()),
            Instruction::Weld { to, circle, speed, .. } => {
                let length = circle.map_or(at.distance(to), |c| c.length());
                at = to;
                times.last_mut().into_iter().for_each(|pass| pass.push(length / speed.max(1e-9)));
            }
            Instruction::PassStart { .. }
            | Instruction::Turn { .. }
            | Instruction::Above
            | Instruction::PassEnd
            | Instruction::WireFeed { .. }
            | Instruction::Crater { .. }
            | Instruction::Dwell { .. }
            | Instruction::ArcOff { .. } => {}
        }
    }
    times
}
