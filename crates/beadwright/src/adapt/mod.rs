//! From what was measured to the layers that follow.
//!
//! | file | what it does |
//! | --- | --- |
//! | [`scan`] | reads scans: PLY, tables of points, height maps |
//! | `align` | aligns a scan with the part |
//! | `see` | compares it with the plan, and refuses what cannot be true |
//! | `surface` | how far a build is from its plan, and how a layer changes that |
//! | `area` | where heights are compared |
//! | `levels` | how many layers follow, and where they lie |
//! | `correct` | the next layer: metal and torch height by place |
//! | `follow` | all layers that follow |
//! | `adapted` | all of these in order, and the files of the layers that follow |
//! | [`page`] | predicted, measured and difference as a page |

mod adapted;
mod align;
#[doc(hidden)]
pub mod area;
mod correct;
mod follow;
mod levels;
pub mod page;
pub mod scan;
mod see;
mod surface;

pub use adapted::{AdaptError, Adapted, Unfinished};
pub use align::{Align, AlignError, Aligned, align};
pub(crate) use correct::next;
pub use correct::{Feedback, Rules, pieces};
pub use follow::{Followed, follow};
pub use levels::{Levels, Rung};
pub use scan::{Scan, ScanError};
pub use see::{SeeError, Seen, see};
pub use surface::{Spread, Surface};
