//! Beadwright
pub mod model;
pub mod slice;
pub mod task;
pub mod warning;
