//! Points and derivatives by de Boor's algorithm on homogeneous control points (w·x, w·y, w·z, w).
//!
//! C. de Boor, "On calculating with B-splines", J. Approx. Theory 6 (1972); quotient rule as in Piegl & Tiller,
//! "The NURBS Book", 4.3.

use super::{MAX_DEGREE, Nurbs};
use glam::{DVec3, DVec4};

/// The control points that matter in one span; elements beyond the degree are unused.
type Local = [DVec4; MAX_DEGREE + 1];

impl Nurbs {
    /// The point at parameter `u`, mm; outside the domain, the nearer end.
    pub fn point(&self, u: f64) -> DVec3 {
        let (u, span) = self.place(u);
        let value = self.de_boor(self.local(span), self.degree, span, u);
        value.truncate() / value.w
    }

    /// First derivative with respect to the parameter, mm; at a knot, of the piece after it, and at the end, of the
    /// last piece.
    pub fn derivative(&self, u: f64) -> DVec3 {
        self.derivatives(u)[1]
    }

    /// Point, first and second derivative at parameter `u`, mm.
    pub fn derivatives(&self, u: f64) -> [DVec3; 3] {
        let [value, first, second] = self.homogeneous(u);
        let point = value.truncate() / value.w;
        let velocity = (first.truncate() - point * first.w) / value.w;
        let acceleration = (second.truncate() - velocity * (2.0 * first.w) - point * second.w) / value.w;
        [point, velocity, acceleration]
    }

    /// Unit tangent at parameter `u`; where the derivative is zero, the direction right next to it; zero if the curve
    /// is a single point.
    pub fn tangent(&self, u: f64) -> DVec3 {
        let velocity = self.derivative(u);
        if velocity.length() > 1e-12 * self.extent() / (self.domain().1 - self.domain().0) {
            return velocity.normalize_or_zero();
        }
        let (start, end) = self.domain();
        let step = 1e-6 * (end - start);
        (self.point(u.min(end - step) + step) - self.point(u.max(start + step) - step)).normalize_or_zero()
    }

    fn homogeneous(&self, u: f64) -> [DVec4; 3] {
        let (u, span) = self.place(u);
        let mut local = self.local(span);
        let value = self.de_boor(local, self.degree, span, u);
        self.differentiate(&mut local, self.degree, span);
        let first = self.de_boor(local, self.degree - 1, span, u);
        if self.degree == 1 {
            return [value, first, DVec4::ZERO];
        }
        self.differentiate(&mut local, self.degree - 1, span);
        [value, first, self.de_boor(local, self.degree - 2, span, u)]
    }

    /// `u` clamped to the domain, and the k with `knots[k] <= u < knots[k + 1]` (at the end, the last span that is not
    /// empty).
    pub(super) fn place(&self, u: f64) -> (f64, usize) {
        let (start, end) = self.domain();
        let u = u.clamp(start, end);
        let inner = &self.knots[self.degree..=self.points.len()];
        let below = if u >= end { inner.partition_point(|&t| t < end) } else { inner.partition_point(|&t| t <= u) };
        (u, self.degree + below.max(1) - 1)
    }

    fn local(&self, span: usize) -> Local {
        let mut local = [DVec4::ZERO; MAX_DEGREE + 1];
        for (slot, i) in local.iter_mut().zip(span - self.degree..=span) {
            *slot = self.homogeneous_point(i);
        }
        local
    }

    /// Control point `i` as (w·x, w·y, w·z, w).
    pub(super) fn homogeneous_point(&self, i: usize) -> DVec4 {
        (self.points[i] * self.weights[i]).extend(self.weights[i])
    }

    /// De Boor's triangle for a spline of this degree, whose coefficient `local[j]` has index `span - degree + j`.
    fn de_boor(&self, mut local: Local, degree: usize, span: usize, u: f64) -> DVec4 {
        for round in 1..=degree {
            for j in (round..=degree).rev() {
                let i = span - degree + j;
                let (low, high) = (self.knots[i], self.knots[i + degree + 1 - round]);
                local[j] = local[j - 1].lerp(local[j], (u - low) / (high - low));
            }
        }
        local[degree]
    }

    /// Coefficients of the derivative, one degree lower, in the same span.
    fn differentiate(&self, local: &mut Local, degree: usize, span: usize) {
        for j in 0..degree {
            let i = span - degree + j;
            let width = self.knots[i + degree + 1] - self.knots[i + 1];
            local[j] = (local[j + 1] - local[j]) * (degree as f64 / width);
        }
    }
}
