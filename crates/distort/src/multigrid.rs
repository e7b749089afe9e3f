//! Geometric multigrid, which makes conjugate gradients converge in a few steps.
//!
//! Each coarser level has voxels twice as large and the stiffness Pᵀ K P of the level below, with trilinear
//! interpolation P (Galerkin), so voxels with holes and thin walls keep the stiffness that the interpolation sees. Voxels
//! whose eight parts are alike need no matrix of their own. The smoother is a Chebyshev polynomial of the diagonally
//! scaled stiffness; the coarsest level is solved directly. All of it is in single precision, since it only guides the
//! solver, and all of it is linear and symmetric.

use crate::element::{Blocks, Element, Matrix, add, blocks, seen_from_parent, zero};
use crate::envelope::Envelope;
use crate::grid::{index, position};
use crate::level::{Alike, Single, Stiffness, in_precision, single};
use crate::mesh::Mesh;
use crate::real::{Field, Real};
use crate::vector;
use rayon::prelude::*;
use rustc_hash::FxHashMap;

/// The coarsest level is solved directly if that takes no more multiplications.
const DIRECT: f64 = 1.2e8;
/// Steps of the smoother before and after the coarser level.
const DEGREE: usize = 2;
/// The smoother works on the highest part of the spectrum, down to this fraction of its end.
const REACH: f64 = 0.2;
/// Power iterations that estimate the end of the spectrum of a coarser level.
const POWER_STEPS: usize = 10;
/// The estimate is from below, so this much is added.
const POWER_MARGIN: f64 = 1.15;

/// What a voxel of a level is.
#[derive(Debug, Clone, Copy)]
enum Kind {
    Alike(f64),
    Single(u32),
}

/// One level and how to smooth on it.
#[derive(Debug)]
struct Level {
    mesh: Mesh,
    stiffness: Stiffness<f32>,
    /// Inverse of the diagonal.
    inverse: Field<f32>,
    /// Largest eigenvalue of the diagonally scaled stiffness.
    largest: f64,
    /// The nodes of the next level between which each node lies.
    parents: Vec<[u32; 8]>,
}

/// Weights of a spring at the eight corners of a voxel, and its stiffness.
type Held = ([f64; 8], [f64; 3]);

/// A preconditioner for the stiffness of voxels.
#[derive(Debug)]
pub(crate) struct Multigrid {
    levels: Vec<Level>,
    direct: Envelope,
}

/// A level while the hierarchy is built.
struct Stage {
    mesh: Mesh,
    /// The stiffness of voxels that are alike, with the factor 1.
    unit: Matrix,
    kinds: Vec<Kind>,
    matrices: Vec<[[f32; 24]; 24]>,
}

impl Multigrid {
    /// For voxels with these factors, and springs at nodes of the mesh.
    pub(crate) fn new(mesh: &Mesh, element: &Element, factors: &[f64], springs: &[(u32, [f64; 3])]) -> Self {
        let kinds = factors.iter().map(|&factor| Kind::Alike(factor)).collect();
        let mut stage = Stage { mesh: mesh.clone(), unit: element.stiffness, kinds, matrices: Vec::new() };
        let mut springs = springs.to_vec();
        let mut levels: Vec<Level> = Vec::new();
        loop {
            let firsts = stage.mesh.first_columns();
            let small = stage.mesh.counts.iter().all(|&n| n <= 2);
            if small || Envelope::cost(&firsts) <= DIRECT {
                return Self { levels, direct: stage.direct(firsts, &springs) };
            }
            let coarser = stage.coarser(&springs);
            let parents = stage.mesh.parents(&coarser.mesh);
            let finest = levels.is_empty();
            levels.push(stage.level(&springs, parents, finest));
            springs.clear();
            stage = coarser;
        }
    }

