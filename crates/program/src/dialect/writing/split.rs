//! Layers too long for one program, cut into parts.

use crate::program::Instruction;

/// Cuts between passes, where the torch is above the part, into consecutive parts of at most `most` (above 0)
/// instructions; only a longer pass makes a longer part.
pub(in crate::dialect) fn passes(instructions: &[Instruction], most: usize) -> Vec<&[Instruction]> {
    let (mut parts, mut start, mut between) = (Vec::new(), 0, 0);
    let ends = |i: &usize| matches!(instructions[*i], Instruction::PassEnd);
    for end in (0..instructions.len()).filter(ends).map(|i| i + 1) {
        if end - start > most && between > start {
            parts.push(&instructions[start..between]);
            start = between;
        }
        between = end;
    }
    parts.push(&instructions[start..]);
    parts
}

#[cfg(test)]
mod tests {
    use super::passes;
    use crate::program::{Attitude, Instruction};
    use bead_plan::pass::PassKind;
    use glam::DVec3;

    /// Passes with these numbers of moves, each with a travel, arc on, arc off and the way up.
    fn layer(moves: &[usize]) -> Vec<Instruction> {
        let to = DVec3::ZERO;
        let pass = |&count: &usize| {
            let weld = Instruction::Weld { to, circle: None, speed: 1.0, last: false, attitude: Attitude::default() };
            let head = [Instruction::Travel { to }];
            let on = Instruction::ArcOn { pass: 1, kind: PassKind::Infill };
            head.into_iter()
                .chain([on])
                .chain(vec![weld; count])
                .chain([Instruction::ArcOff { pass: 1 }, Instruction::Retract { to }, Instruction::PassEnd])
                .collect::<Vec<_>>()
        };
        moves.iter().flat_map(pass).collect()
    }

    #[test]
    fn whole_passes_stay_together() {
        let sizes = |moves: &[usize]| passes(&layer(moves), 12).iter().map(|p| p.len()).collect::<Vec<_>>();
        assert_eq!(sizes(&[3]), [8]);
        assert_eq!(sizes(&[1, 1]), [12]);
        assert_eq!(sizes(&[3, 3, 1]), [8, 8, 6]);
        assert_eq!(sizes(&[25, 1, 25]), [30, 6, 30]);
        assert_eq!(sizes(&[]), [0]);
    }
}
