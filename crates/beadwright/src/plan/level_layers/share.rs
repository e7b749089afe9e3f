//! Metal where the slice needs it.

use super::rim::Rim;
use crate::bead::Law;
use crate::deposit::field::Grid;
use crate::deposit::{DepositSettings, MOST_POINTS, Nominal, RIM, Stack};
use crate::fill::sound;
use crate::layer::{self, Layer};
use crate::pass::{Along, Pass, PassKind, Segment};
use crate::wedge::Wedge;
use glam::DVec2;
use planar::{Join, Region, polyline};

/// A piece gets at most this multiple of its bead's planned metal, and at least its inverse.
pub(super) const MOST: f64 = 1.2;
/// Length of the pieces for which metal is computed, in widths of the nominal bead.
const PIECE: f64 = 0.25;
/// Metal is averaged over this distance before and after a piece, in widths.
const AROUND: f64 = 1.0;
/// Neighbouring pieces whose metal differs by no more than this fraction get the same metal.
const ALIKE: f64 = 0.06;
/// Shifts inwards are averaged over this distance, in widths.
const EVEN: f64 = 0.5;
/// Points no farther than this from the line between their neighbours are dropped, in widths.
const STRAIGHT: f64 = 0.006;
/// A place belongs to a pass if it lies no farther away than this, in widths.
const REACH: f64 = 0.75;
/// Grid points across a bead, if they are not more than [`MOST_POINTS`].
const ACROSS: f64 = 8.0;
/// Fraction of the lack or excess in the metal below that one layer makes up for.
const GAIN: f64 = 0.5;
/// Limits of the height to which a place is filled, in heights of the layer.
const WANTED: std::ops::RangeInclusive<f64> = 0.5..=1.5;

/// How metal is shared out within layers.
#[derive(Debug, Clone, Copy)]
pub(in crate::plan) struct Sharing<'p> {
    /// The nominal bead, and how the model builds up what lies below.
    pub(in crate::plan) deposit: DepositSettings,
    /// Height of a wide layer, mm.
    pub(in crate::plan) height: f64,
    /// How a bead's height follows its width.
    pub(in crate::plan) law: &'p Law,
    /// The narrowest and the widest bead, mm.
    pub(in crate::plan) width_limits: (f64, f64),
}

/// A pass in pieces, with the metal (mm³) that each holds, and the metal that a piece and those around it need, as a
/// multiple of what they hold.
pub(super) struct Share {
    pieces: Vec<Segment>,
    pub(super) held: Vec<f64>,
    pub(super) needs: Vec<f64>,
}

fn metal_of(piece: &Segment, nominal: &Nominal) -> f64 {
    piece.length() * nominal.bead_at(piece.width, piece.pace).area()
}

/// What the passes of a layer hold and need on the metal `below`, or, without it, on a layer that came out as planned.
pub(super) fn shares(
    layer: &Layer,
    below: Option<&Stack>,
    wedge: Option<&Wedge<'_>>,
    region: &Region,
    sharing: &Sharing,
) -> Vec<Share> {
    let nominal = sharing.deposit.nominal;
    let width = nominal.bead.width;
    // A dot already holds what its place needs.
    let pieces = |pass: &Pass| if pass.kind == PassKind::Spot { Vec::new() } else { cut(pass, PIECE * width) };
    let pieces: Vec<Vec<Segment>> = layer.passes.iter().map(pieces).collect();
    // Beads side by side are taken to fill layers.height, whatever the profile's bead would give.
    let wide = nominal.rise / sharing.height;
    let ground = |place| below?.height_at(place).map(|ground| ground / wide);
    let own = |place| wedge.map_or(layer.height, |wedge| wedge.own(place));
    let strips = strips(layer, own, ground, region, pieces.iter().flatten(), width);
    let mut strips = strips.into_iter();
    let share = |(pass, pieces): (&Pass, Vec<Segment>)| {
        let wanted: Vec<f64> = strips.by_ref().take(pieces.len()).collect();
        let held: Vec<f64> = pieces.iter().map(|piece| metal_of(piece, &nominal)).collect();
        let lengths: Vec<f64> = pieces.iter().map(Segment::length).collect();
        let near = |piece| around(piece, &lengths, pass.closed, AROUND * width);
        let sum = |values: &[f64], piece| near(piece).map(|k| values[k]).sum::<f64>();
        let need = |piece| match sum(&held, piece) {
            have if have > 0.0 => wide * sum(&wanted, piece) / have,
            _ => 1.0,
        };
        Share { needs: (0..pieces.len()).map(need).collect(), pieces, held }
    };
    layer.passes.iter().zip(pieces).map(share).collect()
}