    /// An approximate solution for a residual.
    pub(crate) fn apply(&self, residual: &[[f64; 3]], solution: &mut Field<f64>) {
        solution.resize(residual.len(), [0.0; 3]);
        if self.levels.is_empty() {
            solution.copy_from_slice(residual);
            return self.direct.solve(solution.as_flattened_mut());
        }
        // Single precision has its own range.
        let scale = vector::dot(residual, residual).sqrt();
        if scale == 0.0 {
            return solution.fill([0.0; 3]);
        }
        let scaled = vector::map(residual, |r| r.map(|r| (r / scale) as f32));
        let found = self.cycle(0, scaled);
        vector::each2(solution, &found, |s, f| *s = f.map(|f| f64::from(f) * scale));
    }

    fn cycle(&self, depth: usize, mut residual: Field<f32>) -> Field<f32> {
        let Some(level) = self.levels.get(depth) else {
            let mut values: Field<f64> = residual.iter().map(|r| r.map(f64::from)).collect();
            self.direct.solve(values.as_flattened_mut());
            return values.iter().map(|v| v.map(|v| v as f32)).collect();
        };
        let mut solution = level.smoothed(&mut residual, true);
        let coarser = self.levels.get(depth + 1).map(|next| &next.mesh);
        let below = self.cycle(depth + 1, level.restricted(coarser, self.direct.rows() / 3, &residual));
        let mut change = level.interpolated(&below);
        level.subtract(&change, &mut residual);
        vector::each2(&mut solution, &change, plus);
        change = level.smoothed(&mut residual, false);
        vector::each2(&mut solution, &change, plus);
        solution
    }
}

fn plus(sum: &mut [f32; 3], other: &[f32; 3]) {
    (0..3).for_each(|d| sum[d] += other[d]);
}

impl Level {
    /// A Chebyshev polynomial's answer to a residual, from zero; the residual is brought up to date if wanted.
    fn smoothed(&self, residual: &mut [[f32; 3]], keep_residual: bool) -> Field<f32> {
        let (high, low) = (self.largest, REACH * self.largest);
        let (middle, half) = (0.5 * (high + low), 0.5 * (high - low));
        let mut rho = half / middle;
        let mut step = vec![[0f32; 3]; residual.len()];
        let first = (1.0 / middle) as f32;
        vector::each3(&mut step, residual, &self.inverse, |s, r, i| (0..3).for_each(|d| s[d] = first * i[d] * r[d]));
        let mut solution = step.clone();
        for _ in 1..DEGREE {
            self.subtract(&step, residual);
            let next = 1.0 / (2.0 * middle / half - rho);
            let (keep, add) = ((next * rho) as f32, (2.0 * next / half) as f32);
            rho = next;
            vector::each3(&mut step, residual, &self.inverse, |s, r, i| {
                (0..3).for_each(|d| s[d] = keep * s[d] + add * i[d] * r[d]);
            });
            vector::each2(&mut solution, &step, plus);
        }
        if keep_residual {
            self.subtract(&step, residual);
        }
        solution
    }

    /// Takes the forces of a displacement from a residual.
    fn subtract(&self, moved: &[[f32; 3]], residual: &mut [[f32; 3]]) {
        let mut forces = vec![[0f32; 3]; residual.len()];
        self.stiffness.apply(&self.mesh, moved, &mut forces);
        vector::each2(residual, &forces, |r, f| (0..3).for_each(|d| r[d] -= f[d]));
    }

