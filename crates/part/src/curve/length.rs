//! Arc length by Gauss–Legendre quadrature, and its inverse.
//!
//! Every knot span is integrated with 16 points and halved until the halves agree with the whole to 1e-11 of the
//! total length; the halves are kept as a table, in which Newton's method finds the parameter of a length.

use super::Nurbs;
use glam::DVec3;

/// Abscissae above 0 and weights of the 16-point rule (Abramowitz & Stegun, table 25.4).
const GAUSS_16: [(f64, f64); 8] = [
    (0.095_012_509_837_637_44, 0.189_450_610_455_068_5),
    (0.281_603_550_779_258_9, 0.182_603_415_044_923_6),
    (0.458_016_777_657_227_4, 0.169_156_519_395_002_5),
    (0.617_876_244_402_643_8, 0.149_595_988_816_576_7),
    (0.755_404_408_355_003, 0.124_628_971_255_533_9),
    (0.865_631_202_387_831_8, 0.095_158_511_682_492_8),
    (0.944_575_023_073_232_6, 0.062_253_523_938_647_9),
    (0.989_400_934_991_649_9, 0.027_152_459_411_754_1),
];

/// Halves must agree with the whole to this fraction of the total length.
const AGREEMENT: f64 = 1e-11;

/// Most times a span is halved in succession; a cusp takes about forty.
const MAX_DEPTH: u32 = 44;

/// A span is cut into at most this many pieces.
const MAX_PIECES: usize = 4096;

/// The arc length along a curve, tabulated.
#[derive(Debug, Clone)]
pub struct ArcLength<'a> {
    curve: &'a Nurbs,
    parameters: Vec<f64>,
    lengths: Vec<f64>,
}

impl Nurbs {
    /// Length of the curve, mm, to a relative accuracy of about 1e-9.
    pub fn length(&self) -> f64 {
        self.arc_length().total()
    }

    /// The table of lengths, for repeated queries on one curve.
    pub fn arc_length(&self) -> ArcLength<'_> {
        let breaks = self.breaks();
        let spans: Vec<(f64, f64, f64)> =
            breaks.windows(2).map(|w| (w[0], w[1], self.quadrature(w[0], w[1]))).collect();
        // Speeds are differences of coordinates, so they are no more accurate than the coordinates' rounding.
        let rounding = 4.0 * f64::EPSILON * self.degree as f64 * self.reach();
        let tolerance = (AGREEMENT * spans.iter().map(|s| s.2).sum::<f64>()).max(rounding);
        let mut table = ArcLength { curve: self, parameters: vec![breaks[0]], lengths: vec![0.0] };
        for (a, b, whole) in spans {
            let limit = table.lengths.len() + MAX_PIECES;
            table.refine(a, b, whole, (tolerance, limit), MAX_DEPTH);
        }
        table
    }

    /// Length between two parameters of one knot span, mm, by 16 points.
    fn quadrature(&self, a: f64, b: f64) -> f64 {
        let (middle, half) = ((a + b) / 2.0, (b - a) / 2.0);
        let speed = |u: f64| self.derivative(u).length();
        let pair = |&(x, w): &(f64, f64)| w * (speed(middle - half * x) + speed(middle + half * x));
        half * GAUSS_16.iter().map(pair).sum::<f64>()
    }
}

impl ArcLength<'_> {
    /// Adds the span from `a` to `b`, halved until halves and whole agree within the tolerance or the table reaches the
    /// limit.
    fn refine(&mut self, a: f64, b: f64, whole: f64, (tolerance, limit): (f64, usize), depth: u32) {
        let middle = (a + b) / 2.0;
        let (left, right) = (self.curve.quadrature(a, middle), self.curve.quadrature(middle, b));
        if (left + right - whole).abs() > tolerance && depth > 0 && self.lengths.len() < limit {
            self.refine(a, middle, left, (tolerance, limit), depth - 1);
            self.refine(middle, b, right, (tolerance, limit), depth - 1);
        } else {
            self.push(middle, left);
            self.push(b, right);
        }
    }

    fn push(&mut self, parameter: f64, length: f64) {
        self.parameters.push(parameter);
        self.lengths.push(self.total() + length);
    }

    /// Length of the whole curve, mm.
    pub fn total(&self) -> f64 {
        self.lengths.last().copied().unwrap_or_default()
    }

    /// Length from the start to parameter `u`, mm.
    pub fn at(&self, u: f64) -> f64 {
        let (start, end) = self.curve.domain();
        let u = u.clamp(start, end);
        let i = self.parameters.partition_point(|&t| t <= u).clamp(1, self.parameters.len() - 1) - 1;
        self.lengths[i] + self.curve.quadrature(self.parameters[i], u)
    }

    /// The parameter at `length` (mm) from the start; beyond an end, the parameter of that end.
    pub fn parameter(&self, length: f64) -> f64 {
        let length = length.clamp(0.0, self.total());
        let i = self.lengths.partition_point(|&s| s <= length).clamp(1, self.lengths.len() - 1) - 1;
        let (mut low, mut high) = (self.parameters[i], self.parameters[i + 1]);
        let (start, wanted, whole) = (low, length - self.lengths[i], self.lengths[i + 1] - self.lengths[i]);
        let mut u = if whole > 0.0 { low + (high - low) * wanted / whole } else { low };
        // Newton's method, kept inside a bracket that shrinks with every step.
        for _ in 0..60 {
            let excess = self.curve.quadrature(start, u) - wanted;
            if excess.abs() <= 1e-14 * self.total() || high <= low {
                break;
            }
            if excess > 0.0 {
                high = u
            } else {
                low = u
            }
            let next = u - excess / self.curve.derivative(u).length();
            let next = if next > low && next < high { next } else { (low + high) / 2.0 };
            if next == u {
                break;
            }
            u = next;
        }
        u
    }

    /// The point at `length` (mm) from the start.
    ///
    /// ```
    /// use bead_part::curve::Nurbs;
    /// use glam::DVec3;
    ///
    /// let line = Nurbs::polyline(vec![DVec3::ZERO, DVec3::X * 30.0, DVec3::new(30.0, 10.0, 0.0)])?;
    /// let lengths = line.arc_length();
    /// assert!((lengths.total() - 40.0).abs() < 1e-9);
    /// assert!(lengths.point(35.0).distance(DVec3::new(30.0, 5.0, 0.0)) < 1e-9);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn point(&self, length: f64) -> DVec3 {
        self.curve.point(self.parameter(length))
    }

    /// Parameters that cut the curve into `pieces` (at least 1) parts of equal length, both ends included.
    pub fn equal_parameters(&self, pieces: usize) -> Vec<f64> {
        let (start, end) = self.curve.domain();
        let pieces = pieces.max(1);
        let inner = (1..pieces).map(|i| self.parameter(self.total() * i as f64 / pieces as f64));
        std::iter::once(start).chain(inner).chain([end]).collect()
    }
}
