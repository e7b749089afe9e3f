//! Raster angles with few turns (Han et al. 2018, 3.1), and what depends on the angle.

use super::{FillSettings, Strategy};
use glam::DVec2;
use planar::scan::count_and_length;
use planar::turns::{Turns, ends_at};
use planar::{Polygon, Region};
use std::f64::consts::{FRAC_PI_2, PI};

/// An edge direction may have up to this fraction more turns than the best angle.
const EDGE_SLACK: f64 = 0.01;

/// Number of edge directions tried.
const EDGES_TRIED: usize = 4;

/// Angles closer than this count as one, radians.
const SAME_ANGLE: f64 = 1e-6;

/// The regions of some islands that a strategy fills with scan lines.
pub fn infills(strategy: &dyn Strategy, islands: &[Polygon], settings: &FillSettings) -> Vec<Region> {
    let regions = islands.iter().map(|island| strategy.infill(island, settings));
    regions.filter(|region| !region.is_empty()).collect()
}

/// The angle, radians, with the fewest turns on a layer and on the next one, whose lines are turned by 90° (eq 9);
/// from the [`infills`] of the layers. `None` where no scan lines are laid.
pub fn fewest_turns(layers: &[Vec<Region>], settings: &FillSettings) -> Option<f64> {
    few_turns(layers, settings).first().copied()
}

/// Angles likely to take the least time on such layers, radians, the most likely first: those with few turns, and the
/// fixed angle of the settings. Turns are not everything: short lines cost less, and every path costs a start. Each
/// angle is listed within 0..90° and then turned by 90°: if both layers are alike, the lines are the same.
pub fn candidates(layers: &[Vec<Region>], settings: &FillSettings) -> Vec<f64> {
    let few = few_turns(layers, settings);
    let fixed = (!few.is_empty()).then_some(settings.raster_angle);
    let mut candidates: Vec<f64> = Vec::new();
    for angle in few.into_iter().chain(fixed) {
        let rest = angle.rem_euclid(FRAC_PI_2);
        let first = if FRAC_PI_2 - rest < SAME_ANGLE { 0.0 } else { rest };
        if candidates.iter().all(|known| (known - first).abs() > SAME_ANGLE) {
            candidates.extend([first, first + FRAC_PI_2]);
        }
    }
    candidates
}

/// The angle with the fewest turns, then edge directions with few.
///
/// The number of turns is known exactly for angles between edge directions. Exactly along an edge it may be lower
/// still, so the directions of the longest edges are tried too. An edge direction with hardly more turns is preferred
/// to a nearby angle such as 89.9°.
fn few_turns(layers: &[Vec<Region>], settings: &FillSettings) -> Vec<f64> {
    let turned = |layer: usize| if layer % 2 == 1 { FRAC_PI_2 } else { 0.0 };
    let layers = layers.iter().enumerate();
    let regions: Vec<(f64, &Region)> = layers.flat_map(|(i, all)| all.iter().map(move |r| (turned(i), r))).collect();
    let spacing = settings.spacing();
    let sum = regions.iter().fold(Turns::default(), |sum, (turn, region)| {
        let turns = Turns::new(region, spacing);
        sum.plus(&if *turn > 0.0 { turns.turned(*turn) } else { turns })
    });
    let Some((between, fewest)) = sum.least() else { return Vec::new() };
    let along = |angle: f64| regions.iter().map(|(turn, region)| ends_at(region, angle + turn, spacing)).sum::<i64>();
    let mut edges: Vec<(i64, f64)> = sum.edges().iter().map(|&(angle, _)| (along(angle), angle)).collect();
    // The longest edges come first: among equals the longest wins.
    edges.sort_by_key(|(count, _)| *count);
    let wins = edges.first().is_some_and(|(count, _)| *count as f64 <= fewest as f64 * (1.0 + EDGE_SLACK));
    let along_edges = edges.into_iter().map(|(_, angle)| angle).take(EDGES_TRIED);
    (!wins).then_some(between).into_iter().chain(along_edges).collect()
}

/// What depends on the raster angle, on one layer.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Curves {
    /// Angle, °, and number of turns (eqs 6–8): exact between its jumps, or for every degree where there are more edges than
    /// can be distinguished in a picture.
    pub turns: Vec<DVec2>,
    /// Angle, °, and length of the scan lines, mm.
    pub length: Vec<DVec2>,
    /// Angle, °, and area laid twice at the turns, which is as large as the area missed there (eqs 10 and 11), mm².
    pub corner_area: Vec<DVec2>,
}

/// Above this many edges the number of turns is sampled: both its jumps and the cost of each grow with the edges.
const MOST_EDGES: usize = 1000;

/// The curves for the islands of a layer; lengths and areas for every degree.
pub fn curves(strategy: &dyn Strategy, islands: &[Polygon], settings: &FillSettings) -> Curves {
    let regions = infills(strategy, islands, settings);
    let spacing = settings.spacing();
    let place = |(angle, value): (f64, f64)| DVec2::new(angle.to_degrees(), value);
    let sampled = |value: &dyn Fn(&Region, f64) -> f64| {
        let at = |angle: f64| regions.iter().map(|region| value(region, angle)).sum::<f64>();
        (0..=180).map(|degree| f64::from(degree) * PI / 180.0).map(|angle| place((angle, at(angle)))).collect()
    };
    let exact = || {
        let turns = regions.iter().fold(Turns::default(), |sum, region| sum.plus(&Turns::new(region, spacing)));
        let corners = turns.steps().windows(2).flat_map(|w| [(w[0].0, w[0].1), (w[1].0, w[0].1)]);
        corners.map(|(angle, count)| place((angle, count as f64))).collect()
    };
    let edges: usize = regions.iter().flat_map(Region::rings).map(|ring| ring.points().len()).sum();
    let few = edges <= MOST_EDGES;
    Curves {
        turns: if few { exact() } else { sampled(&|region, angle| ends_at(region, angle, spacing) as f64) },
        length: sampled(&|region, angle| count_and_length(region, angle, spacing).1),
        corner_area: sampled(&|region, angle| corner_area(region, angle, settings)),
    }
}

/// Area laid twice at all turns, mm²: `S = r² (cot(θ/2) + θ/2 − π/2)` at a turn with the angle θ between line and edge,
/// r half a bead (eqs 10 and 11). An edge has as many turns as lines fit across it, half of them at π − θ: together
/// `r² (2 / sin θ − π/2)` for each two, and none for an edge along the lines. `angle` is in radians.
pub fn corner_area(region: &Region, angle: f64, settings: &FillSettings) -> f64 {
    let (r, line) = (settings.bead.width / 2.0, DVec2::from_angle(angle));
    let edge = |(a, b): (DVec2, DVec2)| {
        let (length, across) = (a.distance(b), line.perp_dot(b - a).abs());
        if across > SAME_ANGLE * length { 2.0 * length - FRAC_PI_2 * across } else { 0.0 }
    };
    region.rings().flat_map(|ring| ring.edges()).map(edge).sum::<f64>() * r * r / (2.0 * settings.stepover)
}
