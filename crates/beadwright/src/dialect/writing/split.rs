//! Layers too long for one program, cut into parts.

use crate::program::Instruction;

/// Cuts between passes into consecutive parts of at most `most` (over 0) instructions; only a longer pass makes a
/// longer part.
pub(in crate::dialect) fn passes(instructions: &[Instruction], most: usize) -> Vec<&[Instruction]> {
    let (mut parts, mut start, mut between) = (Vec::new(), 0, 0);
    let ends = instructions.iter().enumerate().filter(|(_, i)| matches!(i, Instruction::ArcOff { .. }));
    for end in ends.map(|(i, _)| i + 1) {
        if end - start > most && between > start {
            parts.push(&instructions[start..between]);
            start = between;
        }
        between = end;
    }
    parts.push(&instructions[start..]);
    parts
}

/// Cuts between passes into consecutive parts of at most `most` (over 0) instructions; a longer pass is cut between its
/// moves.
pub(in crate::dialect) fn parts(instructions: &[Instruction], most: usize) -> Vec<&[Instruction]> {
    let (mut parts, mut start, mut between) = (Vec::new(), 0, 0);
    for i in 1..instructions.len() {
        if matches!(instructions[i - 1], Instruction::ArcOff { .. }) {
            between = i;
        }
        let inside = matches!(instructions[i], Instruction::Weld { .. });
        let cut = if between > start {
            between
        } else if inside {
            i
        } else {
            continue;
        };
        if i - start >= most {
            parts.push(&instructions[start..cut]);
            start = cut;
        }
    }
    parts.push(&instructions[start..]);
    parts
}

#[cfg(test)]
mod tests {
    use super::{parts, passes};
    use crate::pass::PassKind;
    use crate::program::Instruction;
    use glam::DVec3;

    /// Passes of these numbers of moves, each with two travels, arc on and arc off.
    fn layer(moves: &[usize]) -> Vec<Instruction> {
        let to = DVec3::ZERO;
        let pass = |&count: &usize| {
            let weld = Instruction::Weld { to, circle: None, speed: 1.0, last: false };
            let head = [Instruction::Travel { to }, Instruction::Travel { to }];
            let on = Instruction::ArcOn { pass: 1, kind: PassKind::Infill };
            head.into_iter()
                .chain([on])
                .chain(vec![weld; count])
                .chain([Instruction::ArcOff { pass: 1 }])
                .collect::<Vec<_>>()
        };
        moves.iter().flat_map(pass).collect()
    }

    #[test]
    fn whole_passes_stay_together() {
        let sizes = |moves: &[usize]| passes(&layer(moves), 10).iter().map(|p| p.len()).collect::<Vec<_>>();
        assert_eq!(sizes(&[3]), [7]);
        assert_eq!(sizes(&[1, 1]), [10]);
        assert_eq!(sizes(&[3, 3, 1]), [7, 7, 5]);
        assert_eq!(sizes(&[25, 1, 25]), [29, 5, 29]);
        assert_eq!(sizes(&[]), [0]);
    }

    #[test]
    fn layers_are_cut_between_passes_and_long_passes_between_moves() {
        let sizes = |moves: &[usize]| parts(&layer(moves), 10).iter().map(|p| p.len()).collect::<Vec<_>>();
        assert_eq!(sizes(&[3]), [7]);
        assert_eq!(sizes(&[1, 1]), [10]);
        assert_eq!(sizes(&[3, 3, 1]), [7, 7, 5]);
        assert_eq!(sizes(&[25]), [10, 10, 9]);
        assert_eq!(sizes(&[25, 1]).iter().sum::<usize>(), 34);
    }
}
