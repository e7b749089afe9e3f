//! How the torch leans over the part, and how far the turn table under it has turned.

use glam::{DQuat, DVec2, DVec3};

/// The attitude of torch and turn table at the end of a move.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Attitude {
    /// Where the torch leans: the horizontal part of the unit vector from the wire's tip along the torch. 0 is the orientation
    /// in the robot's section.
    pub lean: DVec2,
    /// What turns the part's frame into that of the layer at this place, where layers are not level.
    pub layer: DQuat,
    /// Angle of a table that turns during the program, °; `None` where it does not turn.
    pub table: Option<f64>,
}

impl Attitude {
    /// Whether the torch is oriented as in the robot's section.
    pub fn is_upright(&self) -> bool {
        *self == Self::default()
    }

    /// What turns the tool's orientation in the part's frame: the table's turn undone, so that the torch stays as it
    /// is in the cell, then the lean.
    pub fn rotation(&self) -> DQuat {
        let up = self.lean.extend((1.0 - self.lean.length_squared()).max(0.0).sqrt());
        self.layer
            * DQuat::from_rotation_arc(DVec3::Z, up.normalize())
            * DQuat::from_rotation_z(-self.table.unwrap_or(0.0).to_radians())
    }

    /// The attitude on the way to another, at the fraction `part` of the way.
    ///
    /// ```
    /// use bead_program::program::Attitude;
    /// use glam::DVec2;
    ///
    /// let at =
    ///     |x: f64, table: f64| Attitude { lean: DVec2::new(x, 0.0), table: Some(table), ..Attitude::default() };
    /// assert_eq!(at(0.0, 10.0).towards(&at(0.5, 50.0), 0.5), at(0.25, 30.0));
    /// ```
    pub fn towards(&self, to: &Self, part: f64) -> Self {
        let table = to.table.map(|angle| self.table.map_or(angle, |from| from + (angle - from) * part));
        Self { lean: self.lean.lerp(to.lean, part), layer: self.layer.slerp(to.layer, part), table }
    }
}
