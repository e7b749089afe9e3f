//! Common to axes that turn the part: a table that keeps the arc on its side, or a positioner that keeps the layer
//! level.

/// Greatest turn of an axis with the arc on, ° per mm of path: near its axis it would spin.
pub(super) const MOST_PER_MM: f64 = 2.0;

/// Between passes an axis that turns by more than this, °, turns during a joint move: in a straight move the torch
/// would have to move around with it, since the target is in the part's frame.
pub(super) const WOUND: f64 = 180.0;

/// Whole turns tried to each side.
const TURNS: i32 = 100;

/// By which whole turns, °, the angles of a pass from the least to the greatest come within limits, or as near as they can; of those
/// the turns by which the axis, now `ahead` (°) of where it was, turns least. Also by how much the angles are still beyond, °.
pub(super) fn whole_turns([low, high]: [f64; 2], [least, most]: [f64; 2], ahead: f64) -> (f64, f64) {
    let beyond = |turns: f64| (low - least - turns).max(0.0) + (most + turns - high).max(0.0);
    let key = |turns: &f64| (beyond(*turns), (ahead + turns).abs());
    let turns = (-TURNS..=TURNS).map(|k| 360.0 * f64::from(k));
    let best = turns.min_by(|a, b| key(a).partial_cmp(&key(b)).unwrap_or(std::cmp::Ordering::Equal));
    best.map_or((0.0, 0.0), |turns| (turns, beyond(turns)))
}
