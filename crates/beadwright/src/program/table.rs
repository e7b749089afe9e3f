//! A turn table that turns with the torch, so that the arc stays on one side of it.

use super::ProgramSettings;
use glam::DVec3;

/// The table turns no faster than this under the arc, ° for each mm of the path: places near its axis would spin it.
const MOST_PER_MM: f64 = 2.0;
/// Closer to the axis than this there is no side to turn to, mm.
const AXIS_MM: f64 = 1.0;

/// Follows the torch with the table.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Follower {
    /// Direction from the axis in which the arc shall stay, °.
    side: f64,
    /// How the table stands, °.
    angle: f64,
}

impl Follower {
    /// A table as the profile has it; `None` where it stands still.
    pub(super) fn new(program: &ProgramSettings) -> Option<Self> {
        program.table_side.map(|side| Self { side, angle: 0.0 })
    }

    /// Turns to the start of a pass, by the shorter way; a table that has been wound up by a whole turn is unwound.
    pub(super) fn begin(&mut self, at: DVec3) -> f64 {
        if self.angle.abs() > 360.0 {
            self.angle -= (self.angle / 360.0).round() * 360.0;
        }
        self.angle += self.missing(at);
        self.angle
    }

    /// Turns on with a move of a length (mm) under the arc.
    pub(super) fn follow(&mut self, to: DVec3, length: f64) -> f64 {
        let most = MOST_PER_MM * length;
        self.angle += self.missing(to).clamp(-most, most);
        self.angle
    }

    /// The turn that brings a place to the side, -180 to 180°.
    fn missing(&self, at: DVec3) -> f64 {
        if at.truncate().length() < AXIS_MM {
            return 0.0;
        }
        let turn = self.side - at.y.atan2(at.x).to_degrees() - self.angle;
        turn - (turn / 360.0).round() * 360.0
    }
}

#[cfg(test)]
mod tests {
    use super::Follower;
    use glam::DVec3;

    fn on_circle(degrees: f64) -> DVec3 {
        DVec3::new(50.0 * degrees.to_radians().cos(), 50.0 * degrees.to_radians().sin(), 2.0)
    }

    #[test]
    fn the_arc_stays_on_its_side_for_many_turns_and_is_unwound_between_passes() {
        let mut table = Follower { side: -90.0, angle: 0.0 };
        assert_eq!(table.begin(on_circle(0.0)), -90.0);
        for k in 1..=720 {
            let angle = table.follow(on_circle(f64::from(k)), 50.0_f64.to_radians());
            assert!((angle + f64::from(k) + 90.0).abs() < 1e-9, "{k}: {angle}");
        }
        assert!((table.begin(on_circle(0.0)) + 90.0).abs() < 1e-9);
    }

    #[test]
    fn a_path_across_the_axis_does_not_spin_the_table() {
        let mut table = Follower { side: 0.0, angle: 0.0 };
        table.begin(DVec3::new(20.0, 1.5, 2.0));
        let mut before = table.angle;
        for k in 1..=400 {
            let angle = table.follow(DVec3::new(20.0 - 0.1 * f64::from(k), 1.5, 2.0), 0.1);
            assert!((angle - before).abs() <= 0.2 + 1e-9);
            before = angle;
        }
    }
}
