//! What is welded, on what, and what holds it.

use crate::error::{DistortError, within};
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// One bead, arc on to arc off.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Bead {
    /// Points along the middle of its top, mm, at least two; a closed one ends where it began.
    pub points: Vec<DVec3>,
    /// Width, mm.
    pub width: f64,
    /// Height, mm, from the metal below to its points.
    pub height: f64,
    /// Heat that metal receives per length, J/mm.
    pub heat: f64,
    /// When it begins, s.
    pub start: f64,
    /// When it ends, s.
    pub end: f64,
    /// Normal of its layer, of length 1; +z in level layers.
    pub up: DVec3,
}

impl Bead {
    /// Length, mm.
    pub fn length(&self) -> f64 {
        self.points.windows(2).map(|pair| pair[0].distance(pair[1])).sum()
    }

    /// Volume of the box that stands for it, mm³.
    pub fn volume(&self) -> f64 {
        self.length() * self.width * self.height
    }

    pub(crate) fn check(&self, bead: usize) -> Result<(), DistortError> {
        let fault = |reason| Err(DistortError::Bead { bead, reason });
        if self.points.len() < 2 || self.length() <= 0.0 {
            return fault("it has no length; give at least two points that differ");
        }
        if !self.points.iter().all(|p| p.is_finite() && p.abs().max_element() < 1e6) {
            return fault("a point is not finite or lies more than 1 km away");
        }
        if !((0.01..=1000.0).contains(&self.width) && (0.01..=1000.0).contains(&self.height)) {
            return fault("width and height must lie between 0.01 and 1000 mm");
        }
        if !(0.0..=1e6).contains(&self.heat) {
            return fault("the heat must lie between 0 and 10⁶ J/mm");
        }
        if !(self.start.is_finite() && self.end >= self.start) {
            return fault("it must not end before it starts");
        }
        if (self.up.length() - 1.0).abs() < 1e-6 { Ok(()) } else { fault("its normal must have the length 1") }
    }
}

/// The plate that is welded on.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Plate {
    /// Lowest corner, mm.
    pub low: DVec3,
    /// Highest corner, mm.
    pub high: DVec3,
    /// Young's modulus as a multiple of the part's; 1 for the same material.
    pub stiffness: f64,
}

impl Plate {
    /// Lengths of its sides, mm.
    pub fn size(&self) -> DVec3 {
        self.high - self.low
    }

    pub(crate) fn check(&self) -> Result<(), DistortError> {
        let size = self.size();
        if !(size.min_element() > 0.0 && self.low.is_finite() && self.high.is_finite()) {
            return Err(DistortError::NoPlate);
        }
        within("stiffness of the plate", self.stiffness, [1e-3, 1e3], "(of the part's)")
    }

    /// Clamps on the four corners, each holding what lies within `radius` (mm) of a point half as far inside on each side.
    pub fn clamped_at_corners(&self, radius: f64, stiffness: DVec3) -> Vec<Clamp> {
        let inside = 0.5 * radius;
        let xs = [self.low.x + inside, self.high.x - inside];
        let ys = [self.low.y + inside, self.high.y - inside];
        let corner = |i: usize| DVec3::new(xs[i & 1], ys[i >> 1], self.high.z);
        (0..4).map(|i| Clamp { at: corner(i), radius, stiffness }).collect()
    }

    /// Clamps all along the edge, at most `spacing` (mm) apart.
    pub fn clamped_along_edge(&self, spacing: f64, radius: f64, stiffness: DVec3) -> Vec<Clamp> {
        let (low, high) = (self.low, self.high);
        let corners = [(low.x, low.y), (high.x, low.y), (high.x, high.y), (low.x, high.y)];
        let corners = corners.map(|(x, y)| DVec3::new(x, y, high.z));
        let side = |i: usize| {
            let (from, to) = (corners[i], corners[(i + 1) % 4]);
            let pieces = (from.distance(to) / spacing.max(0.1)).ceil().clamp(1.0, 1e4) as usize;
            (0..pieces).map(move |n| from.lerp(to, n as f64 / pieces as f64))
        };
        (0..4).flat_map(side).map(|at| Clamp { at, radius, stiffness }).collect()
    }
}

/// A clamp: a spring between a place of the plate and the table.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Clamp {
    /// Middle of what it holds, mm.
    pub at: DVec3,
    /// It holds the nodes of the plate's upper face within this distance, mm, or the nearest if there is none.
    pub radius: f64,
    /// Stiffness along x, y and z, N/mm: 10⁴ to 10⁶ for a clamp with its bolt, less along the plate if it can slip.
    pub stiffness: DVec3,
}

impl Clamp {
    /// The stiffness of a firm clamp, N/mm; our own default.
    pub const FIRM: DVec3 = DVec3::splat(1e5);

    pub(crate) fn check(&self) -> Result<(), DistortError> {
        within("radius of a clamp", self.radius, [0.0, 1e4], "mm")?;
        for stiffness in self.stiffness.to_array() {
            within("stiffness of a clamp", stiffness, [0.0, 1e9], "N/mm")?;
        }
        within("place of a clamp", self.at.abs().max_element(), [0.0, 1e6], "mm")
    }
}
