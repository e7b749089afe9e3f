//! All tests of the papers as one program: `cargo test -p beadwright-papers --test it FILE::` runs one file.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may fail by panic")]

mod b_fdm_order;
mod book;
mod c_compound;
mod d_thin_wall;
