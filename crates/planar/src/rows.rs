//! Where a region crosses horizontal rows: used to find which of many points on a grid lie inside.

use crate::{Region, Ring};

impl Region {
    /// For each of `count` rows y = `first` + k · `step`: the sorted places in x at which it crosses the boundary.
    /// The row is inside between the first and the second, the third and the fourth, and so on.
    pub fn rows(&self, first: f64, step: f64, count: usize) -> Vec<Vec<f64>> {
        crossings(self.rings(), first, step, count)
    }
}

/// [`Region::rows`] of loose rings.
pub(crate) fn crossings<'a>(
    rings: impl IntoIterator<Item = &'a Ring>,
    first: f64,
    step: f64,
    count: usize,
) -> Vec<Vec<f64>> {
    let mut rows = vec![Vec::new(); count];
    for ring in rings {
        cross(ring, first, step, &mut rows);
    }
    for row in &mut rows {
        row.sort_unstable_by(f64::total_cmp);
    }
    rows
}

/// Adds the crossings of one ring. An edge includes its lower end but not its upper one, so every row is crossed an
/// even number of times.
fn cross(ring: &Ring, first: f64, step: f64, rows: &mut [Vec<f64>]) {
    for (a, b) in ring.edges() {
        let (low, high) = if a.y <= b.y { (a, b) } else { (b, a) };
        let from = ((low.y - first) / step).floor().max(0.0) as usize;
        for (k, row) in rows.iter_mut().enumerate().skip(from) {
            let y = first + k as f64 * step;
            if y >= high.y {
                break;
            }
            if y >= low.y {
                row.push(low.x + (y - low.y) / (high.y - low.y) * (high.x - low.x));
            }
        }
    }
}
