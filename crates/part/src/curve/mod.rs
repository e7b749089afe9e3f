//! Curves in space: rational B-splines (NURBS), and exact versions of the shapes that walls are drawn with.
//!
//! | file | what it does |
//! | --- | --- |
//! | `nurbs` | the curve, its checks, reversing and moving |
//! | `evaluate` | points and derivatives (de Boor, equations 1–3 and 10 of Li et al.) |
//! | `refine` | one more knot; a piece of a curve |
//! | `shape` | lines, polylines, arcs and conics, exact |
//! | `length` | arc length and its inverse |
//! | `sample` | points by chord error and by equal length |
//! | `closest` | the nearest point of a curve |
//! | `fit` | cubics through points, and near them with few knots |
//! | `spline_space` | the basis of such a cubic and its least-squares solution |
//! | `banded` | the linear systems behind it |
//!
//! Lengths are in the unit of the control points, mm everywhere in Beadwright; parameters are dimensionless.

mod banded;
mod closest;
mod evaluate;
mod fit;
mod length;
mod nurbs;
mod refine;
mod sample;
mod shape;
mod spline_space;

pub use closest::Closest;
pub use fit::Fit;
pub use length::ArcLength;
pub use nurbs::{MAX_DEGREE, Nurbs};

/// Why a curve cannot be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CurveError {
    /// The degree is zero or beyond [`MAX_DEGREE`].
    #[error("the curve has degree {degree}; degrees from 1 to {MAX_DEGREE} are supported. Export it with degree 3.")]
    Degree {
        /// As given.
        degree: usize,
    },
    /// Too few control points.
    #[error(
        "the curve has {points} control points; degree {degree} takes at least {}. Export it again.",
        degree + 1
    )]
    TooFewPoints {
        /// Number given.
        points: usize,
        /// Degree of the curve.
        degree: usize,
    },
    /// The lengths of the lists do not match.
    #[error("the curve has {found} {what} where its degree and control points require {expected}. Export it again.")]
    Count {
        /// `knots` or `weights`.
        what: &'static str,
        /// Number given.
        found: usize,
        /// Number needed.
        expected: usize,
    },
    /// A value that is not a finite number.
    #[error("{what} {index} of the curve is not a finite number. Export it again.")]
    NotFinite {
        /// What is not finite: `knot`, `weight`, `control point` or `point`.
        what: &'static str,
        /// From 1.
        index: usize,
    },
    /// A knot below the one before.
    #[error("knot {index} of the curve ({knot}) is smaller than the one before it. Export it again.")]
    KnotOrder {
        /// From 1.
        index: usize,
        /// Its value.
        knot: f64,
    },
    /// A knot is repeated so often that the curve breaks in two.
    #[error(
        "knot {knot} of the curve occurs {times} times; at degree {degree} the curve breaks in two there. \
         Split it in the drawing program and export both."
    )]
    KnotRepeated {
        /// Its value.
        knot: f64,
        /// Its multiplicity.
        times: usize,
        /// Degree of the curve.
        degree: usize,
    },
    /// The curve begins and ends at the same parameter.
    #[error("the curve begins and ends at the same parameter ({start}), so it has no length. Export it again.")]
    EmptyDomain {
        /// The parameter.
        start: f64,
    },
    /// A weight that is zero or negative.
    #[error("weight {index} of the curve is {weight}; weights must be above 0. Export it again.")]
    Weight {
        /// From 1.
        index: usize,
        /// Its value.
        weight: f64,
    },
    /// Not enough different points for a fit.
    #[error("a curve cannot be fitted through {points} different points; at least {needed} are needed.")]
    TooFewToFit {
        /// Different points given.
        points: usize,
        /// Number needed.
        needed: usize,
    },
    /// A tolerance that is not a positive length.
    #[error("the curve is to be fitted within {error} mm; the tolerance must be a number above 0.")]
    Tolerance {
        /// As given, mm.
        error: f64,
    },
}
