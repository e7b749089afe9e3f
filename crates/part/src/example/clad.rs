//! Cladding of a saddle, in layers that follow it.

use super::surface_body;
use crate::model::solid::Solid;
use glam::{DVec2, DVec3};

/// Half its length and width, mm.
const HALF: DVec2 = DVec2::new(70.0, 45.0);
/// Thickness of the cladding, mm.
const THICKNESS: f64 = 5.6;
/// Pieces along each side.
const PIECES: [u32; 2] = [70, 46];

/// Height of the saddle, mm; its lowest places lie at 0.
fn saddle(p: DVec2) -> f64 {
    let part = p / HALF;
    4.0 + 6.0 * part.x * part.x - 4.0 * part.y * part.y
}

pub(super) fn bodies() -> String {
    surface_body("clad", 10.0, 8, 6, saddle)
}

pub(super) fn build() -> Solid {
    let [columns, rows] = PIECES;
    let place = |i: u32, j: u32| {
        HALF * (2.0 * DVec2::new(f64::from(i) / f64::from(columns), f64::from(j) / f64::from(rows)) - 1.0)
    };
    let pair = |p: DVec2| [p.extend(saddle(p) + THICKNESS), p.extend(saddle(p))];
    let vertices: Vec<DVec3> = (0..=rows).flat_map(|j| (0..=columns).flat_map(move |i| pair(place(i, j)))).collect();
    let top = |i: u32, j: u32| 2 * (j * (columns + 1) + i);
    let mut triangles = Vec::new();
    for j in 0..rows {
        for i in 0..columns {
            let [a, b, c, d] = [top(i, j), top(i + 1, j), top(i + 1, j + 1), top(i, j + 1)];
            triangles.extend([[a, b, c], [a, c, d], [a + 1, c + 1, b + 1], [a + 1, d + 1, c + 1]]);
        }
    }
    let mut side = |a: u32, b: u32| triangles.extend([[a, a + 1, b + 1], [a, b + 1, b]]);
    for i in 0..columns {
        side(top(i, 0), top(i + 1, 0));
        side(top(i + 1, rows), top(i, rows));
    }
    for j in 0..rows {
        side(top(columns, j), top(columns, j + 1));
        side(top(0, j + 1), top(0, j));
    }
    Solid { vertices, triangles }
}
