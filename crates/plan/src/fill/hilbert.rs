//! A Hilbert curve (Hilbert 1891) inside perimeters: short moves in all directions, so that heat spreads evenly.
//!
//! The steps of the curve are one stepover long. Where the edge of the core cuts it, its pieces are joined along that edge,
//! the shortest links first, as slicers do.

use super::compound::within_perimeters;
use super::line_index::LineIndex;
use super::{Fill, FillSettings, PassKind, Path, Strategy, thin};
use glam::{DVec2, IVec2};
use planar::clip::Keep;
use planar::nearest::foot;
use planar::{Polygon, Region, Ring};

/// A Hilbert curve.
pub struct Hilbert;

/// Pieces are joined along the boundary over at most this many stepovers.
const LONGEST_LINK: f64 = 4.0;
/// The curve has at most 2 to this power steps along a side.
const MOST_HALVINGS: u32 = 20;

impl Strategy for Hilbert {
    fn name(&self) -> &'static str {
        "hilbert"
    }

    fn fill(&self, island: &Polygon, settings: &FillSettings) -> Fill {
        thin::around(island, settings, |part, settings| within_perimeters(part, settings, |core| lines(core, settings)))
    }
}

fn lines(core: &Region, settings: &FillSettings) -> Vec<Path> {
    let pieces = curve(core, settings).iter().flat_map(|run| core.clip_line(run, Keep::Inside)).collect();
    let lines = joined(pieces, core, LONGEST_LINK * settings.stepover).into_iter();
    lines.map(|points| Path::line(PassKind::Infill, points, settings.bead.width)).collect()
}

/// The runs of the curve within the bounding box of a region and one step beyond.
fn curve(region: &Region, settings: &FillSettings) -> Vec<Vec<DVec2>> {
    let Some(bounds) = region.bounds() else { return Vec::new() };
    let d = settings.stepover;
    let cell = |p: DVec2| ((p - settings.datum) / d).floor().as_ivec2();
    let (low, high) = (cell(bounds.min) - 1, cell(bounds.max) + 1);
    // The same curve on all layers and for all islands: its square is centred on the datum.
    let reach = low.abs().max(high.abs()).max_element().unsigned_abs() + 1;
    let halvings = reach.next_power_of_two().trailing_zeros().min(MOST_HALVINGS) + 1;
    let half = 1 << (halvings - 1);
    let mut walk = Walk { low, high, runs: vec![Vec::new()] };
    walk.square(IVec2::splat(-half), IVec2::new(2 * half, 0), IVec2::new(0, 2 * half));
    let place = |cell: &IVec2| settings.datum + (cell.as_dvec2() + 0.5) * d;
    walk.runs.iter().filter(|run| run.len() > 1).map(|run| run.iter().map(place).collect()).collect()
}

/// Walks along the curve through the cells of a box.
struct Walk {
    low: IVec2,
    high: IVec2,
    runs: Vec<Vec<IVec2>>,
}

impl Walk {
    /// Walks through a square from its corner `at` to the other end of side `x`.
    fn square(&mut self, at: IVec2, x: IVec2, y: IVec2) {
        // The cells of a square extend from one corner along both sides.
        let (a, b) = (at.min(at + x).min(at + y).min(at + x + y), at.max(at + x).max(at + y).max(at + x + y) - 1);
        if b.cmplt(self.low).any() || a.cmpgt(self.high).any() {
            // The curve leaves the box here.
            if self.runs.last().is_some_and(|run| !run.is_empty()) {
                self.runs.push(Vec::new());
            }
            return;
        }
        if a == b {
            self.runs.extend(self.runs.is_empty().then(Vec::new));
            if let Some(run) = self.runs.last_mut() {
                run.push(a);
            }
            return;
        }
        let (u, v) = (x / 2, y / 2);
        self.square(at, v, u);
        self.square(at + v, u, v);
        self.square(at + u + v, u, v);
        self.square(at + x + v, -v, -u);
    }
}

/// An end of a piece on the boundary: the piece, whether it is its last point, the ring, and the distance along the
/// ring, mm.
#[derive(Debug, Clone, Copy)]
struct End {
    piece: usize,
    last: bool,
    ring: usize,
    along: f64,
}

/// The end to which another is linked (piece, whether its last point), and the path to it.
type Link = (usize, bool, Vec<DVec2>);

