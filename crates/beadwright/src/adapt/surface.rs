//! How far the top of a build lies above or below its planned height: the model of height that `adapt` and `build`
//! share.
//!
//! A layer lays its beads as the deposit model does, and the pools level what they melt: where a layer laid metal, the
//! error of the height diffuses like heat, 2 D t = (w/3)² per layer, as far as the layer's metal reaches and no
//! farther. Both are linear, so the error after a layer is the error before it, plus the metal laid, minus the metal
//! promised, levelled; its sum changes by exactly the metal that was too much or too little. A bead that overhangs the
//! layer below begins at the height of the metal next to it.
//!
//! The model ignores flow along the path beyond a bead's width, heat, an arc that grows longer where the metal is low,
//! and metal that drips.

use crate::deposit::field::{Band, Grid, bands};
use crate::deposit::stroke::strokes;
use crate::deposit::{Nominal, Stroke};
use crate::layer::Layer;
use glam::DVec2;
use planar::Bounds;

/// Grid points across a bead, unless that would be more than [`MOST_POINTS`]. Odd, so that a bead along a row of points covers
/// as many rows as it is wide, and none lies on its edges.
const POINTS_ACROSS: f64 = 7.0;
/// Maximum number of points of a surface.
const MOST_POINTS: f64 = 4e6;
/// Standard deviation of the Gaussian by which a layer's pools spread an error, in bead widths.
const LEVELLED: f64 = 1.0 / 3.0;
/// Greatest fraction of a difference that flows to a neighbouring point in one step; above 0.25 the steps are unstable.
const FLOW: f64 = 0.2;
/// A point that got no metal in this many layers counts as lying beside the wall: a bead that comes back there
/// overhangs.
const RECENT: usize = 3;
/// Thinner metal counts as none, mm.
const NO_METAL: f64 = 1e-9;

/// The height error of a build after some of its layers.
#[derive(Debug, Clone)]
pub struct Surface {
    grid: Grid,
    nominal: Nominal,
    /// Height above the promised height, mm.
    error: Vec<f64>,
    /// The last layer that laid metal at a point, counted from 1; 0 where none did.
    last: Vec<usize>,
    layers: usize,
    level: f64,
}

/// Heights over an area, mm.
#[derive(Debug, Clone, Copy, PartialEq, Default, serde::Serialize)]
pub struct Spread {
    /// Their mean.
    pub mean: f64,
    /// Root mean square, about 0 and not about the mean.
    pub rms: f64,
    /// The lowest.
    pub low: f64,
    /// The highest.
    pub high: f64,
}

impl Spread {
    /// Mean, root mean square and extremes of all values; all 0 without any.
    pub fn of(values: impl Iterator<Item = f64>) -> Self {
        let (mut count, mut sum, mut square) = (0.0_f64, 0.0, 0.0);
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for value in values {
            (count, sum, square) = (count + 1.0, sum + value, square + value * value);
            (low, high) = (low.min(value), high.max(value));
        }
        if count == 0.0 {
            return Self::default();
        }
        Self { mean: sum / count, rms: (square / count).sqrt(), low, high }
    }

    /// All values moved by `by` (mm).
    #[must_use]
    pub fn moved(self, by: f64) -> Self {
        // ⟨(x + b)²⟩ = ⟨x²⟩ + 2 b ⟨x⟩ + b².
        let square = self.rms * self.rms + 2.0 * by * self.mean + by * by;
        Self { mean: self.mean + by, rms: square.max(0.0).sqrt(), low: self.low + by, high: self.high + by }
    }
}

impl Surface {
    /// The bare plate below the first of these layers, with a grid that covers them all.
    pub fn plate(layers: &[Layer], nominal: Nominal) -> Self {
        let passes = || layers.iter().flat_map(|layer| &layer.passes);
        let outlines =
            layers.iter().flat_map(|layer| &layer.islands).flat_map(|island| island.outer.points().iter().copied());
        let places = passes().flat_map(|pass| &pass.points).map(|p| p.truncate()).chain(outlines);
        let bounds = Bounds::of(places).unwrap_or(Bounds { min: DVec2::ZERO, max: DVec2::ZERO });
        let width = passes().map(|pass| pass.width.max()).fold(nominal.bead.width, f64::max);
        let area = (bounds.size() + 2.0 * width).element_product();
        let step = (nominal.bead.width / POINTS_ACROSS).max((area / MOST_POINTS).sqrt());
        let grid = Grid::covering(&bounds, width + 2.0 * step, step);
        let points = grid.points();
        let level = layers.first().map_or(0.0, |first| first.z - first.height);
        Self { grid, nominal, error: vec![0.0; points], last: vec![0; points], layers: 0, level }
    }

    /// The grid.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// The height that the uppermost layer should reach, mm.
    pub fn level(&self) -> f64 {
        self.level
    }

    /// Height above the promised height at a point of the grid, mm; `None` where the uppermost layer laid no metal.
    pub fn error(&self, point: usize) -> Option<f64> {
        (self.last[point] == self.layers && self.layers > 0).then(|| self.error[point])
    }

    /// Lays a layer: `laid` is what `promised` turned into, along the same paths.
    pub fn lay(&mut self, promised: &Layer, laid: &Layer) {
        let (wanted, real) = (self.heights(promised), self.heights(laid));
        self.layers += 1;
        let touched = self.inner().filter(|&i| wanted[i] > NO_METAL || real[i] > NO_METAL).collect::<Vec<_>>();
        self.hang(&touched);
        touched.iter().for_each(|&i| self.error[i] += real[i] - wanted[i]);
        self.even_out(&touched);
        self.level += promised.height;
    }

