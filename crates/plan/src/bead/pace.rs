//! The pace of beads: the speed at which the nominal wire feed lays the metal that each one needs.

use super::wall::WallBead;
use super::{Bead, Law};

/// What determines the pace of beads in all layers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PaceSettings<'a> {
    /// The nominal bead.
    pub bead: Bead,
    /// How a bead's height follows its width.
    pub law: &'a Law,
    /// Pace of the nominal bead, mm/s.
    pub nominal: f64,
    /// Distance between neighbouring centre-lines, mm.
    pub stepover: f64,
    /// The wall predicted from the beads; `None` where walls are not predicted.
    pub wall: Option<WallBead>,
    /// Thickness, mm, of a layer that nominal beads fill exactly, if thicker and thinner layers get correspondingly
    /// more or less metal; `None` if beads hold the same metal in every layer.
    pub filled: Option<f64>,
}

impl<'a> PaceSettings<'a> {
    /// The paces in layer `index` (from 0), which is `height` thick, mm.
    ///
    /// ```
    /// use bead_plan::bead::pace::PaceSettings;
    /// use bead_plan::bead::{Bead, Law};
    ///
    /// // A layer 1.6 mm thick takes less metal than one of 2 mm, so its beads are laid faster.
    /// let settings = PaceSettings {
    ///     bead: Bead::parabola(6.0, 2.5),
    ///     law: &Law::ConstantHeight,
    ///     nominal: 8.0,
    ///     stepover: 4.5,
    ///     wall: None,
    ///     filled: Some(2.0),
    /// };
    /// assert!((settings.in_layer(3, 1.6).of_bead(6.0) - 8.0 * 2.0 / 1.6).abs() < 1e-12);
    /// ```
    pub fn in_layer(&self, index: usize, height: f64) -> LayerPace<'a> {
        let Self { bead, law, nominal, stepover, wall, filled } = *self;
        let rise = wall.map(|wall| wall.rise_of_layer(index, height));
        let thinner = match (rise, filled) {
            (Some(rise), _) => bead.rise(stepover) / rise,
            (None, Some(filled)) if height > 0.0 => filled / height,
            (None, _) => 1.0,
        };
        LayerPace { bead, law, nominal, thinner, rise }
    }
}

/// The pace of beads in one layer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LayerPace<'a> {
    bead: Bead,
    law: &'a Law,
    nominal: f64,
    /// Thickness of a layer that nominal beads fill, over that of this layer.
    thinner: f64,
    rise: Option<f64>,
}

impl LayerPace<'_> {
    /// What the layer adds to a wall, mm; `None` where walls are not predicted.
    pub fn wall_rise(&self) -> Option<f64> {
        self.rise
    }

    /// Pace, mm/s, of a bead of this width, mm, beside others, by the bead law.
    pub fn of_bead(&self, width: f64) -> f64 {
        self.nominal * self.thinner * self.law.pace(&self.bead, width)
    }

    /// Pace, mm/s, of a bead that is a wall of this width, mm: its metal fills that width over the rise of the layer.
    /// Where walls are not predicted, the pace of any bead.
    pub fn of_wall(&self, width: f64) -> f64 {
        match self.rise {
            Some(rise) => self.nominal * self.bead.area() / (width * rise),
            None => self.of_bead(width),
        }
    }
}
