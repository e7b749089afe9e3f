//! Parallel scan lines through a region, and how their ends are connected along its boundary.
//!
//! The region is turned so that the lines run along x. Every crossing of a line with a ring remembers its position on
//! the ring; two consecutive crossings there are joined by a piece of boundary (a *chain*) that meets no scan line in
//! between. A path from line to line along chains can therefore neither leave the region nor cross another line: no
//! geometric test is needed.

use crate::{PerRow, Region, Ring};
use glam::DVec2;

/// Lines are moved off exact vertices by this, mm.
const NUDGE_MM: f64 = 5e-4;

/// A section of one scan line inside the region.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Span {
    /// Index of the scan line.
    pub line: usize,
    /// Crossing where the span begins (lower x in the turned frame).
    left: usize,
    /// Crossing where it ends.
    right: usize,
}

/// One of the two ends of a span.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// Lower x in the turned frame.
    Left,
    /// Higher x in the turned frame.
    Right,
}

impl End {
    /// The other end.
    pub fn other(self) -> Self {
        match self {
            Self::Left => Self::Right,
            Self::Right => Self::Left,
        }
    }
}

/// The path along the boundary from the end of one span to the same end of a span on the next line.
#[derive(Debug, Clone, PartialEq)]
pub struct Chain {
    /// Index of the span it leads to.
    pub to: usize,
    /// Boundary vertices between the two ends, in the turned frame; often none.
    pub via: Vec<DVec2>,
}

/// The next end of a span along the boundary, of any span.
#[derive(Debug, Clone, PartialEq)]
pub struct Neighbour {
    /// Index of the span it belongs to.
    pub span: usize,
    /// Which end of that span.
    pub end: End,
    /// Boundary vertices between the two ends, in the turned frame; often none.
    pub via: Vec<DVec2>,
}

struct Crossing {
    line: usize,
    at: DVec2,
    ring: usize,
    edge: usize,
    upward: bool,
    /// Span of which this is an end.
    span: Option<usize>,
}

/// Scan lines of one angle through one region.
///
/// ```
/// use planar::scan::{End, Scan, Spacing};
/// use planar::{DVec2, Polygon, Region, Ring};
///
/// let corners = [(0.0, 0.0), (10.0, 0.0), (10.0, 4.0), (0.0, 4.0)].map(DVec2::from);
/// let plate = Region::from(Polygon::simple(Ring::new(corners.to_vec())));
/// let scan = Scan::new(&plate, 0.0, Spacing::AtMost(1.0));
/// assert_eq!(scan.spans().len(), 5);
/// assert!((0..5).all(|span| scan.length(span) == 10.0));
/// // The right edge leads from each line to the next.
/// assert_eq!(scan.chain_up(0, End::Right).map(|chain| chain.to), Some(1));
/// ```
pub struct Scan {
    rings: Vec<Ring>,
    /// First crossing of each ring, and one past the last ring.
    ring_starts: Vec<usize>,
    crossings: Vec<Crossing>,
    spans: Vec<Span>,
    axis: DVec2,
}

/// Spacing and position of the lines, in the frame turned by the raster angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Spacing {
    /// Lines spread evenly from edge to edge, at most this far apart, mm.
    AtMost(f64),
    /// Lines exactly this far apart, mm, the first one on the lower edge (Liu et al. 2022, eq 11).
    Exact(f64),
}

impl Spacing {
    /// Positions of the lines across an extent from `low` to `high`.
    fn lines(self, low: f64, high: f64) -> Vec<f64> {
        let extent = high - low;
        let (count, step) = match self {
            Self::AtMost(d) => {
                let gaps = (extent / d - 1e-9).ceil().max(1.0);
                (gaps, extent / gaps)
            }
            Self::Exact(d) => ((extent / d + 1e-9).floor(), d),
        };
        let (Self::AtMost(d) | Self::Exact(d)) = self;
        if extent < d / 2.0 {
            return vec![(low + high) / 2.0];
        }
        let place = |i: usize| (low + i as f64 * step).clamp(low + NUDGE_MM, high - NUDGE_MM);
        (0..=count as usize).map(place).collect()
    }
}

