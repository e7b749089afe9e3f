//! A file of the crate with a test of its own, compiled with these, so that the crate is not built twice for it.
#![allow(dead_code, unreachable_pub, reason = "what only the crate uses")]

#[path = "../../src/view3d/lie.rs"]
mod view3d_lie;
