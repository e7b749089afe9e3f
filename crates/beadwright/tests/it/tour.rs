//! Tours: the exact optimum against brute force, the others against the optimum and against each other.

use crate::solids;

use beadwright::order::ant_colony::{self, Colony};
use beadwright::order::tour::{self, Ends, Gate, Stop, Visit};
use beadwright::order::{Method, exact, local_search, nearest};
use beadwright::planar::DVec2;
use proptest::prelude::*;
use solids::runner;
use std::f64::consts::TAU;

/// Seeded numbers in 0..1, apart from the library's own.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as f64 / (1_u64 << 31) as f64
    }

    fn point(&mut self) -> DVec2 {
        DVec2::new(self.next(), self.next()) * 100.0
    }

    /// A polygon of 3 to 8 vertices around a place.
    fn ring(&mut self) -> Stop {
        let (middle, radius, n) = (self.point(), 2.0 + 8.0 * self.next(), 3 + (self.next() * 6.0) as usize);
        Stop::ring((0..n).map(|k| middle + DVec2::from_angle(TAU * k as f64 / n as f64) * radius).collect())
    }

    fn line(&mut self) -> Stop {
        let (a, b, turn) = (self.point(), self.point(), self.next());
        Stop::Line { gate: Gate { enter: a, leave: a.lerp(b, 0.3) }, reversible: turn < 0.7 }
    }

    fn stops(&mut self, count: usize) -> Vec<Stop> {
        let lines = self.next();
        (0..count).map(|_| if self.next() < lines { self.line() } else { self.ring() }).collect()
    }
}

/// Every stop once, by a gate of it or a point of its path.
fn check(stops: &[Stop], tour: &[Visit]) {
    let mut seen: Vec<usize> = tour.iter().map(|v| v.stop).collect();
    seen.sort_unstable();
    assert!(seen.into_iter().eq(0..stops.len()), "every stop once");
    for visit in tour {
        let stop = &stops[visit.stop];
        let gate = Gate { enter: visit.enter, leave: visit.leave };
        let on_path = match stop {
            Stop::Ring { path, .. } => {
                let mut edges = path.iter().zip(path.iter().cycle().skip(1));
                gate.enter == gate.leave
                    && edges.any(|(&a, &b)| tour::nearest_on(a, b, gate.enter).distance(gate.enter) < 1e-9)
            }
            Stop::Line { .. } => false,
        };
        assert!(on_path || stop.gates().any(|g| g == gate), "{visit:?}");
    }
}

/// Shortest tour by trying every order and every gate.
fn brute_force(stops: &[Stop], ends: Ends) -> f64 {
    fn go(stops: &[Stop], ends: Ends, tour: &mut Vec<Visit>, best: &mut f64) {
        if tour.len() == stops.len() {
            *best = best.min(tour::length(tour, ends));
        }
        for (s, stop) in stops.iter().enumerate() {
            if tour.iter().all(|v| v.stop != s) {
                for gate in stop.gates() {
                    tour.push(Visit::new(s, gate));
                    go(stops, ends, tour, best);
                    tour.pop();
                }
            }
        }
    }
    let mut best = f64::INFINITY;
    go(stops, ends, &mut Vec::new(), &mut best);
    best
}

fn both_ends(numbers: &mut Numbers) -> [Ends; 2] {
    [Ends::Closed, Ends::From(numbers.point())]
}

#[test]
fn dynamic_programming_finds_what_brute_force_finds() {
    let mut numbers = Numbers(1);
    for case in 0..60 {
        let stops = numbers.stops(1 + case % 4);
        for ends in both_ends(&mut numbers) {
            let tour = exact::tour(&stops, ends);
            check(&stops, &tour);
            assert!((tour::length(&tour, ends) - brute_force(&stops, ends)).abs() < 1e-9, "case {case}");
        }
    }
}

#[test]
fn local_search_lies_within_one_percent_of_the_optimum() {
    let mut numbers = Numbers(2);
    for case in 0..200 {
        let stops = numbers.stops(1 + case % 9);
        for ends in both_ends(&mut numbers) {
            let (tour, best) = (local_search::tour(&stops, ends), exact::tour(&stops, ends));
            check(&stops, &tour);
            let (length, least) = (tour::length(&tour, ends), tour::length(&best, ends));
            assert!(length <= 1.01 * least, "case {case}: {length} mm for {least} mm");
        }
    }
}