/// Edges parallel to the lines and longer than this get a line along them, in line distances.
const LONG: f64 = 1.5;
/// But not where that line would be closer than this to another one, in line distances.
const NEAREST: f64 = 0.6;
/// Lines may be this much farther apart than asked for if one more line would make them much too close, in line
/// distances.
const FARTHER: f64 = 0.25;

/// Lines along all long edges that run along x, and evenly spaced between them, about `distance` apart; `None` where
/// the only such edges are the lowest and the highest.
fn fitted(rings: &[Ring], low: f64, high: f64, distance: f64) -> Option<Vec<f64>> {
    let edges = rings.iter().flat_map(Ring::edges);
    let long = edges.filter(|(a, b)| (b.y - a.y).abs() < NUDGE_MM && (b.x - a.x).abs() > LONG * distance);
    // The inside lies to the left of an edge: put the line just inside.
    let mut ledges: Vec<f64> = long.map(|(a, b)| a.y + NUDGE_MM * (b.x - a.x).signum()).collect();
    ledges.sort_unstable_by(f64::total_cmp);
    let mut held = vec![low + NUDGE_MM];
    for ledge in ledges {
        let near = |other: f64| (ledge - other).abs() < NEAREST * distance;
        if !held.last().copied().is_some_and(near) && !near(high) {
            held.push(ledge);
        }
    }
    if held.len() == 1 {
        return None;
    }
    held.push(high - NUDGE_MM);
    let mut lines = vec![held[0]];
    for pair in held.windows(2) {
        let gaps = ((pair[1] - pair[0]) / distance - FARTHER).ceil().max(1.0);
        lines.extend((1..=gaps as usize).map(|k| pair[0] + (pair[1] - pair[0]) * k as f64 / gaps));
    }
    Some(lines)
}

impl Scan {
    /// Lays scan lines at `angle` (radians from x) through `region`.
    pub fn new(region: &Region, angle: f64, spacing: Spacing) -> Self {
        Self::with_lines(region, angle, |_, low, high| spacing.lines(low, high))
    }

    /// Lays scan lines at `angle` (radians from x) through `region`, about `distance` (mm) apart, so that one runs
    /// along every long edge parallel to them: no strip narrower than `distance` is left next to such an edge.
    pub fn fitted(region: &Region, angle: f64, distance: f64) -> Self {
        Self::with_lines(region, angle, |rings, low, high| {
            fitted(rings, low, high, distance).unwrap_or_else(|| Spacing::AtMost(distance).lines(low, high))
        })
    }

    fn with_lines(region: &Region, angle: f64, lines: impl Fn(&[Ring], f64, f64) -> Vec<f64>) -> Self {
        let (axis, rings, lines) = turned(region, angle, lines);
        let (mut ring_starts, mut crossings) = (vec![0], Vec::new());
        for (number, ring) in rings.iter().enumerate() {
            crossings_along(ring, &lines, |crossing| crossings.push(Crossing { ring: number, ..crossing }));
            ring_starts.push(crossings.len());
        }
        let mut scan = Self { rings, ring_starts, crossings, spans: Vec::new(), axis };
        scan.pair_spans(lines.len());
        scan
    }

    /// The inside lies to the left of an upward crossing and to the right of a downward one.
    fn pair_spans(&mut self, line_count: usize) {
        let numbers = self.crossings.iter().enumerate().map(|(i, crossing)| (crossing.line, i));
        let mut by_line = PerRow::grouped(line_count, numbers);
        for (line, on_line) in by_line.iter_mut().enumerate() {
            let key = |i: usize| self.crossings[i].at.x;
            on_line.sort_by(|&i, &j| {
                key(i).total_cmp(&key(j)).then(self.crossings[i].upward.cmp(&self.crossings[j].upward))
            });
            let mut open = None;
            for &mut i in on_line {
                match (self.crossings[i].upward, open) {
                    (false, _) => open = Some(i),
                    (true, Some(left)) => {
                        self.crossings[left].span = Some(self.spans.len());
                        self.crossings[i].span = Some(self.spans.len());
                        self.spans.push(Span { line, left, right: i });
                        open = None;
                    }
                    (true, None) => {}
                }
            }
        }
    }

