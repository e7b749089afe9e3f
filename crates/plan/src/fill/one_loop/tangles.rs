//! Moves back lines that would cross, or fold back on themselves.

use super::line::Line;
use crate::fill::sound::crossing_pieces;
use glam::DVec2;

/// Points on each side of a crossing that are moved back at first, and the factor by which their number grows with each
/// attempt.
const AROUND: usize = 4;
const MORE: usize = 3;
/// After this many attempts all points are moved back.
const ATTEMPTS: u32 = 4;

/// What is done after each round, given the lines as they are and as they were before it.
pub type Mend = fn(&mut [Line], &[Line]);

/// Moves lines in rounds so that lines that do not cross do not cross afterwards: first without checking for crossings,
/// which takes time, and again with the check if that tangled them.
pub fn moved(lines: &[Line], rounds: impl Fn(Vec<Line>, Mend) -> Vec<Line>) -> Vec<Line> {
    let quick = rounds(lines.to_vec(), |_, _| {});
    let is_worse = (tangled(&quick) && !tangled(lines)) || new_folds(&quick, lines).next().is_some();
    if is_worse { rounds(lines.to_vec(), untangle) } else { quick }
}

/// A line folds where the cosine of its turn is below this, about 150°.
const FOLD: f64 = -0.87;

/// Where lines fold and did not `before`: indices of the line and of the piece after the fold.
fn new_folds<'a>(lines: &'a [Line], before: &'a [Line]) -> impl Iterator<Item = (usize, usize)> + 'a {
    let folds = |line: &Line, i: usize| {
        let (here, way) = (line.points[i], line.points[line.behind(i)] - line.points[i]);
        let back = here - line.points[line.before(i)];
        back.dot(way) < FOLD * back.length() * way.length()
    };
    let is_new = move |number: usize, i: usize| {
        let line = &lines[number];
        !line.is_end(i) && folds(line, i) && !folds(&before[number], i)
    };
    (0..lines.len()).flat_map(move |number| {
        (0..lines[number].points.len()).filter(move |&i| is_new(number, i)).map(move |i| (number, i))
    })
}

/// Whether lines cross each other or themselves.
pub fn tangled(lines: &[Line]) -> bool {
    !crossing_pieces(&paths(lines)).is_empty()
}

/// Moves points back to where they were `before`, with the neighbouring widths, until no line crosses another or itself
/// or folds. The lines have the same points in the same order, and did not cross before.
fn untangle(lines: &mut [Line], before: &[Line]) {
    for attempt in 0..ATTEMPTS {
        let crossings = crossing_pieces(&paths(lines)).into_iter().flat_map(|crossing| crossing.pieces);
        let faults: Vec<(usize, usize)> = crossings.chain(new_folds(lines, before)).collect();
        if faults.is_empty() {
            return;
        }
        let around = AROUND * MORE.pow(attempt);
        for (line, piece) in faults {
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
