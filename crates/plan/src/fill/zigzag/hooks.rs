//! Line ends that hook along the boundary where they are not linked.
//!
//! Where lines meet an edge at an angle φ, their ends lie d/sin φ apart along it. A link covers every second of these
//! gaps. Below about 60°, the round ends on either side of the other gaps leave a wedge bare; so they do beside a hole
//! that begins between two lines. Of the two ends beside such a gap, one has an obtuse corner between line and
//! boundary. There the path leaves its line early, meets the boundary ahead of the end, in the gap, and comes back
//! along it, or does the same in reverse. At the beginning or end of a path, it follows the boundary instead.
//!
//! Sharp corners are blunted, because both of their sides lay metal there.
//!
//! All of this is ours; the lines of Liu et al. 2022 end straight. The constants are those that leave the least void
//! and overfill in the deposit model at the distances of the paper (0.738 w between lines, 0.591 w to the contour), at
//! edges that meet the lines at 15° to 90°.

use super::regions::Weave;
use glam::DVec2;
use planar::scan::{End, Neighbour, Scan};
use planar::{PerRow, polyline};

/// A hook extends until the boundary comes this near to the next line, in bead widths, less [`SHORTER`].
const NEAR: f64 = 0.42;
/// The round end of a hook, in bead widths.
const SHORTER: f64 = 0.2;
/// A hook between two lines is at least this long, in bead widths: a blunted corner needs it even at a right angle.
const SHORTEST: f64 = 0.14;
/// Around a local extreme of the boundary, shorter ones are left out, in bead widths.
const SHORTEST_AROUND: f64 = 0.3;
/// Space beyond the last line that is worth a bead, in bead widths.
const DEEP: f64 = 0.5;
/// A path leaves its line this far before the end, in bead widths.
const EARLY: f64 = 1.5;
/// But at most this fraction of the line before its end.
const MOST_OF_LINE: f64 = 0.4;
/// Where the way back to the line is blocked, a hook is retried with this fraction of its length.
const AGAIN: f64 = 0.6;
/// Number of retries.
const TRIES: usize = 3;
/// Corners that turn by more than this are blunted, radians.
const SHARP: f64 = 1.0;
/// This much is cut off on both sides of a corner, in bead widths.
const BLUNT: f64 = 0.15;

/// Directions across the lines.
#[derive(Clone, Copy, PartialEq)]
enum Towards {
    Below,
    Above,
}

/// Position of a hook on a path, which leads up from line to line.
#[derive(Clone, Copy)]
pub(super) enum Place {
    /// Before its first line.
    Begin,
    /// At the end where a line begins: a hook towards the next line.
    Above,
    /// At the end where a line ends: a hook from the line before.
    Below,
    /// After its last line.
    Finish,
}

/// The hooks of some scan lines.
pub(super) struct Hooks<'a> {
    weave: &'a Weave<'a>,
    /// Bead width, mm.
    width: f64,
    /// y of each line, mm; `None` for one outside the region.
    lines: Vec<Option<f64>>,
    edges: Edges,
}

/// The course along the boundary from an end of a span.
struct Along {
    /// The points, starting at that end.
    way: Vec<DVec2>,
    /// Length over which a bead is wanted, mm.
    reach: f64,
    /// Whether it leads to the other end of the same span: around the last line of a region.
    around_last: bool,
}

impl<'a> Hooks<'a> {
    /// Hooks for beads of `width`, mm.
    pub(super) fn new(weave: &'a Weave<'a>, width: f64) -> Self {
        let spans = weave.scan.spans();
        let mut lines = vec![None; spans.iter().map(|span| span.line + 1).max().unwrap_or_default()];
        for (i, span) in spans.iter().enumerate() {
            lines[span.line] = Some(weave.scan.end(i, End::Left).y);
        }
        Self { weave, width, lines, edges: Edges::new(weave.scan, width) }
    }

    /// The points that a path lays beside the end of a span.
    pub(super) fn lay(&self, place: Place, span: usize, end: End) -> Vec<DVec2> {
        let reversed = |mut points: Vec<DVec2>| {
            points.reverse();
            points
        };
        match place {
            Place::Begin => reversed(self.run(span, end, Towards::Below)),
            Place::Above => self.hook(span, end, Towards::Above),
            Place::Below => reversed(self.hook(span, end, Towards::Below)),
            Place::Finish => self.run(span, end, Towards::Above),
        }
    }

    /// The course along the boundary where a path begins or ends.
    fn run(&self, span: usize, end: End, towards: Towards) -> Vec<DVec2> {
        let way = self.along(span, end, towards).map(|along| along.up_to(along.reach));
        way.map_or_else(Vec::new, |mut way| way.split_off(1))
    }

    /// A hook from the end of a span: along the boundary to its tip, then to the line.
    fn hook(&self, span: usize, end: End, towards: Towards) -> Vec<DVec2> {
        let Some(along) = self.along(span, end, towards).filter(|along| !along.around_last) else { return Vec::new() };
        let early = (EARLY * self.width).min(MOST_OF_LINE * self.weave.scan.length(span));
        let foot = along.way[0] - outward(end) * early * DVec2::X;
        let reaches = std::iter::successors(Some(along.reach), |reach| Some(AGAIN * reach)).take(TRIES);
        let ways = reaches.map(|reach| along.up_to(reach));
        let way = ways.into_iter().find(|way| way.last().is_some_and(|tip| self.edges.clear(foot, *tip)));
        way.map_or_else(Vec::new, |mut way| {
            way.push(foot);
            way.split_off(1)
        })
    }

