//! 104: arcs of `A x² + B x y + C y² + D x + E y + F = 0`, as exact rational quadratics.

use super::entities::{Read, text};
use super::free_format::Parameters;
use crate::curve::Nurbs;
use glam::{DMat3, DVec2, DVec3, dvec2, dvec3};
use std::f64::consts::TAU;

/// Ends of an ellipse closer than this fraction of its size coincide: the ellipse is complete.
const SAME: f64 = 1e-9;

/// Reads a conic arc: six coefficients, z, start and end. An ellipse runs counter-clockwise.
///
/// # Errors
/// A description of the fault, as the rest of a sentence.
pub(super) fn curve(p: &Parameters) -> Read {
    let [a, b, c, d, e, f] = [1, 2, 3, 4, 5, 6].map(|i| p.real(i));
    let (a, b, c, d, e, f) = (a?, b?, c?, d?, e?, f?);
    let z = p.real(7)?;
    let (start, end) = (dvec2(p.real(8)?, p.real(9)?), dvec2(p.real(10)?, p.real(11)?));
    // The conic as a symmetric form of (x, y, 1).
    let form = DMat3::from_cols(dvec3(a, b / 2.0, d / 2.0), dvec3(b / 2.0, c, e / 2.0), dvec3(d / 2.0, e / 2.0, f));
    let curve = if a * c - b * b / 4.0 > 1e-12 * (a * a + b * b + c * c) {
        ellipse(&form, z, start, end)
    } else {
        open_conic(&form, z, start, end)
    };
    Ok((curve?, 11))
}

fn ellipse(form: &DMat3, z: f64, start: DVec2, end: DVec2) -> Result<Nurbs, String> {
    let (a, b, c) = (form.x_axis.x, 2.0 * form.x_axis.y, form.y_axis.y);
    let (d, e) = (form.x_axis.z, form.y_axis.z);
    let determinant = a * c - b * b / 4.0;
    let centre = dvec2(b / 2.0 * e - c * d, b / 2.0 * d - a * e) / determinant;
    let level = -value(form, centre, centre);
    let turn = 0.5 * b.atan2(a - c);
    let axis = DVec2::from_angle(turn);
    let along = |v: DVec2| a * v.x * v.x + b * v.x * v.y + c * v.y * v.y;
    let (u, v) = (axis * (level / along(axis)).sqrt(), axis.perp() * (level / along(axis.perp())).sqrt());
    if !(u.is_finite() && v.is_finite() && u.length_squared() * v.length_squared() > 0.0) {
        return Err("its coefficients have no real points".to_owned());
    }
    let angle = |p: DVec2| {
        let p = p - centre;
        (p.dot(v) / v.length_squared()).atan2(p.dot(u) / u.length_squared())
    };
    let is_whole = start.distance(end) <= SAME * u.length().max(v.length());
    let sweep = if is_whole { TAU } else { (angle(end) - angle(start)).rem_euclid(TAU) };
    Nurbs::arc(lifted(centre, z), lifted(u, 0.0), lifted(v, 0.0), angle(start), sweep).map_err(text)
}

/// A parabola or a hyperbola: the tangents at the ends meet in the middle control point, and the weight there
/// follows from the form F along the curve, `w² = −F(start, end) / 2 F(corner, corner)`.
fn open_conic(form: &DMat3, z: f64, start: DVec2, end: DVec2) -> Result<Nurbs, String> {
    let tangent = |p: DVec2| *form * dvec3(p.x, p.y, 1.0);
    let meet = tangent(start).cross(tangent(end));
    let corner = meet.truncate() / meet.z;
    let square = -value(form, start, end) / (2.0 * value(form, corner, corner));
    if !corner.is_finite() || !square.is_finite() || square <= 0.0 {
        return Err("its start and end do not lie on one branch of a parabola or hyperbola".to_owned());
    }
    Nurbs::conic(lifted(start, z), lifted(corner, z), lifted(end, z), square.sqrt()).map_err(text)
}

fn value(form: &DMat3, p: DVec2, q: DVec2) -> f64 {
    dvec3(p.x, p.y, 1.0).dot(*form * dvec3(q.x, q.y, 1.0))
}

fn lifted(p: DVec2, z: f64) -> DVec3 {
    p.extend(z)
}
