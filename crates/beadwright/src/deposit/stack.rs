//! Layers on top of each other: where metal is missing or piles up from layer to layer.

use super::Mask;
use super::field::{Band, Grid};
use glam::DVec2;
use serde::Serialize;

/// The sum over layers of height less the nominal rise, where the layers have metal to lay.
#[derive(Debug, Clone)]
pub struct Stack {
    grid: Grid,
    excess: Vec<f32>,
    growth: Vec<Growth>,
}

/// How far the stack stands above and below its nominal height after a layer, mm.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Growth {
    /// The highest peak above the nominal height.
    pub peak: f64,
    /// Where it is.
    pub peak_place: DVec2,
    /// The deepest hollow below the nominal height.
    pub hollow: f64,
    /// Where it is.
    pub hollow_place: DVec2,
}

impl Stack {
    pub(super) fn new(grid: Grid) -> Self {
        Self { excess: vec![0.0; grid.points()], grid, growth: Vec::new() }
    }

    /// The state after every layer, the lowest first.
    pub fn growth(&self) -> &[Growth] {
        &self.growth
    }

    /// Adds a layer whose grid lies within the stack's; `excess` holds its points row after row.
    pub(super) fn add(&mut self, layer: &Grid, mut excess: impl Iterator<Item = f32>) {
        let shift = layer.low - self.grid.low;
        for row in 0..layer.rows {
            let target = usize::try_from(shift.y + row as i64).ok().filter(|&r| r < self.grid.rows);
            for column in 0..layer.columns {
                let value = excess.next().unwrap_or_default();
                let at = usize::try_from(shift.x + column as i64).ok().filter(|&c| c < self.grid.columns);
                if let (Some(row), Some(column)) = (target, at) {
                    self.excess[row * self.grid.columns + column] += value;
                }
            }
        }
        self.growth.push(self.extremes());
    }

    fn extremes(&self) -> Growth {
        let (mut low, mut high) = ((0.0, 0), (0.0, 0));
        for (i, &value) in self.excess.iter().enumerate() {
            if value > high.0 {
                high = (value, i);
            }
            if value < low.0 {
                low = (value, i);
            }
        }
        let place = |i: usize| self.grid.place(i % self.grid.columns.max(1), i / self.grid.columns.max(1));
        Growth { peak: high.0.into(), peak_place: place(high.1), hollow: (-low.0).into(), hollow_place: place(low.1) }
    }
}

/// Height less rise inside the outline less its rim, zero elsewhere.
pub(super) fn excess(band: &Band<'_>, mask: &Mask, rise: f64) -> Vec<f32> {
    let mut values = vec![0.0; band.heights.len()];
    let columns = band.grid.columns;
    for (row, heights) in band.rows() {
        let start = (row - band.first) * columns;
        for range in mask.core(band.grid, row) {
            let target = &mut values[start + range.start..start + range.end];
            target.iter_mut().zip(&heights[range]).for_each(|(value, height)| *value = (height - rise) as f32);
        }
    }
    values
}
