//! Metal in voxels: what each holds, what it conducts to its neighbours, how warm it is.
//!
//! A voxel holds a volume of metal and the area that this covers seen from above; both may be less than the voxel's
//! own, so thin walls keep their metal and cross-section wherever they lie on the grid. The conductance of a face
//! follows from the geometric mean of the two cross-sections on either side, and its bare area from their difference
//! (finite volumes; Patankar, Numerical Heat Transfer and Fluid Flow, 1980, chapter 4).

use super::grid::Grid;
use super::sweep::{self, Lags};
use std::ops::Range;

/// Stefan-Boltzmann constant, W/(mm²·K⁴).
pub(super) const STEFAN_BOLTZMANN: f64 = 5.670_374e-14;

/// Absolute temperature of 0 °C, K.
pub(super) const KELVIN: f64 = 273.15;

/// Heat losses from bare faces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Air {
    /// Temperature of surroundings and table, °C.
    pub ambient: f64,
    /// Convection, W/(mm²·K).
    pub convection: f64,
    /// Emissivity, 0 to 1.
    pub emissivity: f64,
    /// Contact of the lowest voxels with the table, W/(mm²·K).
    pub contact: f64,
}

impl Air {
    /// Surroundings at a temperature, °C, that take no heat.
    pub fn none(ambient: f64) -> Self {
        Self { ambient, convection: 0.0, emissivity: 0.0, contact: 0.0 }
    }
}

/// Thermal properties of a level of voxels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stuff {
    /// Heat capacity, J/(mm³·K).
    pub capacity: f64,
    /// Conductivity, W/(mm·K).
    pub conductivity: f64,
}

/// Metal in voxels. Temperatures are stored relative to the surroundings.
#[derive(Debug, Clone)]
pub struct Body {
    pub(super) grid: Grid,
    pub(super) air: Air,
    /// Properties of each level.
    stuff: Vec<Stuff>,
    /// Properties of metal that is not welded, where it may lie in any level, and which voxels hold it.
    stock: Option<(Stuff, Vec<bool>)>,
    /// Temperature above the surroundings, K.
    pub(super) theta: Vec<f64>,
    /// Volume of metal, mm³.
    metal: Vec<f64>,
    /// Area of the metal seen from above, mm².
    area: Vec<f64>,
    /// Heat capacity, J/K.
    pub(super) capacity: Vec<f64>,
    /// Conductance to the next voxel along each axis, W/K.
    pub(super) across: [Vec<f64>; 3],
    /// Bare area across each axis, mm².
    pub(super) bare: [Vec<f64>; 3],
    /// Total bare area, mm².
    pub(super) bare_area: f64,
    /// Area in contact with the table, mm²: of the lowest level, or of every voxel if any may touch it
    /// ([`Self::hold`]).
    pub(super) table: Vec<f64>,
    /// True area of the sides of a level over that of its voxels' sides.
    pub(super) sides: Vec<f64>,
    /// The same for horizontal faces.
    pub(super) upright: f64,
    /// Number of levels that hold metal, from the lowest on.
    pub(super) levels: usize,
    supplied: f64,
    lost: f64,
    /// Time that has passed, s; levels and tiles may lag behind it.
    pub(super) clock: f64,
    pub(super) lags: Lags,
    /// Number of voxels of each level that are bare across each axis.
    pub(super) exposed: [Vec<usize>; 3],
    /// Extent of each level's metal along x and y: nothing beyond it is swept.
    pub(super) extents: Vec<[Range<usize>; 2]>,
    /// Number of levels up to the highest metal, of every tile of columns.
    pub(super) tops: Vec<usize>,
}

impl Body {
    /// An empty grid; one [`Stuff`] per level.
    pub fn new(grid: Grid, stuff: Vec<Stuff>, air: Air) -> Self {
        let none = vec![0.0; grid.len()];
        let three = || [none.clone(), none.clone(), none.clone()];
        let sides = vec![1.0; stuff.len()];
        Self {
            table: vec![0.0; grid.strides()[2]],
            air,
            stuff,
            stock: None,
            bare_area: 0.0,
            theta: none.clone(),
            metal: none.clone(),
            area: none.clone(),
            capacity: none.clone(),
            across: three(),
            bare: three(),
            sides,
            upright: 1.0,
            levels: 0,
            supplied: 0.0,
            lost: 0.0,
            clock: 0.0,
            lags: Lags::new(&grid),
            exposed: [0; 3].map(|none| vec![none; grid.counts()[2]]),
            extents: vec![[0..0, 0..0]; grid.counts()[2]],
            tops: vec![0; sweep::tiles(&grid) * grid.counts()[1]],
            grid,
        }
    }

