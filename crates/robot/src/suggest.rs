//! A better position for the part: a search over x, y, z and rotation for the greatest least margin near the current
//! position.
//!
//! A grid over the space in front of the robot, then smaller and smaller steps from its best position. A position is
//! judged by the outermost points of a few layers, with one torch angle for all of them. Nothing is random.

use crate::arm::{Arm, Branch, Frame, turned_near};
use crate::cell::{Cell, PartPlace};
use crate::part_from_tool;
use crate::track::Track;
use glam::DVec3;
use rayon::prelude::*;
use serde::Serialize;

/// Number of layers examined.
const LAYERS: usize = 5;
/// Number of horizontal directions in which the outermost points are taken, each tilted up and down.
const DIRECTIONS: usize = 8;
/// Number of torch angles tried on the grid.
const COARSE: usize = 12;
/// Number of torch angles tried after that: the same as in the walk.
const FINE: usize = crate::turn::ANGLES;
/// Least gain in margin that makes moving a part worthwhile, °.
pub(crate) const WORTH_MOVING: f64 = 5.0;
/// Move, mm, and turn, °, that must each gain one degree of margin: of equal positions the nearest is chosen.
const MM_PER_DEGREE: f64 = 100.0;
const TURN_PER_DEGREE: f64 = 45.0;
/// Steps of the refinement, mm and °; the last ones are the resolution of the answer.
const STEPS: [(f64, f64); 4] = [(80.0, 16.0), (40.0, 8.0), (20.0, 4.0), (10.0, 2.0)];

/// A suggested position for the part.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Suggestion {
    /// The position.
    pub place: PartPlace,
    /// Least margin of the points examined, °.
    pub margin: f64,
    /// The torch angle that gives it, °.
    pub torch_angle: f64,
    /// Least margin of these points with the part in its current position, °; `None` if some are out of reach.
    pub now: Option<f64>,
}

impl Suggestion {
    /// The suggestion in words.
    pub fn sentence(&self) -> String {
        let Self { place, margin, torch_angle, now } = self;
        if let Some(now) = now.filter(|now| margin - now < WORTH_MOVING) {
            return format!(
                "The part is well placed: its outermost points keep {now:.1}° from all limits and singularities with the torch \
                 at one angle; the best place found, {}, would give {margin:.1}°.",
                place.sentence()
            );
        }
        let now = now.map_or("some are out of reach now".to_owned(), |now| format!("it is {now:.1}° now"));
        format!(
            "Put the part's origin at {}: its outermost points then keep {margin:.1}° from all limits and singularities with \
             the torch at {torch_angle:.0}° ({now}). Make sure that the arm and the torch have room there.",
            place.sentence()
        )
    }
}

/// Searches for a position; `None` if the arm cannot reach all points from any position tried.
pub fn suggest(cell: &Cell, start: PartPlace, track: &Track) -> Option<Suggestion> {
    let points = outermost(track);
    let (arm, tool_from_flange) = (cell.arm(), cell.flange_from_tool().inverse());
    let rated = |place: PartPlace, angles: usize| rate(&arm, &tool_from_flange, place, &points, angles);
    let fine = |place: PartPlace| rated(place, FINE);
    let mut places = vec![start];
    places.extend(grid(&arm, start.rotation));
    // Collected in order: the first of equal ones wins, whatever the threads do.
    let judged: Vec<Option<Suggestion>> = places.into_par_iter().map(|p| rated(p, COARSE)).collect();
    let here = fine(start);
    let better = |best: Option<Suggestion>, tried: Vec<Option<Suggestion>>| better(start, best, tried);
    let mut best = better(None, judged).and_then(|found| better(here, vec![fine(found.place)]))?;
    for (mm, degrees) in STEPS {
        // Every step gains some margin, so the loop ends.
        loop {
            let tried: Vec<Option<Suggestion>> = around(best.place, mm, degrees).into_par_iter().map(fine).collect();
            let Some(found) = better(Some(best), tried).filter(|f| worth(f, start) > worth(&best, start) + 0.05) else {
                break;
            };
            best = found;
        }
    }
    Some(Suggestion { now: here.map(|s| s.margin), ..best })
}

/// The margin of a position, less the cost of moving the part there, °.
fn worth(found: &Suggestion, start: PartPlace) -> f64 {
    let moved = DVec3::from(found.place.position).distance(DVec3::from(start.position));
    let turned = turned_near(found.place.rotation - start.rotation, 0.0).abs();
    found.margin - moved / MM_PER_DEGREE - turned / TURN_PER_DEGREE
}

/// The first of the best positions.
fn better(start: PartPlace, best: Option<Suggestion>, tried: Vec<Option<Suggestion>>) -> Option<Suggestion> {
    let better = |best: Option<Suggestion>, new: Suggestion| match best {
        Some(old) if worth(&old, start) >= worth(&new, start) => Some(old),
        _ => Some(new),
    };
    tried.into_iter().flatten().fold(best, better)
}

