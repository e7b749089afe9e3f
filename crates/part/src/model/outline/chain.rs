//! Joins loose pieces of outlines where their ends meet.

use glam::DVec2;
use planar::{Bounds, Ring};
use std::collections::HashMap;

/// Ends closer than this fraction of the drawing's extent are one.
const JOIN: f64 = 1e-5;

/// A chain that does not close: its ends, in the units of the file.
pub(super) struct Gap(pub(super) DVec2, pub(super) DVec2);

/// The rings formed by pieces of at least two points; each piece is used once.
pub(super) fn rings(pieces: Vec<Vec<DVec2>>) -> Result<Vec<Ring>, Gap> {
    let extent = Bounds::of(pieces.iter().flatten().copied()).map_or(0.0, |bounds| bounds.size().max_element());
    let mut ends = Ends { cells: HashMap::new(), step: (JOIN * extent).max(f64::MIN_POSITIVE), pieces };
    for i in 0..ends.pieces.len() {
        for end in [false, true] {
            let cell = ends.cell(ends.end(i, end));
            ends.cells.entry(cell).or_default().push((i, end));
        }
    }
    let (mut used, mut rings) = (vec![false; ends.pieces.len()], Vec::new());
    for first in 0..ends.pieces.len() {
        if std::mem::replace(&mut used[first], true) {
            continue;
        }
        let mut chain = ends.pieces[first].clone();
        while let (Some(&start), Some(&last)) = (chain.first(), chain.last()) {
            if chain.len() > 2 && start.distance(last) <= ends.step {
                chain.pop();
                rings.push(Ring::new(chain));
                break;
            }
            let (next, backwards) = ends.at(last, &used).ok_or(Gap(start, last))?;
            used[next] = true;
            let mut piece = ends.pieces[next].clone();
            if backwards {
                piece.reverse();
            }
            chain.extend(piece.into_iter().skip(1));
        }
    }
    Ok(rings)
}

/// The ends of all pieces, by position.
struct Ends {
    pieces: Vec<Vec<DVec2>>,
    cells: HashMap<[i64; 2], Vec<(usize, bool)>>,
    step: f64,
}

impl Ends {
    fn cell(&self, at: DVec2) -> [i64; 2] {
        (at / self.step).to_array().map(|v| v.floor() as i64)
    }

    /// The first or the last point of a piece.
    fn end(&self, piece: usize, last: bool) -> DVec2 {
        let points = &self.pieces[piece];
        let end = if last { points.last() } else { points.first() };
        end.copied().unwrap_or_default()
    }

    /// The nearest unused piece that begins or ends at a position, and whether that is its end.
    fn at(&self, place: DVec2, used: &[bool]) -> Option<(usize, bool)> {
        let [x, y] = self.cell(place);
        let near = (-1..=1).flat_map(|dx| (-1..=1).map(move |dy| [x + dx, y + dy]));
        let found = near.filter_map(|cell| self.cells.get(&cell)).flatten().filter(|(piece, _)| !used[*piece]);
        let away = |(piece, last): &(usize, bool)| self.end(*piece, *last).distance(place);
        let meeting = found.copied().filter(|end| away(end) <= self.step);
        meeting.min_by(|a, b| away(a).total_cmp(&away(b)).then(a.cmp(b)))
    }
}
