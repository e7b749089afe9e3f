//! A plane that cuts away what lies on one side of it, to show the inside.

use glam::DVec3;

/// A plane square to an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Section {
    /// The axis: 0 x, 1 y, 2 z.
    pub axis: usize,
    /// Its position on the axis, mm.
    pub at: f64,
    /// Whether the side of the smaller coordinates is cut away, and not that of the greater ones.
    pub lower: bool,
}

impl Section {
    /// Normal of length 1 and offset, mm: points with normal · point > offset are cut away.
    pub fn plane(&self) -> (DVec3, f64) {
        let sign = if self.lower { -1.0 } else { 1.0 };
        let normal = DVec3::AXES.get(self.axis).copied().unwrap_or(DVec3::X) * sign;
        (normal, self.at * sign)
    }

    /// The stretch of a ray on the side that is kept: from and to this multiple of its direction; `None` if it never
    /// is.
    pub fn kept(&self, origin: DVec3, way: DVec3) -> Option<(f64, f64)> {
        let (normal, offset) = self.plane();
        let (ahead, room) = (normal.dot(way), offset - normal.dot(origin));
        if ahead.abs() < 1e-12 {
            return (room >= 0.0).then_some((0.0, f64::INFINITY));
        }
        let meets = room / ahead;
        if ahead < 0.0 { Some((meets.max(0.0), f64::INFINITY)) } else { (meets > 0.0).then_some((0.0, meets)) }
    }
}