/// Joins pieces of lines whose ends lie on the boundary of a region along that boundary; no third end lies between the
/// two ends that a link joins.
fn joined(pieces: Vec<Vec<DVec2>>, region: &Region, longest: f64) -> Vec<Vec<DVec2>> {
    let rings: Vec<&Ring> = region.rings().collect();
    let mut links = links(&pieces, &rings, longest);
    links.sort_by(|a, b| a.2.total_cmp(&b.2));
    // For each end, what it is linked to, with the path there.
    let mut linked: Vec<[Option<Link>; 2]> = vec![[None, None]; pieces.len()];
    let mut group: Vec<usize> = (0..pieces.len()).collect();
    for (from, to, length) in links {
        let taken = |end: &End| linked[end.piece][usize::from(end.last)].is_some();
        if taken(&from) || taken(&to) || group[from.piece] == group[to.piece] {
            continue;
        }
        let way = between(rings[from.ring], from.along, length);
        let (new, old) = (group[from.piece], group[to.piece]);
        group.iter_mut().filter(|g| **g == old).for_each(|g| *g = new);
        linked[to.piece][usize::from(to.last)] = Some((from.piece, from.last, way.iter().rev().copied().collect()));
        linked[from.piece][usize::from(from.last)] = Some((to.piece, to.last, way));
    }
    let mut lines = Vec::new();
    let mut done = vec![false; pieces.len()];
    for start in 0..pieces.len() {
        let Some(first) = [false, true].into_iter().find(|end| linked[start][usize::from(*end)].is_none()) else {
            continue;
        };
        if done[start] {
            continue;
        }
        let (mut line, mut piece, mut entry) = (Vec::new(), start, first);
        loop {
            done[piece] = true;
            let points = pieces[piece].iter().copied();
            if entry {
                line.extend(points.rev())
            } else {
                line.extend(points)
            }
            let Some((next, end, way)) = &linked[piece][usize::from(!entry)] else { break };
            line.extend(way);
            (piece, entry) = (*next, *end);
        }
        line.dedup_by(|a, b| a.distance_squared(*b) < 1e-8);
        lines.push(line);
    }
    lines
}

/// Every pair of consecutive ends along a ring, and their distance along the ring, mm.
fn links(pieces: &[Vec<DVec2>], rings: &[&Ring], longest: f64) -> Vec<(End, End, f64)> {
    let mut near = LineIndex::new(longest);
    let closed = |ring: &Ring| ring.points().iter().chain(ring.points().first()).copied().collect::<Vec<_>>();
    rings.iter().enumerate().for_each(|(number, ring)| near.add_line(number, &closed(ring)));
    let starts: Vec<Vec<f64>> = rings.iter().map(|ring| starts(ring)).collect();
    let mut on: Vec<Vec<End>> = vec![Vec::new(); rings.len()];
    for (piece, points) in pieces.iter().enumerate() {
        for (last, p) in [(false, points.first()), (true, points.last())] {
            let Some(&p) = p else { continue };
            let feet = near.near(p).map(|(ring, edge, a, b)| (ring, edge, a, foot((a, b), p)));
            let Some((ring, edge, a, foot)) = feet.min_by(|a, b| a.3.distance(p).total_cmp(&b.3.distance(p))) else {
                continue;
            };
            // Ends of the curve inside the region are cut off by the box.
            if foot.distance(p) < 1e-3 {
                on[ring].push(End { piece, last, ring, along: starts[ring][edge] + a.distance(foot) });
            }
        }
    }
    let mut links = Vec::new();
    for (ring, ends) in on.iter_mut().enumerate() {
        ends.sort_by(|a, b| a.along.total_cmp(&b.along));
        let next = ends.iter().cycle().skip(1);
        let length = rings[ring].length();
        let pairs = ends.iter().zip(next).map(|(a, b)| (*a, *b, (b.along - a.along).rem_euclid(length)));
        links.extend(pairs.filter(|(.., apart)| *apart <= longest));
    }
    links
}

/// Distance of each point of a ring from its first, mm.
fn starts(ring: &Ring) -> Vec<f64> {
    let sums = ring.edges().scan(0.0, |sum, (a, b)| {
        let start = *sum;
        *sum += a.distance(b);
        Some(start)
    });
    sums.collect()
}

/// The corners of a ring between a position along it and one `length` further on.
fn between(ring: &Ring, from: f64, length: f64) -> Vec<DVec2> {
    let (whole, starts) = (ring.length(), starts(ring));
    let mut found: Vec<(f64, DVec2)> =
        starts.iter().zip(ring.points()).map(|(s, p)| ((s - from).rem_euclid(whole), *p)).collect();
    found.retain(|(ahead, _)| *ahead < length);
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    found.into_iter().map(|(_, p)| p).collect()
}
