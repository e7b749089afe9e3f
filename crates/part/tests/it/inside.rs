//! Files of the crate with tests of their own, compiled with these, so that the crate is not built twice for them.
#![allow(dead_code, reason = "what only the crate uses")]

#[path = "../../src/directions/between.rs"]
mod between;
#[path = "../../src/model/connected.rs"]
mod connected;