    /// The lowest `levels` full of metal at a temperature, °C.
    pub fn fill(&mut self, levels: usize, temperature: f64) {
        let full = |voxel: usize| {
            let size = self.grid.size(voxel);
            (voxel, size.x * size.y * size.z, size.x * size.y)
        };
        let full: Vec<(usize, f64, f64)> = (0..self.grid.strides()[2] * levels).map(full).collect();
        self.place(&full, temperature);
    }

    /// Adds metal at a temperature (°C): voxels, each with the volume added (mm³) and the area (mm²) that all of its
    /// metal then covers seen from above.
    pub(super) fn place(&mut self, metal: &[(usize, f64, f64)], temperature: f64) {
        let theta = temperature - self.air.ambient;
        for &(voxel, volume, area) in metal {
            let before = self.capacity[voxel];
            self.add(voxel, volume, area);
            let (now, new) = (self.capacity[voxel], self.capacity[voxel] - before);
            self.theta[voxel] += theta * (new / now.max(f64::MIN_POSITIVE));
            self.supplied += theta * new;
        }
        self.refresh(&metal.iter().map(|(voxel, ..)| *voxel).collect::<Vec<_>>());
    }

    /// Adds metal (mm³) at the temperature of the surroundings; `area` (mm²) is the total that the voxel's metal then
    /// covers seen from above. [`Self::refresh`] must follow.
    pub(super) fn add(&mut self, voxel: usize, volume: f64, area: f64) {
        let [x, y, level] = self.grid.place(voxel);
        let capacity = volume * self.stuff(voxel).capacity;
        let size = self.grid.size(voxel);
        self.theta[voxel] *= self.capacity[voxel] / (self.capacity[voxel] + capacity).max(f64::MIN_POSITIVE);
        self.capacity[voxel] += capacity;
        self.metal[voxel] += volume;
        self.area[voxel] = self.area[voxel].max(area).min(size.x * size.y);
        self.levels = self.levels.max(level + 1);
        for (extent, at) in self.extents[level].iter_mut().zip([x, y]) {
            *extent = if extent.end == 0 { at..at + 1 } else { extent.start.min(at)..extent.end.max(at + 1) };
        }
        let top = &mut self.tops[y * sweep::tiles(&self.grid) + x / sweep::TILE];
        *top = (*top).max(level + 1);
    }

    /// Heats a voxel, J. One without metal takes no heat.
    pub fn heat(&mut self, voxel: usize, joules: f64) {
        if self.capacity[voxel] > 0.0 {
            self.theta[voxel] += joules / self.capacity[voxel];
            self.supplied += joules;
            self.wake(voxel);
        }
    }

    /// Advances every level and tile by all the time that has passed.
    pub(super) fn settle(&mut self) {
        self.lost += sweep::settle(self);
    }

    /// The neighbourhood of a voxel takes part in the next steps, after being advanced by all the time that has passed.
    pub(super) fn wake(&mut self, voxel: usize) {
        sweep::wake(self, voxel);
    }

    /// Recomputes conductances and bare areas at these voxels and next to them.
    pub(super) fn refresh(&mut self, voxels: &[usize]) {
        let strides = self.grid.strides();
        for &voxel in voxels {
            let place = self.grid.place(voxel);
            for axis in 0..3 {
                self.connect(voxel, axis);
                if place[axis] > 0 {
                    self.connect(voxel - strides[axis], axis);
                }
            }
        }
        for &voxel in voxels {
            let (place, counts) = (self.grid.place(voxel), self.grid.counts());
            self.expose(voxel);
            for axis in 0..3 {
                if place[axis] > 0 {
                    self.expose(voxel - strides[axis]);
                }
                if place[axis] + 1 < counts[axis] {
                    self.expose(voxel + strides[axis]);
                }
            }
        }
    }

    /// Lets metal that is not welded lie in any level, and be the only metal on the table.
    pub(super) fn with_stock(mut self, stuff: Stuff) -> Self {
        self.stock = Some((stuff, vec![false; self.grid.len()]));
        self.table = vec![0.0; self.grid.len()];
        self
    }

    /// Adds metal that is not welded, as [`Self::place`] does, and the area (mm²) of each voxel that lies on the table.
    pub(super) fn hold(&mut self, metal: &[(usize, f64, f64)], areas: &[(usize, f64)], temperature: f64) {
        if let Some((_, voxels)) = &mut self.stock {
            metal.iter().for_each(|&(voxel, ..)| voxels[voxel] = true);
        }
        areas.iter().for_each(|&(voxel, area)| self.table[voxel] = area);
        self.place(metal, temperature);
    }

    /// Cross-section of a voxel's metal across an axis, mm².
    fn section(&self, voxel: usize, axis: usize) -> f64 {
        if axis == 2 { self.area[voxel] } else { self.metal[voxel] / self.grid.size(voxel)[axis] }
    }

    /// Half the distance through a voxel's metal, over its conductivity, mm²·K/W.
    fn resistance(&self, voxel: usize, axis: usize) -> f64 {
        let length = if axis == 2 { self.metal[voxel] / self.area[voxel] } else { self.grid.size(voxel)[axis] };
        length / 2.0 / self.stuff(voxel).conductivity
    }

