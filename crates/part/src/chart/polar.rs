//! Layers around an axis: a point has an angle, a position along the layer's straight lines, and a height. A layer is
//! unrolled from half a turn before angle 0 to half a turn after it.

use super::At;
use glam::{DVec2, DVec3};
use std::f64::consts::{PI, TAU};

/// A point in space, relative to an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Around {
    /// Angle about the axis, rad, above -π and up to π.
    pub(super) angle: f64,
    /// Position along the straight line of its layer, mm.
    pub(super) along: f64,
    /// Height above the surface on which the build begins, mm.
    pub(super) height: f64,
}

/// Layers around an axis that unroll without stretch.
pub(super) trait Polar: Sync {
    /// The coordinates of a point in space.
    fn around(&self, p: DVec3) -> Around;

    /// Distance of a point from the axis, mm.
    fn off_axis(&self, p: DVec3) -> f64;

    /// The point with this angle (rad), position along its layer's straight line and height (mm).
    fn at(&self, angle: f64, along: f64, height: f64) -> At;

    /// The unrolled position of a point on the layer with this middle (mm).
    fn unrolled(&self, angle: f64, along: f64, middle: f64) -> DVec2;

    /// Inverse of [`Self::unrolled`]: angle (rad) and position along the straight line (mm).
    fn rolled(&self, p: DVec2, middle: f64) -> (f64, f64);

    /// Angle and position along the straight line after moving `rise` mm along the normal.
    fn risen(&self, angle: f64, along: f64, rise: f64) -> (f64, f64);
}

/// Unit vectors square to an axis: towards angle 0, and towards a quarter turn.
#[derive(Debug, Clone, Copy)]
pub(super) struct Axes {
    zero: DVec3,
    quarter: DVec3,
}

/// The seam is offset by this from the given angle, rad, so that no edge of a part lies in it.
const BESIDE: f64 = 1.234_567e-4;
/// Points this close to half a turn lie on the seam, rad.
const ON_SEAM: f64 = 1e-9;

impl Axes {
    /// Angle 0 is half a turn away from `seam` (rad), with the offset, so a layer is unrolled from the seam on. For a
    /// vertical axis, `seam` is counted from x.
    pub(super) fn new(axis: DVec3, seam: f64) -> Self {
        let start = if axis.x.abs() > 0.9 { DVec3::Y } else { DVec3::X };
        let start = (start - axis * axis.dot(start)).normalize();
        let beside = axis.cross(start);
        let (sin, cos) = (seam + PI + BESIDE).sin_cos();
        let zero = start * cos + beside * sin;
        Self { zero, quarter: axis.cross(zero) }
    }

    /// Angle (rad, above -π and up to π) and distance from the axis (mm) of a vector that starts on it.
    pub(super) fn polar(&self, from_axis: DVec3) -> (f64, f64) {
        let (x, y) = (from_axis.dot(self.zero), from_axis.dot(self.quarter));
        let angle = y.atan2(x);
        (if angle.abs() > PI - ON_SEAM { PI } else { angle }, x.hypot(y))
    }

    /// Unit vectors radially outwards and tangentially.
    pub(super) fn outward_and_around(&self, angle: f64) -> [DVec3; 2] {
        let (sin, cos) = angle.sin_cos();
        [self.zero * cos + self.quarter * sin, self.quarter * cos - self.zero * sin]
    }
}

/// The equivalent angle, whole turns away, that is nearest to another, rad.
pub(super) fn near(angle: f64, to: f64) -> f64 {
    angle + ((to - angle) / TAU).round() * TAU
}
