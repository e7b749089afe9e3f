//! Local search over order, directions and start points together.
//!
//! From the nearest-next tour, three moves are tried between stops that are near each other, until none shortens the
//! travel: reverse a section of the tour (2-opt), move one to three stops elsewhere, reversed if that is better
//! (Or-opt; a single stop takes its best gate there), and enter a stop by another gate. Then sections of the tour are
//! exchanged, all of them if there are few stops, otherwise at random, and the tour is repaired; exchanges that do not
//! shorten it are undone. Finally the starts of closed passes slide along their edges.

use super::nearest;
use super::tour::{self, Circle, Ends, Gate, Stop, Visit, gap, neighbours};
use crate::random::Random;
use glam::DVec2;
use rstar::RTree;
use rstar::primitives::GeomWithData;

/// Number of nearest stops with which moves are tried.
const NEAR: usize = 8;

/// With at most this many stops every exchange is tried; with more, this many random ones per stop, up to a limit.
const FEW_STOPS: usize = 9;
const KICKS_PER_STOP: usize = 3;
const MOST_KICKS: usize = 800;

/// Most stops in a section that is exchanged.
const KICK_LENGTH: usize = 12;

/// Gains smaller than this do not count, mm.
const LEAST_GAIN: f64 = 1e-3;

/// A short tour through all stops.
pub fn tour(stops: &[Stop], ends: Ends) -> Vec<Visit> {
    let mut search = Search::new(stops, ends, nearest::tour(stops, ends));
    if stops.len() < 2 {
        return search.tour;
    }
    let mut queue: Vec<usize> = (0..stops.len()).collect();
    search.improve(&mut queue);
    search.choose_gates();
    search.kick();
    search.choose_gates();
    search.slide_starts();
    search.tour
}

struct Search<'a> {
    stops: &'a [Stop],
    gates: Vec<Vec<Gate>>,
    /// A circle around the gates of each stop.
    circles: Vec<Circle>,
    ends: Ends,
    tour: Vec<Visit>,
    /// Index of each stop on the tour.
    place: Vec<usize>,
    /// The nearest stops of each stop (all if there are few), with a lower bound of the distance between their gates.
    near: Vec<Vec<(f64, usize)>>,
    all_reversible: bool,
}

impl<'a> Search<'a> {
    fn new(stops: &'a [Stop], ends: Ends, tour: Vec<Visit>) -> Self {
        let place = vec![0; stops.len()];
        let all_reversible = stops.iter().all(Stop::reversible);
        let gates: Vec<Vec<Gate>> = stops.iter().map(|s| s.gates().collect()).collect();
        let circles: Vec<Circle> = stops.iter().map(Circle::around).collect();
        let near = if stops.len() <= FEW_STOPS { all_near(&circles) } else { near(stops) };
        let mut search = Self { stops, gates, circles, ends, tour, place, near, all_reversible };
        search.number(0, stops.len());
        search
    }

    fn number(&mut self, from: usize, to: usize) {
        for i in from..to {
            self.place[self.tour[i].stop] = i;
        }
    }

    fn before(&self, i: usize) -> Option<DVec2> {
        neighbours(&self.tour, i, self.ends).0
    }

    fn after(&self, i: usize) -> Option<DVec2> {
        neighbours(&self.tour, i, self.ends).1
    }

    /// The gate of a stop with the shortest path from `from` through the stop to `to`.
    fn best_gate(&self, stop: usize, from: Option<DVec2>, to: Option<DVec2>) -> Gate {
        let mut best = (f64::INFINITY, self.gates[stop][0]);
        for gate in &self.gates[stop] {
            let way = gap(from, Some(gate.enter)) + gap(Some(gate.leave), to);
            if way < best.0 {
                best = (way, *gate);
            }
        }
        best.1
    }

    /// Whether index `j` of the tour directly follows index `i`.
    fn follows(&self, i: usize, j: usize) -> bool {
        i + 1 == j || (self.ends == Ends::Closed && i + 1 == self.tour.len() && j == 0)
    }

    /// Tries moves around the stops of the queue until it is empty; returns the gain, mm.
    fn improve(&mut self, queue: &mut Vec<usize>) -> f64 {
        let mut waiting = vec![false; self.stops.len()];
        queue.iter().for_each(|&s| waiting[s] = true);
        let mut gained = 0.0;
        while let Some(stop) = queue.pop() {
            waiting[stop] = false;
            while let Some((gain, touched)) = self.improve_at(stop) {
                gained += gain;
                for s in touched {
                    if !std::mem::replace(&mut waiting[s], true) {
                        queue.push(s);
                    }
                }
            }
        }
        gained
    }