    fn stuff(&self, voxel: usize) -> Stuff {
        let stock = self.stock.as_ref().filter(|(_, voxels)| voxels[voxel]);
        stock.map_or_else(|| self.stuff[self.grid.place(voxel)[2]], |(stuff, _)| *stuff)
    }

    fn connect(&mut self, voxel: usize, axis: usize) {
        let next = voxel + self.grid.strides()[axis];
        let inside = self.grid.place(voxel)[axis] + 1 < self.grid.counts()[axis];
        let shared = if inside { (self.section(voxel, axis) * self.section(next, axis)).sqrt() } else { 0.0 };
        self.across[axis][voxel] =
            if shared > 0.0 { shared / (self.resistance(voxel, axis) + self.resistance(next, axis)) } else { 0.0 };
    }

    fn expose(&mut self, voxel: usize) {
        let (place, counts, strides) = (self.grid.place(voxel), self.grid.counts(), self.grid.strides());
        for axis in 0..3 {
            let own = self.section(voxel, axis);
            let after = if place[axis] + 1 < counts[axis] { self.section(voxel + strides[axis], axis) } else { 0.0 };
            let before = if place[axis] > 0 {
                self.section(voxel - strides[axis], axis)
            } else {
                // The lowest voxels lie on the table.
                if axis == 2 && self.stock.is_none() { own } else { 0.0 }
            };
            if axis == 2 && place[2] == 0 && self.stock.is_none() {
                self.table[voxel] = own;
            }
            let bare = (own - before).max(0.0) + (own - after).max(0.0);
            let count = &mut self.exposed[axis][place[2]];
            *count = *count + usize::from(bare > 0.0) - usize::from(self.bare[axis][voxel] > 0.0);
            self.bare_area += bare - self.bare[axis][voxel];
            self.bare[axis][voxel] = bare;
        }
    }

    /// Side area of a level according to its voxels, mm².
    pub(super) fn voxel_sides(&self, level: usize) -> f64 {
        let plane = self.grid.strides()[2];
        let of = |axis: usize| self.bare[axis][plane * level..plane * (level + 1)].iter().sum::<f64>();
        of(0) + of(1)
    }

    /// Advances by a time, s, in one step of the implicit scheme (`sweep.rs`).
    pub fn step(&mut self, seconds: f64) {
        if seconds <= 0.0 {
            return;
        }
        self.lost += sweep::step(self, seconds);
    }

    /// Temperature of a voxel, °C.
    pub fn temperature(&self, voxel: usize) -> f64 {
        self.air.ambient + self.theta[voxel]
    }

    /// Metal of a voxel, mm³.
    pub fn metal(&self, voxel: usize) -> f64 {
        self.metal[voxel]
    }

    /// Where the voxels lie.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// Heat content of the metal above the temperature of the surroundings, J.
    ///
    /// ```
    /// use bead_plan::heat::{Air, Body, Grid, Stuff};
    /// use glam::DVec3;
    ///
    /// // A cube of steel whose surroundings take nothing keeps what its middle is given.
    /// let steel = Stuff { capacity: 0.0045, conductivity: 0.044 };
    /// let grid = Grid::even(DVec3::ZERO, DVec3::splat(2.0), [5, 5, 5]);
    /// let mut cube = Body::new(grid, vec![steel; 5], Air::none(20.0));
    /// cube.fill(5, 20.0);
    /// cube.heat(62, 100.0);
    /// cube.step(3.0);
    /// assert!((cube.energy() - 100.0).abs() < 1e-6);
    /// ```
    pub fn energy(&self) -> f64 {
        self.theta.iter().zip(&self.capacity).map(|(theta, capacity)| theta * capacity).sum()
    }

    /// Heat supplied so far, J.
    pub fn supplied(&self) -> f64 {
        self.supplied
    }

    /// Heat lost to surroundings and table so far, J, summed over the faces.
    pub fn lost(&self) -> f64 {
        self.lost
    }

    /// Metal of a level, mm³.
    pub fn level_metal(&self, level: usize) -> f64 {
        let plane = self.grid.strides()[2];
        self.metal[plane * level..plane * (level + 1)].iter().sum()
    }

    /// Mean temperature of a level's metal, °C; that of the surroundings if it has none.
    pub fn level_temperature(&self, level: usize) -> f64 {
        let plane = self.grid.strides()[2];
        let voxels = plane * level..plane * (level + 1);
        let (heat, capacity) = voxels.fold((0.0, 0.0), |(heat, capacity), v| {
            (heat + self.theta[v] * self.capacity[v], capacity + self.capacity[v])
        });
        self.air.ambient + if capacity > 0.0 { heat / capacity } else { 0.0 }
    }
}
