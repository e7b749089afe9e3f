//! The contours of one plane, walked from triangle to triangle across shared edges.
//!
//! A crossed triangle has one edge that rises through the plane and one that falls. Entering by the falling edge
//! and leaving by the rising one keeps the solid on the left: outer contours come out counter-clockwise. A shared
//! edge rises in one triangle and falls in the other, so the walk never has to choose.

use crate::model::{Mesh, NO_NEIGHBOUR};
use glam::{DVec2, DVec3};
use planar::Ring;

/// The contours on one plane.
#[derive(Default)]
pub(super) struct Trace {
    pub(super) rings: Vec<Ring>,
    /// Contours that end at a hole in the surface.
    pub(super) open: Vec<Vec<DVec2>>,
}

/// Marks of visited triangles, reused from layer to layer.
pub(super) struct Scratch {
    visited: Vec<u32>,
    mark: u32,
}

impl Scratch {
    pub(super) fn new(triangles: usize) -> Self {
        Self { visited: vec![0; triangles], mark: 0 }
    }

    fn next_layer(&mut self) {
        if self.mark == u32::MAX {
            self.visited.fill(0);
            self.mark = 0;
        }
        self.mark += 1;
    }

    /// Whether this is the first visit on this layer.
    fn visit(&mut self, triangle: u32) -> bool {
        std::mem::replace(&mut self.visited[triangle as usize], self.mark) != self.mark
    }
}

/// The edges through which a contour enters and leaves a triangle.
#[derive(Clone, Copy)]
struct Crossed {
    falling: usize,
    rising: usize,
}

/// Indexed by the set of corners above the plane, corner k being bit k. A table instead of branches, because the set is
/// practically random and the processor would mispredict branches at every step.
const CROSSED: [Option<Crossed>; 8] = {
    const fn edges(falling: usize, rising: usize) -> Option<Crossed> {
        Some(Crossed { falling, rising })
    }
    [None, edges(0, 2), edges(1, 0), edges(1, 2), edges(2, 1), edges(0, 1), edges(2, 0), None]
};

/// One plane through a mesh.
pub(super) struct Cut<'a> {
    pub(super) mesh: &'a Mesh,
    /// For each vertex, the number of planes at or below it.
    pub(super) levels: &'a [u32],
    /// Index of the plane.
    pub(super) layer: u32,
    /// Height of the plane, mm.
    pub(super) plane: f64,
}

impl Cut<'_> {
    /// The contours through the `triangles` that the plane crosses.
    pub(super) fn trace(&self, triangles: &[u32], scratch: &mut Scratch) -> Trace {
        scratch.next_layer();
        let mut result = Trace::default();
        // Open contours first, from where they begin; only loops remain after that.
        for &triangle in triangles {
            let Some(Crossed { falling, .. }) = self.crossed(triangle) else { continue };
            if self.mesh.neighbours[triangle as usize][falling] == NO_NEIGHBOUR && scratch.visit(triangle) {
                let [upper, lower] = self.ends(triangle, falling);
                let mut points = vec![self.point(lower, upper)];
                self.walk(triangle, scratch, &mut points);
                result.open.push(points);
            }
        }
        for &triangle in triangles {
            if scratch.visit(triangle) {
                let mut points = Vec::new();
                if self.walk(triangle, scratch, &mut points) {
                    points.dedup();
                    result.rings.push(Ring::new(points));
                } else {
                    result.open.push(points);
                }
            }
        }
        result
    }

    /// Follows the contour from a triangle just visited; true when it comes back to a visited one.
    fn walk(&self, mut triangle: u32, scratch: &mut Scratch, points: &mut Vec<DVec2>) -> bool {
        while let Some(Crossed { rising, .. }) = self.crossed(triangle) {
            let [lower, upper] = self.ends(triangle, rising);
            points.push(self.point(lower, upper));
            triangle = self.mesh.neighbours[triangle as usize][rising];
            if triangle == NO_NEIGHBOUR {
                return false;
            }
            if !scratch.visit(triangle) {
                return true;
            }
        }
        false
    }

    fn crossed(&self, triangle: u32) -> Option<Crossed> {
        let [a, b, c] = self.mesh.triangles[triangle as usize].map(|v| self.levels[v as usize] > self.layer);
        CROSSED[usize::from(a) | usize::from(b) << 1 | usize::from(c) << 2]
    }

    fn ends(&self, triangle: u32, edge: usize) -> [DVec3; 2] {
        let corners = self.mesh.triangles[triangle as usize];
        [corners[edge], corners[(edge + 1) % 3]].map(|v| self.mesh.vertices[v as usize])
    }

    /// Where an edge meets the plane; computed from the lower end, so that both triangles get the same point.
    fn point(&self, lower: DVec3, upper: DVec3) -> DVec2 {
        let t = (self.plane - lower.z) / (upper.z - lower.z);
        lower.truncate().lerp(upper.truncate(), t)
    }
}
