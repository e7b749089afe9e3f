//! One voxel: its stiffness, and the forces of its shrinkage.
//!
//! A plain trilinear hexahedron is far too stiff in bending (shear locking): a strip two of them thick bends by less than
//! half. So the three incompatible modes of Wilson (1 − ξ², 1 − η², 1 − ζ² for each direction; Wilson, Taylor, Doherty,
//! Ghaboussi 1973; QM6 of Taylor, Beresford, Wilson 1976) are added and condensed. For boxes the two variants are the
//! same element, and it bends exactly under a constant moment with one voxel through the thickness.
//!
//! All voxels are equal but for a factor, so there is one stiffness matrix. A box has three planes of symmetry, so in the
//! basis of the eight corner patterns (+ or − along x, y, z: Walsh functions) the 24 × 24 matrix falls into eight blocks of
//! 3 × 3. Multiplying takes 264 operations that way instead of 1152.

use glam::DVec3;
use serde::{Deserialize, Serialize};

/// Elastic values of a material that is alike in all directions.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Elastic {
    /// Young's modulus, MPa.
    pub young: f64,
    /// Poisson's ratio.
    pub poisson: f64,
}

impl Elastic {
    /// Stress, MPa, of a strain; both as xx, yy, zz, xy, yz, zx with shear angles.
    ///
    /// ```
    /// use distort::Elastic;
    ///
    /// // Pulled along x, and free to become thinner.
    /// let stress = Elastic { young: 200e3, poisson: 0.3 }.stress(&[1e-3, -0.3e-3, -0.3e-3, 0.0, 0.0, 0.0]);
    /// assert!((stress[0] - 200.0).abs() < 1e-9 && stress[1].abs() < 1e-9);
    /// ```
    pub fn stress(&self, strain: &[f64; 6]) -> [f64; 6] {
        let shear = self.young / (2.0 * (1.0 + self.poisson));
        let lame = self.young * self.poisson / ((1.0 + self.poisson) * (1.0 - 2.0 * self.poisson));
        let sum = lame * (strain[0] + strain[1] + strain[2]);
        std::array::from_fn(|i| if i < 3 { 2.0 * shear * strain[i] + sum } else { shear * strain[i] })
    }
}

/// 24 × 24 values; row and column are 3 · corner + direction.
pub(crate) type Matrix = [[f64; 24]; 24];
/// The same in the basis of corner patterns: a 3 × 3 block for each of the eight kinds of symmetry.
pub(crate) type Blocks<T> = [[[T; 3]; 3]; 8];

const ZERO: Matrix = [[0.0; 24]; 24];

/// A box with its elastic values.
#[derive(Debug, Clone)]
pub(crate) struct Element {
    pub(crate) elastic: Elastic,
    pub(crate) size: DVec3,
    pub(crate) stiffness: Matrix,
}

/// The sign of a corner along a direction.
fn sign(corner: usize, direction: usize) -> f64 {
    if corner >> direction & 1 == 1 { 1.0 } else { -1.0 }
}

/// Strain of a displacement in `direction` whose gradient is given.
fn strain_of(direction: usize, gradient: [f64; 3]) -> [f64; 6] {
    let [x, y, z] = gradient;
    match direction {
        0 => [x, 0.0, 0.0, y, 0.0, z],
        1 => [0.0, y, 0.0, x, z, 0.0],
        _ => [0.0, 0.0, z, 0.0, y, x],
    }
}

impl Element {
    pub(crate) fn new(elastic: Elastic, size: DVec3) -> Self {
        let mut with_modes = [[0.0; 33]; 33];
        let weight = size.x * size.y * size.z / 8.0;
        for point in 0..8 {
            let at: [f64; 3] = std::array::from_fn(|d| sign(point, d) / 3f64.sqrt());
            let strains = strains_at(at, size);
            let stresses = strains.map(|strain| elastic.stress(&strain));
            for (row, strain) in with_modes.iter_mut().zip(&strains) {
                for (value, stress) in row.iter_mut().zip(&stresses) {
                    *value += weight * strain.iter().zip(stress).map(|(a, b)| a * b).sum::<f64>();
                }
            }
        }
        Self { elastic, size, stiffness: condensed(with_modes) }
    }

    /// Forces on the corners, N, that a stress-free strain (xx, yy, zz, xy, yz, zx) asks for.
    pub(crate) fn forces(&self, strain: &[f64; 6]) -> [[f64; 3]; 8] {
        let [xx, yy, zz, xy, yz, zx] = self.elastic.stress(strain);
        let faces = [self.size.y * self.size.z, self.size.z * self.size.x, self.size.x * self.size.y];
        std::array::from_fn(|corner| {
            let [x, y, z]: [f64; 3] = std::array::from_fn(|d| sign(corner, d) * faces[d] / 4.0);
            [xx * x + xy * y + zx * z, xy * x + yy * y + yz * z, zx * x + yz * y + zz * z]
        })
    }

    /// Mean strain of a displacement of the corners, mm.
    pub(crate) fn mean_strain(&self, moved: &[[f64; 3]; 8]) -> [f64; 6] {
        let mut mean = [0.0; 6];
        for (corner, moved) in moved.iter().enumerate() {
            let gradient = std::array::from_fn(|d| sign(corner, d) / (4.0 * self.size[d]));
            for (direction, along) in moved.iter().enumerate() {
                let strain = strain_of(direction, gradient);
                mean.iter_mut().zip(strain).for_each(|(m, s)| *m += s * along);
            }
        }
        mean
    }

