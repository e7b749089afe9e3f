//! An arm as a table of numbers: its geometry, and the limits and speeds of its joints.

use crate::arm::{Arm, Joints};
use crate::chain::Chain;
use crate::opw::{Lengths, Opw};
use std::sync::Arc;

/// The range of a value in a cell: key, value, least, greatest, unit.
pub(crate) type Range = (&'static str, f64, f64, f64, &'static str);

/// An arm with its limits.
#[derive(Debug, Clone, PartialEq)]
pub struct ArmTable {
    /// Its geometry.
    pub shape: Shape,
    /// Least and greatest angle of each joint, °.
    pub limits: [[f64; 2]; 6],
    /// Greatest speed of each joint, °/s.
    pub speeds: [f64; 6],
}

/// The geometry of an arm.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    /// Parallel base and spherical wrist, by lengths.
    Opw(OpwTable),
    /// Any of the chains that have closed forms.
    Chain(Arc<Chain>),
}

/// A six-axis arm with parallel base and spherical wrist. Lengths in mm, angles in °.
#[derive(Debug, Clone, PartialEq)]
pub struct OpwTable {
    /// From axis 1 forward to axis 2, mm.
    pub a1: f64,
    /// From axis 3 to axis 4, mm; negative where axis 4 lies above.
    pub a2: f64,
    /// Sideways offset of the arm, mm.
    pub b: f64,
    /// From the foot up to axis 2, mm.
    pub c1: f64,
    /// Length of the upper arm, mm.
    pub c2: f64,
    /// Length of the forearm to the wrist, mm.
    pub c3: f64,
    /// From the wrist to the flange, mm.
    pub c4: f64,
    /// Displayed angle of each joint when the arm points straight up, times its sign: model angle = sign × displayed −
    /// offset, °.
    pub offsets: Joints,
    /// 1 if the maker's positive direction is that of the model, −1 otherwise.
    pub signs: [i8; 6],
    /// Whether joint 3 is driven through a parallelogram, so that its displayed angle is the forearm's angle to the
    /// floor.
    pub parallelogram: bool,
}

impl ArmTable {
    /// The arm, ready to be moved.
    pub(crate) fn arm(&self) -> Arm {
        match &self.shape {
            Shape::Opw(table) => Arm::new(Arc::new(table.model()), self.limits, self.speeds),
            Shape::Chain(chain) => Arm::new(chain.clone(), self.limits, self.speeds),
        }
    }

    pub(crate) fn ranges(&self) -> Vec<Range> {
        let mut ranges = match &self.shape {
            Shape::Opw(table) => table.ranges(),
            Shape::Chain(_) => Vec::new(),
        };
        ranges.extend(self.limits.as_flattened().iter().map(|&v| ("arm.limits", v, -7200.0, 7200.0, "°")));
        ranges.extend(self.speeds.map(|v| ("arm.speeds", v, 1e-3, 1e5, "°/s")));
        ranges
    }

    /// The first impossible value: its key, the value, and why.
    pub(crate) fn first_broken(&self) -> Option<(&'static str, String, String)> {
        let signs = match &self.shape {
            Shape::Opw(table) => table.signs,
            Shape::Chain(_) => [1; 6],
        };
        if let Some(sign) = signs.iter().find(|s| s.abs() != 1) {
            return Some(("arm.signs", sign.to_string(), "each sign is 1 or -1.".to_owned()));
        }
        let swapped = self.limits.iter().find(|[low, high]| low >= high)?;
        Some(("arm.limits", format!("{swapped:?}"), "the least angle comes first, then the greatest.".to_owned()))
    }
}

impl OpwTable {
    fn model(&self) -> Opw {
        let Self { a1, a2, b, c1, c2, c3, c4, offsets, signs, parallelogram } = *self;
        Opw::new(Lengths { a1, a2, b, c1, c2, c3, c4 }, offsets, signs, parallelogram)
    }

    fn ranges(&self) -> Vec<Range> {
        let mut ranges = vec![
            ("arm.a1", self.a1, -5e3, 5e3, "mm"),
            ("arm.a2", self.a2, -5e3, 5e3, "mm"),
            ("arm.b", self.b, -5e3, 5e3, "mm"),
            ("arm.c1", self.c1, 0.0, 5e3, "mm"),
            ("arm.c2", self.c2, 1.0, 5e3, "mm"),
            ("arm.c3", self.c3, 1.0, 5e3, "mm"),
            ("arm.c4", self.c4, 0.0, 5e3, "mm"),
        ];
        ranges.extend(self.offsets.map(|v| ("arm.offsets", v, -360.0, 360.0, "°")));
        ranges
    }
}
