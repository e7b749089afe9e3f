//! Whether the passes of an island can be welded: they stay inside it and do not cross each other.
//!
//! Every fill is checked, whichever strategy made it, so that a faulty strategy never reaches a robot.

use super::Path;
use glam::DVec2;
use planar::Polygon;
use planar::boxes::{Boxes, Piece};
use planar::polyline::distance_squared_to_segment;
use std::cmp::Ordering;
use std::collections::BTreeMap;
use std::f64::consts::TAU;

/// Centre-lines may leave the outline by this much, mm: coordinates are rounded.
pub const TOLERANCE_MM: f64 = 0.01;

/// Points nearer to each other, mm, are one: programs have no finer resolution.
const FINEST_MM: f64 = 1e-3;

/// A piece of a path: number of the path, number of the piece in it.
type Number = (usize, usize);

/// What is wrong with the passes of an island.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Fault {
    /// A centre-line leaves the island.
    Outside {
        /// Where, mm.
        place: DVec2,
        /// By how much, mm.
        by: f64,
    },
    /// Two passes cross, or one crosses itself.
    Crossing {
        /// Where, mm.
        place: DVec2,
    },
}

/// The first fault of an island's passes; centre-lines may lie outside by `allowance`, mm. `None` if they are sound.
///
/// ```
/// use bead_plan::fill::Path;
/// use bead_plan::fill::sound::{Fault, fault};
/// use planar::{DVec2, Polygon, Ring};
///
/// let island = Polygon::simple(Ring::new([(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0)].map(DVec2::from).to_vec()));
/// let contour = |corners: [(f64, f64); 4]| Path::contour(Ring::new(corners.map(DVec2::from).to_vec()), 2.0);
/// let square = contour([(1.0, 1.0), (9.0, 1.0), (9.0, 9.0), (1.0, 9.0)]);
/// assert_eq!(fault(&[&square], &island, 0.0), None);
/// let hourglass = contour([(1.0, 1.0), (9.0, 9.0), (9.0, 1.0), (1.0, 9.0)]);
/// assert_eq!(fault(&[&hourglass], &island, 0.0), Some(Fault::Crossing { place: DVec2::splat(5.0) }));
/// ```
pub fn fault(paths: &[&Path], island: &Polygon, allowance: f64) -> Option<Fault> {
    let lines: Vec<Vec<DVec2>> = paths.iter().map(|path| path.path()).collect();
    if let Some(&place) = lines.iter().flatten().find(|p| !p.is_finite()) {
        return Some(Fault::Outside { place, by: f64::INFINITY });
    }
    let edges: Vec<Piece> = island.rings().flat_map(|ring| ring.edges()).map(|(a, b)| [a, b]).collect();
    let (numbers, laid) = pieces(&lines);
    let boxes = Boxes::new([edges.as_slice(), &laid].concat());
    let (mut cuts, mut found): (BTreeMap<Number, Vec<f64>>, Vec<_>) = (BTreeMap::new(), Vec::new());
    boxes.pairs(|i, j| match (i.checked_sub(edges.len()), j.checked_sub(edges.len())) {
        (None, None) => {}
        (Some(i), Some(j)) => found.extend(crossing(&lines, numbers[i], numbers[j])),
        (Some(piece), None) => note(&mut cuts, numbers[piece], cut(laid[piece], edges[j])),
        (None, Some(piece)) => note(&mut cuts, numbers[piece], cut(laid[piece], edges[i])),
    });
    let inside = |p: DVec2| boxes.inside(p, edges.len());
    outside(&lines, &cuts, &edges, inside, allowance)
        .or_else(|| first(found).map(|Crossing { place, .. }| Fault::Crossing { place }))
}

fn note(cuts: &mut BTreeMap<Number, Vec<f64>>, piece: Number, cut: Option<f64>) {
    if let Some(cut) = cut {
        cuts.entry(piece).or_default().push(cut);
    }
}

