//! What lies between two surfaces over a rectangle.

use crate::model::solid::Solid;
use glam::{DVec2, DVec3};

/// The solid over a rectangle around the origin, given by half its sides (mm), between two heights (mm) at each place, the
/// higher first. `pieces` is the number of facets along each side.
pub(super) fn between(half: DVec2, pieces: [u32; 2], heights: impl Fn(DVec2) -> [f64; 2]) -> Solid {
    let [columns, rows] = pieces;
    let place = |i: u32, j: u32| {
        half * (2.0 * DVec2::new(f64::from(i) / f64::from(columns), f64::from(j) / f64::from(rows)) - 1.0)
    };
    let pair = |p: DVec2| heights(p).map(|height| p.extend(height));
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
