//! Beads along the medial axis of narrow pieces.
//!
//! A piece keeps the least gap from the contours around it, so the space across it from contour to contour is W =
//! thickness + 2 gap. In it n = round(W/d) − 1 beads, at least one, are spread evenly, W/(n + 1) apart. The contours
//! fill half a stepover on each side, so each of the n beads fills (W − d)/n. Its width follows from that, within the
//! limits of the process, and the speed keeps the bead height.

use crate::fill::line_index::LineIndex;
use crate::fill::{FillSettings, Path};
use crate::pass::{Along, PassKind};
use glam::DVec2;
use planar::clip::Keep;
use planar::ladder::{Ladder, Rung, ladders};
use planar::{Polygon, Region};
use std::ops::Range;

/// Samples of the boundary per bead width.
const SAMPLES: f64 = 8.0;
/// Points of a pass are at least this fraction of a bead width apart.
const POINT_STEP: f64 = 0.2;
/// Least length of a section with another number of beads, in bead widths.
const SHORTEST_RUN: f64 = 1.5;
/// Ends closer together than this are joined, in stepovers.
const JOIN: f64 = 1.6;
/// A short line across a piece must lie inside it for at least this fraction of the shortest pass.
const SHORTEST_PART: f64 = 0.6;

/// The passes of a narrow piece. `laid` holds the lines already laid, to which these are added; `outermost` is where
/// centre-lines may lie.
pub fn beads(piece: &Polygon, outermost: &Region, laid: &mut LineIndex, settings: &FillSettings) -> Vec<Path> {
    let spacing = settings.bead.width / SAMPLES;
    let mut lines: Vec<Line> = Vec::new();
    for ladder in ladders(&piece.clone().into(), spacing).iter().filter(|ladder| !is_knot(ladder)) {
        lines.extend(climb(ladder, piece, settings));
    }
    let long = |line: &Line| line.closed || planar::polyline::length(&line.points) >= settings.min_pass_length;
    let mut lines: Vec<Line> = join(lines, JOIN * settings.stepover, laid).into_iter().filter(long).collect();
    if lines.is_empty() {
        lines.extend(across(piece, outermost, settings));
    }
    let free = lines.into_iter().filter_map(|line| uncrossed(line, laid)).filter(long);
    free.map(|line| line.pass()).collect()
}

/// The longest section of a line that crosses neither laid lines nor itself; it is added to `laid`.
fn uncrossed(mut line: Line, laid: &mut LineIndex) -> Option<Line> {
    let closed = std::mem::take(&mut line.closed);
    if closed {
        line.points.extend(line.points.first().copied());
        line.widths.extend(line.widths.first().copied());
    }
    let mut own = LineIndex::new(laid.sight_mm());
    let (mut best, mut start, mut longest, mut length) = (0..0, 0, 0.0, 0.0);
    for k in 0..line.points.len().saturating_sub(1) {
        let (a, b) = (line.points[k], line.points[k + 1]);
        if laid.crosses(a, b) || own.crosses(a, b) {
            (start, length) = (k + 1, 0.0);
        } else {
            length += a.distance(b);
        }
        own.add_line(0, &[a, b]);
        if length > longest {
            (longest, best) = (length, start..k + 2);
        }
    }
    let whole = best.len() == line.points.len();
    line.points = line.points.drain(best.clone()).collect();
    line.widths = line.widths.drain(best).collect();
    laid.add_line(0, &line.points);
    if closed && whole {
        line.points.pop();
        line.widths.pop();
        line.closed = true;
    }
    (line.points.len() >= 2).then_some(line)
}

/// Whether a ladder only separates two forks: the lines that meet there go around this knot, and the space left in its
/// middle is filled later.
fn is_knot(ladder: &Ladder) -> bool {
    let widest = ladder.rungs.iter().map(|rung| rung.thickness).fold(0.0, f64::max);
    ladder.free == [false, false] && !ladder.closed && ladder.length() < widest
}

/// A line across a piece without a useful axis, from its farthest corner through its middle; `None` if it would be too
/// short.
fn across(piece: &Polygon, outermost: &Region, settings: &FillSettings) -> Option<Line> {
    let middle = piece.outer.centroid()?;
    let far = |a: &&DVec2, b: &&DVec2| a.distance_squared(middle).total_cmp(&b.distance_squared(middle));
    let to = *piece.outer.points().iter().max_by(far)?;
    let way = (middle - to).try_normalize()?;
    let reach = hit(piece, middle, way);
    if !piece.contains(middle) || !reach.is_finite() {
        return None;
    }
    let from = middle + way * reach;
    // It may extend slightly beyond the piece, to be long enough.
    let (length, middle) = (to.distance(from), (to + from) / 2.0);
    let half = (to - middle) * (1.001 * settings.min_pass_length / length).max(1.0);
    if length < SHORTEST_PART * settings.min_pass_length {
        return None;
    }
    let inside = outermost.clip_line(&[middle - half, middle + half], Keep::Inside);
    let points = inside.into_iter().find(|part| part.len() == 2)?;
    Some(Line { points, widths: vec![settings.bead.width; 2], closed: false, contour: false })
}