    /// The course over which a bead along the boundary is wanted from an end of a span; `None` if nowhere.
    fn along(&self, span: usize, end: End, towards: Towards) -> Option<Along> {
        let scan = self.weave.scan;
        let to = scan.neighbour(span, end, towards == Towards::Above)?;
        let (from, line, w) = (scan.end(span, end), scan.spans()[span].line, self.width);
        let next = match towards {
            Towards::Above => line + 1,
            Towards::Below => line.checked_sub(1)?,
        };
        let last = scan.end(to.span, to.end);
        let way: Vec<DVec2> = [from].into_iter().chain(to.via.iter().copied()).chain([last]).collect();
        let length = polyline::length(&way);
        let next_y = self.lines.get(next).copied().flatten();
        if scan.spans()[to.span].line == line {
            let depth = way.iter().map(|p| (p.y - from.y).abs()).fold(0.0, f64::max);
            let around_last = to.span == span;
            let reach =
                if around_last { length } else { self.until_near(&way, next_y).min(length / 2.0) } - SHORTER * w;
            let wanted = reach > SHORTEST_AROUND * w && (!around_last || depth > DEEP * w);
            return wanted.then_some(Along { way, reach, around_last });
        }
        let linked = match towards {
            Towards::Above => self.weave.link(span, end).is_some_and(|link| link.to == to.span),
            Towards::Below => self.weave.link(to.span, end).is_some_and(|link| link.to == span),
        };
        let reach = (self.until_near(&way, next_y) - SHORTER * w).max(SHORTEST * w).min(length / 2.0);
        (linked && self.is_obtuse(end, towards, from, &to)).then_some(Along { way, reach, around_last: false })
    }

    /// Whether the corner between line and boundary is the blunter one of a gap; at a right angle, the upper one is.
    fn is_obtuse(&self, end: End, towards: Towards, from: DVec2, to: &Neighbour) -> bool {
        let farther = outward(end) * (self.weave.scan.end(to.span, to.end).x - from.x);
        let right = 1e-3 * self.width;
        farther > right || farther.abs() <= right && towards == Towards::Below
    }

    /// Length of a course until it comes near the line at `next`, mm.
    fn until_near(&self, way: &[DVec2], next: Option<f64>) -> f64 {
        let Some(next) = next else { return f64::INFINITY };
        let (near, mut length) = (NEAR * self.width, 0.0);
        for pair in way.windows(2) {
            let (step, [a, b]) = (pair[0].distance(pair[1]), [pair[0], pair[1]].map(|p| (p.y - next).abs()));
            if b < near {
                return length + if a > near { step * (a - near) / (a - b) } else { 0.0 };
            }
            length += step;
        }
        f64::INFINITY
    }

    /// A path without its sharp corners.
    pub(super) fn blunt(&self, points: Vec<DVec2>) -> Vec<DVec2> {
        let (cut, mut blunted) = (BLUNT * self.width, Vec::with_capacity(points.len()));
        for (i, &p) in points.iter().enumerate() {
            let neighbours = i.checked_sub(1).and_then(|before| Some((points[before], *points.get(i + 1)?)));
            let sharp = |&(a, b): &(DVec2, DVec2)| (p - a).angle_to(b - p).abs() > SHARP;
            match neighbours.filter(sharp) {
                Some((a, b)) => {
                    blunted.extend([a, b].map(|q| p + (q - p).clamp_length_max((2.0 * cut).min(p.distance(q)) / 2.0)))
                }
                None => blunted.push(p),
            }
        }
        blunted
    }
}

/// Direction out of the region along the lines: −1 or 1.
fn outward(end: End) -> f64 {
    match end {
        End::Left => -1.0,
        End::Right => 1.0,
    }
}

impl Along {
    /// The first `reach` (mm) of it.
    fn up_to(&self, reach: f64) -> Vec<DVec2> {
        polyline::without_end(self.way.clone(), polyline::length(&self.way) - reach)
    }
}

/// The boundary, binned in rows one bead width high.
struct Edges {
    low: f64,
    height: f64,
    rows: PerRow<(DVec2, DVec2)>,
}

impl Edges {
    fn new(scan: &Scan, height: f64) -> Self {
        let ys = scan.edges().map(|(a, _)| a.y);
        let (low, high) = ys.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), y| (l.min(y), h.max(y)));
        let row = |y: f64| ((y - low) / height) as usize;
        let count = if low < high { row(high) + 1 } else { 0 };
        let rows_of = |(a, b): (DVec2, DVec2)| row(a.y.min(b.y))..=row(a.y.max(b.y));
        let each = scan.edges().flat_map(|edge| rows_of(edge).map(move |row| (row, edge)));
        Self { low, height, rows: PerRow::grouped(count, each) }
    }

    /// Whether a straight cut stays clear of the boundary until it ends on it.
    fn clear(&self, foot: DVec2, tip: DVec2) -> bool {
        /// The last fraction, where the cut meets the boundary.
        const MEETS: f64 = 1e-3;
        let end = tip.lerp(foot, MEETS);
        let row = |y: f64| ((y - self.low) / self.height).max(0.0) as usize;
        let rows = row(foot.y.min(end.y))..=row(foot.y.max(end.y));
        let apart = |a: DVec2, b: DVec2, p: DVec2, q: DVec2| (b - a).perp_dot(p - a) * (b - a).perp_dot(q - a) > 0.0;
        let cuts = |&(a, b): &(DVec2, DVec2)| !apart(foot, end, a, b) && !apart(a, b, foot, end);
        !rows.flat_map(|row| self.rows.row(row)).any(cuts)
    }
}
