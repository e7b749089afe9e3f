//! The part grows step by step, and each step shrinks.

use crate::element::{Element, times};
use crate::error::DistortError;
use crate::figures::{Balance, Distortion, Lift, Shape, Step};
use crate::grid::Grid;
use crate::input::{Bead, Clamp, Plate};
use crate::metal::Metal;
use crate::settings::Settings;
use crate::system::System;
use crate::vector;
use crate::zone::shrink;
use glam::DVec3;
use rayon::prelude::*;

/// Force out of balance at the end, clamped and released, as a fraction of the whole load.
const LAST_TOLERANCE: f64 = 1e-10;

/// Welds beads on a plate, and releases it from its clamps.
///
/// Beads are laid in groups, in the order in which they start. The metal of a group is free of stress when it is laid;
/// then it shrinks together with the zone beneath, and plate and part find their balance. Without clamps the plate lies
/// free from the beginning. `progress` gets the fraction that is done, and stops the computation by returning `false`.
///
/// The same input gives the same bytes for any number of threads.
///
/// # Errors
/// Numbers out of range, beads that cannot be used, more than [`crate::MOST_VOXELS`] voxels, or [`DistortError::Cancelled`].
///
/// ```
/// use distort::{Bead, DVec3, Plate, Settings};
///
/// let plate = Plate { low: DVec3::new(-60.0, -15.0, -6.0), high: DVec3::new(60.0, 15.0, 0.0), stiffness: 1.0 };
/// let points = vec![DVec3::new(-45.0, 0.0, 2.0), DVec3::new(45.0, 0.0, 2.0)];
/// let bead = Bead { points, width: 6.0, height: 2.0, heat: 100.0, start: 0.0, end: 9.0, up: DVec3::Z };
/// let bent = distort::build(&plate, &[bead], &plate.clamped_at_corners(5.0, distort::Clamp::FIRM), &Settings::steel(), &mut |_| true)?;
/// // Both ends come up when the clamps are gone.
/// assert!(bent.released.lift.range > bent.clamped.lift.range);
/// # Ok::<(), distort::DistortError>(())
/// ```
pub fn build(
    plate: &Plate,
    beads: &[Bead],
    clamps: &[Clamp],
    settings: &Settings,
    progress: &mut dyn FnMut(f64) -> bool,
) -> Result<Distortion, DistortError> {
    settings.check()?;
    plate.check()?;
    clamps.iter().try_for_each(Clamp::check)?;
    beads.iter().enumerate().try_for_each(|(i, bead)| bead.check(i))?;
    let metal = Metal::new(plate, beads, settings)?;
    let mut growing = Growing::new(&metal, clamps, settings);
    let all = metal.steps.len() + 1;
    let mut steps = Vec::with_capacity(metal.steps.len());
    for step in 1..all {
        steps.push(growing.weld(step, beads)?);
        if !progress(step as f64 / all as f64) {
            return Err(DistortError::Cancelled);
        }
    }
    let (clamped, clamped_balance) = growing.settled()?;
    growing.release()?;
    let (released, released_balance) = growing.settled()?;
    progress(1.0);
    Ok(growing.distortion(steps, [clamped, released], [clamped_balance, released_balance]))
}

/// Plate and part at a moment of the build.
struct Growing<'a> {
    metal: &'a Metal,
    settings: &'a Settings,
    element: Element,
    /// Stiffness of the voxels that are there.
    factors: Vec<f64>,
    springs: Vec<(usize, [f64; 3])>,
    clamped: bool,
    /// Displacement of every node of the lattice, mm.
    moved: Vec<[f64; 3]>,
    /// Force out of balance at every node of the lattice, N.
    residual: Vec<[f64; 3]>,
    /// Forces of all shrinkage so far, N.
    load: Vec<[f64; 3]>,
    /// Nodes of the plate's lower face.
    lower: Vec<usize>,
    /// Nodes that have belonged to metal so far.
    there: Vec<bool>,
    /// Stress-free strain that each voxel shall have, without calibration, and the one that it has.
    wanted: Vec<[f64; 6]>,
    strains: Vec<[f64; 6]>,
    /// Place of each voxel with metal in `begun`.
    order: Vec<u32>,
    /// Displacement of the corners of each voxel with metal when it was laid.
    begun: Vec<[[f64; 3]; 8]>,
    /// Work that the shrinkage has done, N·mm.
    work: f64,
    /// Work that clamps did on the body while they were released, N·mm.
    release_work: f64,
    iterations: usize,
}

