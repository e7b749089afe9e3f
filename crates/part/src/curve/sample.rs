//! Points along a curve.

use super::Nurbs;
use glam::DVec3;

/// Fractions of an interval at which its chord is compared with the curve; not symmetric, so that a wave that crosses
/// the chord in the middle is noticed.
const PROBES: [f64; 5] = [0.13, 0.31, 0.5, 0.69, 0.87];

/// Chords are made a little tighter than asked for, as a margin for the curve between the probes.
const SAFETY: f64 = 0.9;

/// A piece is halved at most this many times.
const MAX_DEPTH: u32 = 14;

/// Largest number of pieces of equal length.
const MAX_PIECES: f64 = 1e7;

impl Nurbs {
    /// Parameters between which the curve departs from its chords by at most `error`, mm; knots and ends are among
    /// them.
    ///
    /// Every knot span is first cut into as many pieces as the degree; then every chord is compared with the curve at
    /// five places. An `error` below 1e-9 of the curve's extent, or below the rounding of its coordinates, is raised to
    /// that.
    pub fn parameters_by_chord(&self, error: f64) -> Vec<f64> {
        let error = SAFETY * error.max(1e-9 * self.extent()).max(1e-14 * self.reach());
        let breaks = self.breaks();
        let mut parameters = vec![breaks[0]];
        for span in breaks.windows(2) {
            for piece in 0..self.degree {
                let at = |i: usize| span[0] + (span[1] - span[0]) * i as f64 / self.degree as f64;
                let b = if piece + 1 == self.degree { span[1] } else { at(piece + 1) };
                self.halve((at(piece), self.point(at(piece))), (b, self.point(b)), error, MAX_DEPTH, &mut parameters);
            }
        }
        parameters
    }

    fn halve(&self, a: (f64, DVec3), b: (f64, DVec3), error: f64, depth: u32, out: &mut Vec<f64>) {
        let leaves = |share: f64| {
            let p = self.point(a.0 + (b.0 - a.0) * share);
            nearest_on_segment(p, a.1, b.1).1 > error
        };
        if self.degree > 1 && depth > 0 && PROBES.into_iter().any(leaves) {
            let u = (a.0 + b.0) / 2.0;
            let middle = (u, self.point(u));
            self.halve(a, middle, error, depth - 1, out);
            self.halve(middle, b, error, depth - 1, out);
        } else {
            out.push(b.0);
        }
    }

    /// Points whose chords depart from the curve by at most `error`, mm; both ends are among them.
    pub fn points_by_chord(&self, error: f64) -> Vec<DVec3> {
        self.parameters_by_chord(error).into_iter().map(|u| self.point(u)).collect()
    }

    /// Points at equal lengths along the curve, at most `step` mm apart; both ends are among them.
    pub fn points_by_length(&self, step: f64) -> Vec<DVec3> {
        let table = self.arc_length();
        let pieces = (table.total() / step - 1e-9).ceil().clamp(1.0, MAX_PIECES) as usize;
        table.equal_parameters(pieces).into_iter().map(|u| self.point(u)).collect()
    }
}

/// The nearest point on the segment from `a` to `b`: its fraction along the segment, and its distance, mm.
pub(super) fn nearest_on_segment(p: DVec3, a: DVec3, b: DVec3) -> (f64, f64) {
    let along = b - a;
    let square = along.length_squared();
    let share = if square > 0.0 { ((p - a).dot(along) / square).clamp(0.0, 1.0) } else { 0.0 };
    (share, p.distance(a + along * share))
}
