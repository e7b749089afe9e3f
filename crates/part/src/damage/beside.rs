//! Places beside one another on a grid.

use crate::chart::surface::Grid;
use glam::DVec2;

/// The places around one, and how far away they are, mm.
pub(super) fn neighbours(grid: &Grid, k: usize) -> impl Iterator<Item = (usize, f64)> {
    let ways = (-1..=1).flat_map(|y| (-1..=1).map(move |x| (x, y))).filter(|way| *way != (0, 0));
    ways.filter_map(move |way| beyond(grid, k, way))
}

/// The place some steps from another, where the grid has it, and how far away it is, mm.
pub(super) fn beyond(grid: &Grid, k: usize, way: (isize, isize)) -> Option<(usize, f64)> {
    let column = (k % grid.columns).checked_add_signed(way.0).filter(|column| *column < grid.columns)?;
    let row = (k / grid.columns).checked_add_signed(way.1).filter(|row| *row < grid.rows)?;
    Some((row * grid.columns + column, away(way, grid.step)))
}

pub(super) fn away(way: (isize, isize), step: f64) -> f64 {
    DVec2::new(way.0 as f64, way.1 as f64).length() * step
}