impl<'a> Growing<'a> {
    fn new(metal: &'a Metal, clamps: &[Clamp], settings: &'a Settings) -> Self {
        let grid = &metal.grid;
        let (voxels, nodes) = (grid.voxels(), grid.nodes());
        let mut order = vec![u32::MAX; voxels];
        let with_metal = (0..voxels).filter(|&voxel| metal.factors[voxel] > 0.0);
        let count = with_metal.enumerate().map(|(i, voxel)| order[voxel] = i as u32).count();
        let clamped = clamps.iter().any(|clamp| clamp.stiffness.max_element() > 0.0);
        let mut growing = Self {
            element: Element::new(settings.elastic, grid.size),
            factors: vec![0.0; voxels],
            springs: Vec::new(),
            clamped,
            moved: vector::zeros(nodes),
            residual: vector::zeros(nodes),
            load: vector::zeros(nodes),
            lower: lower_face(metal),
            there: vec![false; nodes],
            wanted: vec![[0.0; 6]; voxels],
            strains: vec![[0.0; 6]; voxels],
            order,
            begun: vec![[[0.0; 3]; 8]; count],
            work: 0.0,
            release_work: 0.0,
            iterations: 0,
            metal,
            settings,
        };
        growing.springs = growing.supports();
        if clamped {
            // Clamps may hold in one direction only, so a trace of the supports stays.
            let clamps = clamps.iter().flat_map(|clamp| springs(clamp, metal));
            growing.springs =
                if holds(clamps.clone(), grid) { clamps.collect() } else { clamps.chain(growing.supports()).collect() };
        }
        growing.lay(0);
        growing
    }

    /// Three corners of the plate's lower face held so that it can neither move nor turn, and nothing more.
    fn supports(&self) -> Vec<(usize, [f64; 3])> {
        let (grid, k) = (&self.metal.grid, self.settings.elastic.young * self.metal.grid.size.min_element());
        let (Some(&first), Some(&last)) = (self.lower.first(), self.lower.last()) else { return Vec::new() };
        let ([x0, y0, z], [x1, y1, _]) = (grid.node_at(first), grid.node_at(last));
        let (along, beside) = (grid.node([x1, y0, z]), grid.node([x0, y1, z]));
        vec![(first, [k; 3]), (along, [0.0, k, k]), (beside, [0.0, 0.0, k])]
    }

    /// Metal of a step appears, free of stress.
    fn lay(&mut self, step: u32) -> Vec<usize> {
        let (grid, nodes_above) = (&self.metal.grid, self.metal.grid.node([0, 0, 1]));
        let new: Vec<usize> =
            (0..grid.voxels()).filter(|&v| self.metal.born[v] == step && self.metal.factors[v] > 0.0).collect();
        // From below, so that each node finds the one beneath it.
        for &voxel in &new {
            self.factors[voxel] = self.metal.factors[voxel];
            for node in grid.corners(voxel) {
                if !self.there[node] {
                    self.there[node] = true;
                    let below = node.checked_sub(nodes_above).filter(|&below| self.there[below]);
                    self.moved[node] = [0.0, 0.0, below.map_or(0.0, |below| self.moved[below][2])];
                }
            }
        }
        for &voxel in &new {
            self.begun[self.order[voxel] as usize] = grid.corners(voxel).map(|node| self.moved[node]);
        }
        new
    }