/// Passes with ends near each other linked into one, where a link crosses nothing; closed ones stay as they are.
pub fn linked(passes: Vec<Path>, settings: &FillSettings) -> Vec<Path> {
    let reach = JOIN * settings.stepover;
    let mut laid = LineIndex::new(reach);
    passes.iter().enumerate().for_each(|(number, pass)| laid.add_line(number, &pass.path()));
    let line = |pass: Path| Line {
        widths: (0..pass.points.len()).map(|i| pass.width.after(i)).collect(),
        points: pass.points,
        closed: pass.closed,
        contour: pass.kind == PassKind::Contour,
    };
    let linked = join(passes.into_iter().map(line).collect(), reach, &laid).into_iter();
    let pass = |line: Line| Path {
        kind: if line.contour { PassKind::Contour } else { PassKind::Skeleton },
        closed: line.closed,
        points: line.points,
        width: Along::Each(line.widths),
        reversible: true,
    };
    linked.map(pass).collect()
}

/// A centre-line with the width at each point.
#[derive(Debug, Clone)]
struct Line {
    points: Vec<DVec2>,
    widths: Vec<f64>,
    closed: bool,
    /// Whether part of it is a contour.
    contour: bool,
}

impl Line {
    fn pass(self) -> Path {
        let mut widths = self.widths.clone();
        // From each point to the next, the mean of both widths applies.
        let next = self.widths.iter().cycle().skip(1);
        let last = if self.closed { widths.len() } else { widths.len().saturating_sub(1) };
        widths.iter_mut().zip(next).take(last).for_each(|(width, next)| *width = (*width + next) / 2.0);
        Path {
            kind: PassKind::Skeleton,
            closed: self.closed,
            points: self.points,
            width: Along::Each(widths),
            reversible: true,
        }
    }

    fn reverse(&mut self) {
        self.points.reverse();
        self.widths.reverse();
    }
}

/// The lines along one ladder.
fn climb(ladder: &Ladder, piece: &Polygon, settings: &FillSettings) -> Vec<Line> {
    let rungs = thinned(ladder, POINT_STEP * settings.bead.width);
    let counts = counts(&rungs, settings);
    let mut lines = Vec::new();
    for run in runs(&counts) {
        let n = counts[run.start];
        // Neighbouring runs share a rung, so that no hole is left between them.
        let with_next = run.start..(run.end + 1).min(rungs.len());
        let free = [ladder.free[0] && run.start == 0, ladder.free[1] && run.end == rungs.len()];
        for j in 1..=n {
            let mut line = line(&rungs[with_next.clone()], j, n, settings);
            line.closed = ladder.closed && run.len() == rungs.len();
            if !line.closed {
                extend(&mut line, free, piece, settings);
            }
            lines.push(line);
        }
    }
    lines
}

/// Rungs at least `step` apart, ends included.
fn thinned(ladder: &Ladder, step: f64) -> Vec<Rung> {
    let mut rungs: Vec<Rung> = Vec::new();
    for rung in &ladder.rungs {
        if rungs.last().is_none_or(|last| last.middle().distance(rung.middle()) >= step) {
            rungs.push(*rung);
        }
    }
    if let (Some(last), true) = (ladder.rungs.last(), rungs.len() > 1) {
        let end = rungs.len() - 1;
        rungs[end] = *last;
    }
    rungs
}

/// Number of beads across each rung; sections too short to be worth a change take the neighbouring number.
fn counts(rungs: &[Rung], settings: &FillSettings) -> Vec<usize> {
    let across = |rung: &Rung| rung.thickness + 2.0 * settings.hybrid.least_gap;
    let count = |rung: &Rung| ((across(rung) / settings.stepover - 1.0).round().max(1.0)) as usize;
    let mut counts: Vec<usize> = rungs.iter().map(count).collect();
    let length = |run: &Range<usize>| {
        let middles: Vec<DVec2> = rungs[run.clone()].iter().map(Rung::middle).collect();
        planar::polyline::length(&middles)
    };
    loop {
        let found = runs(&counts);
        let short = |run: &&Range<usize>| length(run) < SHORTEST_RUN * settings.bead.width;
        let Some(run) = found.iter().filter(short).min_by(|a, b| length(a).total_cmp(&length(b))) else { break };
        if found.len() == 1 {
            break;
        }
        let before = run.start.checked_sub(1).map(|i| counts[i]);
        let after = counts.get(run.end).copied();
        let Some(value) = before.into_iter().chain(after).min_by_key(|v| v.abs_diff(counts[run.start])) else { break };
        counts[run.clone()].fill(value);
    }
    counts
}

/// Sections of equal values.
fn runs(counts: &[usize]) -> Vec<Range<usize>> {
    let mut runs: Vec<Range<usize>> = Vec::new();
    for (i, count) in counts.iter().enumerate() {
        match runs.last_mut() {
            Some(run) if counts[run.start] == *count => run.end = i + 1,
            _ => runs.push(i..i + 1),
        }
    }
    runs
}

