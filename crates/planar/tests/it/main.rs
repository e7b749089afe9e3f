//! All tests of the crate as one program: each file is a module, `cargo test -p bead-planar --test it FILE::` runs one.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may fail by panic")]

mod arcs;
mod booleans;
mod clip;
mod hull;
mod ladder;
mod lattice;
mod medial;
mod offsets;
mod polyline;
mod scan;
mod shapes;
mod stroke;
mod triangulate;
mod turns;
