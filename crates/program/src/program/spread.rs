//! Merges points that follow each other faster than a controller can read them.
//!
//! A controller interpolates every few milliseconds (KRC4: 12) and looks a few points ahead. Where points come faster,
//! it slows down and the bead thickens. After each point, the next one kept is the first that the torch reaches once
//! the least time is over; where the path bends so much that the tolerance would be exceeded before that, it is the
//! farthest point within the tolerance.

use glam::DVec3;

/// What a controller can handle.
#[derive(Debug, Clone, Copy)]
pub(super) struct Spread {
    /// Least time between two points, s.
    pub(super) time: f64,
    /// Greatest distance of dropped points from the path, mm.
    pub(super) tolerance: f64,
}

/// Drops points of a path (positions, each with the speed of the move to it). A merged move takes as long as its
/// pieces, and so lays the same metal.
pub(super) fn spread(moves: &mut Vec<(DVec3, f64)>, spread: Spread) {
    let mut kept = vec![0];
    let mut start = 0;
    while start + 1 < moves.len() {
        start = next(moves, start, spread);
        kept.push(start);
    }
    if let [.., before, middle, last] = kept[..]
        && seconds(moves, middle, last) < spread.time
        && within(moves, before, last, spread.tolerance)
    {
        kept.retain(|k| *k != middle);
    }
    let merged = kept.windows(2).map(|w| (moves[w[1]].0, speed(moves, w[0], w[1])));
    *moves = moves.first().copied().into_iter().chain(merged).collect();
}

/// The point that is kept after `start`.
fn next(moves: &[(DVec3, f64)], start: usize, spread: Spread) -> usize {
    let (mut end, mut time) = (start + 1, seconds(moves, start, start + 1));
    while time < spread.time && end + 1 < moves.len() && within(moves, start, end + 1, spread.tolerance) {
        time += seconds(moves, end, end + 1);
        end += 1;
    }
    end
}

fn seconds(moves: &[(DVec3, f64)], from: usize, to: usize) -> f64 {
    moves[from..=to].windows(2).map(|w| w[0].0.distance(w[1].0) / w[1].1.max(1e-9)).sum()
}

/// Whether all points between two points lie within the tolerance of the straight move.
fn within(moves: &[(DVec3, f64)], from: usize, to: usize, tolerance: f64) -> bool {
    let (a, b) = (moves[from].0, moves[to].0);
    let along = b - a;
    let near = |p: DVec3| {
        let part = (p - a).dot(along) / along.length_squared().max(1e-12);
        p.distance(a + along * part.clamp(0.0, 1.0)) <= tolerance
    };
    // A hairpin smaller than the tolerance would become a move of zero length.
    along.length() >= super::MIN_MOVE_MM && moves[from + 1..to].iter().all(|(p, _)| near(*p))
}

/// Speed of the straight move that takes as long as the pieces.
fn speed(moves: &[(DVec3, f64)], from: usize, to: usize) -> f64 {
    let first = moves[from + 1].1;
    if moves[from + 1..=to].iter().all(|(_, speed)| *speed == first) {
        return first;
    }
    moves[from].0.distance(moves[to].0) / seconds(moves, from, to).max(1e-9)
}

#[cfg(test)]
mod tests {
    use super::{Spread, seconds, spread};
    use glam::DVec3;

    fn path(count: u32, bend: f64, speed: impl Fn(u32) -> f64) -> Vec<(DVec3, f64)> {
        let at = |i: u32| DVec3::new(0.05 * f64::from(i), bend * f64::from(i % 2), 0.0);
        (0..count).map(|i| (at(i), speed(i))).collect()
    }

    #[test]
    fn dense_points_are_merged_and_keep_their_time() {
        // 0.05 mm at 10 mm/s are 5 ms.
        let before = path(101, 0.01, |i| if i < 50 { 10.0 } else { 8.0 });
        let mut moves = before.clone();
        spread(&mut moves, Spread { time: 0.012, tolerance: 0.02 });
        assert_eq!((moves[0].0, moves.last().unwrap().0), (before[0].0, before[100].0));
        assert!(moves.len() <= 43, "{}", moves.len());
        assert!(moves.windows(2).all(|w| w[0].0.distance(w[1].0) / w[1].1 >= 0.0119), "{moves:?}");
        let time = |m: &[(DVec3, f64)]| seconds(m, 0, m.len() - 1);
        assert!((time(&moves) / time(&before) - 1.0).abs() < 0.03, "{} {}", time(&moves), time(&before));
    }

    #[test]
    fn points_off_the_tolerance_stay() {
        let before = path(50, 0.1, |_| 10.0);
        let mut moves = before.clone();
        spread(&mut moves, Spread { time: 0.012, tolerance: 0.02 });
        assert_eq!(moves, before);
        let mut few = path(2, 0.0, |_| 10.0);
        spread(&mut few, Spread { time: 1.0, tolerance: 1.0 });
        assert_eq!(few.len(), 2);
    }
}