    /// Makes the first move around a stop that shortens the tour; returns its gain, mm, and the stops whose neighbours
    /// changed.
    fn improve_at(&mut self, stop: usize) -> Option<(f64, Vec<usize>)> {
        if let Some(gain) = self.other_gate(self.place[stop]) {
            return Some((gain, self.around([self.place[stop]])));
        }
        let freed = [1, 2, 3].map(|length| self.freed(self.place[stop], length));
        let a = self.place[stop];
        let longest = gap(self.before(a), Some(self.tour[a].enter)).max(gap(Some(self.tour[a].leave), self.after(a)));
        for k in 0..self.near[stop].len() {
            let (distance, other) = self.near[stop][k];
            // A new travel gains only if it is shorter than the one it replaces at one of its ends.
            if distance >= longest {
                break;
            }
            let b = self.place[other];
            let (low, high) = (a.min(b), a.max(b));
            let reversed = self.reverse(low + 1, high).or_else(|| self.reverse(low, high - 1));
            if let Some(gain) = reversed {
                return Some((gain, self.around([low, high])));
            }
            for (length, &freed) in (1..).zip(&freed) {
                if freed > LEAST_GAIN
                    && let Some(moved) = self.relocate(a, length, b, freed)
                {
                    return Some(moved);
                }
            }
        }
        None
    }

    /// The stops at some indices of the tour and next to them.
    fn around<const N: usize>(&self, places: [usize; N]) -> Vec<usize> {
        let last = self.tour.len() - 1;
        let beside = places.into_iter().flat_map(|i| [i.saturating_sub(1), i, (i + 1).min(last)]);
        beside.map(|i| self.tour[i].stop).collect()
    }

    fn other_gate(&mut self, i: usize) -> Option<f64> {
        let (before, after, visit) = (self.before(i), self.after(i), self.tour[i]);
        let way = |enter, leave| gap(before, Some(enter)) + gap(Some(leave), after);
        let now = way(visit.enter, visit.leave);
        if now - self.circles[visit.stop].least_way(before, after).max(straight(before, after, &visit)) <= LEAST_GAIN {
            return None;
        }
        let gate = self.best_gate(visit.stop, before, after);
        let gain = now - way(gate.enter, gate.leave);
        (gain > LEAST_GAIN).then(|| {
            self.tour[i] = Visit::new(visit.stop, gate);
            gain
        })
    }

    /// Reverses the section from index i to j if that is shorter; returns the gain, mm.
    fn reverse(&mut self, i: usize, j: usize) -> Option<f64> {
        if i > j || (i == 0 && j + 1 == self.tour.len() && self.ends == Ends::Closed) {
            return None;
        }
        let (before, after) = (self.before(i), self.after(j));
        let (first, last) = (self.tour[i], self.tour[j]);
        let gain = gap(before, Some(first.enter)) + gap(Some(last.leave), after)
            - gap(before, Some(last.leave))
            - gap(Some(first.enter), after);
        if gain <= LEAST_GAIN || !self.may_reverse(i, j) {
            return None;
        }
        self.run_backwards(i, j);
        Some(gain)
    }

    fn may_reverse(&self, i: usize, j: usize) -> bool {
        self.all_reversible || self.tour[i..=j].iter().all(|v| self.stops[v.stop].reversible())
    }

    fn run_backwards(&mut self, i: usize, j: usize) {
        self.tour[i..=j].reverse();
        self.tour[i..=j].iter_mut().for_each(|v| *v = v.flipped());
        self.number(i, j + 1);
    }

    /// How much shorter the tour is without the `length` stops from index `i` on, mm.
    fn freed(&self, i: usize, length: usize) -> f64 {
        let (n, j) = (self.tour.len(), i + length - 1);
        if j >= n || length >= n {
            return 0.0;
        }
        let (before, after) = (self.before(i), self.after(j));
        gap(before, Some(self.tour[i].enter)) + gap(Some(self.tour[j].leave), after) - gap(before, after)
    }

    /// Moves the `length` stops from index `i` on to before or after the stop at index `to`, if that shortens the tour.
    fn relocate(&mut self, i: usize, length: usize, to: usize, freed: f64) -> Option<(f64, Vec<usize>)> {
        let j = i + length - 1;
        if (i..=j).contains(&to) {
            return None;
        }
        let (before, after) = (self.before(i), self.after(j));
        for behind in [true, false] {
            // The travel into which the section is inserted, after its removal.
            let (from, into) = if behind {
                let next = if self.follows(to, i) { after } else { self.after(to) };
                (Some(self.tour[to].leave), next)
            } else {
                let previous = if self.follows(j, to) { before } else { self.before(to) };
                (previous, Some(self.tour[to].enter))
            };
            // Most stops are too far away, whichever gate is used.
            let least = if i == j { self.circles[self.tour[i].stop].least_way(from, into) } else { 0.0 };
            if freed - (least - gap(from, into)) <= LEAST_GAIN {
                continue;
            }
            let (gate, backwards) = self.best_stretch(i, j, from, into);
            let cost = gap(from, Some(gate.enter)) + gap(Some(gate.leave), into) - gap(from, into);
            if freed - cost > LEAST_GAIN {
                let gain = freed - cost;
                let touched = self.move_stretch(i, j, to, behind, gate, backwards);
                return Some((gain, touched));
            }
        }
        None
    }

