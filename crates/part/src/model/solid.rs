//! Turns outlines into closed triangle meshes, wound counter-clockwise seen from outside.

use glam::{DVec2, DVec3};
use planar::triangulate::triangulate_by_edges;
use planar::{Polygon, Ring};
use std::collections::HashMap;
use std::f64::consts::TAU;

/// A closed surface of triangles, mm.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Solid {
    /// Corners, mm.
    pub vertices: Vec<DVec3>,
    /// Corners of each triangle, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
}

impl Solid {
    /// A prism over `base` from height `z0` up to `z1`, mm.
    pub fn extrude(base: &Polygon, z0: f64, z1: f64) -> Self {
        Self::loft(base, &[z0, z1], |p, _| p)
    }

    /// A body whose outline at each height of `levels` (mm, ascending) is `base` with its points moved by
    /// `place(point, height)`. The moved outline must not cross itself; turning and scaling are safe.
    pub fn loft(base: &Polygon, levels: &[f64], place: impl Fn(DVec2, f64) -> DVec2) -> Self {
        let points: Vec<DVec2> = base.rings().flat_map(Ring::points).copied().collect();
        let vertices = levels.iter().flat_map(|&z| points.iter().map(move |&p| (p, z)));
        let mut solid = Self { vertices: vertices.map(|(p, z)| place(p, z).extend(z)).collect(), triangles: vec![] };
        for level in 1..levels.len() {
            let mut below = (level - 1) * points.len();
            for ring in base.rings() {
                let count = ring.points().len();
                solid.wall(below, below + points.len(), count);
                below += count;
            }
        }
        solid.caps(&triangulate_by_edges(base), solid.vertices.len().saturating_sub(points.len()));
        solid
    }

    /// The body that the closed loop `profile` of (radius, height), mm, sweeps around the z axis in `segments` steps.
    /// Points on the axis have radius 0.
    pub fn revolve(profile: &[DVec2], segments: u32) -> Self {
        let profile = Polygon::simple(Ring::new(profile.to_vec())).outer.into_points();
        let mut solid = Self::default();
        let starts: Vec<u32> = profile.iter().map(|&p| solid.circle(p, segments)).collect();
        let vertex = |i: usize, k: u32| starts[i] + if profile[i].x == 0.0 { 0 } else { k % segments };
        for i in 0..profile.len() {
            let j = (i + 1) % profile.len();
            for k in 0..segments {
                let [a, b, c, d] = [vertex(i, k), vertex(i, k + 1), vertex(j, k + 1), vertex(j, k)];
                let halves = [[a, b, c], [a, c, d]].into_iter();
                solid.triangles.extend(halves.filter(|&[a, b, c]| a != b && b != c && c != a));
            }
        }
        solid
    }

    /// Merges vertices at the same position (to 1 nm) and drops triangles left without an area.
    pub fn welded(self) -> Self {
        let mut numbers = HashMap::new();
        let mut welded = Self::default();
        let number: Vec<u32> = self
            .vertices
            .iter()
            .map(|&vertex| {
                let key = (vertex * 1e6).round().as_i64vec3();
                *numbers.entry(key).or_insert_with(|| {
                    welded.vertices.push(vertex);
                    welded.vertices.len() as u32 - 1
                })
            })
            .collect();
        let triangles = self.triangles.iter().map(|t| t.map(|i| number[i as usize]));
        welded.triangles = triangles.filter(|&[a, b, c]| a != b && b != c && c != a).collect();
        welded
    }

    /// The wall between a ring of `count` vertices that begins at `low` and the one above that begins at `high`.
    fn wall(&mut self, low: usize, high: usize, count: usize) {
        for i in 0..count {
            let j = (i + 1) % count;
            let [a, b, c, d] = [low + i, low + j, high + j, high + i].map(|v| v as u32);
            self.triangles.extend([[a, b, c], [a, c, d]]);
        }
    }

    /// Closes the bottom, whose vertices come first, and the top, whose vertices begin at `top`.
    fn caps(&mut self, cap: &[[usize; 3]], top: usize) {
        for &[a, b, c] in cap {
            self.triangles.push([a, c, b].map(|i| i as u32));
            self.triangles.push([a, b, c].map(|i| (i + top) as u32));
        }
    }

    /// Adds the vertices of the circle that `p` (radius, height) sweeps, a single one if on the axis; returns the first
    /// index.
    fn circle(&mut self, p: DVec2, segments: u32) -> u32 {
        let first = self.vertices.len() as u32;
        let count = if p.x == 0.0 { 1 } else { segments };
        let at = |k: u32| (DVec2::from_angle(TAU * f64::from(k) / f64::from(count)) * p.x).extend(p.y);
        self.vertices.extend((0..count).map(at));
        first
    }
}
