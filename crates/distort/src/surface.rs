//! The surface of plate and part: faces of voxels that no other voxel covers.

use crate::figures::Distortion;
use crate::grid::Grid;

/// Faces of a voxel, by bits of its corners (see [`Grid::corners`]), counter-clockwise seen from outside: along -x, +x, -y, +y,
/// -z, +z.
const FACES: [[usize; 4]; 6] = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];

impl Distortion {
    /// Faces between metal and air, each with its four nodes, counter-clockwise seen from the air.
    pub fn surface(&self) -> Vec<[usize; 4]> {
        faces(&self.grid, &self.voxels)
    }

    /// Faces of the plate by itself, likewise: those that the part covers are among them.
    pub fn plate_surface(&self) -> Vec<[usize; 4]> {
        let plate = self.voxels.iter().zip(&self.born).filter(|(_, born)| **born == 0);
        faces(&self.grid, &plate.map(|(&voxel, _)| voxel).collect::<Vec<_>>())
    }
}

/// Faces of a body of these voxels that none of them covers.
fn faces(grid: &Grid, voxels: &[usize]) -> Vec<[usize; 4]> {
    let mut there = vec![false; grid.voxels()];
    voxels.iter().for_each(|&voxel| there[voxel] = true);
    let open = |voxel: usize, face: usize| !beside(grid, voxel, face).is_some_and(|other| there[other]);
    let faces = voxels.iter().flat_map(|&voxel| (0..FACES.len()).map(move |face| (voxel, face)));
    let open = faces.filter(|&(voxel, face)| open(voxel, face));
    open.map(|(voxel, face)| FACES[face].map(|corner| grid.corners(voxel)[corner])).collect()
}

/// The voxel on the other side of a face.
fn beside(grid: &Grid, voxel: usize, face: usize) -> Option<usize> {
    let (mut at, axis) = (grid.voxel_at(voxel), face / 2);
    at[axis] = if face.is_multiple_of(2) { at[axis].checked_sub(1)? } else { at[axis] + 1 };
    (at[axis] < grid.counts[axis]).then(|| grid.voxel(at))
}
