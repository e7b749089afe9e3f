//! A file of the crate with a test of its own, compiled with these, so that the crate is not built twice for it.
#![allow(dead_code, reason = "what only the crate uses")]

#[path = "../../src/report/lie.rs"]
mod report_lie;