    /// All spans, by line from low to high and along each line.
    pub fn spans(&self) -> &[Span] {
        &self.spans
    }

    /// The given end of a span, in the turned frame, mm.
    pub fn end(&self, span: usize, end: End) -> DVec2 {
        self.crossings[self.crossing(span, end)].at
    }

    /// Length of a span, mm.
    pub fn length(&self, span: usize) -> f64 {
        self.end(span, End::Right).x - self.end(span, End::Left).x
    }

    /// The chain from one end of a span up to the same end of a span on the next line; `None` if the boundary leads
    /// elsewhere.
    pub fn chain_up(&self, span: usize, end: End) -> Option<Chain> {
        let from = self.crossing(span, end);
        let crossing = &self.crossings[from];
        let range = self.ring_starts[crossing.ring]..self.ring_starts[crossing.ring + 1];
        let ring = self.rings[crossing.ring].points();
        // Right ends lie on upward edges: follow the ring. Left ends lie on downward edges: go against it.
        let to = match end {
            End::Right if from + 1 == range.end => range.start,
            End::Right => from + 1,
            End::Left if from == range.start => range.end - 1,
            End::Left => from - 1,
        };
        let target = &self.crossings[to];
        if target.line != crossing.line + 1 || target.upward != crossing.upward {
            return None;
        }
        let to_span = target.span?;
        let n = ring.len();
        let via = match end {
            End::Right => {
                let count = (target.edge + n - crossing.edge) % n;
                (1..=count).map(|k| ring[(crossing.edge + k) % n]).collect()
            }
            End::Left => {
                let count = (crossing.edge + n - target.edge) % n;
                (0..count).map(|k| ring[(crossing.edge + n - k) % n]).collect()
            }
        };
        Some(Chain { to: to_span, via })
    }

    /// Where the boundary leads from an end of a span, up or down, until it meets a scan line again; with the boundary
    /// vertices on the way, in the turned frame.
    pub fn neighbour(&self, span: usize, end: End, up: bool) -> Option<Neighbour> {
        let from = self.crossing(span, end);
        let crossing = &self.crossings[from];
        let range = self.ring_starts[crossing.ring]..self.ring_starts[crossing.ring + 1];
        let (ring, n) = (self.rings[crossing.ring].points(), self.rings[crossing.ring].points().len());
        // Right ends lie on upward edges: the ring leads up from there.
        let along = (end == End::Right) == up;
        let to = match along {
            true if from + 1 == range.end => range.start,
            true => from + 1,
            false if from == range.start => range.end - 1,
            false => from - 1,
        };
        let target = &self.crossings[to];
        let span = target.span?;
        let end = if self.spans[span].left == to { End::Left } else { End::Right };
        let via = if along {
            let count = (target.edge + n - crossing.edge) % n;
            (1..=count).map(|k| ring[(crossing.edge + k) % n]).collect()
        } else {
            let count = (crossing.edge + n - target.edge) % n;
            (0..count).map(|k| ring[(crossing.edge + n - k) % n]).collect()
        };
        Some(Neighbour { span, end, via })
    }

    /// The edges of the region in the turned frame, mm.
    pub fn edges(&self) -> impl Iterator<Item = (DVec2, DVec2)> + Clone + '_ {
        self.rings.iter().flat_map(Ring::edges)
    }

    /// From the turned frame back to that of the region.
    pub fn turn_back(&self, p: DVec2) -> DVec2 {
        self.axis * p.x + self.axis.perp() * p.y
    }

    fn crossing(&self, span: usize, end: End) -> usize {
        match end {
            End::Left => self.spans[span].left,
            End::Right => self.spans[span].right,
        }
    }
}