/// What the beads of a layer should fill: its islands, including what is milled off.
pub(super) fn region(layer: &Layer, sharing: &Sharing) -> Region {
    let region = Region::from_normalised(layer.islands.clone());
    match sharing.deposit.machining_allowance {
        allowance if allowance > 0.0 => region.offset(allowance, Join::ROUND),
        _ => region,
    }
}

/// Shares out the metal of a layer: each piece of a pass is laid at the pace that fills the strip of the slice nearest
/// to it, from the metal below; it is as wide as the bead law gives, and stays inside the outline.
pub(in crate::plan) fn share(layer: &mut Layer, below: Option<&Stack>, wedge: Option<&Wedge<'_>>, sharing: &Sharing) {
    let (nominal, region) = (sharing.deposit.nominal, region(layer, sharing));
    let (shares, rim) = (shares(layer, below, wedge, &region, sharing), Rim::of(&region));
    let (narrowest, widest) = sharing.width_limits;
    let laid = |(pass, share): (&Pass, &Share)| {
        let Share { pieces, held, needs } = share;
        if pieces.is_empty() {
            return (pass.clone(), pass.clone());
        }
        let laid = |(piece, need): (&Segment, f64)| {
            let bead = nominal.bead_at(piece.width, piece.pace);
            let (narrowest, widest) = (piece.width.min(narrowest), piece.width.max(widest));
            let metal = |width: f64| sharing.law.bead(&bead, width).area() / bead.area();
            let factor = need.clamp(MOST.recip(), MOST).clamp(metal(narrowest), metal(widest));
            let width = sharing.law.width_of_area(&bead, factor * bead.area()).clamp(narrowest, widest);
            Segment { width, pace: piece.pace / factor, ..*piece }
        };
        let wider: Vec<Segment> = pieces.iter().zip(needs.iter().copied()).map(laid).collect();
        let laid: Vec<Segment> = pieces.iter().zip(in_runs(needs, held)).map(laid).collect();
        let along =
            |shifts: &[DVec2]| joined(pass, &laid, &places(pieces, shifts, pass.closed), STRAIGHT * nominal.bead.width);
        let shifts = shifts(pieces, &wider, pass.closed, &rim, EVEN * nominal.bead.width);
        (along(&shifts), along(&vec![DVec2::ZERO; shifts.len()]))
    };
    let (moved, stayed) = layer.passes.iter().zip(&shares).map(laid).unzip();
    layer.passes = uncrossed(moved, stayed);
}

/// Passes that would cross once their beads are moved inwards stay where they were planned.
fn uncrossed(mut moved: Vec<Pass>, stayed: Vec<Pass>) -> Vec<Pass> {
    loop {
        let lines: Vec<Vec<DVec2>> = moved.iter().map(Pass::line).collect();
        let mut crossing: Vec<usize> = sound::crossings(&lines).flat_map(|(one, other, _)| [one, other]).collect();
        crossing.retain(|&pass| moved[pass] != stayed[pass]);
        if crossing.is_empty() {
            return moved;
        }
        crossing.into_iter().for_each(|pass| moved[pass].clone_from(&stayed[pass]));
    }
}

