//! Parts for weld deposition: what a file describes, repaired, and its level slices. Nothing here knows about beads or
//! machines.
//!
//! | module | what it holds |
//! | --- | --- |
//! | [`chart`] | layers that are not level: around an axis, on a cone, square to a direction or a curve |
//! | [`curve`] | NURBS curves, fits and lengths |
//! | [`model`] | meshes, curves and outlines read from files (STL, 3MF, OBJ, PLY, AMF, IGES, DXF, SVG), repaired and placed |
//! | [`slice`](mod@slice) | level slices: islands with holes, or the lines of an open surface |
//! | [`directions`] | a part divided into pieces with directions of their own |
//! | [`cladding`] | metal over the surface of an existing part |
//! | [`damage`] | what a scan of a part lacks, and the metal that replaces it |
//! | [`middle_line`] | the curve in the middle of a bent tube, from its sections |
//! | [`deviation`] | signed distances of measured points to a mesh |
//! | [`example`] | parametric example parts |
//! | [`finding`], [`warning`] | what is wrong or doubtful, and what was lost or repaired |
//! | [`task`] | progress and cancelling |
//! | [`text`] | encodings and line ends |

pub mod chart;
pub mod cladding;
pub mod curve;
pub mod damage;
pub mod deviation;
pub mod directions;
pub mod example;
pub mod finding;
pub mod middle_line;
pub mod model;
pub mod slice;
pub mod task;
pub mod text;
pub mod warning;