    fn restricted(&self, coarser: Option<&Mesh>, nodes: usize, fine: &[[f32; 3]]) -> Field<f32> {
        let gather = |range: std::ops::Range<usize>, own: &mut [[f32; 3]], first: usize| {
            for (parents, values) in self.parents[range.clone()].iter().zip(&fine[range]) {
                for &parent in parents {
                    if let Some(sum) = own.get_mut((parent as usize).wrapping_sub(first)) {
                        (0..3).for_each(|d| sum[d] += 0.125 * values[d]);
                    }
                }
            }
        };
        let Some(mesh) = coarser else {
            let mut sums = vec![[0f32; 3]; nodes];
            gather(0..fine.len(), &mut sums, 0);
            return sums;
        };
        let mut sums = vec![[0f32; 3]; mesh.nodes.len()];
        let starts = &self.mesh.node_starts;
        mesh.each_chunk(&mut sums, |chunk, own| {
            let last = starts.len() - 1;
            let from = (2 * chunk.slabs.start).saturating_sub(1).min(last);
            gather(starts[from]..starts[(2 * chunk.slabs.end).min(last)], own, chunk.nodes.start);
        });
        sums
    }

    fn interpolated(&self, coarse: &[[f32; 3]]) -> Field<f32> {
        vector::map(&self.parents, |parents| {
            let mut sum = [0f32; 3];
            for &parent in parents {
                (0..3).for_each(|d| sum[d] += 0.125 * coarse[parent as usize][d]);
            }
            sum
        })
    }
}

impl Stage {
    /// The matrix of a voxel.
    fn matrix(&self, voxel: usize) -> Matrix {
        match self.kinds[voxel] {
            Kind::Alike(factor) => self.unit.map(|row| row.map(|value| factor * value)),
            Kind::Single(at) => self.matrices[at as usize].map(|row| row.map(f64::from)),
        }
    }

    fn coarser(&self, springs: &[(u32, [f64; 3])]) -> Self {
        let mesh = self.mesh.coarser();
        let parts: [Matrix; 8] = std::array::from_fn(|part| seen_from_parent(&self.unit, part));
        let mut unit = zero();
        parts.iter().for_each(|part| add(&mut unit, 1.0, part));
        let order = self.mesh.order();
        let held = self.springs_by_parent(springs);
        let counts = self.mesh.counts;
        let of_voxel = |&voxel: &usize| {
            let at = position(mesh.counts, voxel).map(|a| 2 * a);
            let child = |part: usize| {
                let at: [usize; 3] = std::array::from_fn(|d| at[d] + (part >> d & 1));
                let inside = (0..3).all(|d| at[d] < counts[d]);
                inside.then(|| order[index(counts, at)]).filter(|&o| o != u32::MAX).map(|o| o as usize)
            };
            let children: [Option<usize>; 8] = std::array::from_fn(child);
            let springs = held.get(&voxel);
            match self.common_factor(&children).filter(|_| springs.is_none()) {
                Some(factor) => Err(factor),
                None => Ok(self.combined(&children, &parts, springs.map_or(&[][..], Vec::as_slice))),
            }
        };
        let found: Vec<Result<[[f32; 24]; 24], f64>> = mesh.voxels.par_iter().map(of_voxel).collect();
        let (mut kinds, mut matrices) = (Vec::with_capacity(found.len()), Vec::new());
        for voxel in found {
            kinds.push(match voxel {
                Err(factor) => Kind::Alike(factor),
                Ok(matrix) => {
                    matrices.push(matrix);
                    Kind::Single(matrices.len() as u32 - 1)
                }
            });
        }
        Self { mesh, unit, kinds, matrices }
    }

    /// The factor of eight voxels that are all there and alike.
    fn common_factor(&self, children: &[Option<usize>; 8]) -> Option<f64> {
        let factor = |child: &Option<usize>| match child.map(|child| self.kinds[child]) {
            Some(Kind::Alike(factor)) => Some(factor),
            _ => None,
        };
        let first = factor(&children[0])?;
        children.iter().all(|child| factor(child) == Some(first)).then_some(first)
    }

