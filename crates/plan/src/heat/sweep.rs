//! One step in time: implicit along x, y and z in turn (locally one-dimensional scheme; Yanenko, The Method of
//! Fractional Steps, 1971). Each sweep solves the lines of one axis exactly, so it is stable for any step, creates no
//! new extremes, and conserves heat except for what the bare faces lose in it. Every step consists of two halves, the
//! second in the opposite order, which cancels most of the splitting error, and no temperature depends on how many
//! steps came before.

use super::body::{Air, Body, KELVIN, STEFAN_BOLTZMANN};
use super::grid::Grid;
use rayon::prelude::*;

/// Voxels along x in a tile: columns that are swept along z side by side.
pub(super) const TILE: usize = 16;

/// Tiles worth handing to one thread.
const TILES_A_TURN: usize = 8;

/// Sweeps over fewer voxels are not worth a second thread.
const WORTH_SHARING: usize = 16_000;

/// Faces radiate at most as if they were at this temperature, that of melting steel, K: losses of the arc and its pool
/// are already excluded by the arc efficiency.
const HOTTEST: f64 = 1800.0;

/// Voxels this near to the torch, on all sides, take part in every step.
const NEAR: usize = 5;

/// Lines along x that are solved side by side.
const LANES: usize = 8;

/// The longest step away from the torch, as a fraction of the time since it was near.
const PART_OF_REST: f64 = 0.08;

/// A level (swept along x and y) or a tile of columns (swept along z) that may take longer steps than the torch: the
/// longer ago it was heated, the slower its temperatures change.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Lag {
    /// Time by which it has not yet been advanced, s.
    owed: f64,
    /// The body's clock when the torch was last near, s.
    heated: f64,
}

impl Lag {
    /// The step to take when the body's clock has advanced by `seconds` to `now`; 0 if it is put off.
    fn step(&mut self, seconds: f64, now: f64, patience: f64) -> f64 {
        self.owed += seconds;
        let longest = (PART_OF_REST * (now - self.heated)).min(patience);
        if self.owed >= longest { std::mem::take(&mut self.owed) } else { 0.0 }
    }
}

/// Levels and tiles near a voxel take part in the next steps.
pub(super) fn wake(body: &mut Body, voxel: usize) {
    let ([x, y, level], [nx, ny, _]) = (body.grid.place(voxel), body.grid.counts());
    let (tiles, now) = (tiles(&body.grid), body.clock);
    for k in level.saturating_sub(NEAR)..(level + NEAR + 1).min(body.lags.levels.len()) {
        body.lags.levels[k].heated = now;
    }
    for j in y.saturating_sub(NEAR)..(y + NEAR + 1).min(ny) {
        for t in x.saturating_sub(NEAR) / TILE..(x + NEAR).min(nx - 1) / TILE + 1 {
            body.lags.tiles[j * tiles + t].heated = now;
        }
    }
}

/// The lag of every level and tile.
#[derive(Debug, Clone, Default)]
pub(super) struct Lags {
    pub(super) levels: Vec<Lag>,
    pub(super) tiles: Vec<Lag>,
    /// The longest step, s: longer ones let too little heat pass from the wall into the plate. With 0 everything takes
    /// part in every step.
    pub(super) patience: f64,
}

impl Lags {
    pub(super) fn new(grid: &Grid) -> Self {
        let [_, ny, nz] = grid.counts();
        Self { levels: vec![Lag::default(); nz], tiles: vec![Lag::default(); tiles(grid) * ny], patience: 0.0 }
    }
}

/// One step of `seconds`; returns the heat lost, J. Every sweep takes whole lines, so that none of them blocks the heat
/// of another, however long its step.
pub(super) fn step(body: &mut Body, seconds: f64) -> f64 {
    body.clock += seconds;
    let (now, patience) = (body.clock, body.lags.patience);
    let steps = |lags: &mut [Lag]| lags.iter_mut().map(|lag| lag.step(seconds, now, patience)).collect();
    let (levels, tiles): (Vec<f64>, Vec<f64>) = (steps(&mut body.lags.levels), steps(&mut body.lags.tiles));
    both_ways(body, levels, tiles)
}

/// Advances everything by the time that has passed; returns the heat lost, J.
pub(super) fn settle(body: &mut Body) -> f64 {
    let steps = |lags: &mut [Lag]| lags.iter_mut().map(|lag| std::mem::take(&mut lag.owed)).collect();
    let (levels, tiles): (Vec<f64>, Vec<f64>) = (steps(&mut body.lags.levels), steps(&mut body.lags.tiles));
    both_ways(body, levels, tiles)
}

/// Sweeps every level and tile by half of its own step, and by the other half in the opposite order.
fn both_ways(body: &mut Body, mut levels: Vec<f64>, mut tiles: Vec<f64>) -> f64 {
    levels.iter_mut().chain(&mut tiles).for_each(|seconds| *seconds /= 2.0);
    let lost = level(body, &levels, [0, 1]) + vertical(body, &tiles);
    lost + vertical(body, &tiles) + level(body, &levels, [1, 0])
}

