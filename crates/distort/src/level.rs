//! The stiffness of one level, multiplied without being put together.

use crate::element::{Blocks, Matrix};
use crate::mesh::Mesh;
use crate::real::Real;

/// Voxels computed at once.
const LANES: usize = 8;

/// Voxels that are all alike but for a factor.
#[derive(Debug, Clone, Default)]
pub(crate) struct Alike {
    pub(crate) corners: Vec<[u32; 8]>,
    pub(crate) factors: Vec<f64>,
    /// Where the voxels of each slab begin.
    pub(crate) starts: Vec<usize>,
}

/// Voxels that each have a matrix of their own.
#[derive(Debug, Clone, Default)]
pub(crate) struct Single {
    pub(crate) corners: Vec<[u32; 8]>,
    pub(crate) matrices: Vec<[[f32; 24]; 24]>,
    pub(crate) starts: Vec<usize>,
}

/// What multiplies a displacement: voxels, and springs to the ground.
#[derive(Debug, Clone)]
pub(crate) struct Stiffness<T> {
    pub(crate) blocks: Blocks<T>,
    pub(crate) alike: Alike,
    pub(crate) single: Single,
    /// Stiffness of springs at nodes, N/mm.
    pub(crate) springs: Vec<(u32, [T; 3])>,
}

/// The blocks in another precision, with the factor of going to the corner patterns and back.
pub(crate) fn in_precision<T: Real>(blocks: &Blocks<f64>) -> Blocks<T> {
    blocks.map(|block| block.map(|row| row.map(T::of)))
}

/// A matrix in single precision.
pub(crate) fn single(matrix: &Matrix) -> [[f32; 24]; 24] {
    matrix.map(|row| row.map(|value| value as f32))
}

impl<T: Real> Stiffness<T> {
    /// Forces of a displacement.
    pub(crate) fn apply(&self, mesh: &Mesh, moved: &[[T; 3]], forces: &mut [[T; 3]]) {
        mesh.each_chunk(forces, |chunk, own| {
            own.fill([T::default(); 3]);
            // Voxels of the slab before touch the first nodes; there are none past the last slab.
            let slabs = chunk.slabs.start.saturating_sub(1)..chunk.slabs.end;
            let first = chunk.nodes.start;
            self.add_alike(slabs.clone(), moved, own, first);
            self.add_single(slabs, moved, own, first);
            self.add_springs(moved, own, first);
        });
    }

    fn add_alike(&self, slabs: std::ops::Range<usize>, moved: &[[T; 3]], own: &mut [[T; 3]], first: usize) {
        let range = range_of(&self.alike.starts, slabs);
        let corners = self.alike.corners[range.clone()].chunks(LANES);
        for (corners, factors) in corners.zip(self.alike.factors[range].chunks(LANES)) {
            let mut values = [[[T::default(); LANES]; 8]; 3];
            for (lane, corners) in corners.iter().enumerate() {
                for (corner, &node) in corners.iter().enumerate() {
                    let moved = moved[node as usize];
                    (0..3).for_each(|d| values[d][corner][lane] = moved[d]);
                }
            }
            let mut scale = [T::default(); LANES];
            scale.iter_mut().zip(factors).for_each(|(s, &f)| *s = T::of(f));
            self.multiply(&mut values, &scale);
            for (lane, corners) in corners.iter().enumerate() {
                for (corner, &node) in corners.iter().enumerate() {
                    if let Some(force) = own.get_mut((node as usize).wrapping_sub(first)) {
                        (0..3).for_each(|d| force[d] += values[d][corner][lane]);
                    }
                }
            }
        }
    }

    /// Displacements of corners become forces.
    fn multiply(&self, values: &mut [[[T; LANES]; 8]; 3], scale: &[T; LANES]) {
        values.iter_mut().for_each(patterns);
        for (kind, block) in self.blocks.iter().enumerate() {
            let old: [[T; LANES]; 3] = std::array::from_fn(|d| values[d][kind ^ (1 << d)]);
            for (d, row) in block.iter().enumerate() {
                let new = &mut values[d][kind ^ (1 << d)];
                for lane in 0..LANES {
                    let sum = row[0] * old[0][lane] + row[1] * old[1][lane] + row[2] * old[2][lane];
                    new[lane] = scale[lane] * sum;
                }
            }
        }
        values.iter_mut().for_each(patterns);
    }

    fn add_single(&self, slabs: std::ops::Range<usize>, moved: &[[T; 3]], own: &mut [[T; 3]], first: usize) {
        if self.single.corners.is_empty() {
            return;
        }
        let range = range_of(&self.single.starts, slabs);
        for (corners, matrix) in self.single.corners[range.clone()].iter().zip(&self.single.matrices[range]) {
            let mut sum = [T::default(); 24];
            for (corner, &node) in corners.iter().enumerate() {
                for (d, &moved) in moved[node as usize].iter().enumerate() {
                    let row = &matrix[3 * corner + d];
                    sum.iter_mut().zip(row).for_each(|(s, &k)| *s += T::of(f64::from(k)) * moved);
                }
            }
            for (corner, &node) in corners.iter().enumerate() {
                if let Some(force) = own.get_mut((node as usize).wrapping_sub(first)) {
                    (0..3).for_each(|d| force[d] += sum[3 * corner + d]);
                }
            }
        }
    }

    fn add_springs(&self, moved: &[[T; 3]], own: &mut [[T; 3]], first: usize) {
        for &(node, stiffness) in &self.springs {
            if let Some(force) = own.get_mut((node as usize).wrapping_sub(first)) {
                (0..3).for_each(|d| force[d] += stiffness[d] * moved[node as usize][d]);
            }
        }
    }
}

fn range_of(starts: &[usize], slabs: std::ops::Range<usize>) -> std::ops::Range<usize> {
    let last = starts.len() - 1;
    starts[slabs.start.min(last)]..starts[slabs.end.min(last)]
}

/// From values at the corners to the sums over the eight corner patterns, or back, but for a factor of 8.
fn patterns<T: Real>(values: &mut [[T; LANES]; 8]) {
    for bit in [1, 2, 4] {
        for low in (0..8).filter(|low| low & bit == 0) {
            let (a, b) = (values[low], values[low | bit]);
            values[low] = std::array::from_fn(|lane| a[lane] + b[lane]);
            values[low | bit] = std::array::from_fn(|lane| a[lane] - b[lane]);
        }
    }
}
