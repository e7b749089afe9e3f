//! The 3-D view: model, beads, travels and torch, rendered by wgpu and shown as an egui image.
//!
//! A [`Scene`] holds what can be shown, a [`Style`] says which of it is shown and how, a [`Camera`] from where.
//! [`View3d::show`] is the widget and [`View3d::picture`] the same as pixels. Nothing is rendered while nothing changes.
//!
//! | file | what it does |
//! | --- | --- |
//! | `beads` | one layer as it is drawn and timed |
//! | `lie` | how it lies in space |
//! | `scene` | the model and the layers planned so far |
//! | `scanned` | a scan of the built part; the part in the colours of its bodies |
//! | `bent` | how far plate and beads move as they cool |
//! | `style`, [`palette`] | what is shown and in which colours |
//! | `section` | a plane that cuts away what lies beyond it |
//! | `shape` | what stands around the part: bodies of revolution, boxes, the floor |
//! | `camera` | where the eye is |
//! | `pick`, `face` | which segment, which face of the model is under the pointer |
//! | `gpu` | buffers, shaders, pictures |
//! | `widget` | the pointer turns and picks; frames are kept |
//! | `gizmo` | handles that move and turn the part |
//! | `overlay` | axes, scale bar, the mark of a place |
//! | `headless` | a renderer without a window |

mod beads;
mod bent;
mod camera;
mod face;
mod gizmo;
mod gpu;
mod headless;
mod lie;
mod overlay;
pub mod palette;
mod pick;
mod scanned;
mod scene;
mod section;
mod shape;
mod style;
mod widget;

pub use beads::{Bead, LayerBeads, PassSpan};
pub use bent::Bent;
pub use camera::{Camera, StandardView};
pub use face::face;
pub use gizmo::{Gizmo, Grip, Handle, Moved};
pub(crate) use gpu::BELOW;
pub use headless::headless;
pub use lie::Stance;
pub use overlay::ring;
pub use pick::{Pick, pick};
pub use scanned::Scanned;
pub use scene::{Position, Scene};
pub use section::Section;
pub use shape::{Floor, Look, Shape};
pub use style::{Colour, Plate, Style};
pub use widget::{Shown, Timing, View3d};
