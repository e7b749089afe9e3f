//! A dished cap, to be welded over a mould in layers that follow it.

use super::surface_body;
use crate::model::solid::Solid;
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// Radius of the mould, mm.
const RADIUS: f64 = 300.0;
/// Radius of the cap as seen from above, mm.
const RIM: f64 = 70.0;
/// Thickness along its axis, mm.
const THICKNESS: f64 = 12.0;
const RINGS: u32 = 28;
const AROUND: u32 = 96;

/// Height of the mould, mm; the rim lies at 0.
fn mould(p: DVec2) -> f64 {
    (RADIUS * RADIUS - p.length_squared()).sqrt() - (RADIUS * RADIUS - RIM * RIM).sqrt()
}

pub(super) fn bodies() -> String {
    surface_body("dome", 10.0, 8, 8, mould)
}

pub(super) fn build() -> Solid {
    let top = |p: DVec2| p.extend(mould(p) + THICKNESS);
    let under = |p: DVec2| p.extend(mould(p));
    let mut vertices: Vec<DVec3> = vec![top(DVec2::ZERO), under(DVec2::ZERO)];
    for ring in 1..=RINGS {
        let radius = RIM * f64::from(ring) / f64::from(RINGS);
        let at = |k: u32| DVec2::from_angle(TAU * f64::from(k) / f64::from(AROUND)) * radius;
        vertices.extend((0..AROUND).flat_map(|k| [top(at(k)), under(at(k))]));
    }
    // The upper and the lower vertex at a position on a ring.
    let [above, below] = [0, 1].map(|side| move |ring: u32, k: u32| 2 + 2 * ((ring - 1) * AROUND + k % AROUND) + side);
    let mut triangles = Vec::new();
    for k in 0..AROUND {
        triangles.extend([[0, above(1, k), above(1, k + 1)], [1, below(1, k + 1), below(1, k)]]);
        for ring in 1..RINGS {
            let [a, b, c, d] =
                [(ring, k), (ring + 1, k), (ring + 1, k + 1), (ring, k + 1)].map(|(ring, k)| above(ring, k));
            triangles.extend([[a, b, c], [a, c, d], [a + 1, c + 1, b + 1], [a + 1, d + 1, c + 1]]);
        }
        let [a, b] = [above(RINGS, k), above(RINGS, k + 1)];
        triangles.extend([[a, a + 1, b + 1], [a, b + 1, b]]);
    }
    Solid { vertices, triangles }
}
