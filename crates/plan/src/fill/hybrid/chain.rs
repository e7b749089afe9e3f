//! Contours joined into few passes.
//!
//! Complete contours are joined from outside in: each is opened at its seam and connected to the next by an oblique
//! link of about 45°. Incomplete ones are joined from inside out: the end of a piece is connected to the nearest end of
//! a piece one level away. A link stays inside the outline and crosses nothing.

use super::contours::{Contours, Piece};
use crate::fill::line_index::LineIndex;
use crate::fill::{FillSettings, Path};
use crate::pass::PassKind;
use glam::DVec2;
use planar::polyline::{point_at, without_end};
use planar::{Region, Ring};

/// Maximum length of a link between rings, in stepovers: 45° across one stepover gives 1.41, and corners need more.
const LONGEST_RING_LINK: f64 = 2.2;
/// Maximum length of a link between the ends of pieces, in stepovers.
const LONGEST_END_LINK: f64 = 3.2;
/// A ring is left this far before its seam, and the next one entered far enough past the seam to make the link 45°; in
/// stepovers.
const LEFT_OPEN: f64 = 0.55;
/// The golden ratio spreads the seams of successive layers: no two of them come near each other for many layers.
const GOLDEN: f64 = 0.618_033_988_749_895;

/// Positions tried for the seam of a chain, so that it does not fall on a corner.
const SEAMS: usize = 12;

/// Joins all contours.
pub fn join(contours: &Contours, outermost: &Region, settings: &FillSettings) -> Vec<Path> {
    let mut laid = LineIndex::new(LONGEST_END_LINK * settings.stepover);
    for (number, (_, ring)) in contours.complete.iter().enumerate() {
        let closed: Vec<DVec2> = ring.points().iter().chain(ring.points().first()).copied().collect();
        laid.add_line(number, &closed);
    }
    for (number, piece) in contours.incomplete.iter().enumerate() {
        laid.add_line(contours.complete.len() + number, &piece.points);
    }
    let mut passes = join_complete(&contours.complete, &laid, settings);
    passes.extend(join_incomplete(&contours.incomplete, &laid, outermost, settings));
    passes
}

fn join_complete(rings: &[(usize, Ring)], laid: &LineIndex, settings: &FillSettings) -> Vec<Path> {
    let mut free: Vec<bool> = vec![true; rings.len()];
    let mut passes = Vec::new();
    for start in 0..rings.len() {
        if !free[start] {
            continue;
        }
        let first = settings.layer as f64 * GOLDEN;
        let seams = (0..SEAMS).map(|k| place_at(&rings[start].1, (first + k as f64 / SEAMS as f64) % 1.0));
        // The first of the longest chains.
        let chains = seams.map(|seam| chain(start, seam, rings, &free, laid, settings));
        let best = chains.reduce(|best, next| if next.len() > best.len() { next } else { best });
        let best = best.unwrap_or_default();
        best.iter().for_each(|(ring, _)| free[*ring] = false);
        passes.push(pass(&best, rings, settings));
    }
    passes
}

/// The rings that can be joined, starting at a seam of the first one, and where each is entered.
fn chain(
    start: usize,
    seam: DVec2,
    rings: &[(usize, Ring)],
    free: &[bool],
    laid: &LineIndex,
    settings: &FillSettings,
) -> Vec<(usize, DVec2)> {
    let mut chain = vec![(start, seam)];
    let (mut at, mut place) = (start, seam);
    while let Some((next, begin)) = next_ring(at, place, rings, free, laid, settings) {
        chain.push((next, begin));
        (at, place) = (next, begin);
    }
    chain
}

/// The ring one level further in that can be linked to the end of this one, and the point where it is entered.
fn next_ring(
    at: usize,
    seam: DVec2,
    rings: &[(usize, Ring)],
    free: &[bool],
    laid: &LineIndex,
    settings: &FillSettings,
) -> Option<(usize, DVec2)> {
    let d = settings.stepover;
    let (level, ring) = &rings[at];
    let end = *shortened(&turned_to(ring, seam), LEFT_OPEN * d).last()?;
    let inner = (0..rings.len()).filter(|&i| free[i] && rings[i].0 == level + 1);
    let (next, foot) = inner
        .map(|i| (i, nearest_on(&rings[i].1, seam)))
        .min_by(|a, b| a.1.distance_squared(seam).total_cmp(&b.1.distance_squared(seam)))?;
    let begin = advanced(&rings[next].1, foot, (1.0 - LEFT_OPEN) * d);
    let fits = end.distance(begin) <= LONGEST_RING_LINK * d && is_clear([end, begin], laid);
    fits.then_some((next, begin))
}

