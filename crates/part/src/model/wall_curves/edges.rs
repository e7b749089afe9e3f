//! A wall between two edge curves that are not level: the ruled surface between corresponding points. Its level cuts
//! are the centre-lines of layers; where it leans, layers rise by h_n cos φ (Li et al., 1.2, eqs 5 to 8).
//!
//! The edges may be the bottom and the top, or the two ends of a wall. Nothing is known between them, so the wall is
//! straight there.

use super::{Curve, LEVEL_MM, level};
use crate::model::iges::IgesFile;
use crate::model::{Mesh, RepairReport};
use glam::{DAffine3, DVec3};

/// Greatest distance between the edge curves and their chords, mm.
const CHORD_MM: f64 = 0.01;
/// Least and greatest number of corresponding points.
const POINTS: (usize, usize) = (128, 2048);

/// The surface between the two visible, independent curves of a drawing, turned and scaled by `place`. `None` if there
/// are more or fewer than two curves, if both are level, or if only one is closed.
pub(crate) fn ruled(file: &IgesFile, place: &DAffine3) -> Option<(Mesh, RepairReport)> {
    let curves: Vec<_> = file.independent_curves().collect();
    let [one, other] = curves[..] else { return None };
    let placed =
        [one, other].map(|c| (c.entry, c.parts.iter().map(|part| part.transformed(place)).collect::<Vec<_>>()));
    if placed.iter().all(|(entry, parts)| level(*entry, parts).is_ok()) {
        return None;
    }
    let [lower, upper] = placed.map(|(_, parts)| Curve::new(parts));
    if lower.closed != upper.closed {
        return None;
    }
    let coarse = [&lower, &upper].map(|curve| 4 * spatial(curve).len()).into_iter().max()?.clamp(POINTS.0, POINTS.1);
    let between = |count: usize| {
        let (below, above) = (evenly(&lower, count)?, evenly(&upper, count)?);
        let above = matched(&below, above, lower.closed);
        Some((below, above))
    };
    let (below, above) = between(coarse)?;
    let finer = twist(&below, &above) / CHORD_MM * coarse as f64;
    let count = (finer.ceil() as usize).clamp(coarse, POINTS.1);
    let (below, above) = between(count)?;
    let corners = |k: u32| [2 * k, 2 * k + 1, 2 * k + 2, 2 * k + 3];
    let strip = (0..count as u32 - 1).map(corners).flat_map(|[a, b, c, d]| [[a, c, b], [b, c, d]]);
    let vertices = below.iter().zip(&above).flat_map(|(a, b)| [*a, *b]).collect();
    Some(Mesh::from_triangles(vertices, strip.collect()))
}

/// Distance of the strip's diagonals from the ruled surface, mm: a quarter of the difference between corresponding
/// steps.
fn twist(below: &[DVec3], above: &[DVec3]) -> f64 {
    let steps = below.windows(2).zip(above.windows(2));
    steps.map(|(a, b)| ((a[1] - a[0]) - (b[1] - b[0])).length() / 4.0).fold(0.0, f64::max)
}

/// A curve as a polyline in space.
fn spatial(curve: &Curve) -> Vec<DVec3> {
    let mut points: Vec<DVec3> = curve.parts.iter().flat_map(|part| part.points_by_chord(CHORD_MM)).collect();
    points.dedup_by(|a, b| a.distance(*b) < 1e-6);
    points
}

/// `count` points at equal distances along a curve, both ends among them; `None` for a curve without length.
fn evenly(curve: &Curve, count: usize) -> Option<Vec<DVec3>> {
    let points = spatial(curve);
    let mut lengths = vec![0.0];
    for pair in points.windows(2) {
        lengths.push(lengths[lengths.len() - 1] + pair[0].distance(pair[1]));
    }
    let total = *lengths.last().filter(|total| **total > LEVEL_MM)?;
    let place = |k: usize| {
        let at = total * k as f64 / (count - 1) as f64;
        let i = lengths.partition_point(|length| *length < at).clamp(1, points.len() - 1);
        points[i - 1].lerp(points[i], (at - lengths[i - 1]) / (lengths[i] - lengths[i - 1]))
    };
    Some((0..count).map(place).collect())
}

/// The points of the other edge reordered so that corresponding points are near each other: in the better direction,
/// and for a closed edge from the best start.
fn matched(below: &[DVec3], above: Vec<DVec3>, closed: bool) -> Vec<DVec3> {
    let apart = |points: &[DVec3]| below.iter().zip(points).map(|(a, b)| a.distance_squared(*b)).sum::<f64>();
    let backwards: Vec<DVec3> = above.iter().rev().copied().collect();
    let starts = if closed { above.len() - 1 } else { 1 };
    // The last point of a closed curve is its first one.
    let begun_at = |points: &[DVec3], start: usize| {
        let turned = (0..points.len()).map(|k| points[if closed { (k + start) % (points.len() - 1) } else { k }]);
        turned.collect::<Vec<_>>()
    };
    let ways = [above.clone(), backwards];
    let all = ways.iter().flat_map(|way| (0..starts).map(|start| begun_at(way, start)));
    all.min_by(|a, b| apart(a).total_cmp(&apart(b))).unwrap_or(above)
}
