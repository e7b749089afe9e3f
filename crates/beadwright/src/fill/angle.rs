//! The raster angle with the fewest turns (Han et al. 2018, 3.1), and what else depends on the angle.

use super::{FillSettings, Strategy};
use glam::DVec2;
use planar::scan::{End, Scan};
use planar::turns::{Turns, ends_at};
use planar::{Polygon, Region};
use std::f64::consts::{FRAC_PI_2, PI};

/// An edge direction may have up to this fraction more turns than the best angle.
const EDGE_SLACK: f64 = 0.01;

/// The angle, radians, with the fewest turns on a layer and on the next one, whose lines are turned by 90° (eq 9).
/// `None` where no scan lines are laid.
///
/// The number of turns is known exactly for angles between the directions of edges. Exactly along an edge it may be
/// lower still, so the directions of the longest edges are tried too. One with hardly more turns wins over an angle
/// close to it, such as 89.9°.
pub fn best(strategy: &dyn Strategy, layers: &[&[Polygon]], settings: &FillSettings) -> Option<f64> {
    let turned = |layer: usize| if layer % 2 == 1 { FRAC_PI_2 } else { 0.0 };
    let regions: Vec<(f64, Region)> = layers
        .iter()
        .enumerate()
        .flat_map(|(i, islands)| islands.iter().map(move |island| (turned(i), strategy.infill(island, settings))))
        .filter(|(_, region)| !region.is_empty())
        .collect();
    let spacing = settings.spacing();
    let sum = regions.iter().fold(Turns::default(), |sum, (turn, region)| {
        let turns = Turns::new(region, spacing);
        sum.plus(&if *turn > 0.0 { turns.turned(*turn) } else { turns })
    });
    let (between, fewest) = sum.least()?;
    let along = |angle: f64| regions.iter().map(|(turn, region)| ends_at(region, angle + turn, spacing)).sum::<i64>();
    let edges = sum.edges().iter().map(|&(angle, _)| (along(angle), angle));
    // The longest edges come first: among equals the longest wins.
    let edge = edges.min_by_key(|(count, _)| *count);
    let edge = edge.filter(|(count, _)| *count as f64 <= fewest as f64 * (1.0 + EDGE_SLACK));
    Some(edge.map_or(between, |(_, angle)| angle))
}

/// What depends on the raster angle, on one layer.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Curves {
    /// Angle, °, and number of turns (eqs 6–8), exact.
    pub turns: Vec<DVec2>,
    /// Angle, °, and length of the scan lines, mm.
    pub length: Vec<DVec2>,
    /// Angle, °, and area laid twice at the turns, which is as large as the area missed there (eqs 10 and 11), mm².
    pub corner_area: Vec<DVec2>,
}

/// The curves for the islands of a layer; lengths and areas for every degree.
pub fn curves(strategy: &dyn Strategy, islands: &[Polygon], settings: &FillSettings) -> Curves {
    let regions: Vec<Region> = islands.iter().map(|island| strategy.infill(island, settings)).collect();
    let spacing = settings.spacing();
    let turns = regions.iter().fold(Turns::default(), |sum, region| sum.plus(&Turns::new(region, spacing)));
    let corners = turns.steps().windows(2).flat_map(|w| [(w[0].0, w[0].1), (w[1].0, w[0].1)]);
    let place = |(angle, value): (f64, f64)| DVec2::new(angle.to_degrees(), value);
    let sampled = |value: &dyn Fn(&Region, f64) -> f64| {
        let at = |angle: f64| regions.iter().map(|region| value(region, angle)).sum::<f64>();
        (0..=180).map(|degree| f64::from(degree) * PI / 180.0).map(|angle| place((angle, at(angle)))).collect()
    };
    let length = |region: &Region, angle: f64| {
        let scan = Scan::new(region, angle, spacing);
        (0..scan.spans().len()).map(|s| scan.end(s, End::Right).x - scan.end(s, End::Left).x).sum()
    };
    let corner_area = |region: &Region, angle: f64| corner_area(region, angle, settings);
    Curves {
        turns: corners.map(|(angle, count)| place((angle, count as f64))).collect(),
        length: sampled(&length),
        corner_area: sampled(&corner_area),
    }
}

/// Area laid twice at all turns, mm²: `S = r² (cot(θ/2) + θ/2 − π/2)` at a turn of the angle θ between line and edge,
/// r half a bead (eqs 10 and 11). An edge has as many turns as lines fit across it, half of them at π − θ.
fn corner_area(region: &Region, angle: f64, settings: &FillSettings) -> f64 {
    let (r, line) = (settings.bead.width / 2.0, DVec2::from_angle(angle));
    let area = |theta: f64| r * r * (1.0 / (theta / 2.0).tan() + theta / 2.0 - FRAC_PI_2);
    let edge = |(a, b): (DVec2, DVec2)| {
        let theta = line.angle_to(b - a).rem_euclid(PI).clamp(1e-6, PI - 1e-6);
        line.perp_dot(b - a).abs() / settings.stepover * (area(theta) + area(PI - theta)) / 2.0
    };
    region.rings().flat_map(|ring| ring.edges()).map(edge).sum()
}