/// One pass through the rings of a chain; the last of them is closed.
fn pass(chain: &[(usize, DVec2)], rings: &[(usize, Ring)], settings: &FillSettings) -> Path {
    let turn = |(ring, seam): &(usize, DVec2)| turned_to(&rings[*ring].1, *seam);
    match chain {
        [only] => Path::contour(Ring::new(turn(only)), settings.bead.width),
        [outer @ .., last] => {
            let gap = LEFT_OPEN * settings.stepover;
            let mut points: Vec<DVec2> = outer.iter().flat_map(|ring| shortened(&turn(ring), gap)).collect();
            points.extend(turn(last));
            points.push(last.1);
            Path::line(PassKind::Contour, points, settings.bead.width)
        }
        [] => Path::line(PassKind::Contour, Vec::new(), settings.bead.width),
    }
}

/// Whether a link crosses no contour; it may end on them.
fn is_clear(link: [DVec2; 2], laid: &LineIndex) -> bool {
    // Slightly shortened at both ends, so that the contours it joins do not count.
    !laid.crosses(link[0].lerp(link[1], 1e-3), link[1].lerp(link[0], 1e-3))
}

fn join_incomplete(pieces: &[Piece], laid: &LineIndex, outermost: &Region, settings: &FillSettings) -> Vec<Path> {
    let mut free: Vec<bool> = vec![true; pieces.len()];
    let mut inside_out: Vec<usize> = (0..pieces.len()).collect();
    inside_out.sort_by_key(|&i| std::cmp::Reverse(pieces[i].level));
    let mut passes = Vec::new();
    for start in inside_out {
        if !free[start] {
            continue;
        }
        free[start] = false;
        let mut points = pieces[start].points.clone();
        let mut levels = [pieces[start].level; 2];
        // Grow at the end, then at the beginning.
        for level in levels.iter_mut().rev() {
            while let Some((next, reversed)) = next_piece(&points, *level, pieces, &free, laid, outermost, settings) {
                free[next] = false;
                *level = pieces[next].level;
                let more = pieces[next].points.iter().copied();
                if reversed { points.extend(more.rev()) } else { points.extend(more) }
            }
            points.reverse();
        }
        passes.push(Path::line(PassKind::Contour, points, settings.bead.width));
    }
    passes
}

/// The free piece, one level away, with the end nearest to the end of the line, and whether it must be reversed.
fn next_piece(
    points: &[DVec2],
    level: usize,
    pieces: &[Piece],
    free: &[bool],
    laid: &LineIndex,
    outermost: &Region,
    settings: &FillSettings,
) -> Option<(usize, bool)> {
    let end = *points.last()?;
    let neighbours = (0..pieces.len()).filter(|&i| free[i] && pieces[i].level.abs_diff(level) == 1);
    let ends = neighbours.flat_map(|i| [(i, false, pieces[i].points.first()), (i, true, pieces[i].points.last())]);
    let within = ends.filter_map(|(i, reversed, p)| Some((i, reversed, *p?)));
    let reach = LONGEST_END_LINK * settings.stepover;
    let mut near: Vec<_> = within.filter(|(_, _, p)| p.distance(end) <= reach).collect();
    near.sort_by(|a, b| a.2.distance_squared(end).total_cmp(&b.2.distance_squared(end)));
    let fits = |p: DVec2| is_clear([end, p], laid) && outermost.contains((end + p) / 2.0);
    near.into_iter().find(|(_, _, p)| fits(*p)).map(|(i, reversed, _)| (i, reversed))
}

/// The point at a fraction of a ring's length.
fn place_at(ring: &Ring, fraction: f64) -> DVec2 {
    let line: Vec<DVec2> = ring.points().iter().chain(ring.points().first()).copied().collect();
    point_at(&line, ring.length() * fraction).unwrap_or_default()
}

/// The points of a ring from a point on it onwards; that point comes first.
fn turned_to(ring: &Ring, place: DVec2) -> Vec<DVec2> {
    let distance = |(a, b): (DVec2, DVec2)| planar::polyline::distance_squared_to_segment(place, a, b);
    let nearest = ring.edges().enumerate().min_by(|a, b| distance(a.1).total_cmp(&distance(b.1))).map_or(0, |e| e.0);
    let points = ring.points();
    let around = (0..points.len()).map(|k| points[(nearest + 1 + k) % points.len()]);
    let mut turned = vec![place];
    turned.extend(around.filter(|p| p.distance_squared(place) > 1e-8));
    turned
}

/// The point `by` mm further on along a ring.
fn advanced(ring: &Ring, place: DVec2, by: f64) -> DVec2 {
    point_at(&turned_to(ring, place), by).unwrap_or(place)
}

/// A ring as an open line from its first point almost back to it: its last `gap` (mm) is left out.
fn shortened(turn: &[DVec2], gap: f64) -> Vec<DVec2> {
    without_end(turn.iter().chain(turn.first()).copied().collect(), gap)
}

fn nearest_on(ring: &Ring, p: DVec2) -> DVec2 {
    let foot = |(a, b): (DVec2, DVec2)| {
        let way = b - a;
        let t =
            if way.length_squared() > 0.0 { ((p - a).dot(way) / way.length_squared()).clamp(0.0, 1.0) } else { 0.0 };
        a + way * t
    };
    ring.edges().map(foot).min_by(|a, b| a.distance_squared(p).total_cmp(&b.distance_squared(p))).unwrap_or(p)
}
