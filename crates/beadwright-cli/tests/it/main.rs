//! All tests of the crate as one program: each file is a module, `cargo test -p beadwright-cli --test it FILE::` runs one.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may fail by panic")]

mod bad_input;
mod batch;
mod bodies;
mod book;
mod calibrate;
mod cli;
mod common;
mod convert;
mod deviation;
mod distort;
mod exports;
mod folder;
mod guide;
mod heat;
mod height;
mod learn;
#[cfg(feature = "listen")]
mod listen;
mod opened_elsewhere;
mod own_dialect;
mod preform;
mod record;
mod serve;
mod streams;
mod together;
