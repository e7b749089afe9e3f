//! A rectilinear grid of voxels: fine where the part is, coarser toward the edge of the plate.

use glam::DVec3;

/// The edges of voxels along x, y and z, mm. Voxel (i, j, k) has the index i + nx · (j + ny · k).
#[derive(Debug, Clone, PartialEq)]
pub struct Grid {
    edges: [Vec<f64>; 3],
}

impl Grid {
    /// A grid with these edges, each list ascending and with two or more.
    pub fn new(edges: [Vec<f64>; 3]) -> Self {
        Self { edges }
    }

    /// Equal voxels of `size` (mm) from `low` on.
    pub fn even(low: DVec3, size: DVec3, counts: [usize; 3]) -> Self {
        let axis = |a: usize| (0..=counts[a]).map(|i| low[a] + size[a] * i as f64).collect();
        Self::new([axis(0), axis(1), axis(2)])
    }

    /// Number of voxels along each axis.
    pub fn counts(&self) -> [usize; 3] {
        [0, 1, 2].map(|a| self.edges[a].len() - 1)
    }

    /// Number of voxels.
    pub fn len(&self) -> usize {
        self.counts().iter().product()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Distance between the indices of neighbours along each axis.
    pub fn strides(&self) -> [usize; 3] {
        let [nx, ny, _] = self.counts();
        [1, nx, nx * ny]
    }

    /// Index of a voxel along each axis.
    pub fn place(&self, voxel: usize) -> [usize; 3] {
        let [nx, ny, _] = self.counts();
        [voxel % nx, voxel / nx % ny, voxel / (nx * ny)]
    }

    /// Size of a voxel, mm.
    pub fn size(&self, voxel: usize) -> DVec3 {
        let place = self.place(voxel);
        let size = |a: usize| self.edges[a][place[a] + 1] - self.edges[a][place[a]];
        DVec3::new(size(0), size(1), size(2))
    }

    /// Middle of a voxel, mm.
    pub fn middle(&self, voxel: usize) -> DVec3 {
        let place = self.place(voxel);
        let middle = |a: usize| self.edges[a][place[a]].midpoint(self.edges[a][place[a] + 1]);
        DVec3::new(middle(0), middle(1), middle(2))
    }

    /// The index along an axis of the voxel that contains a coordinate; the outermost ones include everything beyond.
    pub fn along(&self, axis: usize, at: f64) -> usize {
        let edges = &self.edges[axis];
        edges.partition_point(|edge| *edge <= at).clamp(1, edges.len() - 1) - 1
    }

    /// Index of the voxel that contains a point; the outermost ones include everything beyond.
    pub fn holding(&self, place: DVec3) -> usize {
        self.column(place.x, place.y, self.along(2, place.z))
    }

    /// Index of the voxel at (x, y) in the level `level`.
    pub fn column(&self, x: f64, y: f64, level: usize) -> usize {
        let [_, nx, plane] = self.strides();
        self.along(0, x) + nx * self.along(1, y) + plane * level
    }
}

/// Edges about `size` apart from `low` to `high`, and increasingly far apart outside, up to `beyond` (mm) on either
/// side.
pub(super) fn graded([low, high]: [f64; 2], beyond: [f64; 2], size: f64) -> Vec<f64> {
    /// Each voxel outside is larger than its inner neighbour by this factor.
    const GROWTH: f64 = 1.5;
    let count = ((high - low) / size - 1e-6).ceil().max(1.0);
    let inner = (0..=count as usize).map(|i| low + (high - low) * i as f64 / count);
    let outer = |margin: f64| {
        let mut outer = Vec::new();
        let (mut reach, mut step) = (0.0, size);
        while margin - reach > 1e-6 {
            // A remainder that is not worth a voxel of its own.
            reach = if margin - reach < 1.5 * step { margin } else { reach + step };
            outer.push(reach);
            step *= GROWTH;
        }
        outer
    };
    let [below, above] = beyond.map(outer);
    let below = below.into_iter().rev().map(|reach| low - reach);
    below.chain(inner).chain(above.into_iter().map(|reach| high + reach)).collect()
}
