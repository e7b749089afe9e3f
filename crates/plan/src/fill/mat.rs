//! From the medial axis outwards: rings around the middle of every wall, wider or narrower so that a whole number of them
//! fills it (adaptive medial axis transformation: Ding et al. 2016, Robotics and Computer-Integrated Manufacturing 39).
//!
//! The rings of [`one_loop`] before they are joined: closed lines at equal fractions of the way from the axis to the outline,
//! each with the width of its cell. The paper lays rings branch by branch of the axis; here they go around all of it. Each
//! ring has an arc start.

use super::one_loop;
use super::{Fill, FillSettings, Strategy, thin};
use planar::Polygon;

/// Rings from the medial axis outwards.
pub struct Mat;

impl Strategy for Mat {
    fn name(&self) -> &'static str {
        "mat"
    }

    fn fill(&self, island: &Polygon, settings: &FillSettings) -> Fill {
        thin::around(island, settings, |part, settings| Fill {
            stages: one_loop::apart(part, settings).into_iter().rev().collect(),
            fixed_order: false,
        })
    }
}
