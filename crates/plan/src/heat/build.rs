//! A part being built: metal is laid as the torch goes, heated by the arc, and cools meanwhile.

use super::body::{Air, Body, Stuff};
use super::course::Watch;
use super::frame::{Frame, On};
use super::grid::{Grid, graded};
use super::settings::{HeatSettings, Interpass};
use super::space::Skin;
use crate::layer::Layer;
use crate::pass::Pass;
use crate::process::Process;
use crate::weld::{Torch, WeldSettings, path};
use glam::{DVec2, DVec3};
use planar::{Bounds, Polygon};
use std::ops::Range;

/// Metal is laid in pieces of this length, in voxels.
const CHUNK: f64 = 4.0;

/// A level of voxels takes layers until it is this thick, in voxels.
const LEVEL: f64 = 0.5;

/// Steps of waiting grow by this factor …
const GROWTH: f64 = 1.4;

/// … from this one on, in units of the time in which heat crosses a voxel …
const FIRST_STEP: f64 = 1.0;

/// … to this one, or to this fraction of the wait so far: longer steps let too little heat pass from the wall into the
/// plate.
const LAST_STEP: f64 = 1.0;
const PART_OF_WAIT: f64 = 0.04;

/// Longest steps far from the torch, in the same unit.
const PATIENCE: f64 = 2.0;

/// Spacing of the points along and across a bead at which metal is laid, in voxels.
const FINE: f64 = 0.25;

/// Lengths are equal to within this, mm.
const ROUNDING: f64 = 1e-6;

/// Most voxels of a part: they take about 100 bytes each.
pub const MOST_VOXELS: usize = 8_000_000;

/// The longest wait for a pass, s: what has not cooled by then never will.
pub const LONGEST_WAIT: f64 = 36_000.0;

/// Temperatures of a pass, °C; times in s.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct PassHeat {
    /// When its arc is struck, from the beginning of the build.
    pub at: f64,
    /// How long the torch waited for the metal to cool.
    pub wait: f64,
    /// Temperature of the metal below where the arc starts, just before, °C.
    pub start: f64,
    /// Temperature of the metal just ahead of the torch along the pass, every [`Build::spacing`] mm from its start, °C.
    pub along: Vec<f64>,
}

impl PassHeat {
    /// Mean temperature just ahead of the torch, °C.
    pub fn mean(&self) -> f64 {
        self.along.iter().sum::<f64>() / self.along.len().max(1) as f64
    }

    /// Mean temperature just ahead of the torch over a range of the pass (mm), °C; `spacing` is that of the
    /// temperatures (mm).
    pub fn ahead(&self, stretch: Range<f64>, spacing: f64) -> f64 {
        let [first, last] = [stretch.start, stretch.end].map(|way| (way / spacing).round() as usize);
        let end = (last + 1).min(self.along.len());
        let known = &self.along[first.min(end.saturating_sub(1))..end];
        if known.is_empty() { self.start } else { known.iter().sum::<f64>() / known.len() as f64 }
    }

    /// The greatest temperature ahead of the torch: its index in `along`, and its value, °C.
    pub fn peak(&self) -> (usize, f64) {
        let places = self.along.iter().copied().enumerate();
        places.fold((0, self.start), |hottest, place| if place.1 > hottest.1 { place } else { hottest })
    }
}

/// Temperatures of a layer, °C.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct LayerHeat {
    /// Its passes in order.
    pub passes: Vec<PassHeat>,
    /// Mean temperature of the metal below when the layer begins: the layer before, or the plate.
    pub below: f64,
    /// When its last arc ends, s from the beginning of the build.
    pub end: f64,
    /// Where passes were cut because the metal ahead was too hot, mm.
    #[serde(skip)]
    pub cuts: Vec<DVec2>,
}

/// Tolerance of a temperature limit, K.
pub const NOISE: f64 = 1.0;

impl LayerHeat {
    /// The hottest start of its passes, °C.
    pub fn hottest_start(&self) -> Option<f64> {
        self.passes.iter().map(|pass| pass.start).max_by(f64::total_cmp)
    }

    /// Seconds for which the torch waited for the metal to cool.
    pub fn wait(&self) -> f64 {
        self.passes.iter().map(|pass| pass.wait).sum()
    }
}

