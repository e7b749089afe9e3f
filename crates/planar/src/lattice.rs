//! A square lattice of points, and values at them: the basis of distance fields, isolines and smoothing.

use crate::Bounds;
use glam::DVec2;

/// Points `step` apart in x and y, as many columns, and as many rows, on one side of the middle as on the other: a part
/// turned by a right angle gets the same lattice, turned.
///
/// ```
/// use planar::{Bounds, DVec2, Lattice};
///
/// let bounds = Bounds { min: DVec2::ZERO, max: DVec2::splat(20.0) };
/// let lattice = Lattice::covering(&bounds, 1.0, 0.5, 1);
/// assert_eq!((lattice.low(), lattice.columns), (DVec2::splat(-1.0), 45));
/// // A field that rises evenly is read exactly between the points too.
/// let rising: Vec<f32> = (0..lattice.len()).map(|i| lattice.place_of(i).x as f32).collect();
/// assert!((lattice.value_at(&rising, DVec2::new(3.1, 4.7)) - 3.1).abs() < 1e-5);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lattice {
    /// Its middle point.
    pub middle: DVec2,
    /// Distance of neighbouring points, mm.
    pub step: f64,
    /// Points in x.
    pub columns: usize,
    /// Points in y.
    pub rows: usize,
}

impl Lattice {
    /// The lattice centred on a box grown by `margin` (mm). On either side of the middle it has a multiple of
    /// `multiple` points, so that it can be halved repeatedly.
    pub fn covering(bounds: &Bounds, margin: f64, step: f64, multiple: usize) -> Self {
        let half = |size: f64| ((size / 2.0 + margin) / (step * multiple as f64)).ceil() as usize * multiple;
        let size = bounds.size();
        let (x, y) = (half(size.x), half(size.y));
        Self { middle: bounds.center(), step, columns: 2 * x + 1, rows: 2 * y + 1 }
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.columns * self.rows
    }

    /// Whether it has no point.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The lattice of every second point.
    pub fn halved(&self) -> Self {
        let half = |count: usize| (count - 1) / 2 + 1;
        Self { step: 2.0 * self.step, columns: half(self.columns), rows: half(self.rows), ..*self }
    }

    /// Its lowest point.
    pub fn low(&self) -> DVec2 {
        self.middle - DVec2::new((self.columns / 2) as f64, (self.rows / 2) as f64) * self.step
    }

    /// Position of a point, mm.
    pub fn place(&self, column: usize, row: usize) -> DVec2 {
        self.low() + DVec2::new(column as f64, row as f64) * self.step
    }

    /// Position of the point with this index, mm; points are numbered row by row.
    pub fn place_of(&self, index: usize) -> DVec2 {
        self.place(index % self.columns, index / self.columns)
    }

    /// A position in units of `step`, from the lowest point.
    pub fn in_steps(&self, p: DVec2) -> DVec2 {
        (p - self.low()) / self.step
    }

    /// The value at `p`, interpolated bilinearly; outside the lattice, the value at the nearest position on it.
    pub fn value_at(&self, values: &[f32], p: DVec2) -> f64 {
        let at = self.in_steps(p).clamp(DVec2::ZERO, self.last());
        let cell = whole(at).min(self.last() - 1.0);
        let (s, i) = ((at - cell).as_vec2(), cell.y as usize * self.columns + cell.x as usize);
        let low = values[i] + s.x * (values[i + 1] - values[i]);
        let j = i + self.columns;
        let high = values[j] + s.x * (values[j + 1] - values[j]);
        f64::from(low + s.y * (high - low))
    }

    /// The gradient of [`Self::value_at`] at `p`, per mm.
    pub fn slope_at(&self, values: &[f32], p: DVec2) -> DVec2 {
        let at = self.in_steps(p).clamp(DVec2::ONE, self.last() - 1.0);
        let cell = whole(at).min(self.last() - 2.0);
        let (s, i) = (at - cell, cell.y as usize * self.columns + cell.x as usize);
        let central = |i: usize| {
            let x = values[i + 1] - values[i - 1];
            let y = values[i + self.columns] - values[i - self.columns];
            DVec2::new(x.into(), y.into())
        };
        let low = central(i).lerp(central(i + 1), s.x);
        let high = central(i + self.columns).lerp(central(i + self.columns + 1), s.x);
        low.lerp(high, s.y) / (2.0 * self.step)
    }

    fn last(&self) -> DVec2 {
        DVec2::new((self.columns - 1) as f64, (self.rows - 1) as f64)
    }

    /// For each point, whether it lies inside the rings (even-odd rule).
    pub fn inside<'a>(&self, rings: impl IntoIterator<Item = &'a crate::Ring>) -> Vec<bool> {
        let mut inside = vec![false; self.len()];
        let crossings = crate::rows::crossings(rings, self.low().y, self.step, self.rows);
        for (row, crossings) in crossings.iter().enumerate() {
            for pair in crossings.chunks_exact(2) {
                let column = |x: f64| (x - self.low().x) / self.step;
                let first = column(pair[0]).ceil().max(0.0) as usize;
                let last = (column(pair[1]).floor() + 1.0).clamp(0.0, self.columns as f64) as usize;
                if first < last {
                    inside[row * self.columns + first..row * self.columns + last].fill(true);
                }
            }
        }
        inside
    }
}

/// Rounds coordinates that are 0 or more down: for baseline CPU targets a cast is faster than `floor`.
fn whole(at: DVec2) -> DVec2 {
    at.as_uvec2().as_dvec2()
}
