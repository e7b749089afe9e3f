//! Layers around an axis: a point has an angle, a place along the layer's straight lines, and a height. A layer is unrolled from
//! half a turn before the angle 0 to half a turn after it.

use super::At;
use glam::{DVec2, DVec3};
use std::f64::consts::{PI, TAU};

/// A point of space, seen from an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Around {
    /// rad, above -π and up to π
    pub(super) angle: f64,
    /// Along the straight line of its layer that it lies on, mm.
    pub(super) along: f64,
    /// Over the surface on which the build begins, mm.
    pub(super) height: f64,
}

/// Layers around an axis that unroll without stretch.
pub(super) trait Polar: Sync {
    /// A point of space.
    fn around(&self, p: DVec3) -> Around;

    /// Distance of a point from the axis, mm.
    fn off_axis(&self, p: DVec3) -> f64;

    /// A point given by angle (rad), place along its layer's straight line and height (mm).
    fn at(&self, angle: f64, along: f64, height: f64) -> At;

    /// A point of the layer with this middle (mm), unrolled.
    fn unrolled(&self, angle: f64, along: f64, middle: f64) -> DVec2;

    /// Back from [`Self::unrolled`]: angle and place along the straight line.
    fn rolled(&self, p: DVec2, middle: f64) -> (f64, f64);

    /// Angle and place along the straight line after `rise` mm along the normal.
    fn risen(&self, angle: f64, along: f64, rise: f64) -> (f64, f64);
}

/// Unit vectors from an axis to where angles begin, and to where they are a quarter turn.
#[derive(Debug, Clone, Copy)]
pub(super) struct Axes {
    zero: DVec3,
    quarter: DVec3,
}

/// The seam lies beside the angle that is given, so that no edge of a part lies in it, rad.
const BESIDE: f64 = 1.234_567e-4;
/// Points this close to half a turn lie on the seam, rad.
const ON_SEAM: f64 = 1e-9;

impl Axes {
    /// Angles begin beside `seam` (rad) and half a turn, so that a layer is unrolled from there on. The angle 0 of a vertical axis is
    /// along x.
    pub(super) fn new(axis: DVec3, seam: f64) -> Self {
        let start = if axis.x.abs() > 0.9 { DVec3::Y } else { DVec3::X };
        let start = (start - axis * axis.dot(start)).normalize();
        let beside = axis.cross(start);
        let (sin, cos) = (seam + PI + BESIDE).sin_cos();
        let zero = start * cos + beside * sin;
        Self { zero, quarter: axis.cross(zero) }
    }

    /// Angle (rad, above -π and up to π) and distance from the axis (mm) of a vector from a point on it.
    pub(super) fn polar(&self, from_axis: DVec3) -> (f64, f64) {
        let (x, y) = (from_axis.dot(self.zero), from_axis.dot(self.quarter));
        let angle = y.atan2(x);
        (if angle.abs() > PI - ON_SEAM { PI } else { angle }, x.hypot(y))
    }

    /// Unit vectors away from the axis and around it.
    pub(super) fn outward_and_around(&self, angle: f64) -> [DVec3; 2] {
        let (sin, cos) = angle.sin_cos();
        [self.zero * cos + self.quarter * sin, self.quarter * cos - self.zero * sin]
    }
}

/// The angle that is nearest to another, whole turns away, rad.
pub(super) fn near(angle: f64, to: f64) -> f64 {
    angle + ((to - angle) / TAU).round() * TAU
}