/// Line `j` of `n` from the left.
fn line(rungs: &[Rung], j: usize, n: usize, settings: &FillSettings) -> Line {
    let (d, gap, limits) = (settings.stepover, settings.hybrid.least_gap, settings.hybrid.width_limits);
    let at = |rung: &Rung| {
        let across = rung.thickness + 2.0 * gap;
        let part = (j as f64 * across / (n + 1) as f64 - gap) / rung.thickness.max(1e-9);
        rung.left.lerp(rung.right, part.clamp(0.0, 1.0))
    };
    let width = |rung: &Rung| {
        let share = (rung.thickness + 2.0 * gap - d) / (n as f64 * d);
        (settings.bead.width * share).clamp(limits.0, limits.1)
    };
    Line {
        points: rungs.iter().map(at).collect(),
        widths: rungs.iter().map(width).collect(),
        closed: false,
        contour: false,
    }
}

/// Extends free ends to a stepover before the contour that lies beyond; a line otherwise too short to be laid is
/// extended to the edge of the piece.
fn extend(line: &mut Line, free: [bool; 2], piece: &Polygon, settings: &FillSettings) {
    let beyond = settings.stepover - settings.hybrid.least_gap;
    let first = planar::polyline::length(&line.points);
    let ends: f64 = free.iter().map(|f| if *f { 2.0 * beyond } else { 0.0 }).sum();
    let beyond = if first + ends < settings.min_pass_length { 0.0 } else { beyond };
    for (k, free) in free.into_iter().enumerate() {
        // Both ends are handled as the last one, by reversing.
        if k == 0 {
            line.reverse();
        }
        if let ([.., a, b], true) = (&line.points[..], free) {
            let (b, way) = (*b, (*b - *a).normalize_or_zero());
            let reach = (hit(piece, b, way) - beyond).min(1.5 * settings.bead.width);
            if reach > 0.1 * settings.bead.width && reach.is_finite() {
                line.points.push(b + way * reach);
                line.widths.extend(line.widths.last().copied());
            }
        }
        if k == 0 {
            line.reverse();
        }
    }
}

/// Distance from a point inside to the edge of a polygon in a direction, mm.
fn hit(piece: &Polygon, from: DVec2, way: DVec2) -> f64 {
    let edges = piece.rings().flat_map(|ring| ring.edges());
    let distances = edges.filter_map(|(a, b)| {
        let (edge, start) = (b - a, a - from);
        let cross = way.perp_dot(edge);
        let (t, u) = (start.perp_dot(edge) / cross, start.perp_dot(way) / cross);
        (cross.abs() > 1e-12 && t > 1e-9 && (0.0..=1.0).contains(&u)).then_some(t)
    });
    distances.fold(f64::INFINITY, f64::min)
}

/// Cosine of the turn beyond which a link runs back along the line that it leaves.
const BACK: f64 = -0.9;

/// Whether a link from an end of a line to a point would lie on the line itself.
fn runs_back(line: &Line, last: bool, to: DVec2) -> bool {
    let way = match line.points[..] {
        [.., a, b] if last => (a, b),
        [b, a, ..] => (a, b),
        _ => return false,
    };
    (way.1 - way.0).normalize_or_zero().dot((to - way.1).normalize_or_zero()) < BACK
}

/// Joins lines whose ends lie near each other, the nearest first; no link crosses laid lines or these lines, or runs back
/// along one of them.
fn join(mut lines: Vec<Line>, reach: f64, laid: &LineIndex) -> Vec<Line> {
    let mut own = LineIndex::new(laid.sight_mm());
    lines.iter().for_each(|line| own.add_line(0, &line.points));
    loop {
        let end = |line: &Line, last: bool| if last { line.points.last() } else { line.points.first() }.copied();
        let mut best: Option<(f64, usize, bool, usize, bool)> = None;
        for i in 0..lines.len() {
            for j in i + 1..lines.len() {
                if lines[i].closed || lines[j].closed {
                    continue;
                }
                for (a, b) in [(false, false), (false, true), (true, false), (true, true)] {
                    let Some((p, q)) = end(&lines[i], a).zip(end(&lines[j], b)) else { continue };
                    let distance = p.distance(q);
                    let nearer = distance <= reach && best.is_none_or(|best| distance < best.0);
                    let (c, d) = (p.lerp(q, 1e-3), q.lerp(p, 1e-3));
                    let back = runs_back(&lines[i], a, q) || runs_back(&lines[j], b, p);
                    if nearer && !back && !laid.crosses(c, d) && !own.crosses(c, d) {
                        best = Some((distance, i, a, j, b));
                    }
                }
            }
        }
        let Some((_, i, i_last, j, j_last)) = best else { return lines };
        let mut other = lines.swap_remove(j);
        let line = &mut lines[i];
        if !i_last {
            line.reverse();
        }
        if j_last {
            other.reverse();
        }
        let link = line.points.last().into_iter().chain(other.points.first()).copied();
        own.add_line(0, &link.collect::<Vec<_>>());
        let skip = usize::from(line.points.last() == other.points.first());
        line.points.extend(&other.points[skip..]);
        line.widths.extend(&other.widths[skip..]);
        line.contour |= other.contour;
    }
}