#[test]
fn local_search_is_no_worse_than_the_ant_colony() {
    let mut numbers = Numbers(3);
    for case in 0..50 {
        // Most cases are small: the colony takes long.
        let count = 20 + (180.0 * (f64::from(case) / 49.0).powi(4)) as usize;
        let stops: Vec<Stop> = (0..count).map(|_| numbers.ring()).collect();
        let colony = ant_colony::tour(&stops, Ends::Closed, &Colony::default());
        let ours = local_search::tour(&stops, Ends::Closed);
        check(&stops, &colony);
        check(&stops, &ours);
        let (theirs, ours) = (tour::length(&colony, Ends::Closed), tour::length(&ours, Ends::Closed));
        assert!(ours <= theirs, "{count} stops: {ours} mm for {theirs} mm");
    }
}

#[test]
fn every_method_visits_every_stop_and_says_the_same_twice() {
    let methods = [Method::Nearest, Method::ImprovedNearest, Method::AntColony, Method::LocalSearch, Method::Exact];
    let mut numbers = Numbers(4);
    for count in [0, 1, 2, 3, 7, 12, 40] {
        let stops = numbers.stops(count);
        for (method, ends) in methods.iter().flat_map(|m| both_ends(&mut numbers).map(|e| (m, e))) {
            let tour = method.tour(&stops, ends);
            check(&stops, &tour);
            assert_eq!(tour, method.tour(&stops, ends), "{method:?}");
        }
    }
}

#[test]
fn rings_along_a_line_are_entered_where_the_way_passes_them() {
    // The way from the origin through both rings is straight: no vertex lies on it, the edges do.
    let square = |x: f64| {
        Stop::ring([(-2.0, -3.0), (2.0, -3.0), (2.0, 4.0), (-2.0, 4.0)].map(|(u, v)| DVec2::new(x + u, v)).to_vec())
    };
    let tour = local_search::tour(&[square(20.0), square(10.0)], Ends::From(DVec2::ZERO));
    assert_eq!(tour.iter().map(|v| v.stop).collect::<Vec<_>>(), [1, 0]);
    assert!((tour::length(&tour, Ends::From(DVec2::ZERO)) - 18.0).abs() < 0.01);
}

#[test]
fn a_circle_is_entered_on_the_line_to_its_middle() {
    // Han et al. 2018, 2.1: the pseudo-vertex of a curved ring.
    let circle = |middle: DVec2| {
        Stop::ring((0..96).map(|k| middle + DVec2::from_angle(TAU * f64::from(k) / 96.0) * 5.0).collect())
    };
    let square = Stop::ring([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(DVec2::from).to_vec());
    let tour = nearest::improved(&[square, circle(DVec2::new(31.0, 41.0))], Ends::Closed);
    let visit = tour.iter().find(|v| v.stop == 1).unwrap();
    let along = (DVec2::new(31.0, 41.0) - DVec2::ONE).normalize();
    assert!(visit.enter.distance(DVec2::new(31.0, 41.0) - along * 5.0) < 5.0 * (1.0 - (TAU / 192.0).cos()) + 1e-9);
}

#[test]
fn moving_and_turning_the_part_changes_no_length() {
    runner(40)
        .run(&(any::<u32>(), 2..30_usize, -3.0..3.0), |(seed, count, angle)| {
            let stops = Numbers(u64::from(seed)).stops(count);
            let (turn, by) = (DVec2::from_angle(angle), DVec2::new(7.0, -300.0));
            let moved = |p: DVec2| turn.rotate(p) + by;
            let move_stop = |stop: &Stop| match stop {
                Stop::Ring { path, .. } => Stop::ring(path.iter().map(|&p| moved(p)).collect()),
                Stop::Line { gate, reversible } => Stop::Line {
                    gate: Gate { enter: moved(gate.enter), leave: moved(gate.leave) },
                    reversible: *reversible,
                },
            };
            let other: Vec<Stop> = stops.iter().map(move_stop).collect();
            let length = |stops: &[Stop]| tour::length(&nearest::improved(stops, Ends::Closed), Ends::Closed);
            prop_assert!((length(&stops) - length(&other)).abs() < 1e-6);
            // The search may take another way where two moves gain alike, but ends about as short.
            let length = |stops: &[Stop]| tour::length(&local_search::tour(stops, Ends::Closed), Ends::Closed);
            let (a, b) = (length(&stops), length(&other));
            prop_assert!((a - b).abs() <= 0.02 * a, "{a} mm, moved {b} mm");
            Ok(())
        })
        .unwrap();
}
