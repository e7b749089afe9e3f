//! All tests of the crate as one program: each file is a module, `cargo test -p bead-part --test it FILE::` runs one.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may fail by panic")]

use bead_part::chart;

mod charts;
mod cladding;
mod damage;
mod directions;
mod inside;
mod solids;
mod tubes;
