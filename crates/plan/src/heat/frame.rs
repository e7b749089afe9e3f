//! Position of layers in the grid: level ones in levels of voxels, all others wherever their charts put them.

use super::body::Body;
use super::grid::Grid;
use crate::layer::Layer;
use bead_part::chart::{Chart, Sheet};
use glam::{DVec2, DVec3, Vec3Swizzles};
use planar::Bounds;

/// Metal below a point is searched for in steps of half a voxel …
const STEP: f64 = 0.5;

/// … down to six voxels below the middle of the layer.
const DEEPEST: f64 = 6.0;

/// A voxel with less than this fraction of the metal it can hold is the edge of metal in the next one.
const SLIVER: f64 = 0.05;

/// Points on each side of a site at which its extent in space is taken.
const PLACES: usize = 48;

/// The ground of a body: on a plate, or on metal that is not welded.
#[derive(Debug, Clone, PartialEq)]
pub struct Site {
    /// The shape of its layers.
    pub chart: Chart,
    /// The box around the body's metal in space, mm.
    pub space: [DVec3; 2],
    /// The area of the starting surface that the body covers, mm.
    pub ground: Bounds,
}

/// The position of a layer in the grid.
#[derive(Debug, Clone, Copy)]
pub(super) struct On {
    /// Level of voxels, if layers are level.
    pub(super) level: usize,
    body: usize,
    /// Height of its middle, mm.
    middle: f64,
    height: f64,
}

/// How layers are mapped to the grid.
#[derive(Debug, Clone)]
pub(super) enum Frame {
    /// Level layers: the level of voxels of each.
    Level(Vec<usize>),
    /// Layers in space: the chart of each body.
    Space(Vec<Chart>),
}

impl Frame {
    pub(super) fn on(&self, layer: &Layer) -> On {
        let level = match self {
            Self::Level(levels) => levels.get(layer.index).or(levels.last()).copied().unwrap_or_default(),
            Self::Space(_) => 0,
        };
        On { level, body: layer.body, middle: layer.z - layer.height / 2.0, height: layer.height }
    }

    fn sheet(charts: &[Chart], on: On) -> Sheet<'_> {
        charts[on.body.min(charts.len() - 1)].sheet(on.middle)
    }

    /// The voxel that holds the middle of a layer at a place.
    pub(super) fn voxel(&self, grid: &Grid, on: On, at: DVec2) -> usize {
        match self {
            Self::Level(_) => grid.column(at.x, at.y, on.level),
            Self::Space(charts) => grid.holding(Self::sheet(charts, on).at(at.extend(on.middle)).place),
        }
    }

    /// The number of points through the thickness of a layer at which metal is laid, if they are `apart` mm apart.
    pub(super) fn deep(&self, on: On, apart: f64) -> usize {
        match self {
            Self::Level(_) => 1,
            Self::Space(_) => (on.height / apart).ceil().max(1.0) as usize,
        }
    }

    /// The voxels that hold the cross-section of a bead: looked up at `across` points from edge to edge (`side`, mm)
    /// and `deep` points through its thickness; each with the fraction of the bead's area seen from above.
    pub(super) fn across(
        &self,
        grid: &Grid,
        on: On,
        at: DVec2,
        side: DVec2,
        [across, deep]: [usize; 2],
        mut add: impl FnMut(usize, f64),
    ) {
        let part = |k: usize, count: usize| (k as f64 + 0.5) / count as f64 - 0.5;
        match self {
            Self::Level(_) => (0..across).for_each(|t| {
                let at = at + part(t, across) * side;
                add(grid.column(at.x, at.y, on.level), 1.0);
            }),
            Self::Space(charts) => {
                let here = Self::sheet(charts, on).at(at.extend(on.middle));
                let side = here.along[0] * side.x + here.along[1] * side.y;
                let seen = here.normal.z.abs();
                for d in 0..deep {
                    let middle = here.place + here.normal * on.height * part(d, deep);
                    (0..across).for_each(|t| add(grid.holding(middle + part(t, across) * side), seen));
                }
            }
        }
    }

    /// The uppermost metal below a point: its level, or minus its depth in voxels, and its voxel.
    pub(super) fn uppermost(&self, body: &Body, on: On, at: DVec2, voxel: f64) -> Option<(isize, usize)> {
        let grid = body.grid();
        match self {
            Self::Level(_) => {
                let (plane, top) = (grid.strides()[2], grid.column(at.x, at.y, on.level));
                let (level, voxel) = (0..=on.level)
                    .map(|down| (on.level - down, top - down * plane))
                    .find(|(_, voxel)| body.metal(*voxel) > 0.0)?;
                Some((level as isize, voxel))
            }
            Self::Space(charts) => {
                let here = Self::sheet(charts, on).at(at.extend(on.middle));
                let depths = (0..=(DEEPEST / STEP) as usize).map(|k| k as f64 * STEP);
                let (depth, voxel) = depths
                    .map(|depth| (depth, grid.holding(here.place - here.normal * depth * voxel)))
                    .find(|(_, voxel)| body.metal(*voxel) > SLIVER * grid.size(*voxel).element_product())?;
                Some((-(depth as isize), voxel))
            }
        }
    }
}