/// A row of voxels along x, as one sweep sees it.
struct Row<'a> {
    theta: &'a mut [f64],
    capacity: &'a [f64],
    /// Conductance to the next voxel along the axis of the sweep.
    across: &'a [f64],
    /// Bare area, mm²; empty where nothing is bare.
    bare: &'a [f64],
    /// Area on the table, mm²; empty above.
    table: &'a [f64],
    /// True over voxel bare area.
    scale: f64,
}

impl Row<'_> {
    /// Loss of the bare faces of every voxel, W/K.
    fn leaks(&self, air: &Air, leaks: &mut [f64]) {
        let cold = air.ambient + KELVIN;
        leaks[self.bare.len()..].fill(0.0);
        for ((leak, bare), theta) in leaks.iter_mut().zip(self.bare).zip(&*self.theta) {
            // Radiation of at most [`HOTTEST`], over the whole temperature rise.
            let (hot, share) = ((cold + theta).min(HOTTEST), ((HOTTEST - cold) / theta.max(1e-9)).min(1.0));
            let radiated = air.emissivity * STEFAN_BOLTZMANN * (hot * hot + cold * cold) * (hot + cold);
            let film = air.convection + radiated * share;
            *leak = bare * self.scale * film;
        }
        leaks.iter_mut().zip(self.table).for_each(|(leak, area)| *leak += area * air.contact);
    }

    /// The heat lost at the new temperatures, J.
    fn lost(&self, leaks: &[f64], seconds: f64) -> f64 {
        self.theta.iter().zip(leaks).map(|(theta, leak)| theta * leak).sum::<f64>() * seconds
    }
}

/// Heat stored per second and kelvin, W/K, for `often` steps per second; an empty voxel stores a little, so that it
/// keeps its own temperature.
fn stored(capacity: f64, often: f64) -> f64 {
    if capacity > 0.0 { capacity * often } else { 1.0 }
}

/// The sweeps along x and y in some order, level by level, each with its step.
fn level(body: &mut Body, steps: &[f64], axes: [usize; 2]) -> f64 {
    let ([nx, ..], plane) = (body.grid.counts(), body.grid.strides()[2]);
    let Body { air, theta, capacity, across, bare, sides, exposed, extents, .. } = body;
    let swept: usize = extents.iter().zip(steps).filter(|(_, s)| **s > 0.0).map(|([x, y], _)| x.len() * y.len()).sum();
    let sweep = |(k, (theta, &seconds)): (usize, (&mut [f64], &f64))| {
        if seconds <= 0.0 {
            return 0.0;
        }
        let mut lost = 0.0;
        let mut scratch = Scratch::default();
        for axis in axes {
            let [x, y] = &extents[k];
            let rows = theta.chunks_mut(nx).enumerate().take(y.end).skip(y.start).map(|(j, theta)| {
                let from = k * plane + j * nx;
                let (theta, part) = (&mut theta[x.clone()], from + x.start..from + x.end);
                let [capacity, across, bare] =
                    [&capacity[..], &across[axis], &bare[axis]].map(|all| &all[part.clone()]);
                let bare = if exposed[axis][k] > 0 { bare } else { &[] };
                Row { theta, capacity, across, bare, table: &[], scale: sides[k] }
            });
            let mut rows: Vec<Row<'_>> = rows.collect();
            lost += match axis {
                0 => rows.chunks_mut(LANES).map(|rows| along(rows, air, seconds, &mut scratch)).sum(),
                _ => between(&mut rows, air, seconds),
            };
        }
        lost
    };
    if swept > WORTH_SHARING {
        let lost: Vec<f64> = theta.par_chunks_mut(plane).zip(steps).enumerate().map(sweep).collect();
        lost.iter().sum()
    } else {
        theta.chunks_mut(plane).zip(steps).enumerate().map(sweep).sum()
    }
}

/// Tiles side by side along x.
pub(super) fn tiles(grid: &Grid) -> usize {
    grid.counts()[0].div_ceil(TILE)
}