/// The point where a path is farthest outside.
fn outside(
    lines: &[Vec<DVec2>],
    cuts: &BTreeMap<Number, Vec<f64>>,
    edges: &[Piece],
    inside: impl Fn(DVec2) -> bool,
    allowance: f64,
) -> Option<Fault> {
    let square =
        |p: DVec2| edges.iter().map(|&[a, b]| distance_squared_to_segment(p, a, b)).fold(f64::INFINITY, f64::min);
    let by = |p: DVec2| if inside(p) { 0.0 } else { square(p).sqrt() };
    let suspects = lines.iter().enumerate().flat_map(|(number, line)| {
        // A path that crosses no edge is inside if its first point is.
        let crosses = cuts.range((number, 0)..(number + 1, 0)).next().is_some();
        let pieces = if crosses { line.len() } else { 0 };
        let cuts = move |k: usize| cuts.get(&(number, k)).map_or(&[][..], Vec::as_slice);
        let near = line.windows(2).enumerate().take(pieces).flat_map(move |(k, w)| places(w[0], w[1], cuts(k)));
        line.first().copied().into_iter().chain(near)
    });
    let worst = suspects.map(|p| (p, by(p))).max_by(|a, b| a.1.total_cmp(&b.1))?;
    (worst.1 > allowance.max(0.0) + TOLERANCE_MM).then_some(Fault::Outside { place: worst.0, by: worst.1 })
}

/// Points at which a piece may be farthest outside: between two cuts it lies either inside or outside, and a piece
/// without cuts is like its ends.
fn places(from: DVec2, to: DVec2, cuts: &[f64]) -> Vec<DVec2> {
    if cuts.is_empty() {
        return vec![to];
    }
    let mut ends: Vec<f64> = cuts.iter().copied().chain([0.0, 1.0]).collect();
    ends.sort_by(f64::total_cmp);
    let between = |w: &[f64]| {
        let count = ((w[1] - w[0]) * from.distance(to) / SAMPLE_MM).ceil().clamp(LEAST_SAMPLES, MOST_SAMPLES);
        (0..=count as usize).map(move |k| w[0] + (w[1] - w[0]) * k as f64 / count).collect::<Vec<_>>()
    };
    ends.windows(2).flat_map(between).map(|t| from.lerp(to, t)).collect()
}

/// The fraction of a piece at which it crosses an edge.
fn cut([p, q]: Piece, [r, s]: Piece) -> Option<f64> {
    let (u, v) = (q - p, s - r);
    let across = u.perp_dot(v);
    let (t, w) = ((r - p).perp_dot(v) / across, (r - p).perp_dot(u) / across);
    let on = |x: f64| (0.0..=1.0).contains(&x);
    (across != 0.0 && on(t) && on(w)).then_some(t)
}

/// Distance between the points at which a piece near the outline is checked, mm.
const SAMPLE_MM: f64 = 0.25;
/// Least and greatest number of points at which a piece between two crossings is checked.
const LEAST_SAMPLES: f64 = 8.0;
const MOST_SAMPLES: f64 = 4000.0;

/// Where lines cross an earlier line, or an earlier piece of themselves: indices of both lines, and the point, mm.
/// Neighbouring pieces, and lines that only touch, do not count.
pub fn crossings(lines: &[Vec<DVec2>]) -> impl Iterator<Item = (usize, usize, DVec2)> {
    let mut found = crossing_pieces(lines);
    found.sort_by(by_line);
    found.into_iter().map(|Crossing { pieces: [(i, _), (j, _)], place }| (i, j, place))
}

/// The same with the numbers of the pieces, in no order.
pub(super) fn crossing_pieces(lines: &[Vec<DVec2>]) -> Vec<Crossing> {
    let (numbers, pieces) = pieces(lines);
    let mut found = Vec::new();
    let boxes = Boxes::new(pieces);
    boxes.pairs(|i, j| found.extend(crossing(lines, numbers[i], numbers[j])));
    found
}

/// Where two pieces cross.
pub(super) struct Crossing {
    /// The pieces: indices of their lines, the higher one first, and of the pieces in them.
    pub(super) pieces: [Number; 2],
    place: DVec2,
}

