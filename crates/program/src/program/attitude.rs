//! How the torch leans over the part, and how a table or a positioner holds the part under it.

use super::Held;
use glam::{DQuat, DVec2, DVec3};

/// The attitude of torch and part at the end of a move.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Attitude {
    /// Lean of the torch: the horizontal part of the unit vector from the wire's tip along the torch. 0 is the
    /// orientation in the robot's section.
    pub lean: DVec2,
    /// Rotation from the part's frame to that of the layer at this point, if layers are not level.
    pub layer: DQuat,
    /// How the axes that turn the part during the program hold it; `None` if there are none.
    pub held: Option<Held>,
}

impl Attitude {
    /// Whether the torch is oriented as in the robot's section.
    pub fn is_upright(&self) -> bool {
        *self == Self::default()
    }

    /// Rotation of the tool's orientation in the part's frame: it undoes the part's turn, so that the torch keeps its
    /// orientation in the cell, then turns by the shortest rotation to the layer's normal with the lean.
    pub fn rotation(&self) -> DQuat {
        let up = self.lean.extend((1.0 - self.lean.length_squared()).max(0.0).sqrt());
        let lean = DQuat::from_rotation_arc(DVec3::Z, up.normalize());
        let Some(held) = self.held else { return self.layer * lean };
        let (back, along) = (held.turn.inverse(), self.layer * lean * DVec3::Z);
        DQuat::from_rotation_arc(back * DVec3::Z, along) * back
    }

    /// The attitude at the fraction `part` of the way to another.
    ///
    /// ```
    /// use bead_program::program::{Attitude, Held};
    /// use glam::DVec2;
    ///
    /// let at = |x: f64, table: f64| Attitude { lean: DVec2::new(x, 0.0), held: Some(Held::on_table(table)), ..Attitude::default() };
    /// let half = at(0.0, 10.0).towards(&at(0.5, 50.0), 0.5);
    /// assert!(half.lean.x == 0.25 && half.held.is_some_and(|held| held.angles[0] == 30.0));
    /// ```
    pub fn towards(&self, to: &Self, part: f64) -> Self {
        let held = to.held.map(|held| self.held.map_or(held, |from| from.towards(&held, part)));
        Self { lean: self.lean.lerp(to.lean, part), layer: self.layer.slerp(to.layer, part), held }
    }
}
