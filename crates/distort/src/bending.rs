//! How a part deviates at any place, also beside its voxels.

use crate::figures::{Distortion, Shape};
use crate::grid::Grid;
use crate::rigid::Rigid;
use glam::DVec3;
use rustc_hash::{FxHashMap, FxHashSet};

/// A place takes the displacement of the nearest node of the part up to this many voxels away.
const REACH: i64 = 6;

/// The displacement of a part without its motion as a rigid body, at any place.
#[derive(Debug, Clone)]
pub struct Bending {
    grid: Grid,
    /// Displacement of the nodes of the part, mm.
    nodes: FxHashMap<usize, DVec3>,
}

impl Distortion {
    /// How the part deviates in one of the shapes of this build.
    pub fn bending(&self, shape: &Shape) -> Bending {
        let grid = self.grid;
        let welded = self.voxels.iter().zip(&self.born).filter(|(_, born)| **born > 0);
        let of_part: FxHashSet<usize> = welded.flat_map(|(&voxel, _)| grid.corners(voxel)).collect();
        let nodes = || shape.nodes.iter().zip(&shape.moved).filter(|(node, _)| of_part.contains(node));
        let own = Rigid::fitted(nodes().map(|(&node, &moved)| (grid.place(node), moved)));
        Bending { grid, nodes: nodes().map(|(&node, &moved)| (node, moved - own.at(grid.place(node)))).collect() }
    }
}

impl Bending {
    /// The displacement at a place, mm: between the nodes of the part, linear along each axis; beside them, that of the
    /// nearest. `None` more than six voxels away from the part.
    pub fn at(&self, place: DVec3) -> Option<DVec3> {
        let at = (place - self.grid.low) / self.grid.size;
        let cell = at.floor();
        let (mut sum, mut weights) = (DVec3::ZERO, 0.0);
        for corner in 0..8 {
            let step = DVec3::from_array(std::array::from_fn(|d| f64::from(corner >> d & 1)));
            let Some(&moved) = self.node(cell + step) else { continue };
            // A node on the other side of the voxel still has a trace of weight, where there is no other.
            let near = DVec3::ONE - (at - cell - step).abs();
            let weight = (near.x * near.y * near.z).max(1e-12);
            (sum, weights) = (sum + weight * moved, weights + weight);
        }
        if weights > 0.0 { Some(sum / weights) } else { self.nearest(place) }
    }

    /// The displacement of a node at a position in the lattice.
    fn node(&self, at: DVec3) -> Option<&DVec3> {
        let counts = self.grid.node_counts();
        let inside = (0..3).all(|d| (0.0..counts[d] as f64).contains(&at[d]));
        if inside { self.nodes.get(&self.grid.node(at.to_array().map(|a| a as usize))) } else { None }
    }

    /// The displacement of the nearest node of the part.
    fn nearest(&self, place: DVec3) -> Option<DVec3> {
        let middle = ((place - self.grid.low) / self.grid.size).round();
        let range = || -REACH..=REACH;
        let steps = range().flat_map(|x| range().flat_map(move |y| range().map(move |z| [x, y, z].map(|s| s as f64))));
        let around = steps.filter_map(|step| {
            let at = middle + DVec3::from_array(step);
            Some((self.grid.low + at * self.grid.size, self.node(at)?))
        });
        let distance = |node: DVec3| node.distance_squared(place);
        around.min_by(|a, b| distance(a.0).total_cmp(&distance(b.0))).map(|(_, &moved)| moved)
    }
}
