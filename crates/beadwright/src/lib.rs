//! Beadwright turns a part into a weld-deposition program, and predicts what that program would build.
//!
//! A file's bytes become a [`Model`]; placed, it is a [`Part`]; the part is cut into [slices](mod@slice), every island of a
//! slice is [filled](fill), the passes are put in order, and a [`Plan`] holds the result. A plan is written in a robot's
//! language by a [`dialect`], judged by the deposit model ([`deposit`]), checked ([`check`](mod@check)) and shown
//! ([`report`]). All values of the process come from a [`Profile`].
//!
//! ```
//! use beadwright::{Model, Placement, Profile, Task, dialect, example, plan};
//!
//! let (profile, task) = (Profile::built_in("cmt-al2319-kuka")?, Task::new());
//! let bytes = example::find("cross").ok_or("no such example")?.stl();
//! let part = Model::read(&bytes, &task)?.place(&Placement::default(), None, profile.bead.width)?;
//! let plan = plan("cross", &part, &profile, &task)?;
//! let files = dialect::write("krl", &plan.layers, &profile.job("cross"))?;
//! assert!(files["CROSS.src"].contains("CROSS_L001( )"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The library does no I/O (except [`files`], with the feature of that name) and never panics on input. More programs like
//! this one are in `examples/`.

pub mod adapt;
pub mod as_built;
pub mod build;
pub mod check;
pub mod compare;
pub mod directions;
pub mod distortion;
pub mod export;
pub mod files;
pub mod palette;
pub mod plan;
pub mod profile;
pub mod read_back;
pub mod record;
pub mod report;
pub mod trial;

// Used by the modules above, and open to anyone who needs them.
#[doc(hidden)]
pub mod metrics;
#[doc(hidden)]
pub mod plan_file;
#[doc(hidden)]
pub mod simulate;

pub use bead_part::{chart, example, model, slice};
#[doc(hidden)]
pub use bead_part::{cladding, curve, damage, deviation, finding, middle_line, task, text, warning};
use bead_plan::random;
pub use bead_plan::{bead, deposit, fill, heat, preform};
#[doc(hidden)]
pub use bead_plan::{layer, limit, motion, order, pass, process, wedge, weld};
pub use bead_program::{dialect, program};
#[doc(hidden)]
pub use bead_program::{number, template};
pub use bead_robot as robot;
pub use distort;

pub use crate::bead::Bead;
pub use crate::check::check;
pub use crate::deposit::{Figures, Judge};
pub use crate::fill::{FillSettings, Strategy, StrategyName};
pub use crate::finding::Finding;
pub use crate::layer::Layer;
pub use crate::metrics::Metrics;
pub use crate::model::{Mesh, Model, Part, Placement};
pub use crate::pass::{Along, Pass, PassKind};
pub use crate::plan::{Plan, PlanError, Sink, plan};
pub use crate::profile::{Profile, ProfileError};
pub use crate::task::Task;
pub use glam;
pub use planar;
