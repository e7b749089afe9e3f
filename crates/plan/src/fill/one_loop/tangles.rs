//! Lines that would cross when they move go back to where they were.

use super::line::Line;
use crate::fill::sound::crossing_pieces;
use glam::DVec2;

/// Points to each side of a crossing that go back at first, and the factor by which they grow with each further attempt.
const AROUND: usize = 4;
const MORE: usize = 3;
/// After this many attempts all points go back.
const ATTEMPTS: u32 = 4;

/// What is done after each round to lines as they are, given how they were before it.
pub type Mend = fn(&mut [Line], &[Line]);

/// Moves lines in rounds, so that lines that do not cross do not cross afterwards: first without checking for crossings, which
/// takes time, and once more with the check where that tangles them.
pub fn moved(lines: &[Line], rounds: impl Fn(Vec<Line>, Mend) -> Vec<Line>) -> Vec<Line> {
    let quick = rounds(lines.to_vec(), |_, _| {});
    if tangled(&quick) && !tangled(lines) { rounds(lines.to_vec(), untangle) } else { quick }
}

/// Whether lines cross each other or themselves.
pub fn tangled(lines: &[Line]) -> bool {
    !crossing_pieces(&paths(lines)).is_empty()
}

/// Moves points back to where they were `before`, with the neighbouring widths, until no line crosses another or itself; the
/// lines have the same points in the same order, and did not cross before.
fn untangle(lines: &mut [Line], before: &[Line]) {
    for attempt in 0..ATTEMPTS {
        let crossings = crossing_pieces(&paths(lines));
        if crossings.is_empty() {
            return;
        }
        let around = AROUND * MORE.pow(attempt);
        for (line, piece) in crossings.into_iter().flat_map(|crossing| crossing.pieces) {
            lines[line].take_back(&before[line], piece, around);
        }
    }
    lines.clone_from_slice(before);
}

fn paths(lines: &[Line]) -> Vec<Vec<DVec2>> {
    lines.iter().map(Line::path).collect()
}

impl Line {
    /// Moves back the points around a piece.
    fn take_back(&mut self, before: &Self, piece: usize, around: usize) {
        let n = self.points.len();
        for k in 0..=2 * around + 1 {
            let at = match self.closed {
                true => Some((piece + k + (around / n + 1) * n - around) % n),
                false => (piece + k).checked_sub(around).filter(|at| *at < n),
            };
            if let Some(i) = at {
                (self.points[i], self.widths[i]) = (before.points[i], before.widths[i]);
            }
        }
    }
}
