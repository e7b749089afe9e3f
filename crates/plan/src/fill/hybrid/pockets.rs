//! The contours of an island from outside in, and the pockets that each would leave.
//!
//! A level P is moved in by 1.5 d and back out. Places that do not come back are narrower than 3 d or sharp corners:
//! these are its pockets. The distance is 1.5 d rather than d so that no gap narrower than d survives.

use crate::fill::FillSettings;
use glam::DVec2;
use planar::polyline::point_at;
use planar::{Bounds, Polygon, Region};

/// The kinds of pockets.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PocketKind {
    /// A level that vanishes entirely.
    Whole,
    /// A narrow place between wider ones.
    Channel,
    /// A blunt arm with a dead end.
    Arm,
    /// A sharp corner.
    Corner,
}

/// A place that contours would leave empty.
#[derive(Debug, Clone, PartialEq)]
pub struct Pocket {
    /// Its outline.
    pub shape: Polygon,
    /// What it is.
    pub kind: PocketKind,
    /// Length from its opening to its tip, mm; 0 for a whole level.
    pub length: f64,
    /// Whether it is kept, to be filled in its own way.
    pub kept: bool,
}

/// One contour inwards.
#[derive(Debug, Clone, PartialEq)]
pub struct Level {
    /// The region inside the contour of this level, P.
    pub region: Region,
    /// The contour that is laid: in the paper the backtracked level, by default the level less its kept pockets.
    pub contour: Region,
    /// The pockets.
    pub pockets: Vec<Pocket>,
}

/// A pocket that fills more than this fraction of the box over its opening is an arm.
const ARM: f64 = 0.55;
/// Arms shorter than this are left to the contour, in stepovers.
const SHORTEST_ARM: f64 = 0.5;
/// Most contours of a part; a guard, not a limit.
const MOST_LEVELS: usize = 100_000;

/// The levels from `outermost` inwards, until nothing is left.
pub fn levels(outermost: Region, settings: &FillSettings) -> Vec<Level> {
    let mut levels: Vec<Level> = Vec::new();
    let mut region = outermost;
    while !region.is_empty() && levels.len() < MOST_LEVELS {
        let mut level = level(region, settings);
        if !settings.hybrid.literal && levels.is_empty() {
            // The outermost contour defines the shape: no pocket cuts it.
            level.pockets.iter_mut().for_each(|pocket| pocket.kept = false);
            level.contour = level.region.clone();
        }
        // Offsets multiply vertices: those within a quarter of the tolerance are dropped.
        region = level.contour.offset(-settings.stepover, settings.hybrid.join());
        region = region.simplified(settings.hybrid.tolerance / 4.0);
        levels.push(level);
    }
    levels
}

fn level(region: Region, settings: &FillSettings) -> Level {
    let hybrid = &settings.hybrid;
    let (mut contour, mut pockets) = (Vec::new(), Vec::new());
    for piece in region.polygons() {
        let core = piece.offset(-hybrid.pocket_depth, settings.hybrid.join());
        if core.is_empty() {
            let kept = piece.area() >= hybrid.min_pocket_area;
            pockets.push(Pocket { shape: piece.clone(), kind: PocketKind::Whole, length: 0.0, kept });
            continue;
        }
        let whole = Region::from(piece.clone());
        let back = core.offset(hybrid.pocket_depth + hybrid.tolerance, settings.hybrid.join());
        let found: Vec<Pocket> = whole
            .difference(&back)
            .into_polygons()
            .into_iter()
            .filter(|shape| shape.area() >= hybrid.min_pocket_area)
            .map(|shape| classified(shape, &back, settings))
            .collect();
        let laid = if hybrid.literal { back.intersection(&whole) } else { less_kept(&whole, &found) };
        contour.extend(laid.into_polygons());
        pockets.extend(found);
    }
    Level { region, contour: Region::from_normalised(contour), pockets }
}

fn less_kept(whole: &Region, pockets: &[Pocket]) -> Region {
    let kept: Vec<Polygon> = pockets.iter().filter(|p| p.kept).map(|p| p.shape.clone()).collect();
    if kept.is_empty() { whole.clone() } else { whole.difference(&Region::from_normalised(kept)) }
}

/// Determines the kind of a pocket and whether it is kept: channels always, corners and arms above a certain length.
fn classified(shape: Polygon, back: &Region, settings: &FillSettings) -> Pocket {
    let hybrid = &settings.hybrid;
    let near = 3.0 * hybrid.tolerance;
    let edge = edge_near(&shape, back, near);
    // Two openings make a channel, whether they lead to two pieces or to one: a loop around a wide place.
    let openings = openings(&shape, &edge, near);
    let channel = openings.len() > 1;
    let length = length(&shape, &openings, &edge, settings);
    // A corner of any angle fills at most half the box over its opening, an arm nearly all of it.
    let opening = openings.iter().map(|line| chord(line)).fold(0.0, f64::max);
    let kind = match (channel, shape.area() > ARM * length * opening) {
        (true, _) => PocketKind::Channel,
        (false, true) => PocketKind::Arm,
        (false, false) => PocketKind::Corner,
    };
    // In the paper length alone decides. Sharp corners are filled better by contours than by infill, unless they are
    // long.
    let kept = match kind {
        PocketKind::Arm if !hybrid.literal => length >= SHORTEST_ARM * settings.stepover,
        PocketKind::Corner | PocketKind::Arm => length >= hybrid.min_pocket_length,
        PocketKind::Channel | PocketKind::Whole => true,
    };
    Pocket { shape, kind, length, kept }
}