    /// Lays and shrinks the beads of a step.
    ///
    /// Beads of a group that are laid one by one meet, on the mean, the fraction (n + 1) / 2n of the group's metal. So that
    /// is the stiffness of new metal while the group shrinks; afterwards it has all of it, with the same stress.
    fn weld(&mut self, step: usize, beads: &[Bead]) -> Result<Step, DistortError> {
        let new = self.lay(step as u32);
        let range = self.metal.steps[step - 1].clone();
        let of_step: Vec<&Bead> = self.metal.order[range].iter().map(|&bead| &beads[bead]).collect();
        let mut changed = new.clone();
        changed.extend(shrink(&of_step, self.metal, self.settings, &mut self.wanted));
        changed.sort_unstable();
        changed.dedup();
        changed.retain(|&voxel| self.factors[voxel] > 0.0);
        let (carried, from) = (self.residual.clone(), self.moved.clone());
        let before: Vec<[f64; 6]> = changed.iter().map(|&voxel| self.stress(voxel)).collect();
        let added: Vec<[f64; 6]> = changed.iter().map(|&voxel| self.shrink(voxel)).collect();
        let part = (of_step.len() + 1) as f64 / (2 * of_step.len()) as f64;
        new.iter().for_each(|&voxel| self.factors[voxel] = part * self.metal.factors[voxel]);
        self.balance(self.settings.tolerance)?;
        for ((&voxel, before), added) in changed.iter().zip(before).zip(added) {
            self.work += if self.metal.born[voxel] == step as u32 {
                self.complete(voxel, part)
            } else {
                let after = self.stress(voxel);
                let work: f64 = (0..6).map(|i| 0.5 * (before[i] + after[i]) * added[i]).sum();
                -work * self.element.volume()
            };
        }
        self.work -= self.work_out_of_balance(&carried, &from);
        let end = of_step.iter().map(|bead| bead.end).fold(0.0, f64::max);
        Ok(Step { time: end, beads: of_step.len(), lift: Lift::of(&self.metal.grid, &self.moved, &self.lower) })
    }

    /// Gives new metal, which had a part of its stiffness while it shrank, all of it, with the same forces; returns its
    /// energy less the work of these forces.
    fn complete(&mut self, voxel: usize, part: f64) -> f64 {
        let moved = self.since_laid(voxel);
        self.factors[voxel] = self.metal.factors[voxel];
        let begun = &mut self.begun[self.order[voxel] as usize];
        for (begun, moved) in begun.iter_mut().zip(&moved) {
            (0..3).for_each(|d| begun[d] += (1.0 - part) * moved[d]);
        }
        let (after, strain) = (self.since_laid(voxel), &self.strains[voxel]);
        let (held, free) = (times(&self.element.stiffness, &after), self.element.forces(strain));
        let forces = held.iter().flatten().zip(free.iter().flatten()).map(|(held, free)| held - free);
        let work: f64 = forces.zip(moved.iter().flatten()).map(|(force, moved)| 0.5 * force * moved).sum();
        self.factors[voxel] * (self.element.energy(&after, strain) - work)
    }

    /// Brings a voxel's strain up to what it shall have; returns what was added.
    fn shrink(&mut self, voxel: usize) -> [f64; 6] {
        let (wanted, has) = (self.wanted[voxel], self.strains[voxel]);
        let added: [f64; 6] = std::array::from_fn(|i| self.settings.calibration * wanted[i] - has[i]);
        (0..6).for_each(|i| self.strains[voxel][i] += added[i]);
        let forces = self.element.forces(&added);
        for (node, force) in self.metal.grid.corners(voxel).into_iter().zip(forces) {
            for (d, force) in force.into_iter().enumerate() {
                self.residual[node][d] += self.factors[voxel] * force;
                self.load[node][d] += self.factors[voxel] * force;
            }
        }
        added
    }

    /// Displacement of a voxel's corners since it was laid.
    fn since_laid(&self, voxel: usize) -> [[f64; 3]; 8] {
        let (corners, begun) = (self.metal.grid.corners(voxel), &self.begun[self.order[voxel] as usize]);
        std::array::from_fn(|c| std::array::from_fn(|d| self.moved[corners[c]][d] - begun[c][d]))
    }

    /// Mean stress of a voxel, MPa.
    fn stress(&self, voxel: usize) -> [f64; 6] {
        let mean = self.element.mean_strain(&self.since_laid(voxel));
        let free = std::array::from_fn(|i| mean[i] - self.strains[voxel][i]);
        self.element.elastic.stress(&free).map(|s| s * self.factors[voxel])
    }

    /// Moves the nodes until what is out of balance has fallen to a fraction.
    fn balance(&mut self, tolerance: f64) -> Result<(), DistortError> {
        let norm = vector::dot(&self.residual, &self.residual).sqrt();
        self.balance_to(tolerance * norm)
    }

