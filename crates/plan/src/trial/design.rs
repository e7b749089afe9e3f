//! Designs of experiments: which combinations of the factors are welded.

use super::Factor;
use crate::random::Random;

/// How combinations are chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Design {
    /// Every combination of this many values of each factor; of listed values all.
    Factorial(usize),
    /// The middles of the edges of the range, and its middle three times (Box and Behnken 1960, Technometrics 2): enough for a
    /// polynomial of second order without its corners. For three to five factors.
    BoxBehnken,
    /// This many points, such that each has its own value of every factor, as far apart as they could be found (McKay,
    /// Beckman and Conover 1979, Technometrics 21).
    LatinHypercube(usize),
}

/// Latin hypercubes tried, of which the one whose points lie farthest apart is taken.
const TRIED: usize = 300;
/// Middle points of a Box–Behnken design.
const MIDDLES: usize = 3;

/// The combinations of a design: one value for each factor; `None` where a Box–Behnken design does not exist for that
/// number of factors. `seed` matters for Latin hypercubes only.
///
/// ```
/// use bead_plan::trial::{Design, Factor, points};
///
/// let factors: Vec<Factor> = vec!["deposition_speed=6..12".parse()?, "wire_feed_speed=5..8".parse()?];
/// let found = points(Design::Factorial(3), &factors, 1).ok_or("no design")?;
/// assert_eq!(found.len(), 9);
/// assert!(found.contains(&vec![9.0, 6.5]));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn points(design: Design, factors: &[Factor], seed: u64) -> Option<Vec<Vec<f64>>> {
    let random = &mut Random::new(seed);
    let parts = match design {
        Design::Factorial(levels) => factorial(levels, factors),
        Design::BoxBehnken => box_behnken(factors.len())?,
        Design::LatinHypercube(count) => latin_hypercube(count, factors.len(), random),
    };
    let values = |point: &Vec<f64>| factors.iter().zip(point).map(|(factor, part)| factor.at(*part)).collect();
    Some(parts.iter().map(values).collect())
}

fn factorial(levels: usize, factors: &[Factor]) -> Vec<Vec<f64>> {
    factors.iter().fold(vec![Vec::new()], |points, factor| {
        let count = factor.listed().unwrap_or(levels.max(2));
        let parts = (0..count).map(|k| k as f64 / (count - 1) as f64);
        let with = |part: f64| points.iter().map(move |point| [&point[..], &[part]].concat());
        parts.flat_map(with).collect()
    })
}

fn box_behnken(factors: usize) -> Option<Vec<Vec<f64>>> {
    if !(3..=5).contains(&factors) {
        return None;
    }
    let pairs = (0..factors).flat_map(|a| (a + 1..factors).map(move |b| (a, b)));
    let edges = pairs.flat_map(|(a, b)| {
        [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)].map(|(first, second)| {
            let mut point = vec![0.5; factors];
            (point[a], point[b]) = (first, second);
            point
        })
    });
    Some(edges.chain(vec![vec![0.5; factors]; MIDDLES]).collect())
}

fn latin_hypercube(count: usize, factors: usize, random: &mut Random) -> Vec<Vec<f64>> {
    let count = count.max(2);
    let mut best = (-1.0, Vec::new());
    for _ in 0..TRIED {
        let columns: Vec<Vec<usize>> = (0..factors).map(|_| shuffled(count, random)).collect();
        let part = |k: usize| k as f64 / (count - 1) as f64;
        let points: Vec<Vec<f64>> =
            (0..count).map(|i| columns.iter().map(|column| part(column[i])).collect()).collect();
        let apart = least_distance(&points);
        if apart > best.0 {
            best = (apart, points);
        }
    }
    best.1
}

fn least_distance(points: &[Vec<f64>]) -> f64 {
    let distance = |a: &Vec<f64>, b: &Vec<f64>| a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>();
    let pairs = points.iter().enumerate().flat_map(|(i, a)| points[..i].iter().map(move |b| distance(a, b)));
    pairs.fold(f64::INFINITY, f64::min)
}

/// The numbers from 0 to `count` − 1 in random order (Fisher and Yates).
pub(super) fn shuffled(count: usize, random: &mut Random) -> Vec<usize> {
    let mut order: Vec<usize> = (0..count).collect();
    (1..count).rev().for_each(|k| order.swap(k, random.below(k + 1)));
    order
}
