//! Where a region crosses horizontal rows: tells which of many points on a grid lie inside.

use crate::{Region, Ring};

/// The items of many rows, in one allocation.
#[derive(Debug, Clone, PartialEq)]
pub struct PerRow<T> {
    items: Vec<T>,
    /// Where each row begins, and where the last one ends.
    starts: Vec<usize>,
}

impl<T> PerRow<T> {
    /// Sorts items into `count` rows; within a row they keep their order.
    pub fn grouped(count: usize, things: impl Iterator<Item = (usize, T)> + Clone) -> Self
    where
        T: Clone + Default,
    {
        let mut starts = vec![0; count + 1];
        things.clone().for_each(|(row, _)| starts[row + 1] += 1);
        (0..count).for_each(|row| starts[row + 1] += starts[row]);
        // Counting sort: with the rows counted, each item's position is known.
        let (mut items, mut next) = (vec![T::default(); starts[count]], starts.clone());
        for (row, thing) in things {
            items[next[row]] = thing;
            next[row] += 1;
        }
        Self { items, starts }
    }

    /// How many rows there are.
    pub fn count(&self) -> usize {
        self.starts.len() - 1
    }

    /// All items, one row after the other.
    pub fn into_items(self) -> Vec<T> {
        self.items
    }

    /// The items of each row, mutable.
    pub fn iter_mut(&mut self) -> impl Iterator<Item = &mut [T]> {
        let mut rest = self.items.as_mut_slice();
        self.starts.windows(2).map(move |ends| {
            let (row, after) = std::mem::take(&mut rest).split_at_mut(ends[1] - ends[0]);
            rest = after;
            row
        })
    }

    /// The items of a row; none beyond the last row.
    pub fn row(&self, row: usize) -> &[T] {
        self.starts.get(row..row + 2).map_or(&[], |ends| &self.items[ends[0]..ends[1]])
    }

    /// The rows in order.
    pub fn iter(&self) -> impl Iterator<Item = &[T]> {
        self.starts.windows(2).map(|ends| &self.items[ends[0]..ends[1]])
    }
}

impl<T, R: IntoIterator<Item = T>> FromIterator<R> for PerRow<T> {
    fn from_iter<I: IntoIterator<Item = R>>(rows: I) -> Self {
        let (mut items, mut starts) = (Vec::new(), vec![0]);
        for row in rows {
            items.extend(row);
            starts.push(items.len());
        }
        Self { items, starts }
    }
}

impl Region {
    /// For each of `count` rows y = `first` + k · `step`, the sorted x (mm) at which it crosses the boundary. The row
    /// is inside between the first and the second, the third and the fourth, and so on.
    ///
    /// ```
    /// use planar::{DVec2, Polygon, Region, Ring};
    ///
    /// let corners = [(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)].map(DVec2::from);
    /// let square = Region::from(Polygon::simple(Ring::new(corners.to_vec())));
    /// assert!(square.rows(0.5, 1.0, 10).iter().all(|row| row == [0.0, 10.0]));
    /// ```
    pub fn rows(&self, first: f64, step: f64, count: usize) -> PerRow<f64> {
        crossings(self.rings(), first, step, count)
    }
}

/// [`Region::rows`] for loose rings.
pub(crate) fn crossings<'a>(
    rings: impl IntoIterator<Item = &'a Ring>,
    first: f64,
    step: f64,
    count: usize,
) -> PerRow<f64> {
    let mut found = Vec::new();
    for ring in rings {
        cross(ring, first, step, count, &mut found);
    }
    let mut rows = PerRow::grouped(count, found.into_iter());
    rows.iter_mut().for_each(|row| row.sort_unstable_by(f64::total_cmp));
    rows
}

/// Adds the crossings of one ring, each with its row. An edge includes its lower end but not its upper one, so every row
/// is crossed an even number of times.
fn cross(ring: &Ring, first: f64, step: f64, count: usize, found: &mut Vec<(usize, f64)>) {
    for (a, b) in ring.edges() {
        let (low, high) = if a.y <= b.y { (a, b) } else { (b, a) };
        // A cast turns negative values, those below the first row, into 0.
        for row in ((low.y - first) / step) as usize..count {
            let y = first + row as f64 * step;
            if y >= high.y {
                break;
            }
            if y >= low.y {
                found.push((row, low.x + (y - low.y) / (high.y - low.y) * (high.x - low.x)));
            }
        }
    }
}
