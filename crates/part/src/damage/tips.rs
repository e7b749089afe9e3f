//! Tips of a part, such as its edges and corners: layers there would be narrower than a bead, so more is welded around them.

use super::groove::{away, beyond};
use crate::chart::surface::Grid;

/// The part's heights above a layer on a grid, raised around its tips: those of its heights that no disc as wide as a bead (mm) reaches
/// while it stays below the part (a grey opening), where metal is missing (`open`). Each layer is then as wide as a bead around a tip.
pub(super) fn widened(grid: &Grid, top: &[Option<f64>], open: &[bool], bead: f64) -> Vec<Option<f64>> {
    let disc = disc(bead / 2.0, grid.step);
    let around = |heights: &[Option<f64>], of: fn(f64, f64) -> f64| -> Vec<Option<f64>> {
        let at = |k: usize| disc.iter().filter_map(|way| heights[beyond(grid, k, *way)?.0]).reduce(of);
        (0..heights.len()).map(at).collect()
    };
    let reached = around(&around(top, f64::min), f64::max);
    let is_tip =
        |k: usize| open[k] && matches!((top[k], reached[k]), (Some(top), Some(reached)) if top > reached + LEAST);
    let tips: Vec<Option<f64>> = (0..top.len()).map(|k| top[k].filter(|_| is_tip(k))).collect();
    let raised = around(&tips, f64::max);
    top.iter().zip(raised).map(|(top, raised)| top.map(|top| raised.map_or(top, |raised| raised.max(top)))).collect()
}

/// Tips lower than this are left as they are, mm.
const LEAST: f64 = 0.2;

/// Steps on a grid within a radius, mm, and half a step more, so that the disc is nowhere too small.
fn disc(radius: f64, step: f64) -> Vec<(isize, isize)> {
    let steps = (radius / step).ceil() as isize;
    let ways = (-steps..=steps).flat_map(|y| (-steps..=steps).map(move |x| (x, y)));
    ways.filter(|way| away(*way, step) <= radius + step / 2.0).collect()
}
