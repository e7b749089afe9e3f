//! Can the robot weld this plan? Joint paths, margins, and a better position for the part.
//!
//! A [`Cell`] is an [`Arm`] (six lengths, a [`Chain`], or a chain from a [URDF](urdf) file) with its torch and the
//! position of the part. [`Track`] turns a plan into the path of the torch, travels included; [`reach`] walks it with
//! the torch straight down:
//!
//! 1. at stations along the path, the margins of all torch angles are computed (`turn.rs`): the torch may be at any
//!    angle about its own axis, and that freedom keeps joints away from limits;
//! 2. dynamic programming picks one branch of the arm for the whole program and, of all courses of the torch angle with
//!    the greatest least margin, the one that turns least;
//! 3. every point is walked with that course: joint angles, margins, speeds, [findings](finding) (`walk.rs`); before
//!    and after it the moves from and to home (`home.rs`), if the cell has a home;
//! 4. at every stop the arm and the torch, as capsules, are checked against each other, the table and its fixtures, and
//!    the metal laid so far (`room.rs`, `metal.rs`), if the cell gives their thickness. Table, fixtures and metal turn
//!    with the part.
//!
//! A [`Trajectory`] has the joints over time, for simulators. [`suggest()`] searches for a position of the part with
//! greater margins; [`external_axes`] for the position of the robot on a linear axis and the angle of a table under the
//! part.
//!
//! [`calibrate`] finds from measured points where tool, part, positioner and scanner are; it needs no cell.
//!
//! Not checked: cables, anything that the cell does not describe, and the dynamics of the load.

pub mod arm;
mod arm_keys;
pub mod arm_table;
pub mod body;
pub mod calibrate;
pub mod cell;
pub mod chain;
mod error;
mod external;
pub mod finding;
pub mod home;
pub mod linear_axis;
mod metal;
mod opw;
mod room;
pub mod suggest;
pub mod table;
pub mod track;
pub mod trajectory;
mod turn;
pub mod urdf;
mod walk;

pub use arm::{Arm, Axis, Branch, Frame, Joints, Margins};
pub use arm_table::{ArmTable, OpwTable, Shape};
pub use body::{Body, Fixture, Solid};
pub use cell::{Cell, LinearAxis, PartPlace, ScannerPlace, Table};
pub use chain::{Chain, ChainError};
pub use error::CellError;
pub use external::{External, external_axes};
pub use finding::{ReachFinding, Trouble};
pub use home::{Home, Way};
pub use linear_axis::Station;
pub use suggest::{Suggestion, suggest};
pub use table::{TableAngle, turn_table};
pub use track::{Leg, Stop, Track};
pub use trajectory::Trajectory;
pub use urdf::UrdfError;
pub use walk::{Pose, Reach, Turning, reach};

use glam::DQuat;

/// The tool frame with the torch pointing straight down over a point of the part, turned by `angle` (°) about its own
/// axis; at 0 its x axis is the part's.
///
/// ```
/// use bead_robot::part_from_tool;
/// use glam::DVec3;
///
/// let tool = part_from_tool(DVec3::new(10.0, 20.0, 2.0), 90.0);
/// assert!((tool.rotation * DVec3::Z).distance(DVec3::NEG_Z) < 1e-12, "the wire points down");
/// assert!((tool.rotation * DVec3::X).distance(DVec3::Y) < 1e-12);
/// ```
pub fn part_from_tool(at: glam::DVec3, angle: f64) -> Frame {
    let rotation = DQuat::from_rotation_z(angle.to_radians()) * DQuat::from_rotation_x(std::f64::consts::PI);
    Frame { position: at, rotation }
}