    /// The gates by which a section between two points is best entered and left, and whether it is then reversed.
    fn best_stretch(&self, i: usize, j: usize, from: Option<DVec2>, into: Option<DVec2>) -> (Gate, bool) {
        if i == j {
            return (self.best_gate(self.tour[i].stop, from, into), false);
        }
        let forwards = Gate { enter: self.tour[i].enter, leave: self.tour[j].leave };
        let cost = |g: Gate| gap(from, Some(g.enter)) + gap(Some(g.leave), into);
        let backwards = cost(forwards.flipped()) < cost(forwards) && self.may_reverse(i, j);
        (if backwards { forwards.flipped() } else { forwards }, backwards)
    }

    fn move_stretch(&mut self, i: usize, j: usize, to: usize, behind: bool, gate: Gate, backwards: bool) -> Vec<usize> {
        let length = j - i + 1;
        if backwards {
            self.run_backwards(i, j);
        } else if length == 1 {
            self.tour[i] = Visit::new(self.tour[i].stop, gate);
        }
        let place = if to > j {
            let end = to + usize::from(behind);
            self.tour[i..end].rotate_left(length);
            self.number(i, end);
            end - length
        } else {
            let begin = to + usize::from(behind);
            self.tour[begin..=j].rotate_right(length);
            self.number(begin, j + 1);
            begin
        };
        let last = self.tour.len() - 1;
        self.around([i.min(last), j.min(last), place, place + length - 1])
    }

    /// Exchanges neighbouring sections, repairs the tour at their ends, and undoes what does not shorten it.
    fn kick(&mut self) {
        let n = self.tour.len();
        let mut kept = (self.tour.clone(), self.place.clone());
        if n > FEW_STOPS {
            let mut random = Random::new(n as u64);
            for _ in 0..(KICKS_PER_STOP * n).min(MOST_KICKS) {
                let a = random.below(n - 1);
                let b = a + 1 + random.below((n - 1 - a).min(KICK_LENGTH));
                let c = b + 1 + random.below((n - b).min(KICK_LENGTH)) - 1;
                self.exchange(a, b, c.max(b + 1).min(n), &mut kept);
            }
            return;
        }
        let all = || (0..n).flat_map(|a| (a + 1..n).flat_map(move |b| (b + 1..=n).map(move |c| (a, b, c))));
        while all().fold(false, |gained, (a, b, c)| gained | self.exchange(a, b, c, &mut kept)) {}
    }

    /// Exchanges the sections a..b and b..c; restores the `kept` tour if that does not shorten it. Returns whether it
    /// did.
    fn exchange(&mut self, a: usize, b: usize, c: usize, kept: &mut (Vec<Visit>, Vec<usize>)) -> bool {
        let old = self.cost_of_kick(a, b, c);
        self.tour[a..c].rotate_left(b - a);
        self.number(a, c);
        let middle = a + c - b;
        let lost = self.cost_of_kick(a, middle, c) - old;
        let ends = [a.saturating_sub(1), a, middle - 1, middle, c - 1, c.min(self.tour.len() - 1)];
        let mut queue = ends.map(|i| self.tour[i].stop).to_vec();
        let shorter = self.improve(&mut queue) - lost > LEAST_GAIN;
        if shorter {
            kept.0.clone_from(&self.tour);
            kept.1.clone_from(&self.place);
        } else {
            self.tour.clone_from(&kept.0);
            self.place.clone_from(&kept.1);
        }
        shorter
    }

    /// Length of the travels at the three ends of the sections a..b and b..c, mm.
    fn cost_of_kick(&self, a: usize, b: usize, c: usize) -> f64 {
        let into = |i: usize| gap(self.before(i), Some(self.tour[i].enter));
        let out = gap(Some(self.tour[c - 1].leave), self.after(c - 1));
        // A closed tour exchanged as a whole has the same end twice.
        let whole = a == 0 && c == self.tour.len() && self.ends == Ends::Closed;
        into(a) + into(b) + if whole { 0.0 } else { out }
    }

    /// Chooses the best gates for the current order by dynamic programming; for a closed tour in two halves.
    fn choose_gates(&mut self) {
        let n = self.tour.len();
        if n < 2 {
            return;
        }
        match self.ends {
            Ends::From(start) => self.choose_gates_between(0, n, Some(start), None),
            Ends::Closed => {
                let half = n / 2;
                self.choose_gates_between(1, n, self.before(1), self.after(n - 1));
                self.tour.rotate_left(half);
                self.choose_gates_between(1, n, self.before(1), self.after(n - 1));
                self.tour.rotate_right(half);
            }
        }
    }

