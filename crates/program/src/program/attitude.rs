//! How the torch leans over the part, and how a table or a positioner under it holds the part.

use super::Held;
use glam::{DQuat, DVec2, DVec3};

/// The attitude of torch and part at the end of a move.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Attitude {
    /// Where the torch leans: the horizontal part of the unit vector from the wire's tip along the torch. 0 is the orientation
    /// in the robot's section.
    pub lean: DVec2,
    /// What turns the part's frame into that of the layer at this place, where layers are not level.
    pub layer: DQuat,
    /// How the part is held by what turns it during the program; `None` where nothing does.
    pub held: Option<Held>,
}

impl Attitude {
    /// Whether the torch is oriented as in the robot's section.
    pub fn is_upright(&self) -> bool {
        *self == Self::default()
    }

    /// What turns the tool's orientation in the part's frame: the part's turn undone, so that the torch stays as it is in the cell,
    /// then on the shortest way to the layer's normal with the lean.
    pub fn rotation(&self) -> DQuat {
        let up = self.lean.extend((1.0 - self.lean.length_squared()).max(0.0).sqrt());
        let lean = DQuat::from_rotation_arc(DVec3::Z, up.normalize());
        let Some(held) = self.held else { return self.layer * lean };
        let (back, along) = (held.turn.inverse(), self.layer * lean * DVec3::Z);
        DQuat::from_rotation_arc(back * DVec3::Z, along) * back
    }

    /// The attitude on the way to another, at the fraction `part` of the way.
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
