//! The shortest tour over all orders and gates, by dynamic programming (Held and Karp, with gates).

use super::tour::{Ends, Gate, Stop, Visit};

/// Most stops: time and memory grow with 2ⁿ.
pub const MAX_STOPS: usize = 9;

/// The optimum, for at most [`MAX_STOPS`] stops; closed passes start at one of their gates.
///
/// ```
/// use bead_plan::order::exact;
/// use bead_plan::order::tour::{Ends, Stop, length};
/// use glam::DVec2;
///
/// let stops = [30.0, 10.0, 20.0].map(|x| Stop::anywhere([DVec2::X * x]));
/// let ends = Ends::From(DVec2::ZERO);
/// let tour = exact::tour(&stops, ends);
/// assert_eq!(tour.iter().map(|visit| visit.stop).collect::<Vec<_>>(), [1, 2, 0]);
/// assert_eq!(length(&tour, ends), 30.0);
/// ```
pub fn tour(stops: &[Stop], ends: Ends) -> Vec<Visit> {
    let gates: Vec<Vec<Gate>> = stops.iter().map(|s| s.gates().collect()).collect();
    let found = match ends {
        Ends::From(start) => shortest(&gates, |gate| Some(start.distance(gate.enter)), |_| 0.0),
        // The tour passes the first stop by one of its gates: try each, and return to it.
        Ends::Closed => {
            let Some((first, rest)) = gates.split_first() else { return Vec::new() };
            let around = |&gate: &Gate| {
                let enter = |next: &Gate| Some(gate.leave.distance(next.enter));
                let (length, mut tour) = shortest(rest, enter, |last| last.leave.distance(gate.enter))?;
                tour.iter_mut().for_each(|visit| visit.stop += 1);
                tour.insert(0, Visit::new(0, gate));
                Some((length, tour))
            };
            first.iter().filter_map(around).min_by(|a, b| a.0.total_cmp(&b.0))
        }
    };
    found.map(|(_, tour)| tour).unwrap_or_default()
}

/// The shortest path through all stops, including the lengths of the paths in and out.
fn shortest(
    gates: &[Vec<Gate>],
    way_in: impl Fn(&Gate) -> Option<f64>,
    way_out: impl Fn(&Gate) -> f64,
) -> Option<(f64, Vec<Visit>)> {
    let all: Vec<(usize, Gate)> = gates.iter().enumerate().flat_map(|(s, g)| g.iter().map(move |g| (s, *g))).collect();
    let full = (1_usize << gates.len()) - 1;
    if full == 0 {
        return Some((0.0, Vec::new()));
    }
    let mut least = vec![f64::INFINITY; (full + 1) * all.len()];
    let mut from = vec![usize::MAX; least.len()];
    for (g, (stop, gate)) in all.iter().enumerate() {
        least[(1 << stop) * all.len() + g] = way_in(gate)?;
    }
    for visited in 1..=full {
        for (g, (_, gate)) in all.iter().enumerate() {
            let here = least[visited * all.len() + g];
            if here.is_infinite() {
                continue;
            }
            for (h, (next, to)) in all.iter().enumerate().filter(|(_, (s, _))| visited & (1 << s) == 0) {
                let place = (visited | 1 << next) * all.len() + h;
                let length = here + gate.leave.distance(to.enter);
                if length < least[place] {
                    least[place] = length;
                    from[place] = g;
                }
            }
        }
    }
    let total = |g: usize| least[full * all.len() + g] + way_out(&all[g].1);
    let last = (0..all.len()).min_by(|&a, &b| total(a).total_cmp(&total(b)))?;
    let (length, mut tour, mut g, mut visited) = (total(last), Vec::new(), last, full);
    while g != usize::MAX {
        let (stop, gate) = all[g];
        tour.push(Visit::new(stop, gate));
        (g, visited) = (from[visited * all.len() + g], visited & !(1 << stop));
    }
    tour.reverse();
    Some((length, tour))
}
