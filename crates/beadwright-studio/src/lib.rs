//! The desktop program of Beadwright, as a library so that its tests can drive it.

pub mod view3d;
