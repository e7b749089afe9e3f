//! What comes out: shapes before and after release, and their figures.

use crate::error::DistortError;
use crate::grid::Grid;
use crate::metal::Metal;
use crate::rigid::{Rigid, solved};
use glam::DVec3;
use serde::Serialize;

/// How far a plate is from flat.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Lift {
    /// Largest distance of its lower face from the plane that fits it best, mm.
    pub largest: f64,
    /// From the lowest to the highest point above that plane, mm: about what it rises above a flat table.
    pub range: f64,
    /// Where the largest distance is, mm.
    pub at: DVec3,
}

/// How far the part is from where it was meant to be.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Deviation {
    /// Largest displacement, mm, without the motion as a rigid body that fits the part best.
    pub largest: f64,
    /// Root of the mean square, mm.
    pub rms: f64,
    /// Where the largest displacement is, mm.
    pub at: DVec3,
}

/// A bent plate with its part.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Shape {
    /// Nodes of the grid that belong to metal.
    pub nodes: Vec<usize>,
    /// Their displacement, mm: on clamps that from where the program puts them; without, that which is left when the
    /// plate's lower face lies as well as it can on where it was.
    pub moved: Vec<DVec3>,
    /// The plate.
    pub lift: Lift,
    /// The part.
    pub deviation: Deviation,
}

/// The state at the end of a step.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Step {
    /// When its last bead ended, s.
    pub time: f64,
    /// Number of beads.
    pub beads: usize,
    /// The plate on its clamps.
    pub lift: Lift,
}

/// How exactly forces and energies are in balance.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Balance {
    /// Force out of balance as a fraction of the forces of the shrinkage, both as roots of sums of squares over all nodes.
    pub residual: f64,
    /// Elastic energy of plate and part, N·mm.
    pub energy: f64,
    /// Energy of the clamps, N·mm.
    pub clamp_energy: f64,
    /// Work that the shrinkage has done, less the energy that opening the clamps took away, N·mm; the sum of both energies.
    pub work: f64,
    /// Sum of the clamps' forces, N: zero but for rounding.
    pub reaction_sum: DVec3,
    /// Sum of their moments about the origin, N·mm: zero but for rounding.
    pub reaction_moment: DVec3,
    /// Largest force of a clamp on a node, N.
    pub largest_reaction: f64,
}

/// Result of a build.
#[derive(Debug, Clone, PartialEq)]
pub struct Distortion {
    /// Where voxels lie.
    pub grid: Grid,
    /// Voxels with metal.
    pub voxels: Vec<usize>,
    /// For each of them, its stiffness as a multiple of the part's.
    pub factors: Vec<f64>,
    /// For each of them, the step from which it was there; 0 for the plate.
    pub born: Vec<u32>,
    /// For each of them, its mean stress after release, MPa: xx, yy, zz, xy, yz, zx.
    pub stresses: Vec<[f64; 6]>,
    /// The course of the build.
    pub steps: Vec<Step>,
    /// On its clamps, at the end of the build.
    pub clamped: Shape,
    /// Released.
    pub released: Shape,
    /// Forces and energies on the clamps.
    pub clamped_balance: Balance,
    /// Forces and energies after release.
    pub released_balance: Balance,
    /// Iterations of conjugate gradients in all.
    pub iterations: usize,
}

/// A factor from one measured plate.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Calibration {
    /// Multiply [`crate::Settings::calibration`] by this.
    pub factor: f64,
    /// Root of the mean square of what is left, mm.
    pub left: f64,
    /// Root of the mean square of the measured shape, without its plane, mm.
    pub measured: f64,
}

impl Shape {
    /// `lower` has the nodes of the plate's lower face.
    pub(crate) fn new(metal: &Metal, moved: &[[f64; 3]], there: &[bool], lower: &[usize], clamped: bool) -> Self {
        let grid = &metal.grid;
        let nodes: Vec<usize> = (0..there.len()).filter(|&node| there[node]).collect();
        let raw = |node: usize| (grid.place(node), DVec3::from_array(moved[node]));
        let welded = |voxel: usize| metal.factors[voxel] > 0.0 && metal.born[voxel] > 0;
        let of_part = |node: &usize| grid.touching(*node).any(welded);
        let part: Vec<usize> = nodes.iter().copied().filter(of_part).collect();
        let plane = Rigid::fitted(lower.iter().map(|&node| raw(node)));
        let deviation = Deviation::of(part.iter().map(|&node| raw(node)));
        let seen = |&node: &usize| {
            let (place, moved) = raw(node);
            if clamped { moved } else { moved - plane.at(place) }
        };
        Self { moved: nodes.iter().map(seen).collect(), nodes, lift: Lift::of(grid, moved, lower), deviation }
    }
}

impl Lift {
    /// Of the nodes of the plate's lower face.
    pub(crate) fn of(grid: &Grid, moved: &[[f64; 3]], lower: &[usize]) -> Self {
        let face = lower.iter().map(|&node| (grid.place(node), DVec3::from_array(moved[node])));
        let plane = Rigid::fitted(face.clone());
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        let mut lift = Self::default();
        for (place, moved) in face {
            let height = (moved - plane.at(place)).z;
            (low, high) = (low.min(height), high.max(height));
            if height.abs() > lift.largest {
                (lift.largest, lift.at) = (height.abs(), place);
            }
        }
        Self { range: (high - low).max(0.0), ..lift }
    }
}

