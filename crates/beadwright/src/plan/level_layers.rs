//! Level layers: layers as high as their metal fills them, and metal where the slice needs it.
//!
//! Beads that overlap by the rule lie side by side and fill a wide layer. At its rim nothing overlaps them, so that the
//! beads of a narrow part hold less metal than its slices: n beads a stepover of ρ widths apart fill n ρ / ((n − 1) ρ + 1) of
//! them, two 0.83 and ten 0.96 for ρ = 0.715. [`slabs`] looks at slices of the part and places the layers as high as most of their beads fill. Within a
//! layer [`share`] then shifts metal from beads that have neighbours to those that have none, by the pace: every piece of a
//! pass fills the strip of the slice that lies nearest to it.

use super::emitter::lifted;
use super::filled::fill_planned;
use super::{MAX_LAYERS, middle, scan_lines};
use crate::deposit::Nominal;
use crate::deposit::field::Grid;
use crate::fill::Strategy;
use crate::layer::{self, Layer};
use crate::model::Mesh;
use crate::pass::{Along, Pass, Segment};
use crate::profile::Profile;
use crate::slice::{LayerFit, ROUNDING, Slab, Slicer};
use crate::task::{Cancelled, Task};
use planar::{Polygon, Region};
use rayon::prelude::*;

/// Number of heights at which a part is looked at, at most.
const HEIGHTS: usize = 24;
/// A layer is not thinner or thicker than this, in layers.height.
const THICKNESS: std::ops::RangeInclusive<f64> = 0.5..=1.25;

/// The layers of a mesh that stands on z = 0, each as high as its metal fills its slice.
///
/// # Errors
/// [`Cancelled`].
pub(super) fn slabs(
    mesh: &Mesh,
    strategy: &dyn Strategy,
    profile: &Profile,
    task: &Task,
) -> Result<Vec<Slab>, Cancelled> {
    let (top, height) = (mesh.bounds().1.z.max(0.0), profile.layers.height);
    let count = ((top / height) as usize).clamp(1, HEIGHTS);
    let apart = top / count as f64;
    // A slice lies in the middle of its slab.
    let looked_at = (0..count).map(|k| Slab { z: (k as f64 + 0.5) * apart + 0.5 * height, height }).collect();
    let slicer = Slicer::of_slabs(mesh, looked_at, profile.slice_options(), task)?;
    let mut rises: Vec<Option<f64>> = Vec::with_capacity(count);
    for batch in 0..slicer.batch_count() {
        let planned = scan_lines::planned(batch, &slicer, strategy, profile, task)?;
        rises.par_extend(planned.par_iter().map(|layer| {
            let filled = fill_planned(layer, strategy, profile, middle(mesh));
            let laid = filled.slice.islands.iter().zip(&filled.fills).filter(|(_, fill)| !fill.is_empty());
            let islands: Vec<Polygon> = laid.map(|(island, _)| island.clone()).collect();
            let paths = filled.fills.into_iter().flat_map(|fill| fill.stages).flatten().collect();
            let passes = lifted(paths, filled.slice.index, (0.0, height), profile);
            rise(&Layer { height, islands, passes, ..Layer::default() }, profile)
        }));
        task.check()?;
    }
    let known: Vec<(f64, f64)> =
        rises.iter().enumerate().filter_map(|(k, rise)| Some(((k as f64 + 0.5) * apart, (*rise)?))).collect();
    Ok(stacked(top, profile, |z| between(&known, z).unwrap_or(height)))
}

/// How high a layer is whose beads hold what they need, by the median over their metal; `None` for one without beads. The
/// mean would be lower, and narrow more beads than it widens.
fn rise(layer: &Layer, profile: &Profile) -> Option<f64> {
    let shares = shares(layer, profile);
    let mut pieces: Vec<(f64, f64)> =
        shares.iter().flat_map(|share| share.factors.iter().copied().zip(share.held.iter().copied())).collect();
    pieces.sort_by(|a, b| a.0.total_cmp(&b.0));
    let all: f64 = pieces.iter().map(|piece| piece.1).sum();
    let mut sum = 0.0;
    let (factor, _) = pieces.into_iter().find(|piece| {
        sum += piece.1;
        sum >= 0.5 * all
    })?;
    let thinner = (1.0 / factor).clamp(*THICKNESS.start(), *THICKNESS.end());
    Some(layer.height * thinner)
}

fn metal_of(piece: &Segment, nominal: &Nominal) -> f64 {
    piece.length() * nominal.bead_at(piece.width, piece.pace).area()
}

