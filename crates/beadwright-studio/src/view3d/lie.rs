//! How a layer lies in space: where its points are, and the direction out of it.

use beadwright::chart::Sheet;
use glam::{DVec3, Vec2, Vec3};

/// Straight pieces keep this close to the line on their layer, mm, and the layer turns by no more than this along each, rad.
const FINE: (f64, f64) = (0.05, 0.1);

/// A place in space, and the torch's attitude there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stance {
    /// The wire's tip, mm.
    pub at: DVec3,
    /// From the tip along the torch, of length 1.
    pub up: DVec3,
}

impl Stance {
    /// The attitude of a torch that points straight down.
    pub fn upright(at: DVec3) -> Self {
        Self { at, up: DVec3::Z }
    }

    /// The attitude at a fraction `part` (0 to 1) of the way to another.
    pub(super) fn towards(self, to: Self, part: f64) -> Self {
        let up = if self.up == to.up { self.up } else { self.up.lerp(to.up, part).normalize_or(self.up) };
        Self { at: self.at.lerp(to.at, part), up }
    }
}

/// A layer in space; level where it has no sheet.
#[derive(Clone, Copy)]
pub(super) struct Lie<'a>(pub Option<Sheet<'a>>);

impl Lie<'_> {
    pub(super) fn is_level(&self) -> bool {
        self.0.is_none()
    }

    /// A point of the layer, or above it.
    pub(super) fn stance(&self, p: DVec3) -> Stance {
        let on_sheet = |sheet: Sheet<'_>| sheet.at(p);
        self.0.map(on_sheet).map_or(Stance::upright(p), |at| Stance { at: at.place, up: at.normal })
    }

    /// Distance from a point of the layer to the surface that lies `height` (mm) below it, along the direction out of
    /// it, mm.
    pub(super) fn thickness(&self, p: DVec3, height: f64) -> f64 {
        if self.is_level() {
            return height;
        }
        let (top, below) = (self.stance(p), self.stance(p.with_z(p.z - height)));
        (top.at - below.at).dot(top.up).max(0.0)
    }

    /// Points from one to another, without the first, close enough together that the straight pieces between them
    /// follow the layer.
    pub(super) fn divided(&self, from: DVec3, to: DVec3) -> impl Iterator<Item = DVec3> + use<> {
        let (tolerance, angle) = FINE;
        let whole = self.is_level().then_some(to);
        let pieces = self.0.map(|sheet| sheet.divided(from, to, tolerance, angle));
        whole.into_iter().chain(pieces.into_iter().flatten())
    }

    /// A line in space that follows the layer.
    pub(super) fn line(&self, points: &[DVec3]) -> Vec<Stance> {
        let further = points.windows(2).flat_map(|leg| self.divided(leg[0], leg[1]));
        points.first().copied().into_iter().chain(further).map(|p| self.stance(p)).collect()
    }
}

/// A direction as the graphics card reads it (`turned_up` in `common.wgsl`): its place on an octahedron unfolded about its upper
/// tip, so that 0 is straight up.
pub(super) fn packed(up: DVec3) -> u32 {
    let flat = up / (up.x.abs() + up.y.abs() + up.z.abs());
    let folded = |own: f64, other: f64| if flat.z < 0.0 { (1.0 - other.abs()).copysign(own) } else { own };
    let number = |part: f64| u32::from(((part * LARGEST).round() as i16).cast_unsigned());
    number(folded(flat.x, flat.y)) | number(folded(flat.y, flat.x)) << 16
}

/// Back from [`packed`].
pub(super) fn unpacked(up: u32) -> Vec3 {
    if up == 0 {
        return Vec3::Z;
    }
    let part = |bits: u32| f32::from((bits as u16).cast_signed()) / LARGEST as f32;
    let flat = Vec2::new(part(up), part(up >> 16));
    let z = 1.0 - flat.x.abs() - flat.y.abs();
    let back = (-z).max(0.0);
    Vec3::new(flat.x - back.copysign(flat.x), flat.y - back.copysign(flat.y), z).normalize()
}

/// The value of 1 in 16 bits.
const LARGEST: f64 = 32767.0;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_come_out_of_four_bytes_as_they_went_in() {
        let around = (0..720).map(|i| f64::from(i) * 2.399_963);
        let spread = around.enumerate().map(|(i, angle)| {
            let z = 1.0 - 2.0 * (i as f64 + 0.5) / 720.0;
            DVec3::new((1.0 - z * z).sqrt() * angle.cos(), (1.0 - z * z).sqrt() * angle.sin(), z)
        });
        let axes = DVec3::AXES.into_iter().flat_map(|axis| [axis, -axis]);
        for up in spread.chain(axes) {
            let off = unpacked(packed(up)).as_dvec3().distance(up);
            assert!(off < 1e-4, "{up} is off by {off}");
        }
        assert_eq!((packed(DVec3::Z), unpacked(0)), (0, Vec3::Z));
    }
}
