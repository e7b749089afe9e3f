//! All tests of the crate as one program: each file is a module, `cargo test -p bead-record --test it FILE::` runs one.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may fail by panic")]

mod cell;
mod clocks;
mod heights;
mod joined;
mod rows;
