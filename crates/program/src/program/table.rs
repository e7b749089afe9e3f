//! A turn table that turns with the torch, so that the arc stays on one side of it.

use super::ProgramSettings;
use super::turning::{MOST_PER_MM, WOUND, whole_turns};
use glam::DVec3;

/// Within this distance of the axis there is no side to turn to, mm.
const AXIS_MM: f64 = 1.0;

/// Makes the table follow the torch.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Follower {
    /// Direction from the axis in which the arc must stay, °.
    side: f64,
    /// Least and greatest angle of the table, °; `None` if it turns endlessly.
    range: Option<[f64; 2]>,
    /// Angle of the table, °.
    angle: f64,
}

/// Angle of the table at the start of a pass.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Turned {
    /// Angle, °.
    pub(super) angle: f64,
    /// Whether it comes from so far away that a joint move is needed.
    pub(super) far: bool,
}

impl Follower {
    /// A table as in the profile; `None` if it does not turn.
    pub(super) fn new(program: &ProgramSettings) -> Option<Self> {
        program.table_side.map(|side| Self { side, range: program.table_range, angle: 0.0 })
    }

    /// Turns to the start of a pass along these points, by the shorter way; if possible, within its range so that it
    /// can follow the whole pass.
    pub(super) fn begin(&mut self, path: &[DVec3]) -> Turned {
        let Some(&start) = path.first() else { return Turned { angle: self.angle, far: false } };
        let before = self.angle;
        self.angle += self.missing(start);
        if let Some([low, high]) = self.range {
            let free = Self { range: None, ..self.clone() };
            let (least, most) = free.reached(path);
            let (turns, _) = whole_turns([low, high], [least, most], self.angle - before);
            self.angle = (self.angle + turns).clamp(low, high);
        }
        Turned { angle: self.angle, far: (self.angle - before).abs() > WOUND }
    }

    /// Turns on with a move of `length` (mm) with the arc on. At the end of its range the table stops, and the torch
    /// continues around it.
    pub(super) fn follow(&mut self, to: DVec3, length: f64) -> f64 {
        let most = MOST_PER_MM * length;
        self.angle += self.missing(to).clamp(-most, most);
        if let Some([low, high]) = self.range {
            self.angle = self.angle.clamp(low, high);
        }
        self.angle
    }

    /// Least and greatest angle along a path from its start, °.
    fn reached(mut self, path: &[DVec3]) -> (f64, f64) {
        let first = (self.angle, self.angle);
        path.windows(2).fold(first, |(least, most), piece| {
            let angle = self.follow(piece[1], piece[0].distance(piece[1]));
            (least.min(angle), most.max(angle))
        })
    }

    /// The turn that brings a point to the side, -180 to 180°.
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

    fn around(from: i32, to: i32) -> Vec<DVec3> {
        let (step, count) = ((to - from).signum(), (to - from).abs());
        (0..=count).map(|k| on_circle(f64::from(from + k * step))).collect()
    }

    /// The angles of the table along a pass, and whether it came from far away.
    fn pass(table: &mut Follower, path: &[DVec3]) -> (Vec<f64>, bool) {
        let start = table.begin(path);
        let follow = |piece: &[DVec3]| table.follow(piece[1], piece[0].distance(piece[1]));
        (std::iter::once(start.angle).chain(path.windows(2).map(follow).collect::<Vec<_>>()).collect(), start.far)
    }

    /// An endless table continues from where it is; the arc stays on its side for many turns.
    #[test]
    fn an_endless_table_is_never_unwound() {
        let mut table = Follower { side: -90.0, range: None, angle: 0.0 };
        for (layer, from) in [(0, 0), (1, 720), (2, 1440)] {
            let (angles, far) = pass(&mut table, &around(from, from + 720));
            assert!(!far, "layer {layer}");
            for (k, angle) in angles.iter().enumerate() {
                assert!((angle + 90.0 + f64::from(from) + k as f64).abs() < 1e-6, "{k}: {angle}");
            }
        }
    }

    /// A table that turns by 400° to either side begins each ring where it can follow to its end, and is unwound far from the part.
    #[test]
    fn a_pass_stays_within_the_range_of_the_table() {
        let mut table = Follower { side: -90.0, range: Some([-400.0, 400.0]), angle: 0.0 };
        let mut unwound = 0;
        for _ in 0..6 {
            let (angles, far) = pass(&mut table, &around(0, 370));
            unwound += usize::from(far);
            assert!(angles.iter().all(|angle| angle.abs() <= 400.0));
            let wanted = |k: usize| -90.0 - k as f64;
            assert!(
                angles.iter().enumerate().all(|(k, a)| ((a - wanted(k)) / 360.0).fract().abs() < 1e-6),
                "{angles:?}"
            );
        }
        assert!(unwound > 0, "six rings are more than the range");
    }

    /// A pass of three turns is more than the range: the table stops at its end, and the program continues.
    #[test]
    fn at_the_end_of_its_range_the_table_stops() {
        let mut table = Follower { side: -90.0, range: Some([-400.0, 400.0]), angle: 0.0 };
        let (angles, _) = pass(&mut table, &around(0, 1080));
        assert!(angles.iter().all(|angle| angle.abs() <= 400.0));
        assert_eq!(angles.last(), Some(&-400.0));
        assert!(angles[0] > 200.0, "{}", angles[0]);
    }

    #[test]
    fn a_path_across_the_axis_does_not_spin_the_table() {
        let mut table = Follower { side: 0.0, range: None, angle: 0.0 };
        table.begin(&[DVec3::new(20.0, 1.5, 2.0)]);
        let mut before = table.angle;
        for k in 1..=400 {
            let angle = table.follow(DVec3::new(20.0 - 0.1 * f64::from(k), 1.5, 2.0), 0.1);
            assert!((angle - before).abs() <= 0.2 + 1e-9);
            before = angle;
        }
    }
}