impl Deviation {
    /// Of places with their displacements, mm.
    pub fn of(part: impl Iterator<Item = (DVec3, DVec3)> + Clone) -> Self {
        let own = Rigid::fitted(part.clone());
        let (mut sum, mut count, mut deviation) = (0.0, 0usize, Self::default());
        for (place, moved) in part {
            let distance = (moved - own.at(place)).length();
            sum += distance * distance;
            count += 1;
            if distance > deviation.largest {
                (deviation.largest, deviation.at) = (distance, place);
            }
        }
        Self { rms: (sum / count.max(1) as f64).sqrt(), ..deviation }
    }
}

impl Distortion {
    /// Displacement at a place, mm, of a shape of this build; between nodes without metal, that of the nearest with metal
    /// of the same voxel. `None` outside the grid, and in voxels that no metal touches.
    pub fn at(&self, shape: &Shape, place: DVec3) -> Option<DVec3> {
        let grid = &self.grid;
        let most = DVec3::from_array(grid.counts.map(|n| n as f64));
        let at = (place - grid.low) / grid.size;
        if !(at.min_element() >= -1e-9 && (most - at).min_element() >= -1e-9) {
            return None;
        }
        let cell = at.floor().clamp(DVec3::ZERO, most - DVec3::ONE);
        let part = at - cell;
        let corners = grid.corners(grid.voxel(cell.to_array().map(|c| c as usize)));
        let (mut sum, mut weights) = (DVec3::ZERO, 0.0);
        for (corner, node) in corners.into_iter().enumerate() {
            let Ok(found) = shape.nodes.binary_search(&node) else { continue };
            let side = |d: usize| if corner >> d & 1 == 1 { part[d] } else { 1.0 - part[d] };
            let weight = (side(0) * side(1) * side(2)).max(1e-12);
            sum += weight * shape.moved[found];
            weights += weight;
        }
        (weights > 0.0).then(|| sum / weights)
    }

    /// The factor with which the computed shape of the released plate's lower face fits a measured one best. `scan` has
    /// points of that face, mm, in the plan's x and y, with the measured height as z; how the scan lies (height and tilt) does
    /// not matter. The shape is proportional to the calibration, so one build is enough.
    ///
    /// # Errors
    /// Fewer than four points on the plate, or a computed plate that is flat.
    pub fn calibrated(&self, scan: &[DVec3]) -> Result<Calibration, DistortError> {
        let lowest = self
            .voxels
            .iter()
            .zip(&self.born)
            .filter(|(_, born)| **born == 0)
            .map(|(&v, _)| self.grid.voxel_at(v)[2])
            .min();
        let z = self.grid.low.z + lowest.unwrap_or_default() as f64 * self.grid.size.z;
        let computed = |point: &DVec3| Some((*point, self.at(&self.released, DVec3::new(point.x, point.y, z))?.z));
        let points: Vec<(DVec3, f64)> = scan.iter().filter(|p| p.is_finite()).filter_map(computed).collect();
        if points.len() < 4 {
            return Err(DistortError::Length {
                name: "Points of the scan on the plate",
                given: points.len(),
                wanted: 4,
            });
        }
        let middle = points.iter().map(|(p, _)| *p).sum::<DVec3>() / points.len() as f64;
        let row = |(p, w): &(DVec3, f64)| [1.0, p.x - middle.x, p.y - middle.y, *w];
        let fit = |used: usize| {
            let (mut matrix, mut right) = ([[0.0; 4]; 4], [0.0; 4]);
            for point in &points {
                let row = row(point);
                for a in 0..used {
                    right[a] += row[a] * point.0.z;
                    (0..used).for_each(|b| matrix[a][b] += row[a] * row[b]);
                }
            }
            let found = solved(scaled(matrix), scaled_right(matrix, right));
            let factors: [f64; 4] = std::array::from_fn(|i| found[i] / root(matrix[i][i]));
            let left = |point: &(DVec3, f64)| {
                let row = row(point);
                (point.0.z - (0..used).map(|i| factors[i] * row[i]).sum::<f64>()).powi(2)
            };
            (factors[3], (points.iter().map(left).sum::<f64>() / points.len() as f64).sqrt())
        };
        let ((_, measured), (factor, left)) = (fit(3), fit(4));
        if factor == 0.0 || !factor.is_finite() {
            return Err(DistortError::NothingComputed);
        }
        Ok(Calibration { factor, left, measured })
    }
}

/// The root of a diagonal entry, or 1 where it is zero.
fn root(entry: f64) -> f64 {
    if entry > 0.0 { entry.sqrt() } else { 1.0 }
}

/// The matrix with ones on its diagonal.
fn scaled(matrix: [[f64; 4]; 4]) -> [[f64; 4]; 4] {
    std::array::from_fn(|a| std::array::from_fn(|b| matrix[a][b] / (root(matrix[a][a]) * root(matrix[b][b]))))
}

fn scaled_right(matrix: [[f64; 4]; 4], right: [f64; 4]) -> [f64; 4] {
    std::array::from_fn(|a| right[a] / root(matrix[a][a]))
}
