//! A pass as it is welded: with its overlap, hot start and lead-out.

use crate::pass::Pass;
use crate::profile::StartStop;
use glam::DVec3;

/// A change of power nearer to a point than this is made there, mm: no move is shorter.
const SNAP_MM: f64 = 0.01;

/// The points of a pass and the pace (mm/s) on the way to each; that of the first point means nothing.
pub fn path(pass: &Pass, ends: &StartStop) -> Vec<(DVec3, f64)> {
    let mut moves = Vec::with_capacity(pass.points.len() + 4);
    moves.extend(pass.start().map(|start| (start, pass.speed.after(0))));
    moves.extend(pass.segments().map(|s| (s.to, s.speed)));
    if pass.closed {
        overlap(&mut moves, ends.end_overlap);
    }
    lead(&mut moves, ends);
    moves
}

fn length(moves: &[(DVec3, f64)]) -> f64 {
    moves.windows(2).map(|w| w[0].0.distance(w[1].0)).sum()
}

/// Goes on along a closed path by a length, mm, at most once around.
fn overlap(moves: &mut Vec<(DVec3, f64)>, wanted: f64) {
    let (mut left, around) = (wanted, moves.len());
    for i in 1..around {
        let (from, (to, pace)) = (moves[i - 1].0, moves[i]);
        let piece = from.distance(to);
        if left < SNAP_MM {
            return;
        }
        moves.push((if piece > left { from.lerp(to, left / piece) } else { to }, pace));
        left -= piece;
    }
}

/// More power along the beginning, less along the end: a slower and a faster pace.
fn lead(moves: &mut Vec<(DVec3, f64)>, ends: &StartStop) {
    let active = |length: f64, power: f64| if power == 1.0 { 0.0 } else { length };
    let wanted = [active(ends.lead_in_length, ends.lead_in_power), active(ends.lead_out_length, ends.lead_out_power)];
    if moves.len() < 2 {
        return;
    }
    let total = length(moves);
    // A pass too short for both has them in proportion, and nothing between.
    let part = (total / (wanted[0] + wanted[1])).min(1.0);
    if wanted[0] > 0.0 {
        let end = cut(moves, wanted[0] * part);
        moves[1..=end].iter_mut().for_each(|(_, pace)| *pace /= ends.lead_in_power);
    }
    if wanted[1] > 0.0 {
        let begin = cut(moves, total - wanted[1] * part);
        moves[begin + 1..].iter_mut().for_each(|(_, pace)| *pace /= ends.lead_out_power);
    }
}

/// The index of the point that lies so far along the path, mm; a new one where there is none.
fn cut(moves: &mut Vec<(DVec3, f64)>, at: f64) -> usize {
    let mut passed = 0.0;
    for i in 1..moves.len() {
        let (from, (to, pace)) = (moves[i - 1].0, moves[i]);
        let piece = from.distance(to);
        if at <= passed + SNAP_MM {
            return i - 1;
        }
        if at < passed + piece - SNAP_MM {
            moves.insert(i, (from.lerp(to, (at - passed) / piece), pace));
            return i;
        }
        passed += piece;
    }
    moves.len().saturating_sub(1)
}