    fn balance_to(&mut self, target: f64) -> Result<(), DistortError> {
        let system = System::new(&self.metal.grid, &self.element, &self.factors, &self.springs);
        let nodes: Vec<usize> = (0..system.mesh.nodes.len()).map(|number| system.mesh.lattice_node(number)).collect();
        let mut residual: Vec<[f64; 3]> = nodes.iter().map(|&node| self.residual[node]).collect();
        let mut change = vector::zeros(nodes.len());
        self.iterations += system.solve(&mut change, &mut residual, target)?;
        for ((&node, change), residual) in nodes.iter().zip(change).zip(residual) {
            (0..3).for_each(|d| self.moved[node][d] += change[d]);
            self.residual[node] = residual;
        }
        Ok(())
    }

    /// The shape in full balance, with how exact that is.
    fn settled(&mut self) -> Result<(Shape, Balance), DistortError> {
        let target = LAST_TOLERANCE * vector::dot(&self.load, &self.load).sqrt();
        self.residual = self.out_of_balance();
        let (carried, from) = (self.residual.clone(), self.moved.clone());
        self.balance_to(target)?;
        self.work -= self.work_out_of_balance(&carried, &from);
        Ok((self.shape(), self.balance_figures()))
    }

    /// Energy lost because forces were out of balance, before and after nodes moved, N·mm; zero with an exact solver.
    fn work_out_of_balance(&self, carried: &[[f64; 3]], from: &[[f64; 3]]) -> f64 {
        let nodes: Vec<usize> = (0..self.moved.len()).filter(|&node| self.there[node]).collect();
        vector::sum(&nodes, |&node| {
            let of =
                |d: usize| 0.5 * (carried[node][d] + self.residual[node][d]) * (self.moved[node][d] - from[node][d]);
            of(0) + of(1) + of(2)
        })
    }

    /// Shrinkage less the forces of all voxels and clamps, from the beginning.
    fn out_of_balance(&self) -> Vec<[f64; 3]> {
        let mut sum = self.load.clone();
        for voxel in (0..self.factors.len()).filter(|&voxel| self.factors[voxel] > 0.0) {
            let forces = times(&self.element.stiffness, &self.since_laid(voxel));
            for (node, force) in self.metal.grid.corners(voxel).into_iter().zip(forces) {
                (0..3).for_each(|d| sum[node][d] -= self.factors[voxel] * force[d]);
            }
        }
        if self.clamped {
            for &(node, stiffness) in &self.springs {
                (0..3).for_each(|d| sum[node][d] -= stiffness[d] * self.moved[node][d]);
            }
        }
        sum
    }

    fn balance_figures(&self) -> Balance {
        let left = self.out_of_balance();
        let norm = |values: &[[f64; 3]]| vector::dot(values, values).sqrt();
        let held = (0..self.factors.len()).into_par_iter().filter(|&voxel| self.factors[voxel] > 0.0);
        let energies: Vec<f64> =
            held.map(|v| self.factors[v] * self.element.energy(&self.since_laid(v), &self.strains[v])).collect();
        let (mut force, mut moment, mut springs, mut largest) = (DVec3::ZERO, DVec3::ZERO, 0.0, 0.0);
        for &(node, stiffness) in self.springs.iter().filter(|_| self.clamped) {
            let (moved, stiffness) = (DVec3::from_array(self.moved[node]), DVec3::from_array(stiffness));
            let reaction = -stiffness * moved;
            force += reaction;
            moment += self.metal.grid.place(node).cross(reaction);
            springs += 0.5 * moved.dot(stiffness * moved);
            largest = f64::max(largest, reaction.length());
        }
        Balance {
            residual: norm(&left) / norm(&self.load).max(f64::MIN_POSITIVE),
            energy: energies.iter().sum(),
            clamp_energy: springs,
            work: self.work + self.release_work,
            reaction_sum: force,
            reaction_moment: moment,
            largest_reaction: largest,
        }
    }