    /// The matrix of a voxel of the coarser level.
    fn combined(&self, children: &[Option<usize>; 8], parts: &[Matrix; 8], springs: &[Held]) -> [[f32; 24]; 24] {
        let mut sum = zero();
        for (part, child) in children.iter().enumerate() {
            match child.map(|child| (child, self.kinds[child])) {
                Some((_, Kind::Alike(factor))) => add(&mut sum, factor, &parts[part]),
                Some((child, Kind::Single(_))) => add(&mut sum, 1.0, &seen_from_parent(&self.matrix(child), part)),
                None => {}
            }
        }
        for (weights, stiffness) in springs {
            for (a, b) in (0..64).map(|pair| (pair % 8, pair / 8)) {
                for d in 0..3 {
                    sum[3 * a + d][3 * b + d] += weights[a] * weights[b] * stiffness[d];
                }
            }
        }
        single(&sum)
    }

    /// For each voxel of the coarser level that holds springs, their weights at its corners and their stiffness.
    fn springs_by_parent(&self, springs: &[(u32, [f64; 3])]) -> FxHashMap<usize, Vec<Held>> {
        let mut found: FxHashMap<usize, Vec<_>> = FxHashMap::default();
        if springs.is_empty() {
            return found;
        }
        let mut voxel_of = vec![usize::MAX; self.mesh.nodes.len()];
        for (corners, &voxel) in self.mesh.corners.iter().zip(&self.mesh.voxels) {
            corners.iter().for_each(|&corner| voxel_of[corner as usize] = voxel);
        }
        let coarse_counts = self.mesh.counts.map(|n| n.div_ceil(2));
        for &(node, stiffness) in springs {
            let node = node as usize;
            let parent = position(self.mesh.counts, voxel_of[node]).map(|a| a / 2);
            let part = |d: usize| (usize::from(self.mesh.nodes[node][d]) - 2 * parent[d]) as f64 / 2.0;
            let at = [part(0), part(1), part(2)];
            let weight = |c: usize| (0..3).map(|d| if c >> d & 1 == 1 { at[d] } else { 1.0 - at[d] }).product();
            let weights: [f64; 8] = std::array::from_fn(weight);
            found.entry(index(coarse_counts, parent)).or_default().push((weights, stiffness));
        }
        found
    }

    fn direct(&self, firsts: Vec<usize>, springs: &[(u32, [f64; 3])]) -> Envelope {
        let mut envelope = Envelope::new(firsts);
        for (voxel, corners) in self.mesh.corners.iter().enumerate() {
            let matrix = self.matrix(voxel);
            for (a, row) in matrix.iter().enumerate() {
                for (b, &value) in row.iter().enumerate() {
                    let (row, column) = (entry(corners, a), entry(corners, b));
                    if column <= row {
                        envelope.add(row, column, value);
                    }
                }
            }
        }
        for &(node, stiffness) in springs {
            (0..3).for_each(|d| envelope.add(3 * node as usize + d, 3 * node as usize + d, stiffness[d]));
        }
        envelope.factor();
        envelope
    }

    fn level(self, springs: &[(u32, [f64; 3])], parents: Vec<[u32; 8]>, finest: bool) -> Level {
        let inverse = self.inverse_diagonal(springs);
        let largest_of_voxel = largest_eigenvalue(&self.unit);
        let stiffness = self.stiffness(springs);
        let mut level = Level { mesh: self.mesh, stiffness, inverse, largest: largest_of_voxel, parents };
        if !finest {
            level.largest = level.power_iteration();
        }
        level
    }

    fn inverse_diagonal(&self, springs: &[(u32, [f64; 3])]) -> Field<f32> {
        let mut diagonal = vec![[0.0; 3]; self.mesh.nodes.len()];
        for (kind, corners) in self.kinds.iter().zip(&self.mesh.corners) {
            for (corner, &node) in corners.iter().enumerate() {
                for (d, sum) in diagonal[node as usize].iter_mut().enumerate() {
                    let at = 3 * corner + d;
                    *sum += match *kind {
                        Kind::Alike(factor) => factor * self.unit[at][at],
                        Kind::Single(voxel) => f64::from(self.matrices[voxel as usize][at][at]),
                    };
                }
            }
        }
        for &(node, stiffness) in springs {
            (0..3).for_each(|d| diagonal[node as usize][d] += stiffness[d]);
        }
        diagonal.iter().map(|d| d.map(|d| (1.0 / d) as f32)).collect()
    }