/// A part being built, up to the pass that was laid last.
#[derive(Debug, Clone)]
pub struct Build {
    pub(super) settings: HeatSettings,
    nominal: Process,
    process: Process,
    pub(super) torch: Torch,
    pub(super) body: Body,
    frame: Frame,
    /// Surface areas of a build in space.
    pub(super) skin: Skin,
    /// Side area of the layers in every level, mm².
    sides: Vec<f64>,
    /// Area of each voxel that the current layer covers, mm², and the indices of those voxels.
    covered: Vec<f64>,
    touched: Vec<usize>,
    /// Time since the beginning, s, and the part of it by which the body has not yet been advanced.
    pub(super) now: f64,
    pub(super) pending: f64,
    /// Where the heat lay so far, if that is wanted.
    pub(super) watch: Option<Watch>,
}

impl Build {
    /// A plate for a part within `bounds` (mm) whose layers have these tops and thicknesses (mm). Voxels are larger
    /// than in the settings if there would be more than [`MOST_VOXELS`].
    pub fn new(settings: &HeatSettings, weld: &WeldSettings, bounds: &Bounds, layers: &[(f64, f64)]) -> Self {
        let mut settings = settings.clone();
        let (mut grid, mut levels, mut plate_levels) = voxels(&settings, bounds, layers);
        while grid.len() > MOST_VOXELS {
            settings.heat.voxel = Some(1.1 * settings.voxel());
            (grid, levels, plate_levels) = voxels(&settings, bounds, layers);
        }
        let mut build = Self::of(settings, weld, grid, Frame::Level(levels), plate_levels);
        build.body.fill(plate_levels, build.settings.preheat());
        build
    }

    pub(super) fn of(
        settings: HeatSettings,
        weld: &WeldSettings,
        grid: Grid,
        frame: Frame,
        plate_levels: usize,
    ) -> Self {
        let ([part, substrate], [k_part, k_plate]) = (settings.capacities(), settings.conductivities());
        let stuff = |k: usize| match k < plate_levels {
            true => Stuff { capacity: substrate, conductivity: k_plate },
            false => Stuff { capacity: part, conductivity: k_part },
        };
        let stuff = (0..grid.counts()[2]).map(stuff).collect();
        let heat = &settings.heat;
        let [convection, contact] = [heat.convection, settings.substrate.contact].map(|film| film * 1e-6);
        let air = Air { ambient: heat.ambient, convection, emissivity: heat.emissivity, contact };
        let mut build = Self {
            nominal: weld.process.clone(),
            process: weld.process.at_layer(0),
            torch: Torch::of(weld),
            sides: vec![0.0; grid.counts()[2]],
            covered: vec![0.0; grid.len()],
            touched: Vec::new(),
            body: Body::new(grid, stuff, air),
            frame,
            skin: Skin::default(),
            settings,
            now: 0.0,
            pending: 0.0,
            watch: None,
        };
        build.be_patient(PATIENCE);
        build
    }

    /// Sets the longest steps far from the torch, in units of the time in which heat crosses a voxel. With 0 every step
    /// is as short as near the torch: slower; the reference in tests.
    #[doc(hidden)]
    pub fn be_patient(&mut self, steps: f64) {
        self.body.lags.patience = steps * self.crossing();
    }

    /// The limits between passes.
    pub(super) fn limits(&self) -> Option<Interpass> {
        self.settings.interpass
    }

    /// The metal in voxels.
    pub fn body(&self) -> &Body {
        &self.body
    }

    /// Length of the pieces in which metal is laid, mm.
    pub fn spacing(&self) -> f64 {
        CHUNK * self.settings.voxel()
    }

    /// Size of the voxels seen from above, mm.
    pub fn voxel(&self) -> f64 {
        self.settings.voxel()
    }

    /// Time since the beginning, s.
    pub fn seconds(&self) -> f64 {
        self.now
    }

    /// Builds a layer with the waits of its passes.
    pub fn layer(&mut self, layer: &Layer) -> LayerHeat {
        let mut heat = self.begin(layer);
        let on = self.on(layer);
        heat.passes = layer.passes.iter().filter_map(|pass| self.pass(on, pass)).collect();
        self.end(layer);
        LayerHeat { end: self.now, ..heat }
    }

    /// Begins a layer with the wait that it needs for reasons other than heat.
    pub(super) fn begin(&mut self, layer: &Layer) -> LayerHeat {
        self.process = self.nominal.at_layer(layer.index);
        let begun = self.torch.begin_layer(layer, 0);
        self.spend(begun.moving() + begun.waiting());
        self.catch_up(None);
        self.body.settle();
        LayerHeat { passes: Vec::new(), below: self.below(layer), end: self.now, cuts: Vec::new() }
    }

