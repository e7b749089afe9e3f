//! From what was measured to the layers that follow.
//!
//! | file | what it does |
//! | --- | --- |
//! | [`scan`] | reads scans: PLY, tables of points, height maps |
//! | [`align`](mod@align) | aligns a scan with the part |
//! | [`see`](mod@see) | compares it with what the plan promises, and refuses what cannot be true |
//! | [`surface`] | how far a build is from what is promised, and what a layer changes of it |
//! | [`area`] | where heights are compared |
//! | [`levels`] | how many layers follow, and where they lie |
//! | [`correct`] | the next layer: metal and torch height by place |
//! | [`follow`](mod@follow) | all layers that follow |
//! | [`page`] | predicted, measured and difference as a page |

pub mod align;
pub mod area;
pub mod correct;
pub mod follow;
pub mod levels;
pub mod page;
pub mod scan;
pub mod see;
pub mod surface;

pub use align::{Align, AlignError, Aligned, align};
pub use correct::{Feedback, Next, Rules, next, pieces};
pub use follow::{Followed, follow};
pub use levels::Levels;
pub use scan::{Scan, ScanError};
pub use see::{SeeError, Seen, see};
pub use surface::{Spread, Surface};