/// The lines that a pocket shares with the backtracked level, each as points in order. An edge is shared if its middle
/// lies on that level: the ends of a channel's straight sides lie on it too.
fn openings(shape: &Polygon, edge: &[(DVec2, DVec2)], near: f64) -> Vec<Vec<DVec2>> {
    let mut openings = Vec::new();
    for ring in shape.rings() {
        let sides: Vec<(DVec2, DVec2)> = ring.edges().collect();
        let shared: Vec<bool> = sides.iter().map(|(a, b)| distance_to(edge, (*a + *b) / 2.0) <= near).collect();
        let n = sides.len();
        // Begin where a shared line begins.
        let Some(start) = (0..n).find(|&i| shared[i] && !shared[(i + n - 1) % n]) else { continue };
        let mut open: Vec<DVec2> = Vec::new();
        for i in (0..n).map(|k| (start + k) % n) {
            if !shared[i] {
                openings.extend((!open.is_empty()).then(|| std::mem::take(&mut open)));
                continue;
            }
            if open.is_empty() {
                open.push(sides[i].0);
            }
            open.push(sides[i].1);
        }
        openings.extend((!open.is_empty()).then_some(open));
    }
    openings
}

/// Length of a pocket, mm: from the middle of its opening to the point of its own outline that is most squarely in
/// front of the opening. The outline is sampled at its corners and evenly, at most a bead width apart.
fn length(shape: &Polygon, openings: &[Vec<DVec2>], edge: &[(DVec2, DVec2)], settings: &FillSettings) -> f64 {
    let near = 3.0 * settings.hybrid.tolerance;
    let Some(opening) = openings.iter().max_by(|a, b| span(a).total_cmp(&span(b))) else { return 0.0 };
    let (Some(&first), Some(&last)) = (opening.first(), opening.last()) else { return 0.0 };
    let middle = point_at(opening, span(opening) / 2.0).unwrap_or(first);
    let along = (last - first).normalize_or_zero();
    let own = shape.outer.edges().flat_map(|(a, b)| densified(a, b, settings.bead.width));
    let own = own.filter(|p| distance_to(edge, *p) > near);
    // The cosine of the angle to the opening is 0 where a vector is perpendicular to it.
    let slant = |p: &DVec2| (*p - middle).normalize_or_zero().dot(along).abs();
    let square = own.min_by(|a, b| slant(a).total_cmp(&slant(b)).then(far(middle, b).total_cmp(&far(middle, a))));
    square.map_or(0.0, |p| p.distance(middle))
}

fn far(from: DVec2, p: &DVec2) -> f64 {
    from.distance_squared(*p)
}

fn chord(line: &[DVec2]) -> f64 {
    line.first().zip(line.last()).map_or(0.0, |(a, b)| a.distance(*b))
}

fn span(line: &[DVec2]) -> f64 {
    planar::polyline::length(line)
}

fn densified(a: DVec2, b: DVec2, step: f64) -> impl Iterator<Item = DVec2> {
    let count = (a.distance(b) / step).ceil().max(1.0) as usize;
    (0..count).map(move |k| a.lerp(b, k as f64 / count as f64))
}

/// The part of a region's boundary near a shape.
fn edge_near(shape: &Polygon, region: &Region, near: f64) -> Vec<(DVec2, DVec2)> {
    let Some(bounds) = Bounds::of(shape.outer.points().iter().copied()) else { return Vec::new() };
    let (low, high) = (bounds.min - near, bounds.max + near);
    let beside = |(a, b): &(DVec2, DVec2)| a.min(*b).cmple(high).all() && a.max(*b).cmpge(low).all();
    region.rings().flat_map(|ring| ring.edges()).filter(beside).collect()
}

/// Distance from a point to the nearest of some edges, mm.
fn distance_to(edges: &[(DVec2, DVec2)], p: DVec2) -> f64 {
    let squared = edges.iter().map(|&(a, b)| planar::polyline::distance_squared_to_segment(p, a, b));
    squared.fold(f64::INFINITY, f64::min).sqrt()
}

/// The kept pockets merged into skeleton regions: grown by d, united, shrunk by d.
pub fn merge(levels: &[Level], outermost: &Region, settings: &FillSettings) -> Region {
    let kept: Vec<Polygon> =
        levels.iter().flat_map(|level| &level.pockets).filter(|p| p.kept).map(|p| p.shape.clone()).collect();
    // Pockets of neighbouring levels may touch; growing unites them.
    let grown = Region::from_rings(
        &kept.iter().flat_map(|p| p.rings().cloned()).collect::<Vec<_>>(),
        planar::FillRule::NonZero,
    )
    .offset(settings.stepover, settings.hybrid.join());
    let merged = grown.offset(-settings.stepover, settings.hybrid.join());
    if settings.hybrid.literal { merged } else { merged.intersection(outermost) }
}
