//! The part as it grows: every bead laid on the metal below it.
//!
//! A bead keeps the shape of its crown and its volume, and sinks or rises until both fit the ground it meets: its top
//! is max(ground, a + crown), with a such that the metal between top and ground is the metal fed. So a bead on a flat
//! plate is the bead of [`stroke`](super::stroke), one between two others fills their valley, and one on the crest of a
//! wall rises by area over width (the equal areas of [`wall`](crate::bead::wall)). Where the ground falls away, the
//! bead overhangs: its metal runs down no farther below its edge than the mean height of a bead. Nothing else levels
//! out: the model has neither remelting nor flow along a bead.

use super::field::Grid;
use super::stroke::{Domed, Even, Footprint, Frame, Rimmed, Stroke, strokes};
use super::{DepositSettings, Mask, RIM};
use crate::bead::{Bead, Section};
use crate::layer::Layer;
use crate::pass::Pass;
use glam::DVec2;
use planar::Bounds;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// Beads are laid in pieces a quarter to half their width long.
const SHORTEST_PIECE: f64 = 0.25;
const LONGEST_PIECE: f64 = 0.5;
/// Pieces are joined if the chord is at least this fraction of the path.
const STRAIGHT: f64 = 0.95;
/// Grid step of a stack over that of the layers.
const COARSER: f64 = 2.0;
/// Tolerance of a piece's metal against the metal fed, as a fraction.
const BALANCED: f64 = 1e-4;

/// The metal built on the plate.
#[derive(Debug, Clone)]
pub struct Stack {
    grid: Grid,
    settings: DepositSettings,
    /// Height of the metal, mm.
    top: Vec<f32>,
    /// Height that the plan requires inside the rim, mm; NaN elsewhere.
    wanted: Vec<f32>,
    swept: Vec<Swept>,
    pieces: u32,
    /// Underside of the lowest layer, mm.
    plate: Option<f64>,
    /// Thickness of the last layer, mm.
    layer_height: Option<f64>,
    growth: Vec<Growth>,
}

/// How much of the pool has passed over a grid point.
#[derive(Debug, Clone, Copy, Default)]
struct Swept {
    /// The fraction of a bead that it has received.
    part: f32,
    /// The last piece that reached it.
    piece: u32,
}

/// Deviation of the metal from the plan's height, mm, inside the outlines less their rim.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Growth {
    /// The greatest height above the plan, mm.
    pub peak: f64,
    /// Where it is.
    pub peak_place: DVec2,
    /// The greatest depth below the plan, mm.
    pub hollow: f64,
    /// Where that is, mm.
    pub hollow_place: DVec2,
    /// Mean height above the plan, mm; negative below it.
    pub mean: f64,
    /// Fraction of the area that is within one layer height of the plan.
    pub within: f64,
}

impl Stack {
    /// A bare plate below `bounds`.
    pub fn new(bounds: &Bounds, settings: DepositSettings) -> Self {
        let grid = Grid::covering(bounds, settings.nominal.bead.width, COARSER * settings.step);
        let points = grid.points();
        let (top, wanted, swept) = (vec![0.0; points], vec![f32::NAN; points], vec![Swept::default(); points]);
        Self { grid, settings, top, wanted, swept, pieces: 1, plate: None, layer_height: None, growth: Vec::new() }
    }

    /// The state after each layer, the lowest first, within that layer's outline.
    pub fn growth(&self) -> &[Growth] {
        &self.growth
    }

    /// The state of the finished build, each point compared with the highest layer there; `None` if no layer is wider
    /// than its rim, as when the top is a single slope.
    pub fn built(&self) -> Option<Growth> {
        let columns = self.grid.columns.max(1);
        let all = self.wanted.chunks(columns).enumerate().map(|(row, wanted)| (row, 0..wanted.len()));
        let any = self.wanted.iter().any(|wanted| !wanted.is_nan());
        self.layer_height.filter(|_| any).map(|height| self.compared(all, height))
    }

