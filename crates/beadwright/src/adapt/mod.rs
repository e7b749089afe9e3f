//! From what was measured to the layers that follow.
//!
//! | file | what it does |
//! | --- | --- |
//! | [`surface`] | how far a build is from what is promised, and what a layer changes of it |
//! | [`core`](mod@core) | where heights are compared |
//! | [`levels`] | how many layers follow, and where they lie |
//! | [`correct`] | the next layer: metal and torch height by place |

pub mod core;
pub mod correct;
pub mod levels;
pub mod surface;

pub use correct::{Feedback, Next, Rules, next, pieces};
pub use levels::Levels;
pub use surface::{Spread, Surface};
