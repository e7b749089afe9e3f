//! Connected Fermat spirals (Zhao et al. 2016, ACM Transactions on Graphics 35): contours become spirals that go in along
//! every second contour and out along the others, so each begins and ends at its outer edge; pockets are attached to one another
//! as in the tree of the contours, and the whole is one path.
//!
//! The paper ends a pocket wherever contours split; here it continues into the largest part. The paper's smoothing of
//! the finished curve is omitted: contours and links are laid as they are.

use super::ring_tree::{self, Join};
use super::{Fill, FillSettings, Strategy, thin};
use planar::Polygon;

/// Connected Fermat spirals.
pub struct Fermat;

impl Strategy for Fermat {
    fn name(&self) -> &'static str {
        "fermat"
    }

    fn fill(&self, island: &Polygon, settings: &FillSettings) -> Fill {
        thin::around(island, settings, |part, settings| ring_tree::joined(part, settings, Join::InAndOut))
    }
}
