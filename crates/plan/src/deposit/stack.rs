//! The part as it grows: every bead laid on the metal below it.
//!
//! A bead keeps the shape of its crown and its volume, and sinks or rises until both fit the ground it meets: its top
//! is max(ground, a + crown), with a such that the metal between top and ground is the metal fed. So a bead on a flat
//! plate is the bead of [`stroke`](super::stroke), one between two others fills their valley, and one on the crest of a
//! wall rises by area over width (the equal areas of [`wall`](crate::bead::wall)). Where the ground falls away, the
//! bead overhangs: its metal runs down no farther below its edge than the mean height of a bead. Nothing else levels
//! out: the model has neither remelting nor flow along a bead.

use super::field::Grid;
use super::lay::Pool;
use super::stroke::{Domed, Even, Frame, Rimmed, Stroke, strokes};
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
const BALANCED: f32 = 1e-4;

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
    /// Height of the edge of the last piece of this pass, mm.
    edge: Option<f32>,
    /// The points under a piece; kept so that each need not make room anew.
    under: Under,
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

/// How a part grows, bead laid on bead.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Grown {
    /// After each layer, over the area of that layer.
    pub layers: Vec<Growth>,
    /// At the end of each body, over its whole area; `None` where nothing is laid, or where layers do not lie over one
    /// another once they are unrolled.
    pub built: Vec<Option<Growth>>,
}

impl Grown {
    /// The final growth of the body that ends farthest from its plan.
    pub fn worst(&self) -> Option<Growth> {
        self.built.iter().flatten().copied().min_by(|a, b| a.within.total_cmp(&b.within))
    }
}

impl Stack {
    /// A bare plate below `bounds`.
    pub fn new(bounds: &Bounds, settings: DepositSettings) -> Self {
        let margin = settings.nominal.bead.width + settings.machining_allowance.max(0.0);
        let grid = Grid::covering(bounds, margin, COARSER * settings.step);
        let points = grid.points();
        let (top, wanted, swept) = (vec![0.0; points], vec![f32::NAN; points], vec![Swept::default(); points]);
        Self {
            grid,
            settings,
            top,
            wanted,
            swept,
            pieces: 1,
            edge: None,
            under: Under::default(),
            plate: None,
            layer_height: None,
            growth: Vec::new(),
        }
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

    /// The growth of the one body that was stacked.
    pub fn grown(&self) -> Grown {
        Grown { layers: self.growth.clone(), built: vec![self.built()] }
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
            (self.pieces, self.edge) = (self.pieces + 2, None);
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
        let mut under = std::mem::take(&mut self.under);
        match own.section {
            Section::Parabola => self.reach::<Domed>(&own, &wide, &mut under),
            Section::Ellipse => self.reach::<Even>(&own, &wide, &mut under),
            Section::Stadium => self.reach::<Rimmed>(&own, &wide, &mut under),
        }
        let metal = piece.volume() / (self.grid.step * self.grid.step);
        if let Some(edge) = under.edge_height(&piece.bead, metal as f32, self.edge) {
            under.points().for_each(|(at, part, rise)| self.top[at] += part * (edge + rise).max(0.0));
            self.edge = Some(edge);
            self.pieces += 1;
        }
        self.under = under;
    }

    /// Finds the grid points to which a piece brings metal, with the fraction of their bead that it sweeps; `wide` is the
    /// piece widened by half a step on both sides.
    fn reach<F: Pool>(&mut self, own: &Frame, wide: &Frame, under: &mut Under) {
        under.clear();
        let step = self.grid.step;
        let (a, b) = (own.from.y, own.from.y + own.along.y * own.length);
        for row in self.grid.rows_between(a.min(b) - wide.a, a.max(b) + wide.a) {
            let Some((low, high, ..)) = wide.row(self.grid.place(0, row).y) else { continue };
            let columns = self.grid.columns_between(low, high);
            let first = self.grid.place(columns.start, row) - own.from;
            let start = (own.along.dot(first) as f32, own.along.perp_dot(first) as f32);
            under.row.resize(columns.len(), Swath::default());
            sweep::<F>(&mut under.row, start, (own, wide), step);
            for (k, swath) in under.row.iter().enumerate().filter(|(_, swath)| swath.share > 0.0) {
                let at = row * self.grid.columns + columns.start + k;
                let swept = &mut self.swept[at];
                let before = if self.pieces - swept.piece > 1 { 0.0 } else { swept.part };
                // As a fraction of what the bead has yet to bring here; a fully swept point starts again.
                let (part, after) = if before + swath.share < 1.0 {
                    (swath.share / (1.0 - before), before + swath.share)
                } else {
                    (1.0, before + swath.share - 1.0)
                };
                *swept = Swept { part: after, piece: self.pieces };
                under.at.push(at);
                under.part.push(swath.covered * part);
                under.left.push(1.0 - before);
                under.crown.push(swath.crown);
                under.ground.push(self.top[at]);
            }
        }
    }
}

/// What a piece of bead brings to a grid point.
#[derive(Debug, Clone, Copy, Default)]
struct Swath {
    /// The fraction of the bead that it sweeps.
    share: f32,
    /// Height of the bead above its edge, mm.
    crown: f32,
    /// The fraction of the point that the bead covers.
    covered: f32,
}

/// What a piece brings to a row of points; the first of them lies at `start` along and across it, mm. Code without branches,
/// which becomes vector instructions.
fn sweep<F: Pool>(row: &mut [Swath], start: (f32, f32), (own, wide): (&Frame, &Frame), step: f64) {
    let (x, y) = ((own.along.x * step) as f32, (-own.along.y * step) as f32);
    let (length, height, half) = (own.length as f32, own.height as f32, wide.a as f32);
    let (per_own, per_wide, per_step) = ((1.0 / own.a) as f32, (1.0 / wide.a) as f32, (1.0 / step) as f32);
    for (k, swath) in (0_u16..).zip(row) {
        let (along, across) = (start.0 + f32::from(k) * x, start.1 + f32::from(k) * y);
        let (inside, of_own) = (1.0 - (across * per_wide).powi(2), 1.0 - (across * per_own).powi(2));
        let per_chord = per_wide / inside.max(f32::MIN_POSITIVE).sqrt();
        let share = F::share((length - along) * per_chord) - F::share(-along * per_chord);
        *swath = Swath {
            share: if inside > 0.0 { share.min(1.0) } else { 0.0 },
            crown: height * F::whole(of_own),
            covered: ((half - across.abs()) * per_step).clamp(0.0, 1.0),
        };
    }
}

/// The grid points under a piece of bead.
#[derive(Debug, Clone, Default)]
struct Under {
    at: Vec<usize>,
    /// The fraction that the piece brings, of what the bead has yet to bring here.
    part: Vec<f32>,
    /// The fraction of the bead that had not been laid here.
    left: Vec<f32>,
    /// Height of the bead above its edge, mm.
    crown: Vec<f32>,
    /// Height of the metal already here, mm.
    ground: Vec<f32>,
    /// Room for one row.
    row: Vec<Swath>,
}

/// Points computed side by side.
const LANES: usize = 8;

impl Under {
    fn clear(&mut self) {
        self.at.clear();
        [&mut self.part, &mut self.left, &mut self.crown, &mut self.ground].into_iter().for_each(Vec::clear);
    }

