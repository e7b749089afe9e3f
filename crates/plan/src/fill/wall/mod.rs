//! Thin walls along their middle (Li et al., section 2.2): few continuous paths that never cross.
//!
//! | step | file |
//! | --- | --- |
//! | the medial axis without corner branches, cut at corners | [`centre`] |
//! | a graph of nodes and edges | [`graph`] |
//! | edges extended straight into their nodes, and smoothed by fitting | [`smooth`] |
//! | one bead or more along every edge, by its thickness | [`strand`] |
//! | the fewest trails that lay all strands and never cross | [`trails`] |
//! | corners rounded, junctions touched and left, ends held back | [`rounding`] |
//!
//! Every second layer runs all paths backwards, the last one first: it starts where the layer below ended.
//!
//! With one bead everywhere, a graph needs max(1, odd/2) arc starts per layer (odd: number of nodes where an odd number
//! of edges meet), the fewest possible. Where beads lie side by side, a path never turns from one into its neighbour to
//! save an arc start, except at the end of a wall: that would lay two hairpins next to each other.

pub mod centre;
pub mod graph;
pub mod rounding;
pub mod smooth;
pub mod strand;

use super::trails;
use super::{Fill, FillSettings, PassKind, Path, Strategy};
use crate::pass::Along;
use glam::DVec2;
use graph::{Graph, Line};
use planar::Polygon;
use rounding::Rounded;

/// Beads along the middle of walls.
pub struct Wall;

/// How walls are laid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WallSettings {
    /// Ends and crossings nearer than this become one junction, mm.
    pub tolerance: f64,
    /// Greatest distance of the centre-line from the medial axis, mm.
    pub chord_error: f64,
    /// Radius of corners, in bead widths.
    pub corner_radius: f64,
    /// Distance from a junction of paths that touch there, in bead widths.
    pub junction_gap: f64,
    /// Distance of an end at a junction from the paths that run through it, in bead widths.
    pub end_gap: f64,
    /// The narrowest and the widest bead of the process, mm.
    pub width_limits: (f64, f64),
    /// Walls of solids thinner than this get no bead, mm.
    pub thinnest: f64,
}

/// Samples of the medial axis per bead width.
const SAMPLES: f64 = 20.0;

impl Strategy for Wall {
    fn name(&self) -> &'static str {
        "wall"
    }

    fn fill(&self, island: &Polygon, settings: &FillSettings) -> Fill {
        let lines = centre::lines(island, settings.bead.width / SAMPLES);
        along(&lines, settings)
    }

    fn narrowest(&self, settings: &FillSettings) -> f64 {
        settings.wall.width_limits.0
    }

    fn welds_thin_walls(&self) -> bool {
        true
    }
}

/// The smooth graph of centre-lines.
pub fn smooth_graph(lines: &[Line], settings: &FillSettings) -> Graph {
    let mut graph = Graph::of(lines, settings.wall.tolerance);
    smooth::straighten(&mut graph);
    // A third of the error for the curve, a third for its chords, a third for points dropped later.
    smooth::fit(&mut graph, settings.wall.chord_error / 3.0);
    graph
}

/// The passes along centre-lines.
pub fn along(lines: &[Line], settings: &FillSettings) -> Fill {
    let graph = smooth_graph(lines, settings);
    let (strands, network) = strand::strands(&graph, settings);
    let trails = trails::trails(&network);
    let paths = rounding::paths(&strands, &network, &trails, &settings.wall);
    let mut passes: Vec<Path> = in_order(paths).into_iter().map(pass).collect();
    if settings.layer % 2 == 1 {
        passes.reverse();
        passes.iter_mut().for_each(reverse);
    }
    Fill { stages: vec![passes], fixed_order: true }
}

/// Puts each path next to the end of the previous one; closed ones run counter-clockwise.
fn in_order(mut paths: Vec<Rounded>) -> Vec<Rounded> {
    paths.retain(|path| path.points.len() >= 2);
    let ring = |path: &Rounded| planar::Ring::new(path.points.iter().map(|p| p.at).collect()).area();
    for path in paths.iter_mut().filter(|path| path.closed && ring(path) < 0.0) {
        path.points[1..].reverse();
    }
    let mut ordered: Vec<Rounded> = Vec::with_capacity(paths.len());
    while !paths.is_empty() {
        let torch = ordered.last().and_then(|path| if path.closed { path.points.first() } else { path.points.last() });
        let distance = |at: Option<&strand::Point>| match (torch, at) {
            (Some(torch), Some(point)) => torch.at.distance_squared(point.at),
            _ => 0.0,
        };
        let near = |path: &Rounded| {
            let (start, end) = (distance(path.points.first()), distance(path.points.last()));
            if path.closed || start <= end { (start, false) } else { (end, true) }
        };
        let nearest = (0..paths.len()).min_by(|&a, &b| near(&paths[a]).0.total_cmp(&near(&paths[b]).0)).unwrap_or(0);
        let backwards = near(&paths[nearest]).1;
        let mut path = paths.remove(nearest);
        if backwards {
            path.points.reverse();
        }
        ordered.push(path);
    }
    ordered
}

/// The path as a pass; from one point to the next the mean of their widths applies.
fn pass(path: Rounded) -> Path {
    let points: Vec<DVec2> = path.points.iter().map(|p| p.at).collect();
    let mut widths: Vec<f64> = path.points.iter().map(|p| p.width).collect();
    let first = widths.first().copied().unwrap_or_default();
    let width = if widths.iter().all(|&width| width == first) {
        Along::Same(first)
    } else {
        let next: Vec<f64> = widths.iter().copied().cycle().skip(1).take(widths.len()).collect();
        let count = if path.closed { widths.len() } else { widths.len().saturating_sub(1) };
        widths.iter_mut().zip(next).take(count).for_each(|(width, next)| *width = (*width + next) / 2.0);
        Along::Each(widths)
    };
    Path { kind: PassKind::Wall, closed: path.closed, points, width, reversible: false }
}

/// The pass run backwards, from the same point if it is closed.
fn reverse(pass: &mut Path) {
    if !pass.closed {
        pass.points.reverse();
        pass.width.reverse();
        return;
    }
    pass.points[1..].reverse();
    if let Along::Each(widths) = &mut pass.width {
        widths.reverse();
    }
}
