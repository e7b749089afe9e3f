//! The elastic equations of the voxels that hold metal, and their solution by conjugate gradients.

use crate::element::{Element, blocks};
use crate::error::DistortError;
use crate::grid::Grid;
use crate::level::{Alike, Single, Stiffness, in_precision};
use crate::mesh::Mesh;
use crate::multigrid::Multigrid;
use crate::real::Field;
use crate::vector;

/// Iterations after which the solver gives up.
const MOST_ITERATIONS: usize = 1000;

/// Voxels with metal, springs, and what solves for their displacement.
pub(crate) struct System {
    pub(crate) mesh: Mesh,
    stiffness: Stiffness<f64>,
    multigrid: Multigrid,
}

impl System {
    /// `factors` has the stiffness of every voxel of the grid as a multiple of the element's, 0 without metal; springs
    /// (N/mm) hold nodes of the lattice, and those without metal are left out.
    pub(crate) fn new(grid: &Grid, element: &Element, factors: &[f64], springs: &[(usize, [f64; 3])]) -> Self {
        let mesh = Mesh::new(grid.counts, |voxel| factors[voxel] > 0.0);
        let factors: Vec<f64> = mesh.voxels.iter().map(|&voxel| factors[voxel]).collect();
        let springs: Vec<(u32, [f64; 3])> =
            springs.iter().filter_map(|&(node, k)| mesh.number(node).map(|number| (number as u32, k))).collect();
        let multigrid = Multigrid::new(&mesh, element, &factors, &springs);
        let alike = Alike { corners: mesh.corners.clone(), factors, starts: mesh.voxel_starts.clone() };
        let blocks = in_precision(&blocks(&element.stiffness));
        let stiffness = Stiffness { blocks, alike, single: Single::default(), springs };
        Self { mesh, stiffness, multigrid }
    }

    /// Forces of a displacement, N.
    pub(crate) fn forces(&self, moved: &[[f64; 3]]) -> Field<f64> {
        let mut forces = vector::zeros(moved.len());
        self.stiffness.apply(&self.mesh, moved, &mut forces);
        forces
    }

    /// Changes a displacement, mm, until the residual's norm is below `target`, N; both are brought up to date. Returns
    /// the number of iterations.
    pub(crate) fn solve(
        &self,
        moved: &mut [[f64; 3]],
        residual: &mut [[f64; 3]],
        target: f64,
    ) -> Result<usize, DistortError> {
        let begin = vector::dot(residual, residual).sqrt();
        let mut norm = begin;
        let (mut guess, mut direction) = (Vec::new(), vector::zeros(moved.len()));
        let (mut forces, mut last, mut step) = (vector::zeros(moved.len()), 0.0, 0.0);
        for iteration in 0..MOST_ITERATIONS {
            if norm <= target || norm == 0.0 {
                return Ok(iteration);
            }
            self.multigrid.apply(residual, &mut guess);
            let product = vector::dot(residual, &guess);
            // The flexible form, since the preconditioner is in single precision.
            let keep = if iteration == 0 { 0.0 } else { -step * vector::dot(&forces, &guess) / last };
            vector::each2(&mut direction, &guess, |d, g| (0..3).for_each(|i| d[i] = g[i] + keep * d[i]));
            self.stiffness.apply(&self.mesh, &direction, &mut forces);
            let curvature = vector::dot(&direction, &forces);
            if !(product.is_finite() && curvature > 0.0) {
                break;
            }
            step = vector::dot(residual, &direction) / curvature;
            vector::each2(moved, &direction, |m, d| (0..3).for_each(|i| m[i] += step * d[i]));
            vector::each2(residual, &forces, |r, f| (0..3).for_each(|i| r[i] -= step * f[i]));
            last = product;
            norm = vector::dot(residual, residual).sqrt();
        }
        if norm <= target {
            return Ok(MOST_ITERATIONS);
        }
        Err(DistortError::NotConverged { iterations: MOST_ITERATIONS, residual: norm / begin.max(f64::MIN_POSITIVE) })
    }
}
