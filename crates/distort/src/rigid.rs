//! The part of a displacement that only moves and turns, and small systems of linear equations.

use glam::{DMat3, DVec3};

/// A small motion of a rigid body: `shift` + `turn` × (place − `centre`).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Rigid {
    centre: DVec3,
    shift: DVec3,
    turn: DVec3,
}

impl Rigid {
    /// The one that is closest to displacements at places, by least squares.
    pub(crate) fn fitted(places: impl Iterator<Item = (DVec3, DVec3)> + Clone) -> Self {
        let count = places.clone().count().max(1) as f64;
        let sums = places.clone().fold((DVec3::ZERO, DVec3::ZERO), |(a, b), (place, moved)| (a + place, b + moved));
        let (centre, shift) = (sums.0 / count, sums.1 / count);
        let (mut inertia, mut moment) = (DMat3::ZERO, DVec3::ZERO);
        for (place, moved) in places {
            let arm = place - centre;
            let outer = DMat3::from_cols(arm * arm.x, arm * arm.y, arm * arm.z);
            inertia += DMat3::from_diagonal(DVec3::splat(arm.length_squared())) - outer;
            moment += arm.cross(moved);
        }
        let size = inertia.x_axis.x + inertia.y_axis.y + inertia.z_axis.z;
        let turns = inertia.determinant() > 1e-12 * size.powi(3);
        let turn = if turns { inertia.inverse() * moment } else { DVec3::ZERO };
        Self { centre, shift, turn }
    }

    /// Displacement at a place.
    pub(crate) fn at(&self, place: DVec3) -> DVec3 {
        self.shift + self.turn.cross(place - self.centre)
    }
}

/// Solves N linear equations with row pivots; unknowns without influence become 0.
pub(crate) fn solved<const N: usize>(mut matrix: [[f64; N]; N], mut right: [f64; N]) -> [f64; N] {
    let largest = matrix.iter().flatten().fold(0.0, |a: f64, v| a.max(v.abs()));
    let mut pivots = [None; N];
    let mut used = [false; N];
    for column in 0..N {
        let free = (0..N).filter(|&row| !used[row]);
        let Some(row) = free.max_by(|&a, &b| matrix[a][column].abs().total_cmp(&matrix[b][column].abs())) else {
            break;
        };
        let pivot = matrix[row][column];
        if pivot.abs() <= 1e-13 * largest {
            continue;
        }
        (used[row], pivots[column]) = (true, Some(row));
        for other in (0..N).filter(|&other| other != row) {
            let factor = matrix[other][column] / pivot;
            (0..N).for_each(|c| matrix[other][c] -= factor * matrix[row][c]);
            right[other] -= factor * right[row];
        }
    }
    std::array::from_fn(|column| pivots[column].map_or(0.0, |row| right[row] / matrix[row][column]))
}
