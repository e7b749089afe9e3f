//! The desktop program of Beadwright: see the part, the beads and the voids, change a parameter, export.
//!
//! It has no planning logic: a [`project`](project::Project) goes to the [`planner`], a thread that calls the library,
//! and the results are put together in a [`state`](state::PlanState) that the views and panels show.
//!
//! | module | what it holds |
//! | --- | --- |
//! | [`studio`] | the program: where everything is put together |
//! | `app`, `act` | one frame of the window; carrying out actions |
//! | [`project`], [`history`] | what the user works on; undo and redo |
//! | [`planner`], [`state`] | planning in the background, on a thread or in a browser's worker, and its results so far |
//! | [`jobs`], [`heat`], [`level`], [`steps`] | other background work: reach, file dialogs; temperatures; how far layers lean; the steps of strategies |
//! | [`distortion`], `bending` | how plate and part bend as they cool |
//! | [`directions`], `dividing` | divisions of the part into bodies with build directions of their own |
//! | `computing` | a long computation with its progress, which can be given up |
//! | [`compared`], `scan` | a scan of the built part compared with the part |
//! | `process` | the language of programs and the robot cell, which follow the profile |
//! | [`form`] | the profile as a form |
//! | [`listing`] | the lines of a program, and where the torch is at each of them |
//! | [`adaptation`], `adapting` | what follows a scan of an unfinished build; the same in the window |
//! | [`batch`] | several models, planned one after another |
//! | [`shares`] | what the time of a program is spent on |
//! | [`arm`], [`holding`] | the robot's pose with the torch at a place; how the part is held there |
//! | [`machine`] | how robot, positioner, table and floor look |
//! | [`view`] | what is shown, and how |
//! | [`view3d`], [`view2d`] | part and beads; one layer |
//! | `known` | window, project, plans, background work: what panels read; and what they can change |
//! | `panels` | parameters, layers, totals, findings, plots, export: one file each |
//! | `files`, [`export`] | opening and writing files |
//! | [`disk`] | where files lie: on the disk; in a browser, what the user has handed over, and downloads |
//! | `web` | the page in a browser |
//! | [`remedy`], `trial` | what usually helps against a finding; a remedy that is tried |
//! | [`actions`] | what the user can do; menus and keys |
//! | [`thumbnail`] | pictures of the examples |
//! | [`settings`], [`text`], [`fonts`], [`theme`] | what is remembered; texts; fonts; colours |

mod act;
pub mod actions;
pub mod adaptation;
mod adapting;
mod app;
pub mod arm;
pub mod batch;
mod bending;
pub mod chinese;
pub mod compared;
mod computing;
pub mod directions;
pub mod disk;
pub mod distortion;
mod dividing;
pub mod export;
mod files;
pub mod fonts;
pub mod form;
pub mod heat;
pub mod history;
pub mod holding;
pub mod jobs;
mod known;
pub mod level;
pub mod listing;
pub mod machine;
pub mod orient;
mod panels;
pub mod planner;
mod process;
pub mod project;
pub mod remedy;
mod scan;
pub mod settings;
pub mod shares;
pub mod state;
pub mod steps;
pub mod studio;
pub mod text;
pub mod theme;
pub mod thumbnail;
mod trial;
pub mod view;
pub mod view2d;
pub mod view3d;
#[cfg(target_arch = "wasm32")]
pub mod web;

pub use studio::Studio;
