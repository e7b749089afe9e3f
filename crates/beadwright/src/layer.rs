//! A layer: the outlines of a slice, and the passes that fill it.

use crate::pass::Pass;
use crate::warning::Warning;
use planar::Polygon;

/// One layer, ready to be deposited.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Layer {
    /// Index from 0.
    pub index: usize,
    /// Top of the layer, mm.
    pub z: f64,
    /// Thickness, mm.
    pub height: f64,
    /// Outlines of the slice.
    pub islands: Vec<Polygon>,
    /// Passes in deposition order; the arc is off between them.
    pub passes: Vec<Pass>,
    /// Area of the slice, mm².
    pub slice_area: f64,
    /// Area within reach of a bead, mm².
    pub planned_area: f64,
    /// What was lost or mended here.
    pub warnings: Vec<Warning>,
}