fn by_line(a: &Crossing, b: &Crossing) -> Ordering {
    let lines = |crossing: &Crossing| crossing.pieces.map(|(line, _)| line);
    lines(a).cmp(&lines(b)).then(a.place.x.total_cmp(&b.place.x)).then(a.place.y.total_cmp(&b.place.y))
}

fn first(found: Vec<Crossing>) -> Option<Crossing> {
    found.into_iter().min_by(by_line)
}

/// The pieces of some lines with their numbers; those that are not finite are left out.
fn pieces(lines: &[Vec<DVec2>]) -> (Vec<Number>, Vec<Piece>) {
    let of = |(i, line): (usize, &'_ Vec<DVec2>)| {
        let numbered = line.windows(2).enumerate().map(move |(k, w)| ((i, k), [w[0], w[1]]));
        numbered.filter(|(_, [a, b])| a.is_finite() && b.is_finite()).collect::<Vec<_>>()
    };
    lines.iter().enumerate().flat_map(of).unzip()
}

/// Where two pieces cross, or where their lines cross at an end of a piece; neighbours on one line do not count.
fn crossing(lines: &[Vec<DVec2>], (i, k): Number, (j, l): Number) -> Option<Crossing> {
    /// A point nearer than this to an end of a piece, in its lengths, is at the end.
    const AT_END: f64 = 1e-6;
    if (j, l) > (i, k) {
        return crossing(lines, (j, l), (i, k));
    }
    if j == i && l + 1 >= k {
        return None;
    }
    let (p, r) = (lines[i][k], lines[j][l]);
    let (u, v) = (lines[i][k + 1] - p, lines[j][l + 1] - r);
    let across = u.perp_dot(v);
    let (t, w) = ((r - p).perp_dot(v) / across, (r - p).perp_dot(u) / across);
    let meet = [t, w].iter().all(|x| (-AT_END..1.0 + AT_END).contains(x));
    if across == 0.0 || !meet {
        return None;
    }
    let place = p + u * t;
    let through = || {
        let (one, other) = (Bend::of(&lines[i], k, place)?, Bend::of(&lines[j], l, place)?);
        // Checked both ways, because the result would depend on the direction in which a line is traversed.
        (one.is_crossed_by(&other) && other.is_crossed_by(&one)).then_some(())
    };
    // Distance of the ends of each piece from the line of the other: almost 0 where they run along each other.
    let sine = across.abs() / (u.length() * v.length());
    let inner = [(t, u), (w, v)].iter().all(|(x, way)| x.min(1.0 - x) * way.length() * sine > FINEST_MM);
    (inner || through().is_some()).then_some(Crossing { pieces: [(i, k), (j, l)], place })
}

/// The directions in which a line leaves a place on it, backwards and forwards.
struct Bend([DVec2; 2]);

impl Bend {
    /// The bend at a piece of the line; `None` at an end of the line.
    fn of(line: &[DVec2], piece: usize, place: DVec2) -> Option<Self> {
        let closed = line.first() == line.last();
        let points = line.len() - usize::from(closed);
        // How far around a closed line.
        let (before, after) = if closed { (points, points) } else { (piece + 1, points - piece - 1) };
        let away = |p: DVec2| (p.distance_squared(place) > TOLERANCE_MM * TOLERANCE_MM).then(|| p - place);
        let back = (0..before).find_map(|n| away(line[(piece + points - n) % points]))?;
        let on = (0..after).find_map(|n| away(line[(piece + 1 + n) % points]))?;
        Some(Self([back, on]))
    }

    /// Whether another line goes from one side of this one to the other.
    fn is_crossed_by(&self, other: &Self) -> bool {
        let from_back = |way: DVec2| self.0[0].angle_to(way).rem_euclid(TAU);
        let on = from_back(self.0[1]);
        let [a, b] = other.0.map(from_back);
        // Lines that leave in the same direction overlap, so neither side is known.
        let beside = |way: DVec2| {
            self.0.iter().all(|own| {
                own.dot(way) < 0.0 || own.perp_dot(way).abs() > FINEST_MM.min(0.01 * way.length()) * own.length()
            })
        };
        other.0.into_iter().all(beside) && (a < on) != (b < on)
    }
}
