//! What can be wrong with the input, and what can go wrong.

use crate::grid::Grid;

/// Why a distortion cannot be computed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DistortError {
    /// A number is out of its range.
    #[error("{name} = {value} {unit}: the value must lie between {low} and {high} {unit}.")]
    OutOfRange {
        /// Which number.
        name: &'static str,
        /// What it is.
        value: f64,
        /// Lowest value allowed.
        low: f64,
        /// Highest value allowed.
        high: f64,
        /// Its unit.
        unit: &'static str,
    },
    /// A bead's points or numbers are not usable.
    #[error("Bead {}: {reason}.", bead + 1)]
    Bead {
        /// Index of the bead, from 0.
        bead: usize,
        /// What is wrong, and what would be right.
        reason: &'static str,
    },
    /// The box of the plate is empty.
    #[error("The plate has no volume: its highest corner must lie above its lowest in x, y and z.")]
    NoPlate,
    /// The lattice around plate and part would be too large.
    #[error(
        "A lattice of {} × {} × {} voxels would be needed, more than {most} in all. Choose voxels larger than {:.2} mm.",
        counts[0], counts[1], counts[2], voxel
    )]
    TooMany {
        /// Voxels along x, y and z.
        counts: [usize; 3],
        /// Length of a voxel, mm.
        voxel: f64,
        /// Most voxels.
        most: usize,
    },
    /// A list has the wrong length.
    #[error("{name}: {given} values are given, {wanted} are needed.")]
    Length {
        /// Which list.
        name: &'static str,
        /// Its length.
        given: usize,
        /// Length needed.
        wanted: usize,
    },
    /// A voxel or node lies outside the lattice.
    #[error("{name} {index} does not exist: the grid has {count}.")]
    Outside {
        /// Voxel or node.
        name: &'static str,
        /// Its index.
        index: usize,
        /// How many there are.
        count: usize,
    },
    /// A node is held or pushed where there is no metal.
    #[error("There is no metal at x = {:.2}, y = {:.2}, z = {:.2} mm to hold or push: choose a node of a voxel with metal.", at[0], at[1], at[2])]
    NoMetal {
        /// The place, mm.
        at: [f64; 3],
    },
    /// The solver did not get there.
    #[error(
        "The forces were not in balance after {iterations} iterations (a fraction of {residual:.1e} was left): parts of the body \
         may hang together by edges only, or nothing holds it. Use smaller voxels, or hold it."
    )]
    NotConverged {
        /// Iterations of conjugate gradients.
        iterations: usize,
        /// Unbalanced force as a fraction of the load.
        residual: f64,
    },
    /// Nothing to fit.
    #[error("Nothing can be calibrated: the computed values are all zero or not finite.")]
    NothingComputed,
    /// The caller asked to stop.
    #[error("cancelled")]
    Cancelled,
}

/// Most voxels of a lattice, with and without metal.
pub const MOST_VOXELS: usize = 4_000_000;

/// An error unless a number lies in its range.
pub(crate) fn within(
    name: &'static str,
    value: f64,
    [low, high]: [f64; 2],
    unit: &'static str,
) -> Result<(), DistortError> {
    let fine = (low..=high).contains(&value);
    if fine { Ok(()) } else { Err(DistortError::OutOfRange { name, value, low, high, unit }) }
}

/// An error if a grid has too many voxels.
pub(crate) fn not_too_many(grid: &Grid) -> Result<(), DistortError> {
    // Positions along a side are kept in 16 bits.
    let most_along = grid.counts.iter().all(|&n| n < usize::from(u16::MAX));
    let count = grid.counts.iter().try_fold(1usize, |product, &n| product.checked_mul(n));
    if most_along && count.is_some_and(|count| count <= MOST_VOXELS) {
        return Ok(());
    }
    let voxel = grid.size.max_element();
    Err(DistortError::TooMany { counts: grid.counts, voxel, most: MOST_VOXELS })
}