/// The number of spans that [`Scan::new`] would find, and their total length, mm; faster, since crossings are not
/// sorted.
///
/// ```
/// use planar::scan::{Spacing, count_and_length};
/// use planar::{DVec2, Polygon, Region, Ring};
/// use std::f64::consts::FRAC_PI_2;
///
/// let corners = [(0.0, 0.0), (10.0, 0.0), (10.0, 4.0), (0.0, 4.0)].map(DVec2::from);
/// let plate = Region::from(Polygon::simple(Ring::new(corners.to_vec())));
/// assert_eq!(count_and_length(&plate, 0.0, Spacing::AtMost(1.0)), (5, 5.0 * 10.0));
/// assert_eq!(count_and_length(&plate, FRAC_PI_2, Spacing::AtMost(1.0)), (11, 11.0 * 4.0));
/// ```
pub fn count_and_length(region: &Region, angle: f64, spacing: Spacing) -> (usize, f64) {
    let (_, rings, lines) = turned(region, angle, |_, low, high| spacing.lines(low, high));
    let (mut ends, mut length) = (0, 0.0);
    for ring in &rings {
        crossings_along(ring, &lines, |crossing| {
            ends += 1;
            length += if crossing.upward { crossing.at.x } else { -crossing.at.x };
        });
    }
    (ends / 2, length)
}

/// Unit vector along the scan lines, the rings of a region turned so that the lines run along x, and the lines' y.
fn turned(region: &Region, angle: f64, lines: impl Fn(&[Ring], f64, f64) -> Vec<f64>) -> (DVec2, Vec<Ring>, Vec<f64>) {
    let axis = snapped_axis(angle);
    // Turning back by the conjugate: x' = p·axis, y' = axis × p.
    let turn =
        |ring: &Ring| Ring::new(ring.points().iter().map(|&p| DVec2::new(p.dot(axis), axis.perp_dot(p))).collect());
    let rings: Vec<Ring> = region.rings().map(turn).collect();
    let ys = rings.iter().flat_map(|r| r.points()).map(|p| p.y);
    let (low, high) = ys.fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), y| (lo.min(y), hi.max(y)));
    let lines = if low < high { lines(&rings, low, high) } else { Vec::new() };
    (axis, rings, lines)
}

/// Visits the crossings of a ring with lines in the order in which it meets them.
fn crossings_along(ring: &Ring, lines: &[f64], mut visit: impl FnMut(Crossing)) {
    let mut high = ring.points().first().map_or(0, |p| lines_up_to(lines, 0, p.y));
    for (edge, (a, b)) in ring.edges().enumerate() {
        let low = high;
        high = lines_up_to(lines, low, b.y);
        let crossing = |line: usize| {
            let t = ((lines[line] - a.y) / (b.y - a.y)).clamp(0.0, 1.0);
            let at = DVec2::new(a.x + (b.x - a.x) * t, lines[line]);
            Crossing { line, at, ring: 0, edge, upward: b.y > a.y, span: None }
        };
        if low < high {
            (low..high).map(crossing).for_each(&mut visit);
        } else {
            (high..low).rev().map(crossing).for_each(&mut visit);
        }
    }
}

/// Number of lines at or below `y`, searched from `guess`: a vertex on a line counts as above it, for both of its
/// edges.
fn lines_up_to(lines: &[f64], guess: usize, y: f64) -> usize {
    let (below, above) = lines.split_at(guess);
    let less = below.iter().rev().take_while(|&&line| line > y).count();
    guess - less + above.iter().take_while(|&&line| line <= y).count()
}

/// Cosine and sine of `angle`, exact at multiples of 90° so that axis-parallel parts stay axis-parallel.
fn snapped_axis(angle: f64) -> DVec2 {
    let exact = |v: f64| if v.abs() < 1e-12 { 0.0 } else { v };
    let axis = DVec2::from_angle(angle);
    DVec2::new(exact(axis.x), exact(axis.y)).normalize()
}
