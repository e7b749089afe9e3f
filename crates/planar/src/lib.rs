//! Two-dimensional geometry for planning: regions with holes, booleans, offsets, scan lines, hulls.
//!
//! Everything is in millimetres as `f64` ([`glam::DVec2`]); nothing here is about welding, and the crate exposes no
//! type of the polygon library underneath.
//!
//! | file | what it holds |
//! | --- | --- |
//! | [`ring`] | [`Ring`], [`Polygon`], [`Region`]: the shapes and their measures |
//! | [`arcs`] | lines fitted by straight pieces and arcs |
//! | [`boolean`] | union, difference, intersection of regions |
//! | [`boxes`] | straight pieces sorted so that those that may meet are found |
//! | [`offset`](mod@offset) | growing and shrinking, with round or mitred joins |
//! | [`clip`] | open lines cut by a region |
//! | [`scan`] | parallel scan lines through a region, and how their ends are connected along its boundary |
//! | [`polyline`] | length, simplification |
//! | [`isolines`] | closed lines of equal value of a field on a lattice |
//! | [`hull`] | convex hull, minimum-area rectangle |
//! | [`lattice`] | square lattices of points and values on them |
//! | [`nearest`] | the nearest segment of each point of a lattice |
//! | [`ladder`] | narrow regions as pairs of opposite boundary points: their medial axis and thickness |
//! | [`stroke`] | lines grown to areas |
//! | [`medial`] | medial axis: centre-lines with local thickness |
//! | [`triangulate`] | triangles that fill a polygon |
//! | [`turns`] | number of ends of scan lines as a function of their angle |
//!
//! # The grid underneath
//!
//! Booleans and offsets run on exact integer arithmetic (`i_overlay`, 32-bit coordinates) with a grid of
//! [`GRID_MM`] = 0.1 µm. A vertex moves by at most half a grid step per axis when it enters an operation,
//! 0.07 µm, wherever it lies; coordinates may reach ±[`MAX_COORDINATE_MM`] = 50 m and are clamped there.
//! An offset is then simplified by [`offset::SIMPLIFY_MM`].
//!
//! Most operations never need it: where boundaries cross but nowhere touch, the winding number decides (`winding`), on
//! rings that an offset draws edge by edge (`edgewise`). The result is rounded to the same grid.

pub mod arcs;
pub mod boolean;
pub mod boxes;
pub mod clip;
mod disc;
mod edgewise;
mod grid;
pub mod hull;
pub mod isolines;
pub mod ladder;
pub mod lattice;
pub mod medial;
pub mod nearest;
pub mod offset;
pub mod polyline;
pub mod ring;
mod rows;
pub mod scan;
pub mod stroke;
pub mod triangulate;
pub mod turns;
mod winding;

pub use glam::DVec2;
pub use grid::{GRID_MM, MAX_COORDINATE_MM};
pub use hull::{OrientedRect, convex_hull, min_area_rect};
pub use lattice::Lattice;
pub use offset::Join;
pub use ring::{Bounds, FillRule, Polygon, Region, Ring};
pub use rows::PerRow;
pub use stroke::buffer;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