/// By how much pieces move once they are laid wider, averaged over `reach` (mm).
fn shifts(planned: &[Segment], wider: &[Segment], closed: bool, rim: &Rim, reach: f64) -> Vec<DVec2> {
    let shift = |(planned, wider): (&Segment, &Segment)| {
        let middle = planned.from.midpoint(planned.to).truncate();
        rim.shift(middle, planned.width, wider.width)
    };
    let shifts: Vec<DVec2> = planned.iter().zip(wider).map(shift).collect();
    let lengths: Vec<f64> = planned.iter().map(Segment::length).collect();
    let even = |piece: usize| {
        let (sum, way) = around(piece, &lengths, closed, reach)
            .fold((DVec2::ZERO, 0.0), |(sum, way), k| (sum + lengths[k] * shifts[k], way + lengths[k]));
        if way > 0.0 { sum / way } else { DVec2::ZERO }
    };
    (0..planned.len()).map(even).collect()
}

/// Start of each shifted piece, and the end of the last one of an open pass.
fn places(pieces: &[Segment], shifts: &[DVec2], closed: bool) -> Vec<DVec2> {
    let before = |k: usize| match k {
        0 if closed => shifts.len() - 1,
        _ => k.saturating_sub(1),
    };
    let start = |(k, piece): (usize, &Segment)| piece.from.truncate() + shifts[before(k)].midpoint(shifts[k]);
    let end = pieces.last().zip(shifts.last()).map(|(piece, shift)| piece.to.truncate() + shift);
    pieces.iter().enumerate().map(start).chain(end.filter(|_| !closed)).collect()
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

/// Metal that fills the strip of the slice nearest to each piece, mm³: to its `own` height of the layer (mm), more
/// where the `ground` below (mm) is too low and less where it is too high. Where no bead reaches, and at the rim, which
/// no bead fills, the ground counts as planned.
fn strips<'a>(
    layer: &Layer,
    own: impl Fn(DVec2) -> f64,
    ground: impl Fn(DVec2) -> Option<f64>,
    region: &Region,
    pieces: impl Iterator<Item = &'a Segment>,
    width: f64,
) -> Vec<f64> {
    let Some(bounds) = layer::bounds(std::slice::from_ref(layer)) else { return Vec::new() };
    let area = bounds.size().x * bounds.size().y;
    let step = (width / ACROSS).max((area / MOST_POINTS).sqrt());
    let (grid, reach) = (Grid::covering(&bounds, 0.0, step), REACH * width);
    let mut nearest = vec![(f64::INFINITY, 0_usize); grid.points()];
    let mut halves = Vec::new();
    for (index, piece) in pieces.enumerate() {
        let (a, b) = (piece.from.truncate(), piece.to.truncate());
        let (low, high) = (a.min(b) - reach, a.max(b) + reach);
        let (ab, square) = (b - a, a.distance_squared(b));
        let part = if square > 0.0 { ab / square } else { DVec2::ZERO };
        let columns = grid.columns_between(low.x, high.x);
        for row in grid.rows_between(low.y, high.y) {
            let known = &mut nearest[row * grid.columns..][columns.clone()];
            let first = grid.place(columns.start, row) - a;
            for (k, known) in known.iter_mut().enumerate() {
                let p = DVec2::new(first.x + k as f64 * step, first.y);
                let distance = p.distance_squared(ab * p.dot(part).clamp(0.0, 1.0));
                if distance < known.0 {
                    *known = (distance, index);
                }
            }
        }
        halves.push(piece.width / 2.0);
    }
    let rows = |region: &Region| region.rows(grid.place(0, 0).y, grid.step, grid.rows);
    let columns = |ends: &[f64]| grid.columns_between(ends[0], ends[1]);
    let (mut strips, mut inside) = (vec![0.0; halves.len()], 0.0);
    for (row, crossings) in rows(region).iter().enumerate() {
        for column in crossings.chunks_exact(2).flat_map(columns) {
            let (distance, index) = nearest[row * grid.columns + column];
            inside += 1.0;
            if distance <= reach * reach {
                strips[index] += own(grid.place(column, row));
            }
        }
    }
    let core = region.offset(-RIM * width, Join::ROUND);
    for (row, crossings) in rows(&core).iter().enumerate() {
        for column in crossings.chunks_exact(2).flat_map(columns) {
            let (distance, index) = nearest[row * grid.columns + column];
            let is_laid = halves.get(index).is_some_and(|half| distance <= half * half);
            let place = grid.place(column, row);
            if let Some(ground) = ground(place).filter(|_| is_laid) {
                let height = own(place);
                let wanted = height + GAIN * (layer.z - height - ground);
                strips[index] += wanted.clamp(WANTED.start() * height, WANTED.end() * height) - height;
            }
        }
    }
    // Few grid points lie across a wall; they are weighted so that they add up to the area of the slice.
    let each = if inside > 0.0 { region.area() / inside } else { 0.0 };
    strips.iter_mut().for_each(|strip| *strip *= each);
    strips
}