    /// Opens the clamps.
    fn release(&mut self) -> Result<(), DistortError> {
        if !self.clamped {
            return Ok(());
        }
        let clamps = std::mem::take(&mut self.springs);
        let held: Vec<(usize, [f64; 3])> =
            clamps.iter().map(|&(node, k)| (node, std::array::from_fn(|d| k[d] * self.moved[node][d]))).collect();
        for &(node, force) in &held {
            (0..3).for_each(|d| self.residual[node][d] += force[d]);
        }
        self.springs = self.supports();
        self.clamped = false;
        let target = LAST_TOLERANCE * vector::dot(&self.load, &self.load).sqrt();
        self.balance_to(target)?;
        // The forces of the clamps fall to nothing while the body moves, and their own energy is gone.
        let of =
            |&(node, force): &(usize, [f64; 3])| -> f64 { (0..3).map(|d| -0.5 * force[d] * self.moved[node][d]).sum() };
        self.release_work += held.iter().map(of).sum::<f64>();
        Ok(())
    }

    fn shape(&self) -> Shape {
        Shape::new(self.metal, &self.moved, &self.there, &self.lower, self.clamped)
    }

    fn distortion(self, steps: Vec<Step>, [clamped, released]: [Shape; 2], balance: [Balance; 2]) -> Distortion {
        let voxels: Vec<usize> = (0..self.factors.len()).filter(|&voxel| self.factors[voxel] > 0.0).collect();
        Distortion {
            grid: self.metal.grid,
            factors: voxels.iter().map(|&voxel| self.factors[voxel]).collect(),
            born: voxels.iter().map(|&voxel| self.metal.born[voxel]).collect(),
            stresses: voxels.iter().map(|&voxel| self.stress(voxel)).collect(),
            voxels,
            steps,
            clamped,
            released,
            clamped_balance: balance[0],
            released_balance: balance[1],
            iterations: self.iterations,
        }
    }
}

/// Nodes of the plate's lower face.
fn lower_face(metal: &Metal) -> Vec<usize> {
    let grid = &metal.grid;
    let [nx, ny, _] = grid.node_counts();
    let nodes = (0..nx * ny).map(|i| grid.node([i % nx, i / nx, metal.plate_bottom]));
    nodes.filter(|&node| grid.touching(node).any(|voxel| metal.born[voxel] == 0)).collect()
}

/// The springs of a clamp: nodes of the plate's upper face within its radius share its stiffness.
fn springs(clamp: &Clamp, metal: &Metal) -> Vec<(usize, [f64; 3])> {
    let grid = &metal.grid;
    let [nx, ny, _] = grid.node_counts();
    let places = (0..nx * ny).map(|i| grid.node([i % nx, i / nx, metal.plate_top]));
    let of_plate = |node: &usize| grid.touching(*node).any(|voxel| metal.born[voxel] == 0);
    let distance = |node: usize| (grid.place(node) - clamp.at).truncate().length();
    let of_plate: Vec<usize> = places.filter(of_plate).collect();
    let mut held: Vec<usize> = of_plate.iter().copied().filter(|&node| distance(node) <= clamp.radius).collect();
    if held.is_empty() {
        held.extend(of_plate.into_iter().min_by(|&a, &b| distance(a).total_cmp(&distance(b))));
    }
    let share = clamp.stiffness / held.len().max(1) as f64;
    held.into_iter().map(|node| (node, share.to_array())).collect()
}

/// Whether springs leave no motion of a rigid body free.
fn holds(springs: impl Iterator<Item = (usize, [f64; 3])>, grid: &Grid) -> bool {
    let middle = 0.5 * DVec3::from_array(grid.counts.map(|n| n as f64)) * grid.size + grid.low;
    let scale = grid.size.max_element();
    let mut matrix = [[0.0; 6]; 6];
    for (node, stiffness) in springs {
        let arm = (grid.place(node) - middle) / scale;
        for (d, axis) in [DVec3::X, DVec3::Y, DVec3::Z].into_iter().enumerate() {
            let turn = arm.cross(axis);
            let row: [f64; 6] = [axis.x, axis.y, axis.z, turn.x, turn.y, turn.z];
            for (a, b) in (0..36).map(|i| (i % 6, i / 6)) {
                matrix[a][b] += stiffness[d] * row[a] * row[b];
            }
        }
    }
    // Solving for a motion with every part in it finds the whole of it only if nothing is free.
    let right = std::array::from_fn(|row| matrix[row].iter().sum());
    crate::rigid::solved(matrix, right).iter().all(|part| (part - 1.0).abs() < 1e-3)
}