    /// The grid points, the fraction that the piece brings, and how high the bead rises above the ground if its edge is at
    /// height 0.
    fn points(&self) -> impl Iterator<Item = (usize, f32, f32)> {
        let rise = self.crown.iter().zip(&self.ground).map(|(crown, ground)| crown - ground);
        self.at.iter().zip(&self.part).zip(rise).map(|((at, part), rise)| (*at, *part, rise))
    }

    /// The height of a bead's edge at which the metal between its top and the ground is `metal` (mm summed over grid
    /// points), sought from that of the piece `before` it.
    fn edge_height(&self, bead: &Bead, metal: f32, before: Option<f32>) -> Option<f32> {
        let highest = self.ground.iter().copied().fold(f32::NEG_INFINITY, f32::max);
        let lowest = self.ground.iter().copied().fold(f32::INFINITY, f32::min);
        let (height, sag) = (bead.height as f32, (bead.area() / bead.width) as f32);
        let (mut low, mut high) = (lowest - height, highest + height);
        let mut edge = before.filter(|before| (low..=high).contains(before)).unwrap_or(lowest);
        for _ in 0..50 {
            let (laid, slope) = self.metal(edge, sag);
            let sum = laid - metal;
            if sum.abs() <= BALANCED * metal {
                break;
            }
            *(if sum > 0.0 { &mut high } else { &mut low }) = edge;
            let step = edge - sum / slope;
            edge = if step > low && step < high { step } else { 0.5 * (low + high) };
        }
        (!self.at.is_empty() && edge.is_finite()).then_some(edge)
    }

    /// The metal between a bead with its edge at this height and the ground, mm summed over grid points, and how much more it
    /// is for an edge 1 mm higher. Below its edge, metal runs down no farther than `sag`.
    fn metal(&self, edge: f32, sag: f32) -> (f32, f32) {
        let (part, left) = (self.part.chunks(LANES), self.left.chunks(LANES));
        let (crown, ground) = (self.crown.chunks(LANES), self.ground.chunks(LANES));
        let (mut sums, mut slopes) = ([0.0_f32; LANES], [0.0_f32; LANES]);
        for ((part, left), (crown, ground)) in part.zip(left).zip(crown.zip(ground)) {
            for ((((sum, slope), part), left), (crown, ground)) in
                sums.iter_mut().zip(&mut slopes).zip(part).zip(left).zip(crown.iter().zip(ground))
            {
                let (depth, most) = (edge + crown - ground, left * (crown + sag));
                *sum += part * depth.max(0.0).min(most);
                *slope += if depth > 0.0 && depth < most { *part } else { 0.0 };
            }
        }
        (sums.iter().sum(), slopes.iter().sum())
    }
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
