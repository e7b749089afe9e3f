//! Curves and matrices from their parameters, in the unit and the plane of the entity. Parameters are numbered as in
//! the standard: 0 is the entity type.

use super::conic;
use super::free_format::Parameters;
use crate::curve::Nurbs;
use glam::{DAffine3, DMat3, DVec3, dvec3};
use std::f64::consts::TAU;

/// Ends of an arc closer than this fraction of its radius coincide: the arc is a circle.
const SAME: f64 = 1e-9;

/// The radii of an arc's ends may differ by this fraction.
const ROUND: f64 = 1e-3;

/// Gaps between the pieces of a parametric spline may be as wide as this fraction of its extent.
const GAP: f64 = 1e-4;

/// A curve, and the index of its last own parameter; pointers to properties follow.
pub(super) type Read = Result<(Nurbs, usize), String>;

/// Whether entities of this type are curves that [`curve`] reads.
pub(super) fn is_curve(entity: u32) -> bool {
    matches!(entity, 100 | 104 | 106 | 110 | 112 | 126)
}

/// Reads a curve.
///
/// # Errors
/// A description of the fault with parameter and line, as the rest of a sentence.
pub(super) fn curve(entity: u32, form: i32, p: &Parameters) -> Read {
    match entity {
        100 => arc(p),
        104 => conic::curve(p),
        106 => copious(form, p),
        110 => Ok((Nurbs::line(point(p, 1)?, point(p, 4)?).map_err(text)?, 6)),
        112 => parametric_spline(p),
        126 => spline(p),
        _ => Err(format!("entity {entity} is not a curve")),
    }
}

/// An error as text.
pub(super) fn text(error: impl std::fmt::Display) -> String {
    error.to_string()
}

/// Three numbers from parameter `i`.
fn point(p: &Parameters, i: usize) -> Result<DVec3, String> {
    Ok(dvec3(p.real(i)?, p.real(i + 1)?, p.real(i + 2)?))
}

fn reals(p: &Parameters, first: usize, count: usize) -> Result<Vec<f64>, String> {
    (first..first + count).map(|i| p.real(i)).collect()
}

/// 100: z, centre, start, end in the plane; counter-clockwise, and a whole circle when start and end agree.
fn arc(p: &Parameters) -> Read {
    let z = p.real(1)?;
    let at = |i: usize| -> Result<DVec3, String> { Ok(dvec3(p.real(i)?, p.real(i + 1)?, z)) };
    let (centre, start, end) = (at(2)?, at(4)?, at(6)?);
    let (from, to) = (start - centre, end - centre);
    let radius = from.length();
    if (to.length() - radius).abs() > ROUND * radius {
        return Err(format!("the radius is {radius} at its start and {} at its end", to.length()));
    }
    let angle = |v: DVec3| v.y.atan2(v.x);
    let is_circle = start.distance(end) <= SAME * radius;
    let sweep = if is_circle { TAU } else { (angle(to) - angle(from)).rem_euclid(TAU) };
    let curve = Nurbs::arc(centre, DVec3::X * radius, DVec3::Y * radius, angle(from), sweep);
    Ok((curve.map_err(text)?, 7))
}

/// 106: points (forms 1 to 3), polylines (11 to 13) and closed plane polylines (63).
fn copious(form: i32, p: &Parameters) -> Read {
    if !matches!(form, 1..=3 | 11..=13 | 63) {
        return Err(format!("copious data of form {form} is not read"));
    }
    // Flag 1: pairs with one z before them; 2: points; 3: points with a vector each.
    let flag = p.integer(1)?;
    let size = match flag {
        1 => 2,
        2 => 3,
        3 => 6,
        _ => return Err(format!("parameter 1 is {flag}, and must be 1, 2 or 3")),
    };
    let count = p.count(2, size)?;
    let first = if flag == 1 { 4 } else { 3 };
    let z = if flag == 1 { p.real(3)? } else { 0.0 };
    let at = |i: usize| {
        let at = first + size * i;
        if flag == 1 { Ok(dvec3(p.real(at)?, p.real(at + 1)?, z)) } else { point(p, at) }
    };
    let mut points = (0..count).map(at).collect::<Result<Vec<_>, String>>()?;
    if form == 63 && points.first() != points.last() {
        points.extend(points.first().copied());
    }
    Ok((Nurbs::polyline(points).map_err(text)?, first + size * count - 1))
}

