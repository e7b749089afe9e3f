//! One elastic body of voxels under forces, springs and stress-free strains.

use crate::element::{Elastic, Element};
use crate::error::{DistortError, not_too_many, within};
use crate::grid::Grid;
use crate::system::System;
use crate::vector;
use glam::DVec3;
use rayon::prelude::*;

/// A body of voxels, to be loaded and solved once.
///
/// Displacements are small; see [`crate::build()`] for a body that grows.
#[derive(Debug, Clone)]
pub struct Body {
    grid: Grid,
    element: Element,
    factors: Vec<f64>,
    strains: Vec<[f64; 6]>,
    springs: Vec<(usize, [f64; 3])>,
    forces: Vec<(usize, [f64; 3])>,
}

/// How a [`Body`] moves.
#[derive(Debug, Clone, PartialEq)]
pub struct Solved {
    /// Nodes of the grid that belong to voxels with metal.
    pub nodes: Vec<usize>,
    /// Their displacement, mm.
    pub moved: Vec<DVec3>,
    /// Force of the springs on each node, N; zero where there is none.
    pub reactions: Vec<DVec3>,
    /// Elastic energy of the voxels, N·mm.
    pub energy: f64,
    /// Energy of the springs, N·mm.
    pub spring_energy: f64,
    /// Stress of each voxel with metal, mean, MPa: xx, yy, zz, xy, yz, zx; with its index in the grid.
    pub stresses: Vec<(usize, [f64; 6])>,
    /// Force out of balance, as a fraction of the load.
    pub residual: f64,
    /// Iterations of conjugate gradients.
    pub iterations: usize,
}

impl Body {
    /// An empty grid.
    ///
    /// # Errors
    /// Elastic values out of range, a grid without volume, or with more than [`crate::MOST_VOXELS`].
    pub fn new(grid: Grid, elastic: Elastic) -> Result<Self, DistortError> {
        check_elastic(&elastic)?;
        if grid.counts.contains(&0) || !(grid.size.min_element() > 0.0 && grid.size.is_finite()) {
            return Err(DistortError::NoPlate);
        }
        not_too_many(&grid)?;
        let voxels = grid.voxels();
        let element = Element::new(elastic, grid.size);
        let (factors, strains) = (vec![0.0; voxels], vec![[0.0; 6]; voxels]);
        Ok(Self { grid, element, factors, strains, springs: Vec::new(), forces: Vec::new() })
    }

    /// Where its voxels lie.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// Fills a voxel with metal whose Young's modulus is this multiple of the body's; 0 empties it.
    ///
    /// # Errors
    /// No such voxel, or a multiple outside 0 to 1000.
    pub fn fill(&mut self, voxel: usize, factor: f64) -> Result<(), DistortError> {
        within("factor of the stiffness", factor, [0.0, 1000.0], "(of Young's modulus)")?;
        let count = self.factors.len();
        let slot = self.factors.get_mut(voxel).ok_or(DistortError::Outside { name: "Voxel", index: voxel, count })?;
        *slot = factor;
        Ok(())
    }

    /// Fills all voxels.
    pub fn fill_all(&mut self) {
        self.factors.fill(1.0);
    }

    /// Gives a voxel a strain (xx, yy, zz, xy, yz, zx; shear as angles) that it would have if it were free.
    ///
    /// # Errors
    /// No such voxel.
    pub fn strain(&mut self, voxel: usize, strain: [f64; 6]) -> Result<(), DistortError> {
        let count = self.strains.len();
        let slot = self.strains.get_mut(voxel).ok_or(DistortError::Outside { name: "Voxel", index: voxel, count })?;
        *slot = strain;
        Ok(())
    }

    /// Holds a node of the grid by springs along x, y and z, N/mm.
    pub fn hold(&mut self, node: usize, stiffness: DVec3) {
        self.springs.push((node, stiffness.to_array()));
    }