fn nominal(profile: &Profile) -> Nominal {
    super::deposit_settings(profile).nominal
}

/// The value at a height between two that are known; beyond the first and the last, theirs.
fn between(known: &[(f64, f64)], z: f64) -> Option<f64> {
    let behind = known.partition_point(|(at, _)| *at < z);
    match (behind.checked_sub(1).and_then(|i| known.get(i)), known.get(behind)) {
        (Some(a), Some(b)) => Some(a.1 + (b.1 - a.1) * (z - a.0) / (b.0 - a.0)),
        (a, b) => a.or(b).map(|known| known.1),
    }
}

/// Layers that rise as `rise` says of their middle (mm), fitted to the height of a part as the profile asks.
fn stacked(top: f64, profile: &Profile, rise: impl Fn(f64) -> f64) -> Vec<Slab> {
    let (mut slabs, mut z) = (Vec::new(), 0.0);
    while slabs.len() < MAX_LAYERS {
        let height = rise(z + profile.layers.height / 2.0);
        let least = if profile.layers.fit == LayerFit::Last { ROUNDING } else { 0.5 };
        if !slabs.is_empty() && z + least * height >= top {
            break;
        }
        z += height;
        slabs.push(Slab { z, height });
    }
    if profile.layers.fit == LayerFit::Even && z > 0.0 && top > 0.0 {
        let scale = top / z;
        slabs.iter_mut().for_each(|slab| *slab = Slab { z: slab.z * scale, height: slab.height * scale });
    }
    slabs
}

/// A piece gets at most this many times the metal of its bead.
const MOST: f64 = 1.3;
/// Pieces on which the metal is found, in widths of the nominal bead.
const PIECE: f64 = 0.25;
/// Metal is evened out over this distance before and behind a piece, in widths.
const AROUND: f64 = 1.0;
/// Pieces that need the same metal but for this fraction get the same.
const ALIKE: f64 = 0.04;
/// A place belongs to a pass at most this far away, in widths.
const REACH: f64 = 0.75;
/// Grid points across a bead.
const ACROSS: f64 = 8.0;

/// A pass in pieces, with the metal that each holds (mm³), and what it needs as a multiple of that.
struct Share {
    pieces: Vec<Segment>,
    held: Vec<f64>,
    factors: Vec<f64>,
}

/// What the passes of a layer hold and need.
fn shares(layer: &Layer, profile: &Profile) -> Vec<Share> {
    let nominal = nominal(profile);
    let width = nominal.bead.width;
    let pieces: Vec<Vec<Segment>> = layer.passes.iter().map(|pass| cut(pass, PIECE * width)).collect();
    let areas = strips(layer, pieces.iter().flatten(), width);
    let mut areas = areas.iter();
    let share = |(pass, pieces): (&Pass, Vec<Segment>)| {
        let wanted: Vec<f64> = areas.by_ref().take(pieces.len()).map(|area| area * layer.height).collect();
        let held: Vec<f64> = pieces.iter().map(|piece| metal_of(piece, &nominal)).collect();
        let lengths: Vec<f64> = pieces.iter().map(Segment::length).collect();
        let factors = evened(&wanted, &held, &lengths, pass.closed, AROUND * width);
        Share { pieces, held, factors }
    };
    layer.passes.iter().zip(pieces).map(share).collect()
}

/// Shares out the metal of a layer: each piece of a pass is laid at the pace that fills the strip of the slice nearest to
/// it, and is as wide as the law of the bead says.
pub(super) fn share(layer: &mut Layer, profile: &Profile) {
    let nominal = nominal(profile);
    let shares = shares(layer, profile);
    for (pass, Share { pieces, held, factors }) in layer.passes.iter_mut().zip(shares) {
        let laid = |(piece, factor): (&Segment, f64)| {
            let factor = factor.clamp(MOST.recip(), MOST);
            let bead = nominal.bead_at(piece.width, piece.pace);
            let width = profile.bead.law.width_of_area(&bead, factor * bead.area());
            Segment { width, pace: piece.pace / factor, ..*piece }
        };
        let laid: Vec<Segment> = pieces.iter().zip(in_runs(&factors, &held)).map(laid).collect();
        *pass = joined(pass, &laid);
    }
}

/// A pass in pieces of at most `longest` (mm).
fn cut(pass: &Pass, longest: f64) -> Vec<Segment> {
    let parts = |piece: Segment| {
        let count = (piece.length() / longest).ceil().max(1.0);
        let at = move |k: f64| piece.from.lerp(piece.to, k / count);
        (0..count as usize).map(move |k| Segment { from: at(k as f64), to: at(k as f64 + 1.0), ..piece })
    };
    pass.segments().flat_map(parts).collect()
}