/// 112: cubic polynomials `a + b s + c s² + d s³` over each piece, s = u − break.
fn parametric_spline(p: &Parameters) -> Read {
    // A piece takes one break and twelve coefficients.
    let pieces = p.count(4, 13)?;
    let breaks = reals(p, 5, pieces + 1)?;
    let mut points: Vec<DVec3> = Vec::with_capacity(3 * pieces + 1);
    let (mut end, mut gap) = (None::<DVec3>, 0.0);
    for i in 0..pieces {
        let first = 6 + pieces + 12 * i;
        let [x, y, z] = [first, first + 4, first + 8].map(|at| reals(p, at, 4));
        let (x, y, z) = (x?, y?, z?);
        let h = breaks[i + 1] - breaks[i];
        let term = |k: usize| dvec3(x[k], y[k], z[k]) * h.powi(k as i32);
        let (a, b, c, d) = (term(0), term(1), term(2), term(3));
        gap = end.map_or(gap, |end| f64::max(gap, end.distance(a)));
        points.extend([a, a + b / 3.0, a + b * (2.0 / 3.0) + c / 3.0]);
        end = Some(a + b + c + d);
    }
    points.extend(end);
    let ends = [breaks[0], breaks[pieces]];
    let inner = breaks.iter().flat_map(|&t| [t; 3]);
    let knots = std::iter::once(ends[0]).chain(inner).chain([ends[1]]).collect();
    let curve = Nurbs::new(3, knots, vec![1.0; points.len()], points).map_err(text)?;
    if gap > GAP * curve.extent() {
        return Err(format!("its pieces do not meet: they are {gap} units of the file apart"));
    }
    Ok((curve, 5 + pieces + 12 * (pieces + 1)))
}

/// 126: K, M, four flags, knots, weights, points, start and end parameter, normal.
fn spline(p: &Parameters) -> Read {
    let upper = p.count(1, 5)?;
    let degree = usize::try_from(p.integer(2)?).map_err(|_| "its degree is negative".to_owned())?;
    // Checked here, because a huge degree would require as many knots.
    if degree > upper {
        return Err(format!("it has {} control points, too few for its degree {degree}", upper + 1));
    }
    let (points, knots) = (upper + 1, upper + degree + 2);
    let (weights_at, points_at) = (7 + knots, 7 + knots + points);
    let control = (0..points).map(|i| point(p, points_at + 3 * i)).collect::<Result<_, _>>()?;
    let curve = Nurbs::new(degree, reals(p, 7, knots)?, reals(p, weights_at, points)?, control).map_err(text)?;
    let range_at = points_at + 3 * points;
    Ok((in_range(curve, p, range_at)?, range_at + 4))
}

/// The piece between the given start and end parameters; the whole curve if they are omitted.
fn in_range(curve: Nurbs, p: &Parameters, i: usize) -> Result<Nurbs, String> {
    if !(p.has(i) || p.has(i + 1)) {
        return Ok(curve);
    }
    let (from, to) = (p.real(i)?, p.real(i + 1)?);
    let (start, end) = curve.domain();
    let slack = SAME * (end - start);
    if from <= start + slack && to >= end - slack {
        return Ok(curve);
    }
    curve.piece(from, to).map_err(text)
}

/// 124: three rows of a rotation's three numbers and a shift, in the unit of the file.
///
/// # Errors
/// As [`curve`].
pub(super) fn matrix(p: &Parameters) -> Result<DAffine3, String> {
    let row = |i: usize| reals(p, 4 * i + 1, 4);
    let (x, y, z) = (row(0)?, row(1)?, row(2)?);
    let column = |k: usize| dvec3(x[k], y[k], z[k]);
    Ok(DAffine3::from_mat3_translation(DMat3::from_cols(column(0), column(1), column(2)), column(3)))
}
