//! Layers on a cone: domes and overhangs. Each layer is a cone of the same angle, farther out; its tip lies farther along the axis.
//!
//! A point on a layer has an angle about the axis and a distance from the layer's tip. Unrolled, the layer is a sector:
//! the distance is kept, and the angle is multiplied by the sine of the cone's half angle.

use super::At;
use super::polar::{Around, Axes, Polar};
use glam::{DVec2, DVec3};

/// Layers on the outside of a cone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cone {
    /// Tip of the cone on which the build begins, mm.
    pub tip: DVec3,
    /// Unit vector along the axis, into the cone.
    pub axis: DVec3,
    /// Angle between the axis and the cone's surface, °.
    pub half_angle: f64,
    /// Angle at which layers are cut open and unrolled, °; about an axis along z it is counted from x.
    pub seam: f64,
}

impl Cone {
    /// The same layers, starting `by` mm lower.
    pub(super) fn lowered(&self, by: f64) -> Self {
        Self { tip: self.tip + self.axis * (by / self.half_angle.to_radians().sin()), ..*self }
    }

    fn axes(&self) -> Axes {
        Axes::new(self.axis, self.seam.to_radians())
    }
}

impl Polar for Cone {
    fn around(&self, p: DVec3) -> Around {
        let from = p - self.tip;
        let (angle, radius) = self.axes().polar(from);
        let (sin, cos) = self.half_angle.to_radians().sin_cos();
        Around { angle, along: radius / sin, height: radius * cos - from.dot(self.axis) * sin }
    }

    fn off_axis(&self, p: DVec3) -> f64 {
        self.axes().polar(p - self.tip).1
    }

    fn at(&self, angle: f64, along: f64, height: f64) -> At {
        let [outward, around] = self.axes().outward_and_around(angle);
        let (sin, cos) = self.half_angle.to_radians().sin_cos();
        let line = self.axis * cos + outward * sin;
        let place = self.tip - self.axis * (height / sin) + line * along;
        // Unrolled, this angle's straight line points away from the tip.
        let (x, y) = (angle * sin).sin_cos();
        At { place, along: [around * y + line * x, line * y - around * x], normal: outward * cos - self.axis * sin }
    }

    fn unrolled(&self, angle: f64, along: f64, _middle: f64) -> DVec2 {
        let (sin, cos) = (angle * self.half_angle.to_radians().sin()).sin_cos();
        DVec2::new(along * sin, along * cos)
    }

    fn rolled(&self, p: DVec2, _middle: f64) -> (f64, f64) {
        (p.x.atan2(p.y) / self.half_angle.to_radians().sin(), p.length())
    }

    fn risen(&self, angle: f64, along: f64, rise: f64) -> (f64, f64) {
        (angle, along + rise / self.half_angle.to_radians().tan())
    }
}
