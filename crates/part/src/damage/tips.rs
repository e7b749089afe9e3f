//! Tips of a part, such as its edges and corners: layers there would be narrower than a bead, so more is welded around them.

use super::beside::{away, beyond};
use crate::chart::surface::Grid;

/// The part's heights above a layer on a grid, raised around its tips: those of its heights that no disc as wide as a bead (mm)
/// reaches while it stays below the part (a grey opening), where metal is missing (`open`). A disc around the middle of what is as high
/// as the tip within its reach is raised to it, so that each layer has room for a bead there, and no more than it needs.
pub(super) fn widened(grid: &Grid, top: &[Option<f64>], open: &[bool], bead: f64) -> Vec<Option<f64>> {
    let disc = disc(bead / 2.0, grid.step);
    let around = |k: usize| disc.iter().filter_map(move |way| Some((*way, beyond(grid, k, *way)?.0)));
    let of_all = |heights: &[Option<f64>], of: fn(f64, f64) -> f64| -> Vec<Option<f64>> {
        (0..heights.len()).map(|k| around(k).filter_map(|(_, n)| heights[n]).reduce(of)).collect()
    };
    let reached = of_all(&of_all(top, f64::min), f64::max);
    let mut raised = top.to_vec();
    for k in (0..top.len()).filter(|k| open[*k]) {
        let (Some(tip), Some(reached)) = (top[k], reached[k]) else { continue };
        if tip <= reached + LEAST {
            continue;
        }
        let as_high = around(k).filter(|(_, n)| top[*n].is_some_and(|height| height >= tip));
        let (sum, count) =
            as_high.fold(((0, 0), 0_i32), |((x, y), count), (way, _)| ((x + way.0, y + way.1), count + 1));
        let middle = |sum: isize| (sum as f64 / f64::from(count.max(1))).round() as isize;
        let Some((centre, _)) = beyond(grid, k, (middle(sum.0), middle(sum.1))) else { continue };
        for (_, n) in around(centre) {
            raised[n] = raised[n].map(|height| height.max(tip));
        }
    }
    raised
}

/// Tips lower than this are left as they are, mm.
const LEAST: f64 = 0.2;

/// Steps on a grid within a radius, mm, and half a step more, so that the disc is nowhere too small.
fn disc(radius: f64, step: f64) -> Vec<(isize, isize)> {
    let steps = (radius / step).ceil() as isize;
    let ways = (-steps..=steps).flat_map(|y| (-steps..=steps).map(move |x| (x, y)));
    ways.filter(|way| away(*way, step) <= radius + step / 2.0).collect()
}
