//! Builds in space: their layers are not level, or they have several bodies.

use super::body::Stuff;
use super::build::{Build, MOST_VOXELS};
use super::frame::{Frame, Site};
use super::grid::{Grid, graded};
use super::settings::{HeatSettings, Substrate};
use crate::layer::Layer;
use crate::weld::WeldSettings;
use planar::Polygon;
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Surface areas of a build, mm².
#[derive(Debug, Clone, Default)]
pub(super) struct Skin {
    /// Bare area of the ground of its bodies, as represented by the voxels.
    stock: f64,
    /// Sides of all layers.
    sides: f64,
    /// For every body, its first and its last layer's area.
    ends: BTreeMap<usize, [f64; 2]>,
}

impl Build {
    /// The metal under bodies whose layers are not level, or of which there are several: `substrate.thickness` thick
    /// under the first layer of each that begins on a plate or on metal that is not welded, and `substrate.margin`
    /// wider than it.
    pub fn in_space(settings: &HeatSettings, weld: &WeldSettings, sites: &[Option<Site>]) -> Self {
        let mut settings = settings.clone();
        let Substrate { thickness, margin, .. } = settings.substrate;
        let [welded, all] = Site::boxes(sites.iter().flatten(), thickness, margin);
        let beyond = settings.bead_width / 2.0;
        let edges = |axis: usize, voxel: f64| {
            // Aligned to multiples of the voxel, so that a slightly different extent gives the same voxels.
            let [low, high] = [welded[0][axis] - beyond, welded[1][axis] + beyond].map(|at| at / voxel);
            let within = [low.floor() * voxel, high.ceil() * voxel];
            graded(within, [within[0] - all[0][axis], all[1][axis] - within[1]], voxel)
        };
        let grid = |voxel: f64| Grid::new([edges(0, voxel), edges(1, voxel), edges(2, voxel)]);
        while grid(settings.voxel()).len() > MOST_VOXELS {
            settings.heat.voxel = Some(1.1 * settings.voxel());
        }
        let grid = grid(settings.voxel());
        let mut build = Self::of(settings, weld, grid, Frame::Space(weld.charts.clone()), 0);
        let ([_, capacity], [_, conductivity]) = (build.settings.capacities(), build.settings.conductivities());
        build.body = build.body.with_stock(Stuff { capacity, conductivity });
        for (body, site) in sites.iter().enumerate() {
            let on_stock = body == 0 || build.settings.on_stock.get(body).is_some_and(|on_stock| *on_stock);
            if let Some(site) = site.as_ref().filter(|site| on_stock || site.chart.is_level()) {
                build.hold(site);
            }
        }
        build.skin.stock = build.body.bare_area;
        build
    }

    /// Adds the ground of a body.
    fn hold(&mut self, site: &Site) {
        let Substrate { thickness, margin, .. } = self.settings.substrate;
        let (grid, body) = (self.body.grid(), &self.body);
        // The far side lies on the table; its contact is spread over the voxels within one voxel of it.
        let near = thickness.min(self.settings.voxel());
        let laid = |voxel: usize| {
            let (size, part) = (grid.size(voxel), |from, to| site.part(grid, voxel, [from, to], margin));
            let (whole, far) = (part(-thickness, 0.0), part(-thickness, near - thickness));
            let volume = size.element_product();
            let lacking = whole * volume - body.metal(voxel);
            (lacking > 0.0).then_some(((voxel, lacking, whole * size.x * size.y), (voxel, far * volume / near)))
        };
        let laid: Vec<_> = (0..grid.len()).into_par_iter().filter_map(laid).collect();
        let (metal, far): (Vec<_>, Vec<_>) = laid.into_iter().unzip();
        self.body.hold(&metal, &far, self.settings.preheat());
    }

    /// Updates the ratio of the true surface of what is welded in space to that of its voxels, after a layer with sides
    /// of this area, mm².
    pub(super) fn compare_sides(&mut self, layer: &Layer, sides: f64) {
        let Skin { stock, sides: all, ends } = &mut self.skin;
        *all += sides;
        let area = layer.islands.iter().map(Polygon::area).sum();
        ends.entry(layer.body).or_insert([area, area])[1] = area;
        let [firsts, lasts] = [0, 1].map(|end| ends.values().map(|ends| ends[end]).sum::<f64>());
        // What the first layers cover is no longer bare.
        let (surface, voxels) = (*all + lasts, self.body.bare_area - *stock + firsts);
        if sides > 0.0 && voxels > 0.0 {
            let ratio = (surface / voxels).clamp(0.25, 4.0);
            self.body.sides.fill(ratio);
            self.body.upright = ratio;
        }
    }
}
