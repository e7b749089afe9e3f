//! What is welded with each combination.

use super::Parameter;
use glam::DVec2;

/// The shape of a trial.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Shape {
    /// One bead, for width and height.
    Bead,
    /// One bead, for the hump where it begins and the crater where it ends.
    Ends,
    /// This many beads side by side, for the stepover.
    Overlap(usize),
    /// A wall of this many layers, each a bead, for how it grows with the waits between them.
    Wall(usize),
    /// Two legs that meet at an angle, for the metal that piles up there.
    Corner,
}

/// What is measured where beads begin and end: their own width and height, how much higher they are at the start and how much
/// lower at the end, and the lengths over which that fades.
pub(super) const ENDS: [&str; 6] =
    ["width_mm", "height_mm", "hump_height_mm", "hump_length_mm", "crater_depth_mm", "crater_length_mm"];
/// What is measured of beads side by side.
pub(super) const OVERLAP: [&str; 3] = ["width_mm", "height_mm", "deepest_valley_mm"];
/// What is measured at corners.
pub(super) const CORNER: [&str; 3] = ["height_mm", "height_of_legs_mm", "inner_radius_mm"];

/// A path of a trial, and the layer of the trial in which it lies, from 0.
pub(super) struct Stroke {
    pub(super) layer: usize,
    pub(super) points: Vec<DVec2>,
}

impl Shape {
    /// Parameters that only some shapes have.
    pub fn allows(self, parameter: Parameter) -> bool {
        match parameter {
            Parameter::Stepover => matches!(self, Self::Overlap(_)),
            Parameter::Dwell => matches!(self, Self::Wall(_)),
            Parameter::Angle => self == Self::Corner,
            _ if parameter.is_of_ends() => matches!(self, Self::Ends | Self::Corner),
            _ => true,
        }
    }

    /// Columns of the sheet to be filled in with what is measured.
    pub fn measured(self) -> &'static [&'static str] {
        match self {
            Self::Bead => &["width_mm", "height_mm"],
            Self::Ends => &ENDS,
            Self::Overlap(_) => &OVERLAP,
            Self::Wall(_) => &["height_mm", "width_mm"],
            Self::Corner => &CORNER,
        }
    }

    /// The paths, `length` (mm) long, of beads of this width (mm), from the origin along x; `value` gives the values of the
    /// factors.
    pub(super) fn strokes(self, length: f64, width: f64, value: impl Fn(Parameter) -> Option<f64>) -> Vec<Stroke> {
        let line = |y: f64| vec![DVec2::new(0.0, y), DVec2::new(length, y)];
        match self {
            Self::Bead | Self::Ends => vec![Stroke { layer: 0, points: line(0.0) }],
            Self::Overlap(beads) => {
                let stepover = value(Parameter::Stepover).unwrap_or(0.7) * width;
                (0..beads).map(|k| Stroke { layer: 0, points: line(k as f64 * stepover) }).collect()
            }
            // Back and forth, so that starts and ends even out.
            Self::Wall(layers) => (0..layers)
                .map(|layer| {
                    let mut points = line(0.0);
                    if layer % 2 == 1 {
                        points.reverse();
                    }
                    Stroke { layer, points }
                })
                .collect(),
            Self::Corner => {
                let half = value(Parameter::Angle).unwrap_or(90.0).to_radians() / 2.0;
                // The tip on the left, the legs to the right.
                let leg = |side: f64| DVec2::from_angle(side * half) * length / 2.0;
                let points = vec![leg(-1.0), DVec2::ZERO, leg(1.0)];
                vec![Stroke { layer: 0, points }]
            }
        }
    }
}

/// Lowest and highest coordinates of paths, mm.
pub(super) fn bounds<'s>(paths: impl Iterator<Item = &'s [DVec2]>) -> (DVec2, DVec2) {
    let none = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    paths.flatten().fold(none, |(low, high), p| (low.min(*p), high.max(*p)))
}
