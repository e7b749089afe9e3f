//! Beadwright turns a part into a weld-deposition program, and tells beforehand what that program would build.
//!
//! A file's bytes become a [`Mesh`](model::Mesh) ([`model::import`]), the mesh is cut into [layers](mod@slice), every
//! island of a layer is [filled](fill) with passes, the passes are put in [`order`], and a [plan](plan::plan)
//! holds the result. A plan becomes a neutral [`program`], and a [`dialect`] writes that in a robot's language. All
//! values of the process come from a [`profile`]. Data goes down this table only:
//!
//! | stage | module |
//! | --- | --- |
//! | import | [`model`] |
//! | slice | [`slice`](mod@slice) |
//! | bead | [`bead`] |
//! | fill | [`fill`] |
//! | order | [`order`] |
//! | judge | [`deposit`], [`simulate`], [`compare`] |
//! | check | [`check`](mod@check) |
//! | start and stop | [`weld`] |
//! | plan | [`plan`], [`metrics`], [`plan_file`] |
//! | program | [`program`] |
//! | dialect | [`dialect`] |
//! | show | [`report`] |
//! | reach | [`robot`] |
//!
//! Beside it stand [`task`] (progress and cancelling), [`warning`] (what was lost or mended), [`profile`] and
//! [`example`] (parts to try). The library does no I/O and never panics on input.
//!
//! ```
//! use beadwright::{example, plan, profile::Profile, task::Task};
//!
//! let mesh = example::find("cross").ok_or("no such example")?.mesh();
//! let profile = Profile::built_in("plasma-304-cnc")?;
//! let plan = plan::plan("cross", &mesh, &profile, &Task::new())?;
//! assert_eq!(plan.layers.len(), 15);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod bead;
pub mod check;
pub mod compare;
pub mod curve;
pub mod deposit;
pub mod dialect;
pub mod example;
pub mod files;
pub mod fill;
pub mod layer;
pub mod limit;
pub mod metrics;
pub mod model;
pub mod motion;
pub mod number;
pub mod order;
pub mod pass;
pub mod plan;
pub mod plan_file;
pub mod process;
pub mod profile;
pub mod program;
pub mod report;
pub mod reproduce;
pub mod robot;
pub mod simulate;
pub mod slice;
pub mod task;
pub mod template;
pub mod warning;
pub mod weld;

pub use planar;
