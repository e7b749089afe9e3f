//! All tests of the crate as one program: each file is a module, `cargo test -p beadwright-studio --test it FILE::` runs one.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may fail by panic")]

mod arm;
mod broken;
mod colours;
mod contrast;
mod distortion;
mod docs;
mod heat;
mod holding;
mod inside;
mod listing;
mod pieces;
mod project;
mod section;
mod space;
mod studio;
mod texts;
mod ui;
mod view3d;
mod window;
mod wire;