    /// Volume, mm³.
    pub(crate) fn volume(&self) -> f64 {
        self.size.x * self.size.y * self.size.z
    }

    /// Elastic energy, N·mm, of a displacement of the corners (mm) with a stress-free strain.
    pub(crate) fn energy(&self, moved: &[[f64; 3]; 8], strain: &[f64; 6]) -> f64 {
        let stress = self.elastic.stress(strain);
        let own: f64 = stress.iter().zip(strain).map(|(a, b)| a * b).sum::<f64>() * self.volume();
        let (held, free) = (times(&self.stiffness, moved), self.forces(strain));
        let dot =
            |a: &[[f64; 3]; 8]| -> f64 { a.iter().flatten().zip(moved.iter().flatten()).map(|(a, b)| a * b).sum() };
        0.5 * dot(&held) - dot(&free) + 0.5 * own
    }
}

/// A matrix times a displacement of the corners.
pub(crate) fn times(matrix: &Matrix, moved: &[[f64; 3]; 8]) -> [[f64; 3]; 8] {
    let flat = moved.as_flattened();
    std::array::from_fn(|corner| {
        std::array::from_fn(|d| matrix[3 * corner + d].iter().zip(flat).map(|(k, u)| k * u).sum())
    })
}

/// Strains of the 24 displacements of corners and the nine incompatible modes, at a point of the unit cube [−1, 1]³.
fn strains_at(at: [f64; 3], size: DVec3) -> [[f64; 6]; 33] {
    std::array::from_fn(|column| {
        let (shape, direction) = (column / 3, column % 3);
        let gradient = std::array::from_fn(|d| {
            let local = if shape < 8 {
                let others = (0..3).filter(|&o| o != d).map(|o| 1.0 + sign(shape, o) * at[o]);
                sign(shape, d) / 8.0 * others.product::<f64>()
            } else if shape - 8 == d {
                -2.0 * at[d]
            } else {
                0.0
            };
            local * 2.0 / size[d]
        });
        strain_of(direction, gradient)
    })
}

/// The stiffness of the corners after the incompatible modes have found their equilibrium.
fn condensed(mut full: [[f64; 33]; 33]) -> Matrix {
    for mode in (24..33).rev() {
        let pivot = full[mode];
        for row in full.iter_mut().take(mode) {
            let factor = row[mode] / pivot[mode];
            row.iter_mut().zip(&pivot).for_each(|(value, p)| *value -= factor * p);
        }
    }
    std::array::from_fn(|row| std::array::from_fn(|column| full[row][column]))
}

/// The eight blocks of a matrix that has the three symmetries of a box.
///
/// The pattern `m` of a direction `d` belongs to the kind `m ^ (1 << d)`: mirrored at a plane, a displacement changes its
/// sign along the normal.
pub(crate) fn blocks(matrix: &Matrix) -> Blocks<f64> {
    let wave =
        |pattern: usize, corner: usize| if (pattern & corner).count_ones().is_multiple_of(2) { 1.0 } else { -1.0 };
    std::array::from_fn(|kind| {
        std::array::from_fn(|c| {
            std::array::from_fn(|d| {
                let pairs = (0..64).map(|pair| (pair % 8, pair / 8));
                let terms = pairs
                    .map(|(a, b)| wave(kind ^ (1 << c), a) * matrix[3 * a + c][3 * b + d] * wave(kind ^ (1 << d), b));
                terms.sum::<f64>() / 64.0
            })
        })
    })
}

/// The stiffness that a voxel has for the corners of one twice as large, of which it is the eighth `part` (bits as for
/// corners): Pᵀ K P with trilinear interpolation P.
pub(crate) fn seen_from_parent(matrix: &Matrix, part: usize) -> Matrix {
    let mut result = *matrix;
    for _ in 0..2 {
        (0..3).for_each(|axis| gather(&mut result, part, axis));
        result = transposed(&result);
    }
    result
}

/// Pᵀ along one axis: of two rows across it, one belongs to a corner of the parent, the other to the middle of its edge.
fn gather(matrix: &mut Matrix, part: usize, axis: usize) {
    for corner in (0..8).filter(|corner| corner >> axis & 1 == 0) {
        let other = corner | 1 << axis;
        let (outer, middle) = if part >> axis & 1 == 0 { (corner, other) } else { (other, corner) };
        for d in 0..3 {
            let half = matrix[3 * middle + d].map(|value| 0.5 * value);
            matrix[3 * outer + d].iter_mut().zip(half).for_each(|(value, h)| *value += h);
            matrix[3 * middle + d] = half;
        }
    }
}

fn transposed(matrix: &Matrix) -> Matrix {
    std::array::from_fn(|row| std::array::from_fn(|column| matrix[column][row]))
}

/// The sum of matrices with factors.
pub(crate) fn add(sum: &mut Matrix, factor: f64, matrix: &Matrix) {
    for (row, other) in sum.iter_mut().zip(matrix) {
        row.iter_mut().zip(other).for_each(|(value, o)| *value += factor * o);
    }
}

/// A matrix of zeros.
pub(crate) const fn zero() -> Matrix {
    ZERO
}
