//! The ant colony of Han et al. 2018 (section 2.2) over the start points of the improved nearest neighbour.
//!
//! `p_ij = τ_ij^α η_ij^β / Σ`, `η = 1/d_ij`, and after each round `τ ← (1−ρ) τ + Σ Q/L_w` (ant-cycle). The paper gives
//! 50 ants and 200 rounds; α, β, ρ and Q are ours. Kept for comparison: the local search is better and faster.

use super::nearest;
use super::tour::{self, Ends, Stop, Visit};
use crate::random::Random;

/// The parameters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Colony {
    /// Ants in a round (50 in the paper).
    pub ants: usize,
    /// Rounds (200 in the paper).
    pub rounds: usize,
    /// Weight of the pheromone, α.
    pub pheromone_weight: f64,
    /// Weight of the nearness, β.
    pub nearness_weight: f64,
    /// Fraction of the pheromone that evaporates in a round, ρ.
    pub evaporation: f64,
    /// Pheromone that an ant lays on its tour, Q, in lengths of the first tour.
    pub amount: f64,
    /// Seed of the random numbers.
    pub seed: u64,
}

impl Default for Colony {
    fn default() -> Self {
        let (pheromone_weight, nearness_weight, evaporation, amount) = (1.0, 5.0, 0.1, 1.0);
        Self { ants: 50, rounds: 200, pheromone_weight, nearness_weight, evaporation, amount, seed: 1 }
    }
}

/// Tours of the ants of one round, mm (figure 4 of the paper).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Round {
    /// Mean length of the tours of this round.
    pub mean: f64,
    /// The shortest tour so far; before the first round, that of the improved nearest neighbour.
    pub shortest: f64,
}

/// The best tour that an ant walked.
pub fn tour(stops: &[Stop], ends: Ends, colony: &Colony) -> Vec<Visit> {
    let (tour, _) = search(stops, colony);
    match ends {
        Ends::Closed => tour,
        Ends::From(point) => nearest::opened(tour, point),
    }
}

/// How the closed tours of the ants become shorter, round by round.
pub fn convergence(stops: &[Stop], colony: &Colony) -> Vec<Round> {
    search(stops, colony).1
}

/// The best closed tour, and the tour lengths of each round.
fn search(stops: &[Stop], colony: &Colony) -> (Vec<Visit>, Vec<Round>) {
    let start = nearest::improved(stops, Ends::Closed);
    let n = start.len();
    let length = |order: &[usize]| {
        let way = |w: usize| start[order[w]].leave.distance(start[order[(w + 1) % n]].enter);
        (0..n).map(way).sum::<f64>()
    };
    let mut best: Vec<usize> = (0..n).collect();
    let (mut least, mut random) = (length(&best), Random::new(colony.seed));
    let amount = colony.amount * least.max(f64::MIN_POSITIVE);
    let nearness: Vec<f64> = pairs(n).map(|(i, j)| nearness(&start, i, j, colony.nearness_weight)).collect();
    let mut pheromone = vec![1.0; n * n];
    let (mut order, mut rounds) = (Vec::with_capacity(n), Vec::with_capacity(colony.rounds));
    for _ in 0..colony.rounds {
        let pull: Vec<f64> =
            pheromone.iter().zip(&nearness).map(|(p, n)| f64::powf(*p, colony.pheromone_weight) * n).collect();
        pheromone.iter_mut().for_each(|p| *p *= 1.0 - colony.evaporation);
        let mut sum = 0.0;
        for _ in 0..colony.ants {
            walk(n, &pull, &mut random, &mut order);
            let walked = length(&order);
            sum += walked;
            for w in 0..n {
                let (i, j) = (order[w], order[(w + 1) % n]);
                pheromone[i * n + j] += amount / walked.max(f64::MIN_POSITIVE);
                pheromone[j * n + i] = pheromone[i * n + j];
            }
            if walked < least {
                least = walked;
                best.clone_from(&order);
            }
        }
        rounds.push(Round { mean: sum / colony.ants.max(1) as f64, shortest: least });
    }
    (best.into_iter().map(|i| start[i]).collect(), rounds)
}

fn pairs(n: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..n).flat_map(move |i| (0..n).map(move |j| (i, j)))
}

fn nearness(start: &[Visit], i: usize, j: usize, weight: f64) -> f64 {
    const TOUCHING_MM: f64 = 1e-3;
    tour::gap(Some(start[i].leave), Some(start[j].enter)).max(TOUCHING_MM).powf(-weight)
}

/// One ant's tour from a random stop.
fn walk(n: usize, pull: &[f64], random: &mut Random, order: &mut Vec<usize>) {
    order.clear();
    if n == 0 {
        return;
    }
    let mut left: Vec<usize> = (0..n).collect();
    let mut at = left.swap_remove(random.below(n));
    order.push(at);
    while !left.is_empty() {
        let row = &pull[at * n..(at + 1) * n];
        let mut mark = random.unit() * left.iter().map(|&j| row[j]).sum::<f64>();
        let passed = |&j: &usize| {
            mark -= row[j];
            mark <= 0.0
        };
        let chosen = left.iter().position(passed).unwrap_or(left.len() - 1);
        at = left.swap_remove(chosen);
        order.push(at);
    }
}
