//! Counts: how many rings lie on each side of a wall's middle.
//!
//! A whole number of rings on each side means an even number of beads across the wall, so no bead ends anywhere. Along
//! the middle of a wall the number changes as seldom as the range of bead widths allows: neighbouring places vote.

use super::LoopSettings;
use super::room::Room;
use super::squares::Squares;
use glam::DVec2;
use std::cmp::Reverse;

/// Neighbours within this many stepovers vote.
const SIGHT: f64 = 1.2;
/// Rounds of the vote.
const ROUNDS: usize = 2;
/// Where there is space for less than this fraction of a ring, none is laid.
const LEAST_ROOM: f64 = 0.2;
/// How far the vote may go beyond the range of widths, as a fraction.
const SLACK: f64 = 0.05;

/// The number of rings on each side, for each of the room's middles.
pub fn counts(room: &Room, settings: &LoopSettings) -> Vec<u32> {
    let wanted: Vec<f64> =
        room.middles.iter().map(|middle| (middle.radius - settings.edge()) / settings.stepover).collect();
    let rounded = |&q: &f64| if q < LEAST_ROOM { 0 } else { ((q + 0.5).floor() as u32).max(1) };
    let mut counts: Vec<u32> = wanted.iter().map(rounded).collect();
    let places: Vec<DVec2> = room.middles.iter().map(|middle| room.lattice.place_of(middle.point)).collect();
    let sight = SIGHT * settings.stepover;
    let squares = Squares::of(&places, sight);
    let (low, high) = settings.width_ratios();
    let fits = |wanted: f64, count: u32| {
        let width = wanted / f64::from(count);
        count > 0 && (low * (1.0 - SLACK)..=high * (1.0 + SLACK)).contains(&width)
    };
    for _ in 0..ROUNDS {
        let before = counts.clone();
        for (i, count) in counts.iter_mut().enumerate() {
            let mut votes: Vec<(u32, usize)> = Vec::new();
            let seen = |&j: &usize| places[j].distance_squared(places[i]) <= sight * sight;
            for j in squares.near(places[i]).filter(seen) {
                match votes.iter_mut().find(|(count, _)| *count == before[j]) {
                    Some((_, number)) => *number += 1,
                    None => votes.push((before[j], 1)),
                }
            }
            // The smaller count wins a tie.
            let winner = votes.iter().max_by_key(|(count, number)| (*number, Reverse(*count)));
            if let Some(&(winner, _)) = winner.filter(|(winner, _)| fits(wanted[i], *winner)) {
                *count = winner;
            }
        }
    }
    counts
}
