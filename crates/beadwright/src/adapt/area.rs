//! The points of a grid at which heights are compared: inside the outlines, without the rounded edge of the outermost beads.

use crate::deposit::RIM;
use crate::deposit::field::Grid;
use planar::{Join, Polygon, Region};

/// The grid points inside the outlines less a rim of a quarter of a bead `width` (mm), or all inside if none would be
/// left.
pub fn core(grid: &Grid, islands: &[Polygon], width: f64) -> Vec<usize> {
    let whole = Region::from_normalised(islands.to_vec());
    let core = inside(grid, &whole.offset(-RIM * width, Join::ROUND));
    if core.is_empty() { inside(grid, &whole) } else { core }
}

/// The grid points inside the outlines or within `reach` (mm) of them.
pub(super) fn near(grid: &Grid, islands: &[Polygon], reach: f64) -> Vec<usize> {
    inside(grid, &Region::from_normalised(islands.to_vec()).offset(reach, Join::ROUND))
}

fn inside(grid: &Grid, region: &Region) -> Vec<usize> {
    let rows = region.rows(grid.place(0, 0).y, grid.step, grid.rows);
    let mut points = Vec::new();
    for (row, crossings) in rows.iter().enumerate() {
        for pair in crossings.chunks_exact(2) {
            points.extend(grid.columns_between(pair[0], pair[1]).map(|column| row * grid.columns + column));
        }
    }
    points.dedup();
    points
}