    fn choose_gates_between(&mut self, from: usize, to: usize, start: Option<DVec2>, end: Option<DVec2>) {
        let gates: Vec<Vec<Gate>> = self.tour[from..to].iter().map(|v| self.stops[v.stop].gates().collect()).collect();
        let mut lengths: Vec<f64> = gates[0].iter().map(|g| gap(start, Some(g.enter))).collect();
        let mut back: Vec<Vec<usize>> = Vec::with_capacity(gates.len());
        for pair in gates.windows(2) {
            let reach = |g: &Gate| {
                let ways = pair[0].iter().zip(&lengths).map(|(p, l)| l + p.leave.distance(g.enter));
                ways.enumerate().min_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((0, 0.0))
            };
            let reached: Vec<(usize, f64)> = pair[1].iter().map(reach).collect();
            back.push(reached.iter().map(|r| r.0).collect());
            lengths = reached.into_iter().map(|r| r.1).collect();
        }
        let last = gates.len() - 1;
        let total = |g: usize| lengths[g] + gap(Some(gates[last][g].leave), end);
        let best = (0..lengths.len()).min_by(|&a, &b| total(a).total_cmp(&total(b)));
        let mut gate = best.unwrap_or(0);
        for i in (0..gates.len()).rev() {
            self.tour[from + i] = Visit::new(self.tour[from + i].stop, gates[i][gate]);
            if i > 0 {
                gate = back[i - 1][gate];
            }
        }
    }

    /// Moves the starts of closed passes along their edges, one after another, until they settle.
    fn slide_starts(&mut self) {
        const MOST_ROUNDS: usize = 20;
        for _ in 0..MOST_ROUNDS {
            let mut gained = 0.0;
            for i in 0..self.tour.len() {
                let (before, after, visit) = (self.before(i), self.after(i), self.tour[i]);
                let way = |enter, leave| gap(before, Some(enter)) + gap(Some(leave), after);
                let gate = self.stops[visit.stop].best_start(before, after);
                let gain = way(visit.enter, visit.leave) - way(gate.enter, gate.leave);
                if gain > LEAST_GAIN {
                    self.tour[i] = Visit::new(visit.stop, gate);
                    gained += gain;
                }
            }
            if gained < tour::length(&self.tour, self.ends) * 1e-4 {
                break;
            }
        }
    }
}

/// The straight distance past a stop, mm: no path through a stop that is left where it is entered is shorter.
fn straight(before: Option<DVec2>, after: Option<DVec2>, visit: &Visit) -> f64 {
    if visit.enter == visit.leave { gap(before, after) } else { 0.0 }
}

/// For each of a few stops all others, with a lower bound of the distance between their gates, mm.
fn all_near(circles: &[Circle]) -> Vec<Vec<(f64, usize)>> {
    let of = |s: usize| {
        let others = (0..circles.len()).filter(|&other| other != s);
        let mut list: Vec<_> = others.map(|other| (circles[s].least_distance(&circles[other]), other)).collect();
        list.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        list
    };
    (0..circles.len()).map(of).collect()
}

/// For each stop the stops whose gates are nearest to its own, with the distance, mm.
fn near(stops: &[Stop]) -> Vec<Vec<(f64, usize)>> {
    /// The gates of the stop itself come first; at most this many gates around each one are examined.
    const MOST_LOOKED_AT: usize = 64;
    /// Gates of a ring are close together: about this many of them, spread all around it, suffice to find its
    /// neighbours.
    const ASKED: usize = 16;
    let points = |s: usize| stops[s].gates().map(|g| [g.enter.x, g.enter.y]);
    let all = (0..stops.len()).flat_map(|s| points(s).map(move |p| GeomWithData::new(p, s)));
    let tree = RTree::bulk_load(all.collect());
    let nearest = |s: usize| {
        let around = |p: [f64; 2]| {
            let gates = tree.nearest_neighbor_iter_with_distance_2(&p).take(MOST_LOOKED_AT);
            let others = gates.filter(|(gate, _)| gate.data != s).take(NEAR);
            others.map(|(gate, squared)| (squared.sqrt(), gate.data)).collect::<Vec<_>>()
        };
        let every = points(s).count().div_ceil(ASKED).max(1);
        let mut found: Vec<(f64, usize)> = points(s).step_by(every).flat_map(around).collect();
        found.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let mut list: Vec<(f64, usize)> = Vec::with_capacity(NEAR);
        for other in found {
            if list.len() < NEAR && list.iter().all(|(_, known)| *known != other.1) {
                list.push(other);
            }
        }
        list
    };
    (0..stops.len()).map(nearest).collect()
}
