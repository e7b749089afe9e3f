//! Layers around an axis: bosses and flanges on a shaft, blades on a hub, the overlay of a pipe, outside or inside.
//!
//! u = angle × radius at the layer's middle, v runs along the axis, h is the distance from the radius at which the
//! build begins; all mm.

use super::At;
use super::polar::{Around, Axes, Polar};
use glam::{DVec2, DVec3};

/// Layers around an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cylinder {
    /// A point on the axis, at which v is 0, mm.
    pub through: DVec3,
    /// Unit vector along the axis.
    pub axis: DVec3,
    /// Radius at which the build begins, mm.
    pub radius: f64,
    /// On which side layers are laid.
    pub side: Side,
    /// Angle at which layers are cut open and unrolled, °; about an axis along z it is counted from x.
    pub seam: f64,
}

/// The side of a surface on which layers are laid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Side {
    /// Away from the axis.
    #[default]
    Outer,
    /// Towards the axis.
    Inner,
}

impl Side {
    /// The opposite one.
    pub fn other(self) -> Self {
        match self {
            Self::Outer => Self::Inner,
            Self::Inner => Self::Outer,
        }
    }

    fn sign(self) -> f64 {
        match self {
            Self::Outer => 1.0,
            Self::Inner => -1.0,
        }
    }
}

impl Cylinder {
    /// Angle of a point about the axis, from half a turn beyond the seam, °.
    pub fn angle(&self, p: DVec3) -> f64 {
        self.around(p).angle.to_degrees()
    }

    fn axes(&self) -> Axes {
        Axes::new(self.axis, self.seam.to_radians())
    }

    fn radius_at(&self, height: f64) -> f64 {
        self.radius + self.side.sign() * height
    }
}

impl Polar for Cylinder {
    fn around(&self, p: DVec3) -> Around {
        let from = p - self.through;
        let (angle, radius) = self.axes().polar(from);
        Around { angle, along: from.dot(self.axis), height: self.side.sign() * (radius - self.radius) }
    }

    fn off_axis(&self, p: DVec3) -> f64 {
        self.axes().polar(p - self.through).1
    }

    fn at(&self, angle: f64, along: f64, height: f64) -> At {
        let [outward, around] = self.axes().outward_and_around(angle);
        let sign = self.side.sign();
        let place = self.through + self.axis * along + outward * self.radius_at(height);
        // Seen along the normal, u and v are oriented like x and y seen from above.
        At { place, along: [around * sign, self.axis], normal: outward * sign }
    }

    fn unrolled(&self, angle: f64, along: f64, middle: f64) -> DVec2 {
        DVec2::new(self.side.sign() * angle * self.radius_at(middle), along)
    }

    fn rolled(&self, p: DVec2, middle: f64) -> (f64, f64) {
        (self.side.sign() * p.x / self.radius_at(middle), p.y)
    }

    fn risen(&self, angle: f64, along: f64, _rise: f64) -> (f64, f64) {
        (angle, along)
    }
}
