//! How plate and part of a weld deposition bend, and how they spring when the clamps are opened.
//!
//! [`build()`] lays beads on a plate step by step. Plate and beads are elastic voxels; every bead shrinks together with the
//! metal beneath as its tendon force asks for, the plate moves on its clamps, and these are opened at the end
//! (`docs/distort.md` has the equations, their sources and limits, and how they were checked). [`eccentricity()`] says how far
//! the heat of a build lies from the middle of its metal, which costs much less and ranks orders. Nothing here knows about
//! plans: input is a box, polylines and temperatures.
//!
//! | file | what it holds |
//! | --- | --- |
//! | [`input`] | [`Plate`], [`Bead`], [`Clamp`] |
//! | [`settings`] | materials, voxels, steps |
//! | `metal` | beads become voxels, and groups that are laid together |
//! | `zone` | the shrinkage of a bead, shared out |
//! | [`build`](mod@build) | birth, shrinkage, balance and release |
//! | [`figures`] | [`Distortion`]: shapes, lift, deviation, balances; calibration by a scan |
//! | `surface` | the faces between metal and air |
//! | [`bending`] | [`Bending`]: how the part deviates at any place |
//! | [`eccentricity`](mod@eccentricity) | where the heat is |
//! | [`body`] | [`Body`]: one elastic body of voxels, for questions of other kinds |
//! | [`grid`], `mesh` | the lattice, and its voxels with metal |
//! | `element`, `level` | stiffness of a voxel and of all, multiplied without being put together |
//! | `system`, `multigrid`, `envelope` | conjugate gradients, what makes them quick, and the coarsest level |
//!
//! ```
//! use distort::{Bead, Clamp, DVec3, Plate, Settings, build};
//!
//! let plate = Plate { low: DVec3::new(-60.0, -15.0, -6.0), high: DVec3::new(60.0, 15.0, 0.0), stiffness: 1.0 };
//! let points = vec![DVec3::new(-45.0, 0.0, 2.0), DVec3::new(45.0, 0.0, 2.0)];
//! let bead = Bead { points, width: 6.0, height: 2.0, heat: 100.0, start: 0.0, end: 9.0, up: DVec3::Z };
//! let clamps = plate.clamped_at_corners(5.0, Clamp::FIRM);
//! let bent = build(&plate, &[bead], &clamps, &Settings::steel(), &mut |_| true)?;
//! println!("lift {:.2} mm on the clamps, {:.2} mm released", bent.clamped.lift.range, bent.released.lift.range);
//! # Ok::<(), distort::DistortError>(())
//! ```

pub mod bending;
pub mod body;
pub mod build;
pub mod eccentricity;
mod element;
mod envelope;
pub mod error;
pub mod figures;
pub mod grid;
pub mod input;
mod level;
mod mesh;
mod metal;
mod multigrid;
mod real;
mod rigid;
pub mod settings;
mod surface;
mod system;
mod vector;
mod zone;

pub use bending::Bending;
pub use body::{Body, Solved};
pub use build::build;
pub use eccentricity::{Deposit, Eccentricity, EccentricityScore, Snapshot, Warm, cooling, eccentricity};
pub use element::Elastic;
pub use error::{DistortError, MOST_VOXELS};
pub use figures::{Balance, Calibration, Deviation, Distortion, Lift, Shape, Step};
pub use glam::DVec3;
pub use grid::Grid;
pub use input::{Bead, Clamp, Plate};
pub use settings::{Settings, okerblom};