    fn stiffness(&self, springs: &[(u32, [f64; 3])]) -> Stiffness<f32> {
        let (mut alike, mut single) = (Alike::default(), Single::default());
        let starts = &self.mesh.voxel_starts;
        for slab in starts.windows(2) {
            alike.starts.push(alike.corners.len());
            single.starts.push(single.corners.len());
            for voxel in slab[0]..slab[1] {
                let corners = self.mesh.corners[voxel];
                match self.kinds[voxel] {
                    Kind::Alike(factor) => {
                        alike.corners.push(corners);
                        alike.factors.push(factor);
                    }
                    Kind::Single(at) => {
                        single.corners.push(corners);
                        single.matrices.push(self.matrices[at as usize]);
                    }
                }
            }
        }
        alike.starts.push(alike.corners.len());
        single.starts.push(single.corners.len());
        let blocks: Blocks<f32> = in_precision(&blocks(&self.unit));
        let springs = springs.iter().map(|&(node, k)| (node, k.map(f32::of))).collect();
        Stiffness { blocks, alike, single, springs }
    }
}

impl Level {
    /// The largest eigenvalue of the diagonally scaled stiffness, with a margin.
    fn power_iteration(&self) -> f64 {
        // Neighbours of opposite sign, as the stiffest motions have, and all different.
        let start = |i: usize| {
            let sum: usize = self.mesh.nodes[i].iter().map(|&a| usize::from(a)).sum();
            let sign = if sum.is_multiple_of(2) { 1.0 } else { -1.0 };
            std::array::from_fn(|d| sign * (1.0 + ((7 * i + 5 * d) % 11) as f32 / 11.0))
        };
        let mut vector: Field<f32> = (0..self.mesh.nodes.len()).map(start).collect();
        let mut largest = 1.0;
        let mut forces = vec![[0f32; 3]; vector.len()];
        for _ in 0..POWER_STEPS {
            self.stiffness.apply(&self.mesh, &vector, &mut forces);
            vector::each3(&mut vector, &forces, &self.inverse, |v, f, i| (0..3).for_each(|d| v[d] = f[d] * i[d]));
            // With the scalar product of the diagonal, the quotient of two steps is a Rayleigh quotient.
            let norm = vector::sum(&vector, |v| v.iter().map(|v| f64::from(v * v)).sum()).sqrt();
            if norm > 0.0 {
                largest = norm;
                vector.par_iter_mut().for_each(|v| *v = v.map(|v| (f64::from(v) / norm) as f32));
            }
        }
        POWER_MARGIN * largest
    }
}

/// Row of the whole matrix for a row of a voxel's.
fn entry(corners: &[u32; 8], row: usize) -> usize {
    3 * corners[row / 3] as usize + row % 3
}

/// The largest eigenvalue of a matrix scaled by its diagonal: no sum of such matrices has a larger one.
fn largest_eigenvalue(matrix: &Matrix) -> f64 {
    let mut vector: [f64; 24] = std::array::from_fn(|i| 1.0 + ((7 * i) % 11) as f64 / 11.0 - 2.0 * (i % 2) as f64);
    let mut largest = 1.0;
    for _ in 0..200 {
        let next: [f64; 24] = std::array::from_fn(|row| {
            matrix[row].iter().zip(&vector).map(|(k, v)| k * v).sum::<f64>() / matrix[row][row]
        });
        let norm = next.iter().map(|v| v * v).sum::<f64>().sqrt();
        if norm > 0.0 {
            largest = norm;
            vector = next.map(|v| v / norm);
        }
    }
    1.02 * largest
}