/// Area of the slice nearest to each piece, mm².
fn strips<'a>(layer: &Layer, pieces: impl Iterator<Item = &'a Segment>, width: f64) -> Vec<f64> {
    let Some(bounds) = layer::bounds(std::slice::from_ref(layer)) else { return Vec::new() };
    let (grid, reach) = (Grid::covering(&bounds, 0.0, width / ACROSS), REACH * width);
    let mut nearest = vec![(f64::INFINITY, 0_usize); grid.points()];
    let mut count = 0;
    for (index, piece) in pieces.enumerate() {
        let (a, b) = (piece.from.truncate(), piece.to.truncate());
        let (low, high) = (a.min(b) - reach, a.max(b) + reach);
        for row in grid.rows_between(low.y, high.y) {
            for column in grid.columns_between(low.x, high.x) {
                let distance = planar::polyline::distance_squared_to_segment(grid.place(column, row), a, b);
                let known = &mut nearest[row * grid.columns + column];
                if distance < known.0 {
                    *known = (distance, index);
                }
            }
        }
        count = index + 1;
    }
    let mut areas = vec![0.0; count];
    let crossings = Region::from_normalised(layer.islands.clone()).rows(grid.place(0, 0).y, grid.step, grid.rows);
    for (row, crossings) in crossings.iter().enumerate() {
        for ends in crossings.chunks_exact(2) {
            for column in grid.columns_between(ends[0], ends[1]) {
                let (distance, index) = nearest[row * grid.columns + column];
                if distance <= reach * reach {
                    areas[index] += grid.step * grid.step;
                }
            }
        }
    }
    areas
}

/// Metal wanted over metal held around each piece; 1 where none is held.
fn evened(wanted: &[f64], held: &[f64], lengths: &[f64], closed: bool, around: f64) -> Vec<f64> {
    let count = wanted.len();
    let step = |at: usize, forth: bool| match (forth, closed) {
        (true, true) => Some((at + 1) % count),
        (false, true) => Some((at + count - 1) % count),
        (true, false) => Some(at + 1).filter(|&next| next < count),
        (false, false) => at.checked_sub(1),
    };
    let factor = |piece: usize| {
        let (mut want, mut have) = (wanted[piece], held[piece]);
        for forth in [false, true] {
            let (mut at, mut far) = (piece, 0.0);
            while let Some(next) = step(at, forth).filter(|&next| next != piece) {
                far += lengths[next];
                if far > around {
                    break;
                }
                (want, have, at) = (want + wanted[next], have + held[next], next);
            }
        }
        if have > 0.0 { want / have } else { 1.0 }
    };
    (0..count).map(factor).collect()
}

/// The factors, those of neighbours that hardly differ replaced by their mean over the metal held: a program gets a new speed
/// only where it matters.
fn in_runs(factors: &[f64], held: &[f64]) -> Vec<f64> {
    let mut even = Vec::with_capacity(factors.len());
    while even.len() < factors.len() {
        let first = even.len();
        let alike = |factor: &&f64| (**factor / factors[first] - 1.0).abs() <= ALIKE;
        let run = factors[first..].iter().take_while(alike).count().max(1);
        let weight: f64 = held[first..first + run].iter().sum();
        let sum: f64 = (first..first + run).map(|i| factors[i] * held[i]).sum();
        even.extend(std::iter::repeat_n(if weight > 0.0 { sum / weight } else { 1.0 }, run));
    }
    even
}

/// A pass from its pieces, without the points between two that are alike and in line.
fn joined(pass: &Pass, pieces: &[Segment]) -> Pass {
    let (mut points, mut widths, mut paces) = (Vec::new(), Vec::new(), Vec::new());
    let mut corners = pass.points.iter().peekable();
    let mut last: Option<&Segment> = None;
    for piece in pieces {
        let corner = corners.next_if(|corner| **corner == piece.from).is_some();
        let same = last.is_some_and(|last| last.width == piece.width && last.pace == piece.pace);
        if corner || !same {
            points.push(piece.from);
            widths.push(piece.width);
            paces.push(piece.pace);
        }
        last = Some(piece);
    }
    if let Some(last) = last.filter(|_| !pass.closed) {
        points.push(last.to);
        widths.push(last.width);
        paces.push(last.pace);
    }
    Pass { points, width: Along::Each(widths), pace: Along::Each(paces), ..pass.clone() }
}
