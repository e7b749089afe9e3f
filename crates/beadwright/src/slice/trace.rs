//! The contours of one plane, walked from triangle to triangle across shared edges.
//!
//! A crossed triangle has one edge that rises through the plane and one that falls. Entering by the falling edge
//! and leaving by the rising one keeps the solid on the left: outer contours come out counter-clockwise. A shared
//! edge rises in one triangle and falls in the other, so the walk never has to choose.

use crate::model::{Mesh, NO_NEIGHBOUR};
use glam::{DVec2, DVec3};
use planar::Ring;

/// What one plane gives.
#[derive(Default)]
pub(super) struct Trace {
    pub(super) rings: Vec<Ring>,
    /// Contours that end at a hole of the surface.
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

/// Where a triangle lets the contour in and out.
struct Crossed {
    falling: usize,
    rising: usize,
}

pub(super) fn trace(mesh: &Mesh, plane: f64, triangles: &[u32], scratch: &mut Scratch) -> Trace {
    let walker = Walker { mesh, plane };
    scratch.next_layer();
    let mut result = Trace::default();
    // Open contours first, from where they begin; what is left after them are loops.
    for &triangle in triangles {
        let Some(crossed) = walker.crossed(triangle) else { continue };
        if mesh.neighbours[triangle as usize][crossed.falling] == NO_NEIGHBOUR && scratch.visit(triangle) {
            let mut points = vec![walker.point(triangle, crossed.falling)];
            walker.walk(triangle, scratch, &mut points);
            result.open.push(points);
        }
    }
    for &triangle in triangles {
        if scratch.visit(triangle) {
            let mut points = Vec::new();
            if walker.walk(triangle, scratch, &mut points) {
                points.dedup();
                result.rings.push(Ring::new(points));
            } else {
                result.open.push(points);
            }
        }
    }
    result
}

struct Walker<'a> {
    mesh: &'a Mesh,
    plane: f64,
}

impl Walker<'_> {
    /// Follows the contour from a triangle just visited; true when it comes back to a visited one.
    fn walk(&self, mut triangle: u32, scratch: &mut Scratch, points: &mut Vec<DVec2>) -> bool {
        while let Some(crossed) = self.crossed(triangle) {
            points.push(self.point(triangle, crossed.rising));
            triangle = self.mesh.neighbours[triangle as usize][crossed.rising];
            if triangle == NO_NEIGHBOUR {
                return false;
            }
            if !scratch.visit(triangle) {
                return true;
            }
        }
        false
    }

    fn corner(&self, triangle: u32, k: usize) -> DVec3 {
        self.mesh.vertices[self.mesh.triangles[triangle as usize][k % 3] as usize]
    }

    fn crossed(&self, triangle: u32) -> Option<Crossed> {
        let above = [0, 1, 2].map(|k| self.corner(triangle, k).z >= self.plane);
        let falling = (0..3).find(|&k| above[k] && !above[(k + 1) % 3])?;
        let rising = (0..3).find(|&k| !above[k] && above[(k + 1) % 3])?;
        Some(Crossed { falling, rising })
    }

    /// Where an edge meets the plane; computed from the lower end up, so that both triangles get the same point.
    fn point(&self, triangle: u32, edge: usize) -> DVec2 {
        let (mut low, mut high) = (self.corner(triangle, edge), self.corner(triangle, edge + 1));
        if low.z > high.z {
            std::mem::swap(&mut low, &mut high);
        }
        let t = (self.plane - low.z) / (high.z - low.z);
        low.truncate().lerp(high.truncate(), t)
    }
}
