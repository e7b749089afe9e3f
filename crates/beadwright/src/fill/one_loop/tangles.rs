//! Lines that would cross when they move go back to where they were.

use super::line::Line;
use crate::fill::sound::crossing_pieces;
use glam::DVec2;

/// So many points to both sides of a crossing go back at first, and so many times more each time that this does not help.
const AROUND: usize = 4;
const MORE: usize = 3;
/// After so many times all points go back.
const TIMES: u32 = 4;

/// Whether lines cross each other or themselves.
pub fn tangled(lines: &[Line]) -> bool {
    !crossing_pieces(&paths(lines)).is_empty()
}

/// Takes points back to where they were `before`, with the widths beside them, until no line crosses another or itself; the
/// lines have the same points in the same order, and did not cross before.
pub fn untangle(lines: &mut [Line], before: &[Line]) {
    for time in 0..TIMES {
        let crossings = crossing_pieces(&paths(lines));
        if crossings.is_empty() {
            return;
        }
        let around = AROUND * MORE.pow(time);
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
    /// Takes the points around a piece back.
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
