//! Contours connected into a spiral: one arc start, and no travel.
//!
//! Each contour leads to the next one inside it. Where an island has pockets at its side, the path goes into them and
//! back out before it continues (contours linked without retraction: Park, Chung and Choi 2003, Computer-Aided Design
//! 35).

use super::ring_tree::{self, Join};
use super::{Fill, FillSettings, Strategy, thin};
use planar::Polygon;

/// A spiral of contours.
pub struct Spiral;

impl Strategy for Spiral {
    fn name(&self) -> &'static str {
        "spiral"
    }

    fn fill(&self, island: &Polygon, settings: &FillSettings) -> Fill {
        thin::around(island, settings, |part, settings| ring_tree::joined(part, settings, Join::Inwards))
    }
}