    /// Mean temperature of the metal below a layer, °C.
    fn below(&self, layer: &Layer) -> f64 {
        let Frame::Level(levels) = &self.frame else {
            let on = self.frame.on(layer);
            let places = layer.passes.iter().flat_map(|pass| &pass.points);
            let (sum, count) =
                places.fold((0.0, 0), |(sum, count), p| (sum + self.surface(on, p.truncate()), count + 1));
            return if count > 0 { sum / f64::from(count) } else { self.settings.heat.ambient };
        };
        let level = |layer: usize| levels.get(layer).or(levels.last()).copied().unwrap_or_default();
        // The layer before may be in the same level of voxels; an empty layer left no metal.
        let under = layer.index.checked_sub(1).map_or(level(0).saturating_sub(1), level);
        let below = (0..=under).rev().find(|level| self.body.level_metal(*level) > 0.0).unwrap_or_default();
        self.body.level_temperature(below)
    }

    /// Ends a layer, now that its sides are known.
    pub(super) fn end(&mut self, layer: &Layer) {
        let welded = |island: &&Polygon| {
            let starts = layer.passes.iter().filter_map(Pass::start);
            starts.into_iter().any(|start| island.contains(start.truncate()))
        };
        let rings = layer.islands.iter().filter(welded).flat_map(Polygon::rings);
        let around: f64 = rings.map(|ring| ring.length()).sum();
        if let Frame::Space(_) = self.frame {
            self.compare_sides(layer, around * layer.height);
        } else {
            let level = self.on(layer).level;
            self.sides[level] += around * layer.height;
            let voxels = self.body.voxel_sides(level);
            if around > 0.0 && voxels > 0.0 {
                self.body.sides[level..].fill((self.sides[level] / voxels).clamp(0.25, 4.0));
            }
        }
        self.touched.drain(..).for_each(|voxel| self.covered[voxel] = 0.0);
    }

    /// Lets time pass; the body is advanced by it before a temperature is next read.
    pub(super) fn spend(&mut self, seconds: f64) {
        self.now += seconds;
        self.pending += seconds;
    }

    /// Advances the body by the time that has passed; fully, if a temperature is to be read at a point of a layer.
    pub(super) fn catch_up(&mut self, at: Option<(On, DVec2)>) {
        let (mut step, whole) = (FIRST_STEP * self.crossing(), self.pending);
        let place = at.map(|(on, at)| self.frame.voxel(self.body.grid(), on, at));
        while self.pending > 0.0 {
            let next = if self.pending < 1.5 * step { self.pending } else { step };
            if let Some(place) = place {
                self.body.wake(place);
            }
            self.body.step(next);
            self.pending = if next == self.pending { 0.0 } else { self.pending - next };
            self.note();
            step = (step * GROWTH).min(self.longest_step(whole - self.pending));
        }
    }

    /// The longest step after a wait this long, s.
    fn longest_step(&self, waited: f64) -> f64 {
        (LAST_STEP * self.crossing()).max(PART_OF_WAIT * waited)
    }

    /// Time in which heat crosses a voxel, s.
    fn crossing(&self) -> f64 {
        let (capacity, conductivity) = (self.settings.capacities()[0], self.settings.conductivities()[0]);
        self.settings.voxel().powi(2) * capacity / conductivity
    }

    /// Where a layer lies in the grid.
    pub(super) fn on(&self, layer: &Layer) -> On {
        self.frame.on(layer)
    }

    /// Temperature of the metal under a point of a layer, °C: the mean of the uppermost voxels within a bead's width.
    /// Metal more than a level deeper, such as the plate next to a wall, does not count.
    pub(super) fn surface(&self, on: On, at: DVec2) -> f64 {
        let reach = 0.35 * self.settings.bead_width;
        let body = &self.body;
        let uppermost = |offset: DVec2| self.frame.uppermost(body, on, at + reach * offset, self.voxel());
        let around = [DVec2::ZERO, DVec2::X, DVec2::Y, DVec2::NEG_X, DVec2::NEG_Y].map(uppermost);
        let highest = around.iter().flatten().map(|(level, _)| *level).max().unwrap_or_default();
        let near = around.iter().flatten().filter(|(level, _)| level + 1 >= highest);
        let (heat, weight) = near.fold((0.0, 0.0), |(heat, weight), &(_, voxel)| {
            (heat + body.temperature(voxel) * body.metal(voxel), weight + body.metal(voxel))
        });
        if weight > 0.0 { heat / weight } else { self.settings.heat.ambient }
    }

