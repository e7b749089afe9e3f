//! Layers on top of each other: where metal is missing or piles up from layer to layer.

use super::Mask;
use super::field::{Band, Grid, Height};
use glam::DVec2;
use serde::Serialize;
use std::ops::Range;

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

    /// Adds a layer from the excess of its parts.
    pub(super) fn add(&mut self, layer: &Grid, parts: impl Iterator<Item = Excess>) {
        let shift = layer.low - self.grid.low;
        let (width, height) = (self.grid.columns as i64, self.grid.rows as i64);
        for part in parts {
            for (k, values) in part.values.chunks(part.columns.len().max(1)).enumerate() {
                let (row, first) = (shift.y + (part.first + k) as i64, shift.x + part.columns.start as i64);
                let inside = |(i, value): (usize, f32)| {
                    let column = first + i as i64;
                    ((0..width).contains(&column)).then_some(((row * width + column) as usize, value))
                };
                if (0..height).contains(&row) {
                    let values = values.iter().copied().enumerate().filter_map(inside);
                    values.for_each(|(at, value)| self.excess[at] += value);
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

/// Height less rise inside the outline less its rim, zero elsewhere, of a rectangle of a layer.
pub(super) struct Excess {
    first: usize,
    columns: Range<usize>,
    values: Vec<f32>,
}

impl Excess {
    pub(super) fn of<H: Height>(band: &Band<'_, H>, mask: &Mask, rise: f64) -> Self {
        let (mut values, width) = (vec![0.0; band.heights.len()], band.columns.len());
        for (k, (row, heights)) in band.rows().enumerate() {
            for columns in band.parts(mask.core(row)) {
                let target = &mut values[k * width..][columns.clone()];
                target
                    .iter_mut()
                    .zip(&heights[columns])
                    .for_each(|(value, height)| *value = (height.mm() - rise) as f32);
            }
        }
        Self { first: band.first, columns: band.columns.clone(), values }
    }
}