    /// Pushes a node of the grid, N.
    pub fn push(&mut self, node: usize, force: DVec3) {
        self.forces.push((node, force.to_array()));
    }

    /// The displacement under all loads, until the force out of balance is below `tolerance` times the load.
    ///
    /// # Errors
    /// A spring or force where there is no metal, or no balance found, as in a body that nothing holds.
    pub fn solve(&self, tolerance: f64) -> Result<Solved, DistortError> {
        let system = System::new(&self.grid, &self.element, &self.factors, &self.springs);
        let mesh = &system.mesh;
        let number = |node: usize| {
            let at = || self.grid.place(node.min(self.grid.nodes() - 1)).to_array();
            mesh.number(node).ok_or_else(|| DistortError::NoMetal { at: at() })
        };
        let mut load = vector::zeros(mesh.nodes.len());
        for (&voxel, corners) in mesh.voxels.iter().zip(&mesh.corners) {
            let forces = self.element.forces(&self.strains[voxel]);
            for (&node, force) in corners.iter().zip(forces) {
                (0..3).for_each(|d| load[node as usize][d] += self.factors[voxel] * force[d]);
            }
        }
        for &(node, force) in &self.forces {
            let number = number(node)?;
            (0..3).for_each(|d| load[number][d] += force[d]);
        }
        for &(node, _) in &self.springs {
            number(node)?;
        }
        let total = vector::dot(&load, &load).sqrt();
        let mut moved = vector::zeros(load.len());
        let mut residual = load.clone();
        let iterations = system.solve(&mut moved, &mut residual, tolerance * total)?;
        let held = system.forces(&moved);
        let left = vector::sum(&load.iter().zip(&held).collect::<Vec<_>>(), |(l, h)| {
            (0..3).map(|d| (l[d] - h[d]).powi(2)).sum()
        });
        let mut reactions = vec![DVec3::ZERO; load.len()];
        let mut spring_energy = 0.0;
        for &(node, stiffness) in &self.springs {
            let number = number(node)?;
            let (moved, stiffness) = (DVec3::from_array(moved[number]), DVec3::from_array(stiffness));
            reactions[number] -= stiffness * moved;
            spring_energy += 0.5 * moved.dot(stiffness * moved);
        }
        let of_voxel = |(&voxel, corners): (&usize, &[u32; 8])| {
            let moved = corners.map(|node| moved[node as usize]);
            let (strain, factor) = (&self.strains[voxel], self.factors[voxel]);
            let mean = self.element.mean_strain(&moved);
            let free: [f64; 6] = std::array::from_fn(|i| mean[i] - strain[i]);
            let stress = self.element.elastic.stress(&free).map(|s| factor * s);
            ((voxel, stress), factor * self.element.energy(&moved, strain))
        };
        let (stresses, energies): (Vec<_>, Vec<f64>) = mesh.voxels.par_iter().zip(&mesh.corners).map(of_voxel).unzip();
        Ok(Solved {
            nodes: (0..load.len()).map(|number| mesh.lattice_node(number)).collect(),
            moved: moved.iter().map(|&m| DVec3::from_array(m)).collect(),
            reactions,
            energy: energies.iter().sum(),
            spring_energy,
            stresses,
            residual: left.sqrt() / total.max(f64::MIN_POSITIVE),
            iterations,
        })
    }
}

/// An error unless elastic values are possible.
pub(crate) fn check_elastic(elastic: &Elastic) -> Result<(), DistortError> {
    within("Young's modulus", elastic.young, [1.0, 1e6], "MPa")?;
    within("Poisson's ratio", elastic.poisson, [0.0, 0.49], "(no unit)")
}

impl Solved {
    /// The displacement of a node of the grid, mm, if it belongs to metal.
    pub fn at(&self, node: usize) -> Option<DVec3> {
        self.nodes.iter().position(|&n| n == node).map(|i| self.moved[i])
    }
}
