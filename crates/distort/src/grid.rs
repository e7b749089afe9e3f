//! Where the voxels lie: equal boxes, and the nodes at their corners.

use glam::DVec3;

/// A lattice of equal boxes, and of the nodes at their corners.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grid {
    /// Number of voxels along x, y and z.
    pub counts: [usize; 3],
    /// Lengths of a voxel's edges, mm.
    pub size: DVec3,
    /// Lowest corner, mm.
    pub low: DVec3,
}

impl Grid {
    /// Number of voxels.
    pub fn voxels(&self) -> usize {
        self.counts.iter().product()
    }

    /// Number of nodes along x, y and z.
    pub fn node_counts(&self) -> [usize; 3] {
        self.counts.map(|n| n + 1)
    }

    /// Number of nodes.
    pub fn nodes(&self) -> usize {
        self.node_counts().iter().product()
    }

    /// Volume of a voxel, mm³.
    pub fn volume(&self) -> f64 {
        self.size.x * self.size.y * self.size.z
    }

    /// Index of the voxel at a position in the lattice; x counts fastest, then y.
    ///
    /// ```
    /// use distort::{DVec3, Grid};
    ///
    /// let grid = Grid { counts: [4, 3, 2], size: DVec3::ONE, low: DVec3::ZERO };
    /// assert_eq!(grid.voxel([1, 2, 1]), 1 + 4 * (2 + 3));
    /// assert_eq!(grid.voxel_at(grid.voxel([1, 2, 1])), [1, 2, 1]);
    /// assert_eq!(grid.place(grid.node([4, 3, 2])), DVec3::new(4.0, 3.0, 2.0));
    /// ```
    pub fn voxel(&self, at: [usize; 3]) -> usize {
        index(self.counts, at)
    }

    /// Position in the lattice of the voxel with this index.
    pub fn voxel_at(&self, index: usize) -> [usize; 3] {
        position(self.counts, index)
    }

    /// Index of the node at a position in the lattice; x counts fastest, then y.
    pub fn node(&self, at: [usize; 3]) -> usize {
        index(self.node_counts(), at)
    }

    /// Position in the lattice of the node with this index.
    pub fn node_at(&self, index: usize) -> [usize; 3] {
        position(self.node_counts(), index)
    }

    /// Place of the node with this index, mm.
    pub fn place(&self, node: usize) -> DVec3 {
        let [i, j, k] = self.node_at(node);
        self.low + DVec3::new(i as f64, j as f64, k as f64) * self.size
    }

    /// Indices of a voxel's eight nodes: bit 0 of the position in the list is towards +x, bit 1 +y, bit 2 +z.
    pub fn corners(&self, voxel: usize) -> [usize; 8] {
        let [i, j, k] = self.voxel_at(voxel);
        std::array::from_fn(|c| self.node([i + (c & 1), j + (c >> 1 & 1), k + (c >> 2)]))
    }

    /// Indices of the voxels around a node, up to eight.
    pub fn touching(&self, node: usize) -> impl Iterator<Item = usize> {
        let (grid, at) = (*self, self.node_at(node));
        (0..8).filter_map(move |part| {
            let side = |d: usize| at[d].checked_sub(part >> d & 1).filter(|&a| a < grid.counts[d]);
            Some(grid.voxel([side(0)?, side(1)?, side(2)?]))
        })
    }

    /// Index of the voxel that holds a place (mm), if any does.
    pub fn voxel_of(&self, place: DVec3) -> Option<usize> {
        let at = ((place - self.low) / self.size).floor().to_array();
        let inside = at.iter().zip(self.counts).all(|(&a, n)| a >= 0.0 && a < n as f64);
        inside.then(|| self.voxel(at.map(|a| a as usize)))
    }
}

/// Index in a lattice in which the first position counts fastest.
pub(crate) fn index(counts: [usize; 3], at: [usize; 3]) -> usize {
    at[0] + counts[0] * (at[1] + counts[1] * at[2])
}

/// The position with this index.
pub(crate) fn position(counts: [usize; 3], index: usize) -> [usize; 3] {
    [index % counts[0], index / counts[0] % counts[1], index / (counts[0] * counts[1])]
}
