//! Heat: how warm the metal is before each pass, and the waits and the order that a temperature limit requires.
//!
//! A part is divided into voxels about one bead wide. They are added as the torch lays their metal, in the order and
//! timing of the program, and take the power of the arc; heat is conducted within part and plate, and lost to the air,
//! by radiation, and to the table (`docs/heat.md` has the equations, their limits and how they were checked).
//!
//! | file | what it does |
//! | --- | --- |
//! | `settings` | the sections `[material]`, `[substrate]`, `[heat]` and `[interpass]` |
//! | `grid` | where the voxels lie |
//! | `frame` | position of layers among them, level or not |
//! | `space` | builds whose layers are not level, and the metal that their bodies begin on |
//! | `body` | their metal: what it holds, conducts and leaves bare |
//! | `sweep` | one step in time |
//! | `build` | the torch moves, metal is laid and heated; temperatures of passes and layers |
//! | `course` | where the heat lies, over the time of a build |
//! | `history` | all layers of a plan, one after another |
//! | `interpass` | waits, and the order of passes that saves waiting |
//! | `walls` | thickness and width of layers by heat, fitted to measured walls |

mod body;
mod build;
mod course;
mod frame;
mod grid;
mod history;
mod interpass;
mod settings;
mod space;
mod sweep;
mod walls;

pub use body::{Air, Body, Stuff};
pub use build::{Build, LONGEST_WAIT, LayerHeat, MOST_VOXELS, NOISE, PassHeat};
pub use course::Moment;
pub use frame::Site;
pub use grid::Grid;
pub use history::{History, course, history, plate};
pub use settings::{HeatError, HeatSection, HeatSettings, Interpass, Material, Substrate};
pub use walls::{ByHeat, MeasuredWall, PredictedWall, Wall, WallFitError, WallLaw};