/// The sweep along z, tile by tile, each with its step.
fn vertical(body: &mut Body, steps: &[f64]) -> f64 {
    let (tiles, [nx, ..], plane) = (tiles(&body.grid), body.grid.counts(), body.grid.strides()[2]);
    let Body { air, theta, capacity, across, bare, table, levels, exposed, tops, upright, .. } = body;
    let heights: Vec<usize> = tops.iter().zip(steps).map(|(top, step)| if *step > 0.0 { *top } else { 0 }).collect();
    let mut columns: Vec<Vec<Row<'_>>> = heights.iter().map(|height| Vec::with_capacity(*height)).collect();
    for (k, theta) in theta[..plane * *levels].chunks_mut(plane).enumerate() {
        for (j, theta) in theta.chunks_mut(nx).enumerate() {
            for (t, theta) in theta.chunks_mut(TILE).enumerate().filter(|(t, _)| k < heights[j * tiles + t]) {
                let within = j * nx + t * TILE..j * nx + t * TILE + theta.len();
                let part = k * plane + within.start..k * plane + within.end;
                let [capacity, across, bare] = [&capacity[..], &across[2], &bare[2]].map(|all| &all[part.clone()]);
                let bare = if exposed[2][k] > 0 { bare } else { &[] };
                let table = table.get(part.clone()).unwrap_or_default();
                columns[j * tiles + t].push(Row { theta, capacity, across, bare, table, scale: *upright });
            }
        }
    }
    let sweep = |(rows, &seconds): (&mut Vec<Row<'_>>, &f64)| between(rows, air, seconds);
    if heights.iter().sum::<usize>() * TILE > WORTH_SHARING {
        let columns = columns.par_iter_mut().zip(steps).with_min_len(TILES_A_TURN);
        columns.map(sweep).collect::<Vec<f64>>().iter().sum()
    } else {
        columns.iter_mut().zip(steps).map(sweep).sum()
    }
}

/// Buffers for the values of a row.
#[derive(Default)]
struct Scratch {
    leaks: Vec<f64>,
    ratios: Vec<[f64; LANES]>,
}

/// Solves the lines of a few rows side by side, because each is a chain of dependent operations; returns the heat lost,
/// J.
fn along(rows: &mut [Row<'_>], air: &Air, seconds: f64, scratch: &mut Scratch) -> f64 {
    let (count, length) = (rows.len().min(LANES), rows.first().map_or(0, |row| row.theta.len()));
    let Scratch { leaks, ratios } = scratch;
    leaks.resize(LANES * length, 0.0);
    ratios.resize(length, [0.0; LANES]);
    for (row, leaks) in rows.iter().zip(leaks.chunks_mut(length)) {
        row.leaks(air, leaks);
    }
    let often = 1.0 / seconds;
    let [mut before, mut ratio, mut solved] = [[0.0; LANES]; 3];
    for v in 0..length {
        // Lanes without a row hold empty voxels.
        let [mut capacity, mut after, mut leak, mut theta] = [[0.0; LANES]; 4];
        for (lane, row) in rows.iter().enumerate().take(LANES) {
            (capacity[lane], after[lane]) = (row.capacity[v], row.across[v]);
            (leak[lane], theta[lane]) = (leaks[lane * length + v], row.theta[v]);
        }
        for lane in 0..LANES {
            let stored = stored(capacity[lane], often);
            let share = 1.0 / (stored + leak[lane] + after[lane] + before[lane] * (1.0 - ratio[lane]));
            solved[lane] = (stored * theta[lane] + before[lane] * solved[lane]) * share;
            ratio[lane] = after[lane] * share;
        }
        before = after;
        ratios[v] = ratio;
        rows.iter_mut().zip(solved).for_each(|(row, solved)| row.theta[v] = solved);
    }
    let mut next = [0.0; LANES];
    for v in (0..length).rev() {
        for (lane, row) in rows.iter_mut().enumerate().take(count) {
            row.theta[v] += ratios[v][lane] * next[lane];
            next[lane] = row.theta[v];
        }
    }
    rows.iter().zip(leaks.chunks(length)).map(|(row, leaks)| row.lost(leaks, seconds)).sum()
}

/// Solves the lines that cross consecutive rows; returns the heat lost, J.
fn between(rows: &mut [Row<'_>], air: &Air, seconds: f64) -> f64 {
    let width = rows.first().map_or(0, |row| row.theta.len());
    let mut leaks = vec![0.0; rows.len() * width];
    let mut ratios = vec![0.0; rows.len() * width];
    let often = 1.0 / seconds;
    // Stands for the row before the first.
    let none = vec![0.0; width];
    for n in 0..rows.len() {
        let (done, rest) = rows.split_at_mut(n);
        let (before, solved) = done.last().map_or((&none[..], &none[..]), |row| (row.across, &*row.theta));
        let (kept, ratios) = ratios.split_at_mut(n * width);
        let ratio_before = if n > 0 { &kept[(n - 1) * width..] } else { &none[..] };
        let (row, leaks) = (&mut rest[0], &mut leaks[n * width..(n + 1) * width]);
        row.leaks(air, leaks);
        let (theta, ratios) = (&mut row.theta[..width], &mut ratios[..width]);
        let (capacity, across) = (&row.capacity[..width], &row.across[..width]);
        let (before, solved, ratio_before) = (&before[..width], &solved[..width], &ratio_before[..width]);
        for v in 0..width {
            let stored = stored(capacity[v], often);
            let share = 1.0 / (stored + leaks[v] + across[v] + before[v] * (1.0 - ratio_before[v]));
            theta[v] = (stored * theta[v] + before[v] * solved[v]) * share;
            ratios[v] = across[v] * share;
        }
    }
    for n in (0..rows.len().saturating_sub(1)).rev() {
        let (near, far) = rows.split_at_mut(n + 1);
        let (row, next) = (&mut near[n], &far[0]);
        let ratios = &ratios[n * width..];
        row.theta.iter_mut().zip(ratios).zip(&*next.theta).for_each(|((theta, ratio), next)| *theta += ratio * next);
    }
    rows.iter().zip(leaks.chunks(width.max(1))).map(|(row, leaks)| row.lost(leaks, seconds)).sum()
}
