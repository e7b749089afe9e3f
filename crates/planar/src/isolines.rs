//! Lines along which a field on a lattice has a whole-number value (marching squares).
//!
//! The lines are closed if the field is below 1 at the rim of the lattice; they are nested and never cross. Higher
//! values lie to their left.

use crate::lattice::Lattice;
use glam::DVec2;

/// A closed line of one value.
#[derive(Debug, Clone, PartialEq)]
pub struct Isoline {
    /// The value, 1 or more.
    pub level: u32,
    /// Its points; the first one is not repeated.
    pub points: Vec<DVec2>,
}

/// A place where a line crosses an edge of the lattice: level, then edge.
type Key = u64;

/// The closed lines of all whole values from 1 upwards, in ascending order.
///
/// ```
/// use planar::{Bounds, DVec2, Lattice, isolines::isolines};
///
/// // A cone that is 3.7 high has one line at each of the heights 1, 2 and 3.
/// let bounds = Bounds { min: DVec2::splat(-5.0), max: DVec2::splat(5.0) };
/// let lattice = Lattice::covering(&bounds, 0.0, 0.5, 1);
/// let cone: Vec<f32> = (0..lattice.len()).map(|i| 3.7 - lattice.place_of(i).length() as f32).collect();
/// let levels: Vec<u32> = isolines(&lattice, &cone).iter().map(|line| line.level).collect();
/// assert_eq!(levels, [1, 2, 3]);
/// ```
pub fn isolines(lattice: &Lattice, values: &[f32]) -> Vec<Isoline> {
    let mut pieces = pieces(lattice, values);
    pieces.sort_unstable();
    let mut used = vec![false; pieces.len()];
    let mut lines = Vec::new();
    for first in 0..pieces.len() {
        let mut points = Vec::new();
        let mut here = Some(first);
        while let Some(i) = here.filter(|&i| !std::mem::replace(&mut used[i], true)) {
            let (from, to) = pieces[i];
            points.push(crossing(lattice, values, from));
            here = pieces.binary_search_by_key(&to, |piece| piece.0).ok();
        }
        if points.len() >= 3 && here == Some(first) {
            lines.push(Isoline { level: (pieces[first].0 >> 40) as u32, points });
        }
    }
    lines
}

/// The segments of the lines within the lattice's cells, each from where it enters a cell to where it leaves it.
fn pieces(lattice: &Lattice, values: &[f32]) -> Vec<(Key, Key)> {
    let columns = lattice.columns;
    let mut pieces = Vec::new();
    for row in 0..lattice.rows - 1 {
        for i in row * columns..(row + 1) * columns - 1 {
            // Corners counter-clockwise, as are the sides between them.
            let corners = [values[i], values[i + 1], values[i + columns + 1], values[i + columns]];
            let low = corners.iter().copied().fold(f32::INFINITY, f32::min);
            let high = corners.iter().copied().fold(f32::NEG_INFINITY, f32::max);
            let first = low.floor().max(0.0) as u64 + 1;
            if high < first as f32 {
                continue;
            }
            let sides = [2 * i, 2 * (i + 1) + 1, 2 * (i + columns), 2 * i + 1];
            for level in first..=high.floor() as u64 {
                let above = corners.map(|value| value >= level as f32);
                let key = |side: usize| level << 40 | sides[side] as u64;
                // Going counter-clockwise, a line enters through a side that begins on high ground and leaves through
                // one that ends there.
                let enters = |side: &usize| above[*side] && !above[(side + 1) % 4];
                let leaves = |side: &usize| !above[*side] && above[(side + 1) % 4];
                let middle = corners.iter().sum::<f32>() / 4.0 >= level as f32;
                for enter in (0..4).filter(enters) {
                    // At a saddle, the mean of the corners decides whether the high corners are connected.
                    let turn = |k: usize| (enter + k) % 4;
                    let order = if middle { [turn(1), turn(2), turn(3)] } else { [turn(3), turn(2), turn(1)] };
                    if let Some(leave) = order.into_iter().find(leaves) {
                        pieces.push((key(enter), key(leave)));
                    }
                }
            }
        }
    }
    pieces
}

fn crossing(lattice: &Lattice, values: &[f32], key: Key) -> DVec2 {
    let (level, edge) = ((key >> 40) as f64, (key & ((1 << 40) - 1)) as usize);
    let (i, upright) = (edge / 2, edge % 2 == 1);
    let j = if upright { i + lattice.columns } else { i + 1 };
    let (a, b) = (f64::from(values[i]), f64::from(values[j]));
    lattice.place_of(i).lerp(lattice.place_of(j), (level - a) / (b - a))
}