    /// Height of the metal at the grid point nearest to a place, mm; `None` beyond the grid.
    ///
    /// ```
    /// use bead_plan::bead::Bead;
    /// use bead_plan::deposit::{DepositSettings, Nominal, Stack};
    /// use bead_plan::pass::{Along, Pass, PassKind};
    /// use glam::{DVec2, DVec3};
    ///
    /// let nominal = Nominal { bead: Bead::parabola(6.0, 2.0), pace: 8.0, rise: 2.0 };
    /// let (points, width, pace) = (vec![DVec3::ZERO, DVec3::X * 80.0], Along::Same(6.0), Along::Same(8.0));
    /// let bounds = planar::Bounds { min: DVec2::ZERO, max: DVec2::X * 80.0 };
    /// let mut stack = Stack::new(&bounds, DepositSettings::new(nominal, 0.0));
    /// stack.weld(&[Pass { kind: PassKind::Wall, closed: false, points, width, pace, wait: 0.0 }]);
    /// assert!(stack.height_at(DVec2::X * 40.0).is_some_and(|height| (height - 2.0).abs() < 0.1));
    /// ```
    pub fn height_at(&self, place: DVec2) -> Option<f64> {
        self.grid.nearest(place).map(|at| self.top[at].into())
    }

    /// The grid on which the metal lies.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// Lays the passes of a layer as they are welded.
    pub fn weld(&mut self, passes: &[Pass]) {
        for pass in passes {
            // A sweep never continues into the next pass.
            self.pieces += 2;
            for piece in pieces(strokes(pass, &self.settings.nominal)) {
                self.lay(&piece);
            }
        }
    }

    /// Lays the passes of a layer and compares the metal with the plan there.
    pub fn add(&mut self, layer: &Layer) {
        self.layer_height = Some(layer.height);
        let plate = *self.plate.get_or_insert(layer.z - layer.height);
        self.weld(&layer.passes);
        let rim = RIM * self.settings.nominal.bead.width;
        let beside = DepositSettings { machining_allowance: rim, ..self.settings };
        let mask = Mask::new(layer, &beside, &self.grid);
        for row in 0..self.grid.rows {
            let at = row * self.grid.columns;
            mask.allowed(row).iter().for_each(|c| self.wanted[at + c.start..at + c.end].fill(f32::NAN));
            let wanted = (layer.z - plate) as f32;
            mask.core(row).iter().for_each(|c| self.wanted[at + c.start..at + c.end].fill(wanted));
        }
        let core = (0..self.grid.rows).flat_map(|row| mask.core(row).iter().map(move |c| (row, c.clone())));
        let growth = self.compared(core, layer.height);
        self.growth.push(growth);
    }

    /// Compares the metal with the plan on sections of rows.
    fn compared(&self, stretches: impl Iterator<Item = (usize, Range<usize>)>, layer_height: f64) -> Growth {
        let (mut points, mut near, mut sum) = (0_usize, 0_usize, 0.0);
        let mut growth = Growth::default();
        for (row, columns) in stretches {
            for column in columns {
                let at = row * self.grid.columns + column;
                let over = f64::from(self.top[at]) - f64::from(self.wanted[at]);
                if over.is_nan() {
                    continue;
                }
                (points, sum) = (points + 1, sum + over);
                near += usize::from(over.abs() <= layer_height);
                if over > growth.peak {
                    (growth.peak, growth.peak_place) = (over, self.grid.place(column, row));
                }
                if -over > growth.hollow {
                    (growth.hollow, growth.hollow_place) = (-over, self.grid.place(column, row));
                }
            }
        }
        if points > 0 {
            (growth.mean, growth.within) = (sum / points as f64, near as f64 / points as f64);
        }
        growth
    }

    fn lay(&mut self, piece: &Stroke) {
        // Grid points crossed by the edge of the bead belong to it partly.
        let wider = Bead { width: piece.bead.width + self.grid.step, ..piece.bead };
        let Some((own, wide)) = piece.frame().zip(Stroke { bead: wider, ..*piece }.frame()) else { return };
        let cells = match own.section {
            Section::Parabola => self.reached::<Domed>(&own, &wide),
            Section::Ellipse => self.reached::<Even>(&own, &wide),
            Section::Stadium => self.reached::<Rimmed>(&own, &wide),
        };
        let metal = piece.volume() / (self.grid.step * self.grid.step);
        let Some(edge) = edge_height(&cells, &piece.bead, metal) else { return };
        for cell in &cells {
            self.top[cell.at] += (cell.part * (edge + cell.crown - cell.ground).max(0.0)) as f32;
        }
        self.pieces += 1;
    }