/// The box around points: its lowest and its highest corner.
fn around(places: impl Iterator<Item = DVec3>) -> [DVec3; 2] {
    places.fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[low, high], p| [low.min(p), high.max(p)])
}

impl Site {
    /// The site of a body whose metal extends `beyond` these points (mm), each unrolled at its own height; `None`
    /// without any points.
    pub fn of(chart: &Chart, places: &[DVec3], beyond: f64) -> Option<Self> {
        let ground = chart.sheet(0.0);
        let Bounds { min, max } = Bounds::of(places.iter().map(|p| ground.across(p.truncate(), &chart.sheet(p.z))))?;
        let foot = |p: &DVec3| chart.sheet(0.0).at(ground.across(p.truncate(), &chart.sheet(p.z)).extend(0.0)).place;
        let space = around(places.iter().flat_map(|p| [chart.sheet(p.z).at(*p).place, foot(p)]));
        let ground = Bounds { min: min - beyond, max: max + beyond };
        Some(Self { chart: chart.clone(), space, ground })
    }

    /// The box around all sites in space and the metal under them, `depth` thick and `margin` wider than their ground,
    /// mm: `[low, high]` of what is welded, and of everything.
    pub(super) fn boxes<'a>(sites: impl Iterator<Item = &'a Self> + Clone, depth: f64, margin: f64) -> [[DVec3; 2]; 2] {
        if sites.clone().next().is_none() {
            return [[DVec3::ZERO; 2]; 2];
        }
        let welded = around(sites.clone().flat_map(|site| site.space));
        let all = around(sites.flat_map(|site| site.under(depth, margin)).chain(welded));
        [welded, all]
    }

    fn under(&self, depth: f64, margin: f64) -> [DVec3; 2] {
        let sheet = self.chart.sheet(0.0);
        let (low, size) = (self.ground.min - margin, self.ground.size() + 2.0 * margin);
        let part = |k: usize| k as f64 / PLACES as f64;
        let places = (0..=PLACES).flat_map(|i| (0..=PLACES).map(move |j| DVec2::new(part(i), part(j))));
        let points = places.flat_map(|p| [0.0, -depth].map(|h| sheet.at((low + p * size).extend(h)).place));
        around(points)
    }

    /// The fraction of a voxel, 0 to 1, that belongs to the metal under the site between two heights, mm.
    pub(super) fn part(&self, grid: &Grid, voxel: usize, heights: [f64; 2], margin: f64) -> f64 {
        const THIRDS: [f64; 3] = [-1.0 / 3.0, 0.0, 1.0 / 3.0];
        let (middle, size) = (grid.middle(voxel), grid.size(voxel));
        let at = self.chart.coordinates(middle);
        let normal = self.chart.sheet(at.z).at(at).normal.abs();
        // Half the extent of the voxel along the normal: its volume over its area seen along the normal.
        let half = size.element_product() / (size.yzx() * size.zxy()).dot(normal) / 2.0;
        let within = (heights[1].min(at.z + half) - heights[0].max(at.z - half)) / (2.0 * half);
        if within <= 0.0 {
            return 0.0;
        }
        let offsets =
            THIRDS.iter().flat_map(|x| THIRDS.iter().flat_map(|y| THIRDS.iter().map(|z| DVec3::new(*x, *y, *z))));
        let above = offsets.filter(|offset| self.is_above(middle + *offset * size, margin)).count();
        within * above as f64 / 27.0
    }

    /// Whether a point in space lies above or below the ground of the site.
    fn is_above(&self, place: DVec3, margin: f64) -> bool {
        let at = self.chart.coordinates(place);
        let (ground, own) = (self.chart.sheet(0.0), self.chart.sheet(at.z));
        let on_it = ground.across(at.truncate(), &own);
        let inside =
            |p: DVec2| (p - self.ground.min).min_element() >= -margin && (self.ground.max - p).min_element() >= -margin;
        [0.0, -1.0, 1.0].iter().any(|turns| inside(ground.turned(on_it, *turns).unwrap_or(on_it)))
    }
}
