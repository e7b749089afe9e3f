//! Cells that are nearly convex, each with a zigzag in its own direction, inside perimeters (Ding et al. 2014, The
//! International Journal of Advanced Manufacturing Technology 73).
//!
//! The core is cut at its deepest notch, across the shortest distance, until no cell has a notch deeper than a bead width:
//! cutting at every notch (the paper's parts have straight sides) would leave slivers along curves. Beads lie along the greatest
//! width of a cell, so that it takes the fewest. The paper joins the cells into one closed path; here each has its own arc
//! start, and they are counted.

use super::compound::within_perimeters;
use super::{Fill, FillSettings, Path, Strategy, thin, zigzag};
use glam::DVec2;
use planar::nearest::foot;
use planar::{Polygon, Region, Ring, buffer, convex_hull, polyline};
use std::cmp::Ordering::Equal;

/// Zigzags in convex cells.
pub struct Partition;

/// Notches shallower than this many bead widths are left uncut.
const SHALLOW: f64 = 1.0;
/// Cuts begin and end this far outside, mm.
const HAIR_MM: f64 = 1e-3;
/// Cuts must be longer than this, in stepovers: on a curve the nearest points lie on the curve itself.
const SHORTEST_CUT: f64 = 0.5;
/// Edges run along a direction if they deviate by at most this much, rad.
const PARALLEL: f64 = 0.01;
/// Accuracy of the ends of cuts, in bead widths.
const ACCURACY: f64 = 0.01;

impl Strategy for Partition {
    fn name(&self) -> &'static str {
        "partition"
    }

    fn fill(&self, island: &Polygon, settings: &FillSettings) -> Fill {
        thin::around(island, settings, thick)
    }
}

fn thick(part: &Polygon, settings: &FillSettings) -> Fill {
    within_perimeters(part, settings, |core| {
        cells(core, settings).into_iter().flat_map(|cell| lines_along(cell, settings)).collect()
    })
}

/// The cells, with a stepover between neighbours.
fn cells(core: &Region, settings: &FillSettings) -> Vec<Polygon> {
    let (d, w) = (settings.stepover, settings.bead.width);
    let (mut left, mut cells) = (core.polygons().to_vec(), Vec::new());
    while let Some(cell) = left.pop() {
        let notch = deepest_notch(&cell, SHALLOW * w);
        let Some(cut) = notch.and_then(|notch| shortest_cut(&cell, notch, SHORTEST_CUT * d)) else {
            cells.push(cell);
            continue;
        };
        let cut = buffer(&[cut.to_vec()], false, d / 2.0, ACCURACY * w);
        left.extend(Region::from(cell).difference(&cut).into_polygons());
    }
    cells
}

/// A zigzag in the direction in which a cell takes the fewest lines; among equals, the one with the most outline along
/// it.
fn lines_along(cell: Polygon, settings: &FillSettings) -> Vec<Path> {
    let hull = Ring::new(convex_hull(cell.outer.points()));
    let ways = hull.edges().chain(cell.outer.edges()).filter_map(|(a, b)| (b - a).try_normalize());
    let lines = |way: DVec2| {
        let heights = hull.points().iter().map(|p| way.perp_dot(*p));
        let (low, high) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), y| (l.min(y), h.max(y)));
        ((high - low) / settings.stepover).ceil()
    };
    let beside = |way: DVec2| {
        let edges = cell.outer.edges().map(|(a, b)| b - a);
        edges.filter(|edge| way.perp_dot(*edge).abs() < PARALLEL * edge.length()).map(DVec2::length).sum::<f64>()
    };
    let fewest = ways
        .map(|way| (lines(way), -beside(way), way))
        .min_by(|a, b| (a.0, a.1).partial_cmp(&(b.0, b.1)).unwrap_or(Equal));
    let raster_angle = fewest.map_or(0.0, |(.., way)| way.to_angle());
    zigzag::zigzag(&cell.into(), &FillSettings { raster_angle, ..*settings })
}

/// The point of a cell's outline that lies deepest inside its hull, if deeper than `shallow` (mm); any point of a hole
/// counts as deep enough.
fn deepest_notch(cell: &Polygon, shallow: f64) -> Option<DVec2> {
    if let Some(hole) = cell.holes.first() {
        // Where the hole is nearest to the outline, so that the cut is short.
        let apart =
            |p: &&DVec2| cell.outer.edges().map(|edge| foot(edge, **p).distance(**p)).fold(f64::INFINITY, f64::min);
        return hole.points().iter().min_by(|a, b| apart(a).total_cmp(&apart(b))).copied();
    }
    let hull = Ring::new(convex_hull(cell.outer.points()));
    let depth = |p: &DVec2| {
        let squares = hull.edges().map(|(a, b)| polyline::distance_squared_to_segment(*p, a, b));
        squares.fold(f64::INFINITY, f64::min).sqrt()
    };
    let deepest = cell.outer.points().iter().map(|p| (*p, depth(p))).max_by(|a, b| a.1.total_cmp(&b.1))?;
    (deepest.1 > shallow).then_some(deepest.0)
}

/// The shortest straight cut through a cell from a point of its outline that is longer than `shortest` (mm), slightly
/// lengthened at both ends.
fn shortest_cut(cell: &Polygon, from: DVec2, shortest: f64) -> Option<[DVec2; 2]> {
    let edges: Vec<_> = cell.rings().flat_map(Ring::edges).collect();
    let mut feet: Vec<DVec2> = edges.iter().map(|edge| foot(*edge, from)).collect();
    feet.retain(|to| to.distance(from) > shortest);
    feet.sort_by(|a, b| a.distance_squared(from).total_cmp(&b.distance_squared(from)));
    let inside = |to: &&DVec2| {
        let (start, end) = (from.lerp(**to, 1e-4), to.lerp(from, 1e-4));
        cell.contains(start)
            && cell.contains(from.midpoint(**to))
            && !edges.iter().any(|edge| cross(*edge, (start, end)))
    };
    let to = feet.iter().find(inside)?;
    let hair = (*to - from).normalize_or_zero() * HAIR_MM;
    Some([from - hair, *to + hair])
}

/// Whether two segments cross.
fn cross((a, b): (DVec2, DVec2), (c, d): (DVec2, DVec2)) -> bool {
    let side = |p: DVec2, q: DVec2, r: DVec2| (q - p).perp_dot(r - p);
    side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0
}
