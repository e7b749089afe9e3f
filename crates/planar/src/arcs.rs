//! Polylines of many points, fitted with a few straight pieces and circular arcs.
//!
//! Each piece is made as long as the tolerance allows, and ends at a point of the line. An arc passes through both ends
//! of its piece and encloses the same area with its chord as the line does. A piece fits when every point of the line
//! lies within the tolerance of it *and* the line runs along it without turning back, so that the two are nowhere
//! farther apart than the tolerance, measured from either.

use crate::DVec2;
use std::f64::consts::PI;

/// Greatest sweep of an arc, radians: controllers accept less than half a turn, and the larger the sweep, the less
/// precisely three points define the arc.
pub const MAX_SWEEP: f64 = 170.0 / 180.0 * PI;

/// Least sweep of an arc, radians: one degree, as ABB controllers require.
pub const MIN_SWEEP: f64 = PI / 180.0;

/// Shortest chord of an arc, mm: its three points lie 0.1 mm apart or more.
const MIN_CHORD: f64 = 0.25;

/// An arc replaces at least this many straight segments: there is always an arc through three points.
const MIN_REPLACED: usize = 3;

/// Largest radius of an arc, mm: flatter ones are lines to a controller.
const MAX_RADIUS: f64 = 1e4;

/// How a line is fitted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fit {
    /// Greatest distance between the line and its pieces, mm.
    pub tolerance: f64,
    /// Whether pieces may be arcs.
    pub arcs: bool,
    /// The middle point of an arc is rounded to multiples of this, mm; the circle is the one through the three rounded
    /// points.
    pub grid: f64,
}

/// A circular arc; its piece gives the ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Arc {
    /// The point in its middle, rounded to [`Fit::grid`], mm.
    pub via: DVec2,
    /// Its centre, mm.
    pub centre: DVec2,
    /// Its radius, mm.
    pub radius: f64,
    /// The angle it turns through, radians; positive counter-clockwise.
    pub sweep: f64,
}

/// A piece of a fitted line; it begins where the piece before it ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Piece {
    /// Index of the point where it ends.
    pub end: usize,
    /// The arc; none for a straight piece.
    pub arc: Option<Arc>,
}

impl Arc {
    /// The arc through three points, mm; `None` when they lie on a line or the arc would turn by half a turn or more.
    ///
    /// ```
    /// use planar::{DVec2, arcs::Arc};
    /// use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};
    ///
    /// let quarter = Arc::through(DVec2::X, DVec2::from_angle(FRAC_PI_4), DVec2::Y).ok_or("no arc")?;
    /// assert!(quarter.centre.length() < 1e-9 && (quarter.radius - 1.0).abs() < 1e-9);
    /// assert!((quarter.sweep - FRAC_PI_2).abs() < 1e-9);
    /// assert_eq!(Arc::through(DVec2::ZERO, DVec2::X, DVec2::X * 2.0), None);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn through(from: DVec2, via: DVec2, to: DVec2) -> Option<Self> {
        let (a, b) = (via - from, to - from);
        let cross = a.perp_dot(b);
        let to_centre = (a.perp() * b.length_squared() - b.perp() * a.length_squared()) / (2.0 * cross);
        let (centre, radius) = (from + to_centre, to_centre.length());
        let sweep = (from - centre).angle_to(to - centre);
        // Turning left, the middle point lies to the right of the chord.
        let inside = cross * sweep > 0.0 && (via - centre).dot((from + to) / 2.0 - centre) > 0.0;
        (radius.is_finite() && inside).then_some(Self { via, centre, radius, sweep })
    }
}

impl Fit {
    /// The pieces of the open line through `points`; every piece ends at one of them, the last piece at the last point.
    ///
    /// ```
    /// use planar::{DVec2, arcs::Fit};
    /// use std::f64::consts::TAU;
    ///
    /// // An arc turns by less than half a turn, so a circle takes three.
    /// let circle: Vec<DVec2> = (0..=90).map(|k| DVec2::from_angle(TAU * f64::from(k) / 90.0) * 20.0).collect();
    /// let pieces = Fit { tolerance: 0.05, arcs: true, grid: 1e-3 }.pieces(&circle);
    /// assert_eq!(pieces.len(), 3);
    /// assert!(pieces.iter().all(|piece| piece.arc.is_some()));
    /// ```
    pub fn pieces(&self, points: &[DVec2]) -> Vec<Piece> {
        let (mut pieces, mut start) = (Vec::new(), 0);
        while start + 1 < points.len() {
            let piece = self.farthest(points, start);
            start = piece.end;
            pieces.push(piece);
        }
        pieces
    }