    /// Takes over the heights measured after `layer`, relative to its promised top, mm; `number` counts from 1.
    pub(super) fn measure(&mut self, number: usize, layer: &Layer, errors: &[Option<f64>]) {
        (self.layers, self.level) = (number, layer.z);
        for (i, error) in errors.iter().enumerate() {
            if let Some(error) = error {
                (self.error[i], self.last[i]) = (*error, number);
            }
        }
    }

    /// Adds `change` (mm) to every height of the uppermost layer.
    pub(crate) fn disturb(&mut self, mut change: impl FnMut() -> f64) {
        for (error, last) in self.error.iter_mut().zip(&self.last) {
            *error += if *last == self.layers { change() } else { 0.0 };
        }
    }

    /// Raises the height that the build should have by `by` (mm).
    pub(crate) fn settle(&mut self, by: f64) {
        self.level += by;
        self.error.iter_mut().for_each(|error| *error -= by);
    }

    /// Mean error within `radius` (mm) of a place, mm; `None` where the uppermost layer laid no metal.
    pub(crate) fn mean_around(&self, place: DVec2, radius: f64) -> Option<f64> {
        let (mut sum, mut count) = (0.0, 0.0_f64);
        let rows =
            ((place.y - radius) / self.grid.step).ceil() as i64..=((place.y + radius) / self.grid.step).floor() as i64;
        for row in rows.map(|row| row - self.grid.low.y).filter(|row| (0..self.grid.rows as i64).contains(row)) {
            let y = self.grid.place(0, row as usize).y - place.y;
            let half = (radius * radius - y * y).max(0.0).sqrt();
            for column in self.grid.columns_between(place.x - half, place.x + half) {
                if let Some(error) = self.error(row as usize * self.grid.columns + column) {
                    (sum, count) = (sum + error, count + 1.0);
                }
            }
        }
        (count > 0.0).then(|| sum / count)
    }

    /// The errors at some points of the grid, except those without metal.
    pub fn spread(&self, points: &[usize]) -> Spread {
        Spread::of(points.iter().filter_map(|&i| self.error(i)))
    }

    /// The error integrated over the area that the uppermost layer covers, mm³.
    pub fn excess_volume(&self) -> f64 {
        (0..self.error.len()).filter_map(|i| self.error(i)).sum::<f64>() * self.grid.step * self.grid.step
    }

    /// What a layer's beads add to the height, mm, scaled so that the grid holds exactly their metal.
    fn heights(&self, layer: &Layer) -> Vec<f64> {
        let strokes: Vec<Stroke> = layer.passes.iter().flat_map(|pass| strokes(pass, &self.nominal)).collect();
        let mut heights = bands(&strokes, &self.grid, |band: Band<'_>| band.heights).concat();
        let seen = heights.iter().sum::<f64>() * self.grid.step * self.grid.step;
        if seen > 0.0 {
            let missed = strokes.iter().map(Stroke::volume).sum::<f64>() / seen;
            heights.iter_mut().for_each(|height| *height *= missed);
        }
        heights
    }

    /// The points that have all four neighbours.
    fn inner(&self) -> impl Iterator<Item = usize> + use<> {
        let Grid { columns, rows, .. } = self.grid;
        (1..rows.saturating_sub(1))
            .flat_map(move |row| (1..columns.saturating_sub(1)).map(move |column| row * columns + column))
    }

    fn around(&self, point: usize) -> [usize; 4] {
        let columns = self.grid.columns;
        [point - 1, point + 1, point - columns, point + columns]
    }

    /// Marks the points that a layer touches. Points without metal below take the height of the points next to them,
    /// wave after wave.
    fn hang(&mut self, touched: &[usize]) {
        let now = self.layers;
        let lies = |last: usize| now == 1 || (last > 0 && last + RECENT >= now);
        let (on, mut hanging): (Vec<usize>, Vec<usize>) = touched.iter().partition(|&&i| lies(self.last[i]));
        on.iter().for_each(|&i| self.last[i] = now);
        while !hanging.is_empty() {
            let beside = |&i: &usize| Spread::of(self.around(i).into_iter().filter_map(|j| self.error(j)));
            let borders = |i: &usize| self.around(*i).iter().any(|&j| self.error(j).is_some());
            let (wave, rest): (Vec<usize>, Vec<usize>) = hanging.iter().partition(|&i| borders(i));
            let heights: Vec<f64> = wave.iter().map(|i| beside(i).mean).collect();
            // Nothing is next to it, so it begins at the height that it should have.
            let (wave, heights) = if wave.is_empty() { (rest.clone(), vec![0.0; rest.len()]) } else { (wave, heights) };
            hanging = if wave.len() == hanging.len() { Vec::new() } else { rest };
            for (i, height) in wave.into_iter().zip(heights) {
                (self.error[i], self.last[i]) = (height, now);
            }
        }
    }

    /// Levels the error where the uppermost layer laid metal; what leaves a point goes to its neighbours.
    fn even_out(&mut self, touched: &[usize]) {
        let wanted = (LEVELLED * self.nominal.bead.width / self.grid.step).powi(2);
        let steps = (wanted / (2.0 * FLOW)).ceil().max(1.0);
        let flow = wanted / (2.0 * steps);
        let neighbours: Vec<[usize; 4]> =
            touched.iter().map(|&i| self.around(i).map(|j| if self.last[j] == self.layers { j } else { i })).collect();
        for _ in 0..steps as usize {
            let gains: Vec<f64> = touched
                .iter()
                .zip(&neighbours)
                .map(|(&i, around)| flow * around.iter().map(|&j| self.error[j] - self.error[i]).sum::<f64>())
                .collect();
            touched.iter().zip(gains).for_each(|(&i, gain)| self.error[i] += gain);
        }
    }
}