/// Positions in front of the robot, on or above the floor, in whole centimetres.
fn grid(arm: &Arm, rotation: f64) -> Vec<PartPlace> {
    let part_of_reach = |part: f64| (part * arm.reach() / 10.0).round() * 10.0;
    let mut places = Vec::new();
    for y in [0.0, -0.3, 0.3] {
        for x in 0..8 {
            for z in 0..8 {
                for turn in 0..4 {
                    let position = [0.3 + 0.1 * f64::from(x), y, 0.1 * f64::from(z)].map(part_of_reach);
                    let rotation = turned_near(rotation + 45.0 * f64::from(turn), 0.0);
                    places.push(PartPlace { position, rotation });
                }
            }
        }
    }
    places
}

fn around(place: PartPlace, mm: f64, degrees: f64) -> Vec<PartPlace> {
    let mut places = Vec::with_capacity(8);
    for sign in [1.0, -1.0] {
        for axis in 0..3 {
            let mut position = place.position;
            position[axis] += sign * mm;
            // The part does not go below the floor.
            if axis < 2 || position[axis] >= 0.0 {
                places.push(PartPlace { position, ..place });
            }
        }
        places.push(PartPlace { rotation: place.rotation + sign * degrees, ..place });
    }
    places
}

/// The best least margin over branches and torch angles; `None` if each of them has some point out of reach or beyond a
/// limit.
pub(crate) fn rate(
    arm: &Arm,
    tool_from_flange: &Frame,
    place: PartPlace,
    points: &[DVec3],
    angles: usize,
) -> Option<Suggestion> {
    let base_from_part = place.base_from_part();
    let angle = |k: usize| k as f64 * 360.0 / angles as f64;
    let mut least = vec![[f64::INFINITY; Branch::COUNT]; angles];
    for &point in points {
        for (k, least) in least.iter_mut().enumerate() {
            // At this angle every branch has already failed.
            if least.iter().all(|margin| *margin < 0.0) {
                continue;
            }
            let tool = base_from_part.then(&part_from_tool(point, angle(k)));
            let mut here = [-1.0; Branch::COUNT];
            for (branch, joints) in arm.inverse(&tool.then(tool_from_flange)) {
                here[branch.index()] = arm.margins(&joints).least();
            }
            for (margin, here) in least.iter_mut().zip(here) {
                *margin = margin.min(here);
            }
        }
        if least.as_flattened().iter().all(|m| *m < 0.0) {
            return None;
        }
    }
    let of_angle = |margins: &[f64; Branch::COUNT]| margins.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    // The first among equals.
    let best = least.iter().map(of_angle).enumerate().rev().max_by(|a, b| a.1.total_cmp(&b.1));
    let best = best.filter(|(_, margin)| margin.is_finite());
    best.map(|(k, margin)| Suggestion { place, margin, torch_angle: angle(k), now: None })
}

/// The outermost stops of a few layers, in each direction tilted up and down.
pub(crate) fn outermost(track: &Track) -> Vec<DVec3> {
    let mut layers: Vec<&[crate::Stop]> = track.stops.chunk_by(|a, b| a.layer == b.layer).collect();
    let count = layers.len();
    if count > LAYERS {
        layers = (0..LAYERS).map(|i| layers[i * (count - 1) / (LAYERS - 1)]).collect();
    }
    let mut points: Vec<DVec3> = Vec::new();
    for stops in layers {
        for d in 0..2 * DIRECTIONS {
            let turn = (d / 2) as f64 / DIRECTIONS as f64 * std::f64::consts::TAU;
            let way = DVec3::new(turn.cos(), turn.sin(), if d % 2 == 0 { 0.3 } else { -0.3 });
            let outermost = stops.iter().map(|s| s.at).max_by(|a, b| a.dot(way).total_cmp(&b.dot(way)));
            points.extend(outermost.filter(|p| !points.contains(p)));
        }
    }
    points
}

/// The best of some values of an axis that moves the part, its margin (°), and the margin at the value 0 (`None` if
/// some points are out of reach there). Values are judged by the outermost points of a few layers. 0 is kept unless
/// another value gains enough; of equals the smallest wins. `None` if no value brings all points within reach.
pub(crate) fn best(
    cell: &Cell,
    track: &Track,
    values: impl Iterator<Item = f64>,
    place_at: impl Fn(f64) -> PartPlace + Sync,
) -> Option<(f64, f64, Option<f64>)> {
    let points = outermost(track);
    let (arm, tool_from_flange) = (cell.arm(), cell.flange_from_tool().inverse());
    let margin =
        |value: f64| rate(&arm, &tool_from_flange, place_at(value), &points, FINE).map(|found| (value, found.margin));
    let mut values: Vec<f64> = values.collect();
    values.sort_by(|a, b| a.abs().total_cmp(&b.abs()).then(b.total_cmp(a)));
    let judged: Vec<Option<(f64, f64)>> = values.into_par_iter().map(margin).collect();
    let at_zero = judged.iter().flatten().find(|(value, _)| *value == 0.0).map(|(_, margin)| *margin);
    let (value, margin) = judged.into_iter().flatten().rev().max_by(|a, b| a.1.total_cmp(&b.1))?;
    match at_zero {
        Some(now) if margin - now < WORTH_MOVING => Some((0.0, now, at_zero)),
        _ => Some((value, margin, at_zero)),
    }
}
