//! Nearest next, and the improved nearest neighbour of Han et al. 2018 (section 2.1).

use super::tour::{self, Circle, Ends, Gate, Stop, Visit, gap};
use glam::DVec2;

/// The tour that always goes to the stop with the nearest gate.
pub fn tour(stops: &[Stop], ends: Ends) -> Vec<Visit> {
    let from = match ends {
        Ends::From(start) => Some(start),
        Ends::Closed => None,
    };
    let mut left: Vec<usize> = (0..stops.len()).collect();
    let mut tour = Vec::with_capacity(stops.len());
    let circles: Vec<Circle> = stops.iter().map(Circle::around).collect();
    walk(&mut left, from, &mut tour, &circles, |stop, at| stops[stop].best_start(at, None));
    tour
}

/// Starts at every gate of every stop, always goes on to the nearest gate of a stop not yet visited, and keeps the
/// shortest of these closed tours. A curved ring begins where the line from its middle (its pseudo-vertex) to the
/// previous point meets it.
pub fn improved(stops: &[Stop], ends: Ends) -> Vec<Visit> {
    let curves: Vec<Option<DVec2>> = stops.iter().map(pseudo_vertex).collect();
    let circles: Vec<Circle> = stops.iter().map(Circle::around).collect();
    let mut best: Option<(f64, Vec<Visit>)> = None;
    let mut left = Vec::with_capacity(stops.len());
    for (seed, stop) in stops.iter().enumerate() {
        // A curve counts as one vertex, so it is one seed.
        let gates = stop.gates().take(if curves[seed].is_some() { 1 } else { usize::MAX });
        for gate in gates {
            left.clear();
            left.extend((0..stops.len()).filter(|&s| s != seed));
            let mut tour = vec![Visit::new(seed, gate)];
            walk(&mut left, Some(gate.leave), &mut tour, &circles, |s, at| match (&curves[s], at) {
                (Some(middle), Some(at)) => meeting(&stops[s], *middle, at),
                _ => stops[s].best_gate(at, None),
            });
            let length = tour::length(&tour, Ends::Closed);
            if best.as_ref().is_none_or(|(least, _)| length < *least) {
                best = Some((length, tour));
            }
        }
    }
    let tour = best.map(|(_, tour)| tour).unwrap_or_default();
    match ends {
        Ends::Closed => tour,
        Ends::From(start) => opened(tour, start),
    }
}

/// A closed tour, opened at the visit nearest to a point.
pub(super) fn opened(mut tour: Vec<Visit>, start: DVec2) -> Vec<Visit> {
    let distance = |v: &Visit| v.enter.distance_squared(start);
    let first = (0..tour.len()).min_by(|&i, &j| distance(&tour[i]).total_cmp(&distance(&tour[j])));
    tour.rotate_left(first.unwrap_or(0));
    tour
}

/// The middle of a curved ring.
fn pseudo_vertex(stop: &Stop) -> Option<DVec2> {
    match stop {
        Stop::Ring { path, .. } if tour::is_curved(path) => Some(tour::centroid(path)),
        _ => None,
    }
}

/// Where the line from the pseudo-vertex to the previous point meets the ring.
fn meeting(stop: &Stop, middle: DVec2, before: DVec2) -> Gate {
    let Stop::Ring { path, .. } = stop else { return stop.best_gate(Some(before), None) };
    let way = before - middle;
    let hit = |(&a, &b): (&DVec2, &DVec2)| {
        let edge = b - a;
        let (denominator, offset) = (way.perp_dot(edge), a - middle);
        let (t, u) = (offset.perp_dot(edge) / denominator, offset.perp_dot(way) / denominator);
        (denominator != 0.0 && t > 0.0 && (0.0..=1.0).contains(&u)).then(|| middle + way * t)
    };
    let hits = path.iter().zip(path.iter().cycle().skip(1)).filter_map(hit);
    let nearest = hits.min_by(|a, b| a.distance_squared(before).total_cmp(&b.distance_squared(before)));
    nearest.map_or_else(|| stop.best_gate(Some(before), None), |p| Gate { enter: p, leave: p })
}

/// Goes from gate to nearest gate until no stop is left. Stops whose circle is farther away than the nearest gate found
/// are skipped.
fn walk(
    left: &mut Vec<usize>,
    mut at: Option<DVec2>,
    tour: &mut Vec<Visit>,
    circles: &[Circle],
    enter: impl Fn(usize, Option<DVec2>) -> Gate,
) {
    loop {
        let mut nearest: Option<(f64, usize, Gate)> = None;
        for (i, &stop) in left.iter().enumerate() {
            if nearest.is_some_and(|(least, ..)| circles[stop].least_gap(at) > least) {
                continue;
            }
            let gate = enter(stop, at);
            let distance = gap(at, Some(gate.enter));
            if nearest.is_none_or(|(least, ..)| distance < least) {
                nearest = Some((distance, i, gate));
            }
        }
        let Some((_, i, gate)) = nearest else { break };
        at = Some(gate.leave);
        tour.push(Visit::new(left.swap_remove(i), gate));
    }
}