    /// The grid points to which a piece brings metal, with the fraction of their bead that it sweeps; `wide` is the
    /// piece widened by half a step on both sides.
    fn reached<F: Footprint>(&mut self, own: &Frame, wide: &Frame) -> Vec<Cell> {
        let (a, b) = (own.from.y, own.from.y + own.along.y * own.length);
        let mut cells = Vec::new();
        for row in self.grid.rows_between(a.min(b) - wide.a, a.max(b) + wide.a) {
            let Some((low, high, ..)) = wide.row(self.grid.place(0, row).y) else { continue };
            for column in self.grid.columns_between(low, high) {
                let (place, at) = (self.grid.place(column, row), row * self.grid.columns + column);
                let (whole, added) = (wide.passed_over::<F>(place), wide.height_of::<F>(place));
                if added <= 0.0 || whole <= 0.0 {
                    continue;
                }
                let beside = own.along.perp_dot(place - own.from).abs();
                let covered = ((wide.a - beside) / self.grid.step).clamp(0.0, 1.0);
                let swept = &mut self.swept[at];
                let before = if self.pieces - swept.piece > 1 { 0.0 } else { f64::from(swept.part) };
                let share = (added / whole).min(1.0);
                // As a fraction of what the bead has yet to bring here; a fully swept point starts again.
                let (part, after) = if before + share < 1.0 {
                    (share / (1.0 - before), before + share)
                } else {
                    (1.0, before + share - 1.0)
                };
                *swept = Swept { part: after as f32, piece: self.pieces };
                let (crown, ground) = (own.passed_over::<F>(place), f64::from(self.top[at]));
                cells.push(Cell { at, part: covered * part, left: 1.0 - before, crown, ground });
            }
        }
        cells
    }
}

/// A grid point under a piece of bead.
struct Cell {
    at: usize,
    /// The fraction that the piece brings, of what the bead has yet to bring here.
    part: f64,
    /// The fraction of the bead that had not been laid here.
    left: f64,
    /// Height of the bead above its edge, mm.
    crown: f64,
    /// Height of the metal already here, mm.
    ground: f64,
}

/// The height of a bead's edge at which the metal between its top and the ground is `metal` (mm summed over grid
/// points).
fn edge_height(cells: &[Cell], bead: &Bead, metal: f64) -> Option<f64> {
    let highest = cells.iter().map(|cell| cell.ground).fold(f64::NEG_INFINITY, f64::max);
    let lowest = cells.iter().map(|cell| cell.ground).fold(f64::INFINITY, f64::min);
    let sag = bead.area() / bead.width;
    let (mut low, mut high) = (lowest - bead.height, highest + bead.height);
    let mut edge = lowest;
    for _ in 0..50 {
        let (mut sum, mut slope) = (-metal, 0.0);
        for cell in cells {
            let depth = edge + cell.crown - cell.ground;
            if depth > 0.0 {
                let most = cell.left * (cell.crown + sag);
                sum += cell.part * depth.min(most);
                slope += if depth < most { cell.part } else { 0.0 };
            }
        }
        if sum.abs() <= BALANCED * metal {
            break;
        }
        *(if sum > 0.0 { &mut high } else { &mut low }) = edge;
        let step = edge - sum / slope;
        edge = if step > low && step < high { step } else { 0.5 * (low + high) };
    }
    (!cells.is_empty() && edge.is_finite()).then_some(edge)
}

/// A path as pieces of bead no longer than half its width; pieces shorter than a quarter are joined where the path
/// hardly turns.
fn pieces(strokes: impl Iterator<Item = Stroke>) -> Vec<Stroke> {
    let mut joined: Vec<Stroke> = Vec::new();
    for stroke in strokes {
        match joined.last_mut().and_then(|last| together(last, &stroke).map(|both| (last, both))) {
            Some((last, both)) => *last = both,
            None => joined.push(stroke),
        }
    }
    let split = |piece: Stroke| {
        let count = (piece.from.distance(piece.to) / (LONGEST_PIECE * piece.bead.width)).ceil().max(1.0);
        let at = move |k: f64| piece.from.lerp(piece.to, k / count);
        (0..count as usize).map(move |k| Stroke { from: at(k as f64), to: at(k as f64 + 1.0), ..piece })
    };
    joined.into_iter().flat_map(split).collect()
}

/// Two consecutive pieces as one with their metal, if it is short and nearly as long as the two.
fn together(first: &Stroke, second: &Stroke) -> Option<Stroke> {
    let [a, b] = [first, second].map(|piece| piece.from.distance(piece.to));
    let length = first.from.distance(second.to);
    let width = (first.bead.width * a + second.bead.width * b) / (a + b);
    if !(a + b <= SHORTEST_PIECE * width && length >= STRAIGHT * (a + b)) {
        return None;
    }
    let section = first.bead.section;
    let height = section.height_of(width, (first.volume() + second.volume()) / length);
    Some(Stroke { from: first.from, to: second.to, bead: Bead { width, height, section } })
}
