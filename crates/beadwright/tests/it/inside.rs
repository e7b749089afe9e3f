//! Files of the crate with tests of their own, compiled with these, so that the crate is not built twice for them.
#![allow(dead_code, reason = "what only the crate uses")]

#[path = "../../src/plan/support/block.rs"]
mod block;
#[path = "../../src/plan/support/hanging.rs"]
mod hanging;
#[path = "../../src/plan/support/metal.rs"]
mod metal;
#[path = "../../src/report/lie.rs"]
mod report_lie;
