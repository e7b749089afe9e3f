//! All tests of the crate as one program: each file is a module, `cargo test -p bead-plan --test it FILE::` runs one.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may fail by panic")]

mod trial;
mod trial_scan;