    /// Builds a pass of a layer after its wait; `None` if it has no points.
    pub(super) fn pass(&mut self, on: On, pass: &Pass) -> Option<PassHeat> {
        let start = pass.start()?;
        let pause = self.torch.wait(pass.wait);
        self.spend(pause.map_or(0.0, |pause| pause.moving + pause.seconds));
        let approach = self.torch.approach(start);
        self.spend(approach.moving);
        self.catch_up(Some((on, start.truncate())));
        let moves = path(pass, self.torch.ends());
        let temperature = self.surface(on, start.truncate());
        let welded = self.torch.weld(pass.kind, &moves);
        self.spend(welded.before);
        let at = self.now;
        let wait = pause.map_or(0.0, |pause| pause.seconds);
        let mut heat = PassHeat { at, wait, start: temperature, along: vec![temperature] };
        heat.along.extend(self.weld(on, &moves, pass, welded.moving));
        self.crater(on, &moves, pass.width.max(), welded.crater);
        let up = self.torch.retract().moving;
        self.spend(welded.after + up);
        Some(heat)
    }

    /// Lays a path of points and paces chunk by chunk, within `moving` seconds; returns the temperatures ahead of the
    /// torch, °C.
    fn weld(&mut self, on: On, moves: &[(DVec3, f64)], pass: &Pass, moving: f64) -> Vec<f64> {
        let pieces = || moves.windows(2).map(|w| (w[0].0.truncate(), w[1].0.truncate(), w[1].1));
        let steady: f64 = pieces().map(|(a, b, pace)| a.distance(b) / self.process.speed_at(pace)).sum();
        let (slower, spacing) = (moving / steady.max(1e-9), self.spacing());
        let total: f64 = pieces().map(|(a, b, _)| a.distance(b)).sum();
        let mut left = total;
        let width = pass.segments().map(|s| s.length() * s.width).sum::<f64>() / pass.length().max(1e-9);
        let (mut chunk, mut along) = (Chunk::default(), Vec::new());
        // The arc burns before the torch moves off.
        if let Some((_, pace)) = moves.get(1) {
            chunk.joules += self.settings.power_at(&self.process, *pace) * self.process.arc_start_delay;
        }
        for (a, b, pace) in pieces() {
            let (whole, mut done) = (a.distance(b), 0.0);
            while done < whole {
                // A short remainder is laid with the chunk before it.
                let length = if left + chunk.length < 1.5 * spacing { f64::INFINITY } else { spacing };
                let part = (length - chunk.length).min(whole - done);
                let [from, to] = [done, done + part].map(|along| a.lerp(b, along / whole));
                let seconds = part / self.process.speed_at(pace) * slower;
                let area = self.settings.bead_area * self.nominal.deposition_speed / pace;
                chunk.joules += self.settings.power_at(&self.process, pace) * seconds;
                chunk.seconds += seconds;
                chunk.length += part;
                self.cover([from, to], width, area * part, on, &mut chunk);
                done += part;
                left -= part;
                if chunk.length >= length * (1.0 - 1e-9) {
                    along.push(self.finish(on, &mut chunk, to));
                }
            }
        }
        if let Some((end, _)) = moves.last() {
            self.finish(on, &mut chunk, end.truncate());
        }
        // Nothing is ahead at its end.
        along.truncate(((total - ROUNDING) / spacing).max(0.0) as usize);
        along
    }

    /// Lets the arc burn on the spot at the end of a pass.
    fn crater(&mut self, on: On, moves: &[(DVec3, f64)], width: f64, seconds: f64) {
        let (Some((end, pace)), true) = (moves.last(), seconds > 0.0) else { return };
        let feed = self.torch.crater_feed();
        let volume = self.settings.bead_area * self.nominal.deposition_speed * seconds * feed;
        let mut chunk = Chunk { seconds, ..Chunk::default() };
        chunk.joules = self.settings.power_at(&self.process, *pace) * seconds * feed / self.torch.feed_at(*pace);
        let end = end.truncate();
        let before = moves.iter().rev().nth(1).map_or(end, |(before, _)| before.truncate());
        // Over the last half bead width.
        let back = (before - end).normalize_or(DVec2::X) * width / 2.0;
        self.cover([end + back, end], width, volume, on, &mut chunk);
        self.finish(on, &mut chunk, end);
    }

