//! All tests of the crate as one program: each file is a module, `cargo test -p bead-distort --test it FILE::` runs one.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may fail by panic")]

mod balance;
mod bending;
mod calibrate;
mod closed_forms;
mod eccentricity;
mod errors;
mod parts;
mod steps;
mod surface;
mod symmetry;
mod tendon;
