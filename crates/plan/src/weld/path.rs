//! A pass as it is welded: with its overlap, hot start and lead-out.

use crate::layer::Layer;
use crate::pass::{Along, Pass, PassKind};
use crate::process::StartStop;
use glam::DVec3;

/// A change of power closer to a point than this is moved to the point, mm, so that no move is shorter.
const SNAP_MM: f64 = 0.01;

/// A point of a path with the values for the move to it; those of the first point are unused.
#[derive(Clone, Copy)]
struct Move {
    to: DVec3,
    /// Pace, mm/s.
    pace: f64,
    /// Width of the bead, mm.
    width: f64,
}

/// The points of a pass, each with the pace (mm/s) of the move to it; the pace of the first point is unused.
///
/// ```
/// use bead_plan::pass::{Along, Pass, PassKind};
/// use bead_plan::{process::StartStop, weld};
/// use glam::DVec3;
///
/// // A closed pass continues over its own start.
/// let points = vec![DVec3::ZERO, DVec3::X * 10.0, DVec3::new(10.0, 10.0, 0.0), DVec3::Y * 10.0];
/// let (width, pace) = (Along::Same(5.0), Along::Same(8.0));
/// let pass = Pass { kind: PassKind::Contour, closed: true, points, width, pace, wait: 0.0 };
/// let path = weld::path(&pass, &StartStop { end_overlap: 4.0, ..StartStop::default() });
/// assert!(path.last().is_some_and(|(end, _)| end.distance(DVec3::X * 4.0) < 1e-9));
/// ```
pub fn path(pass: &Pass, ends: &StartStop) -> Vec<(DVec3, f64)> {
    moves(pass, ends).into_iter().map(|m| (m.to, m.pace)).collect()
}

/// The pass as it is welded, for the deposit model: with the hump at its start and the crater at its end, for beads of
/// height `bead_height` (mm). The metal that fills craters is not included.
pub fn welded(pass: &Pass, ends: &StartStop, bead_height: f64) -> Pass {
    let mut moves = moves(pass, ends);
    if pass.kind != PassKind::Spot {
        hump_and_crater(&mut moves, ends, bead_height);
    }
    if moves.len() < 2 {
        return pass.clone();
    }
    // A value applies from its point to the next.
    let along = |value: fn(&Move) -> f64| Along::Each(moves[1..].iter().chain(moves.last()).map(value).collect());
    let (width, pace) = (along(|m| m.width), along(|m| m.pace));
    Pass { kind: pass.kind, closed: false, points: moves.iter().map(|m| m.to).collect(), width, pace, wait: pass.wait }
}

/// How the passes of a layer begin and end, given that the arc may stay lit before or after it.
pub fn ends_of(layer: &Layer, ends: &StartStop) -> StartStop {
    let (mut ends, lit) = (ends.at_layer(layer.index), layer.lit);
    if lit.before {
        (ends.lead_in_length, ends.hump_height) = (0.0, 0.0);
    }
    if lit.after {
        (ends.lead_out_length, ends.crater_depth, ends.crater_fill_time) = (0.0, 0.0, 0.0);
    }
    ends
}

fn moves(pass: &Pass, ends: &StartStop) -> Vec<Move> {
    let mut moves = Vec::with_capacity(pass.points.len() + 4);
    moves.extend(pass.start().map(|to| Move { to, pace: pass.pace.after(0), width: pass.width.after(0) }));
    moves.extend(pass.segments().map(|s| Move { to: s.to, pace: s.pace, width: s.width }));
    if pass.closed {
        overlap(&mut moves, ends.end_overlap);
    }
    if pass.kind != PassKind::Spot {
        lead(&mut moves, ends);
    }
    moves
}

fn length(moves: &[Move]) -> f64 {
    moves.windows(2).map(|w| w[0].to.distance(w[1].to)).sum()
}

/// Continues along a closed path by the length `wanted`, mm, at most once around.
fn overlap(moves: &mut Vec<Move>, wanted: f64) {
    let (mut left, around) = (wanted, moves.len());
    for i in 1..around {
        let (from, next) = (moves[i - 1].to, moves[i]);
        let piece = from.distance(next.to);
        if left < SNAP_MM {
            return;
        }
        moves.push(Move { to: if piece > left { from.lerp(next.to, left / piece) } else { next.to }, ..next });
        left -= piece;
    }
}

/// More power along the beginning, less along the end: a slower and a faster pace.
fn lead(moves: &mut Vec<Move>, ends: &StartStop) {
    let active = |length: f64, power: f64| if power == 1.0 { 0.0 } else { length };
    let wanted = [active(ends.lead_in_length, ends.lead_in_power), active(ends.lead_out_length, ends.lead_out_power)];
    if moves.len() < 2 {
        return;
    }
    let total = length(moves);
    // If a pass is too short for both, they are shortened in proportion, with nothing between.
    let part = (total / (wanted[0] + wanted[1])).min(1.0);
    if wanted[0] > 0.0 {
        let end = cut(moves, wanted[0] * part);
        moves[1..=end].iter_mut().for_each(|m| m.pace /= ends.lead_in_power);
    }
    if wanted[1] > 0.0 {
        let begin = cut(moves, total - wanted[1] * part);
        moves[begin + 1..].iter_mut().for_each(|m| m.pace /= ends.lead_out_power);
    }
}

/// Number of steps in which a hump or crater falls off.
const STEPS: u32 = 4;
/// Fraction of the bead that remains in the deepest crater.
const LEAST: f64 = 0.05;

/// Sets the paces that build a pass's hump and crater: a bead of the same width is higher where it is laid more slowly.
fn hump_and_crater(moves: &mut Vec<Move>, ends: &StartStop, bead_height: f64) {
    let total = length(moves);
    let slopes = [(ends.hump_height, ends.hump_length, false), (-ends.crater_depth, ends.crater_length, true)];
    for (height, wanted, at_end) in slopes.into_iter().filter(|(height, length, _)| *height != 0.0 && *length > 0.0) {
        let step = wanted.min(total) / f64::from(STEPS);
        for k in 0..STEPS {
            let near = f64::from(k) * step;
            let [from, to] = if at_end { [total - near - step, total - near] } else { [near, near + step] };
            let first = cut(moves, from);
            let last = cut(moves, to);
            let higher = height / bead_height * (1.0 - (f64::from(k) + 0.5) / f64::from(STEPS));
            moves[first + 1..=last].iter_mut().for_each(|m| m.pace /= (1.0 + higher).max(LEAST));
        }
    }
}

/// The index of the point at the distance `at` along the path, mm; a point is inserted if there is none.
fn cut(moves: &mut Vec<Move>, at: f64) -> usize {
    let mut passed = 0.0;
    for i in 1..moves.len() {
        let (from, next) = (moves[i - 1].to, moves[i]);
        let piece = from.distance(next.to);
        if at <= passed + SNAP_MM {
            return i - 1;
        }
        if at < passed + piece - SNAP_MM {
            moves.insert(i, Move { to: from.lerp(next.to, (at - passed) / piece), ..next });
            return i;
        }
        passed += piece;
    }
    moves.len().saturating_sub(1)
}
