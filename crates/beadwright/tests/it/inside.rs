//! Files of the crate with tests of their own, compiled with these, so that the crate is not built twice for them.
#![allow(dead_code, reason = "what only the crate uses")]

#[path = "../../src/report/lie.rs"]
mod report_lie;

#[path = "../../src/plan/support"]
mod plan_support {
    mod hanging;
    mod metal;
}