    /// The longest piece that fits from the first of `points`, of which there must be at least two.
    pub fn next(&self, points: &[DVec2]) -> Piece {
        self.farthest(points, 0)
    }

    /// The longest piece that fits from `start`. On a coarsely sampled arc a straight piece cannot replace even the
    /// first few segments, so an arc over the fewest segments is also tried as a start.
    fn farthest(&self, points: &[DVec2], start: usize) -> Piece {
        let one = self.grown(points, start, Piece { end: start + 1, arc: None });
        let least = start + MIN_REPLACED;
        if one.end >= least || least >= points.len() || !self.arcs {
            return one;
        }
        self.piece(&points[start..=least], least).map_or(one, |arc| self.grown(points, start, arc))
    }

    /// Lengthens a piece in steps that double while it fits and then halve.
    fn grown(&self, points: &[DVec2], start: usize, mut best: Piece) -> Piece {
        let (mut step, mut grows) = (1, true);
        while step > 0 {
            let found = Some(best.end + step).filter(|&end| end < points.len());
            match found.and_then(|end| self.piece(&points[start..=end], end)) {
                Some(longer) => best = longer,
                None => grows = false,
            }
            step = if grows { step * 2 } else { step / 2 };
        }
        best
    }

    fn piece(&self, line: &[DVec2], end: usize) -> Option<Piece> {
        if self.is_straight(line) {
            return Some(Piece { end, arc: None });
        }
        let arc = if self.arcs { self.arc(line) } else { None };
        arc.map(|arc| Piece { end, arc: Some(arc) })
    }

    fn is_straight(&self, line: &[DVec2]) -> bool {
        let [from, .., to] = *line else { return false };
        let Some(way) = (to - from).try_normalize() else { return false };
        line.iter().all(|&p| way.perp_dot(p - from).abs() <= self.tolerance)
            && line.windows(2).all(|w| way.dot(w[1] - w[0]) >= 0.0)
    }

    fn arc(&self, line: &[DVec2]) -> Option<Arc> {
        let [from, .., to] = *line else { return None };
        let half = from.distance(to) / 2.0;
        if line.len() <= MIN_REPLACED || 2.0 * half < MIN_CHORD {
            return None;
        }
        // Twice the area between line and chord, above 0 where the line bulges to the right: a turn to the left.
        let twice: f64 = line.windows(2).map(|w| (w[0] - from).perp_dot(w[1] - from)).sum();
        let sweep = sweep_of_area(twice.abs() / 2.0 / (half * half))?.copysign(twice);
        let bulge = half * (sweep / 4.0).tan();
        let middle = (from + to) / 2.0 - (to - from).perp() / (2.0 * half) * bulge;
        let via = (middle / self.grid).round() * self.grid;
        Arc::through(from, via, to).filter(|arc| self.runs_along(line, arc))
    }

    /// Whether the line stays within the tolerance of the arc and never turns back.
    fn runs_along(&self, line: &[DVec2], arc: &Arc) -> bool {
        let turn = arc.sweep.abs();
        if !(MIN_SWEEP..=MAX_SWEEP).contains(&turn) || arc.radius > MAX_RADIUS {
            return false;
        }
        let (mut turned, tolerance) = (0.0, self.tolerance);
        let along = line.windows(2).all(|w| {
            let (a, b) = (w[0] - arc.centre, w[1] - arc.centre);
            let step = a.angle_to(b) * arc.sweep.signum();
            turned += step;
            let nearest = (a - (b - a) * (a.dot(b - a) / (b - a).length_squared()).clamp(-1.0, 0.0)).length();
            step >= 0.0 && nearest >= arc.radius - tolerance && b.length() <= arc.radius + tolerance
        });
        along && (turned - turn).abs() < 1e-6
    }
}

/// Sweep, radians, of the arc that encloses `area` with its chord, the area in squared half chords; `None` for half a
/// turn or more ([`MAX_SWEEP`] is checked later).
fn sweep_of_area(area: f64) -> Option<f64> {
    let of = |sweep: f64| (sweep - sweep.sin()) / (2.0 * (sweep / 2.0).sin().powi(2));
    let (mut low, mut high) = (0.0, PI);
    if area <= 0.0 || area >= of(high) {
        return None;
    }
    for _ in 0..48 {
        let middle = (low + high) / 2.0;
        if of(middle) < area { low = middle } else { high = middle }
    }
    Some(high)
}