/// The piece itself, and the pieces of a pass that end within a distance (mm) before and after it.
fn around(piece: usize, lengths: &[f64], closed: bool, distance: f64) -> impl Iterator<Item = usize> {
    let count = lengths.len();
    let next = move |at: usize, forth: bool| match (forth, closed) {
        (true, true) => Some((at + 1) % count),
        (false, true) => Some((at + count - 1) % count),
        (true, false) => Some(at + 1).filter(|&next| next < count),
        (false, false) => at.checked_sub(1),
    };
    let side = move |forth: bool| {
        let mut left = distance;
        std::iter::successors(next(piece, forth), move |&at| next(at, forth)).take_while(move |&at| {
            left -= lengths[at];
            at != piece && left >= 0.0
        })
    };
    std::iter::once(piece).chain(side(true)).chain(side(false))
}

/// The factors, with runs of almost equal ones replaced by their mean over the metal held: a program gets a new speed
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

/// A pass joined from its pieces, whose ends lie at `places`, without points between equal pieces that are in line
/// within a tolerance (mm).
fn joined(pass: &Pass, pieces: &[Segment], places: &[DVec2], tolerance: f64) -> Pass {
    let height = pass.points.first().map_or(0.0, |point| point.z);
    let (mut points, mut widths, mut paces) = (Vec::new(), Vec::new(), Vec::new());
    let mut corners = pass.points.iter().peekable();
    let place = |k: usize| places[k % places.len()];
    let starts = pieces.iter().enumerate().filter_map(|(k, piece)| {
        let corner = corners.next_if(|corner| **corner == piece.from).is_some();
        let same = k.checked_sub(1).is_some_and(|k| pieces[k].width == piece.width && pieces[k].pace == piece.pace);
        (corner || !same).then_some(k)
    });
    let starts: Vec<usize> = starts.chain([pieces.len()]).collect();
    for stretch in starts.windows(2) {
        let line: Vec<DVec2> = (stretch[0]..=stretch[1]).map(place).collect();
        let mut line = polyline::simplify(&line, tolerance);
        line.pop();
        widths.extend(line.iter().map(|_| pieces[stretch[0]].width));
        paces.extend(line.iter().map(|_| pieces[stretch[0]].pace));
        points.extend(line.into_iter().map(|p| p.extend(height)));
    }
    if let Some(last) = pieces.last().filter(|_| !pass.closed) {
        points.push(place(pieces.len()).extend(height));
        widths.push(last.width);
        paces.push(last.pace);
    }
    let along = |values: Vec<f64>| match values.split_first() {
        Some((&first, others)) if others.iter().all(|value| *value == first) => Along::Same(first),
        _ => Along::Each(values),
    };
    Pass { points, width: along(widths), pace: along(paces), ..pass.clone() }
}
