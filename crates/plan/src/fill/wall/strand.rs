//! Beads side by side: every edge becomes one or more strands, depending on its thickness.
//!
//! Together, n beads of width b with the overlap of the profile, stepover/width = q, are b (1 + (n − 1) q) wide. n is
//! the number that brings b nearest to the nominal width, and b follows the wall along the edge within the limits of
//! the process. Strands are edges of the graph of paths, so walls of one bead and of many join, and the same rules hold
//! for both.

use super::WallSettings;
use super::graph::{Edge, Graph};
use crate::fill::FillSettings;
use crate::fill::trails::{Dart, Network};
use glam::DVec2;
use planar::medial::Node;

/// Most beads side by side in a wall.
const MOST_BEADS: usize = 1000;
/// Widths are rounded to this fraction of a bead width, so that equal walls get equal beads.
const GRAIN: f64 = 0.01;

/// A point of a strand.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// Position, mm.
    pub at: DVec2,
    /// Bead width, mm.
    pub width: f64,
}

/// One bead along an edge.
#[derive(Debug, Clone, PartialEq)]
pub struct Strand {
    /// The edge that it belongs to.
    pub edge: usize,
    /// Its points, from the edge's first node to its last.
    pub points: Vec<Point>,
    /// Whether it lies alone on its edge.
    pub alone: bool,
    /// Whether it closes in itself without a junction.
    pub ring: bool,
}

/// The strands of all edges, and how they meet at the nodes.
pub fn strands(graph: &Graph, settings: &FillSettings) -> (Vec<Strand>, Network) {
    let degrees = graph.degrees();
    let mut strands = Vec::new();
    let mut stars: Vec<Vec<(Dart, (f64, f64))>> = vec![Vec::new(); graph.places.len()];
    for (number, edge) in graph.edges.iter().enumerate() {
        let count = beads(edge, settings);
        let reach = settings.wall.tolerance;
        let [out, back] = [true, false].map(|forward| edge.direction(forward, reach).to_angle());
        let ring = graph.is_ring(edge, &degrees);
        for j in 0..count {
            // From the right of the edge to the left; seen from its far end, the reverse.
            let side = j as f64 - (count - 1) as f64 / 2.0;
            let dart = 2 * strands.len();
            stars[edge.from].push((dart, (out, side)));
            stars[edge.to].push((dart + 1, (back, -side)));
            let points = beside(edge, side, count, ring, settings);
            strands.push(Strand { edge: number, points, alone: count == 1, ring });
        }
    }
    for star in &mut stars {
        star.sort_by(|(_, a), (_, b)| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    }
    let stars = stars.into_iter().map(|star| star.into_iter().map(|(dart, (angle, _))| (dart, angle)).collect());
    let network = Network { stars: stars.collect(), walls: strands.iter().map(|s| s.edge).collect() };
    (strands, network)
}

/// Number of beads across an edge, by its median thickness.
fn beads(edge: &Edge, settings: &FillSettings) -> usize {
    let mut thickness: Vec<f64> = edge.nodes.iter().map(|node| 2.0 * node.radius).collect();
    thickness.sort_by(f64::total_cmp);
    let thickness = thickness.get(thickness.len() / 2).copied().unwrap_or_default();
    let misfit = |n: usize| (width(thickness, n, settings) / settings.bead.width).ln().abs();
    let most = (thickness / settings.stepover).ceil().clamp(1.0, MOST_BEADS as f64) as usize;
    (1..=most + 1).min_by(|&a, &b| misfit(a).total_cmp(&misfit(b))).unwrap_or(1)
}

/// Width of each of `n` beads that fill a wall together, mm.
fn width(thickness: f64, n: usize, settings: &FillSettings) -> f64 {
    let covered = thickness + 2.0 * settings.machining_allowance;
    covered / (1.0 + (n - 1) as f64 * settings.stepover / settings.bead.width)
}

/// The strand `side` strands to the left of an edge's middle.
fn beside(edge: &Edge, side: f64, count: usize, ring: bool, settings: &FillSettings) -> Vec<Point> {
    let WallSettings { width_limits: (low, high), .. } = settings.wall;
    let (q, grain) = (settings.stepover / settings.bead.width, GRAIN * settings.bead.width);
    let point = |(i, node): (usize, &Node)| {
        let exact = width(2.0 * node.radius, count, settings);
        let width = ((exact / grain).round() * grain).clamp(low, high);
        Point { at: node.at + way(&edge.nodes, i, ring).perp() * side * q * exact, width }
    };
    let points: Vec<Point> = edge.nodes.iter().enumerate().map(point).collect();
    simplified(&points, settings.wall.chord_error / 3.0)
}

/// Drops points that are not needed within `tolerance` (mm), along sections of one width.
fn simplified(points: &[Point], tolerance: f64) -> Vec<Point> {
    let mut kept = Vec::with_capacity(points.len());
    for stretch in points.chunk_by(|a, b| a.width == b.width) {
        let line: Vec<DVec2> = stretch.iter().map(|point| point.at).collect();
        let width = stretch.first().map_or(0.0, |point| point.width);
        kept.extend(planar::polyline::simplify(&line, tolerance).into_iter().map(|at| Point { at, width }));
    }
    kept
}

/// The direction of a line at a node: the mean of the directions before and after it.
fn way(nodes: &[Node], i: usize, ring: bool) -> DVec2 {
    let last = nodes.len() - 1;
    let before = if i > 0 {
        i - 1
    } else if ring {
        last - 1
    } else {
        0
    };
    let behind = if i < last {
        i + 1
    } else if ring {
        1.min(last)
    } else {
        last
    };
    let unit = |a: usize, b: usize| (nodes[b].at - nodes[a].at).normalize_or_zero();
    (unit(before, i) + unit(i, behind)).normalize_or(DVec2::X)
}