    /// Spreads metal (mm³) along a piece of a bead over the voxels that it covers.
    fn cover(&mut self, [from, to]: [DVec2; 2], width: f64, volume: f64, on: On, chunk: &mut Chunk) {
        let (length, apart) = (from.distance(to), FINE * self.settings.voxel());
        let [along, across] = [length, width].map(|extent| (extent / apart).ceil().max(1.0) as usize);
        let side = (to - from).normalize_or_zero().perp() * width;
        let deep = self.frame.deep(on, apart);
        let part = 1.0 / (along * across * deep) as f64;
        for s in 0..along {
            let middle = from.lerp(to, (s as f64 + 0.5) / along as f64);
            let add = |voxel, seen: f64| chunk.metal.push((voxel, volume * part, width * length * part * seen));
            self.frame.across(self.body.grid(), on, middle, side, [across, deep], add);
        }
    }

    /// Adds the metal and heat of a chunk and lets its time pass; returns the temperature just ahead of its end, °C.
    fn finish(&mut self, on: On, chunk: &mut Chunk, end: DVec2) -> f64 {
        let Chunk { mut metal, joules, seconds, .. } = std::mem::take(chunk);
        if metal.is_empty() {
            return self.surface(on, end);
        }
        let ahead = self.surface(on, end);
        metal.sort_by_key(|(voxel, ..)| *voxel);
        let whole: f64 = metal.iter().map(|(_, volume, _)| volume).sum();
        let mut laid: Vec<(usize, f64)> = Vec::new();
        for alike in metal.chunk_by(|a, b| a.0 == b.0) {
            let (voxel, volume) = (alike[0].0, alike.iter().map(|(_, volume, _)| volume).sum::<f64>());
            if self.covered[voxel] == 0.0 {
                self.touched.push(voxel);
            }
            self.covered[voxel] += alike.iter().map(|(.., area)| area).sum::<f64>();
            // A layer on edge covers the fraction of its voxel that its metal fills.
            let filled = (self.body.metal(voxel) + volume) / self.body.grid().size(voxel).z;
            let area = match self.frame {
                Frame::Level(_) => self.covered[voxel],
                Frame::Space(_) => self.covered[voxel].max(filled),
            };
            self.body.add(voxel, volume, area);
            laid.push((voxel, volume));
        }
        laid.iter().for_each(|&(voxel, volume)| self.body.heat(voxel, joules * volume / whole));
        self.body.refresh(&laid.iter().map(|(voxel, _)| *voxel).collect::<Vec<_>>());
        self.now += seconds;
        self.body.step(seconds + std::mem::take(&mut self.pending));
        self.note();
        ahead
    }

    /// Notes where the heat lies, if that is wanted.
    fn note(&mut self) {
        if let Some(watch) = &mut self.watch {
            watch.note(&self.body, self.now - self.pending);
        }
    }
}

/// The grid, the level of every layer, and the number of levels of the plate.
fn voxels(settings: &HeatSettings, bounds: &Bounds, layers: &[(f64, f64)]) -> (Grid, Vec<usize>, usize) {
    let (voxel, plate) = (settings.voxel(), &settings.substrate);
    let beyond = settings.bead_width / 2.0;
    let within = |axis: usize| [bounds.min[axis] - beyond, bounds.max[axis] + beyond];
    let edges = |axis: usize| graded(within(axis), [plate.margin; 2], voxel);
    let plate_levels = (plate.thickness / voxel).ceil().max(2.0) as usize;
    let bottom = layers.first().map_or(0.0, |(z, height)| z - height);
    let depth = |k: usize| bottom - plate.thickness * (1.0 - k as f64 / plate_levels as f64);
    let mut heights: Vec<f64> = (0..=plate_levels).map(depth).collect();
    let (mut levels, mut from) = (Vec::with_capacity(layers.len()), bottom);
    for (i, &(z, _)) in layers.iter().enumerate() {
        // Parts built one after another repeat layer heights.
        if z <= from && i > 0 {
            levels.push(levels[i - 1]);
            continue;
        }
        levels.push(heights.len() - 1);
        if z - from >= LEVEL * voxel || i + 1 == layers.len() {
            heights.push(z);
            from = z;
        }
    }
    (Grid::new([edges(0), edges(1), heights]), levels, plate_levels)
}

/// Metal and heat that enter the body together.
#[derive(Default)]
struct Chunk {
    /// Voxel, volume (mm³), area (mm²).
    metal: Vec<(usize, f64, f64)>,
    joules: f64,
    seconds: f64,
    length: f64,
}
