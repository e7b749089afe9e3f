//! A positioner that turns the part so that the layer lies level under the torch.
//!
//! The angles that bring a layer's normal upright have closed forms: the normal turns about the axis next to the part
//! until its angle to the other axis equals that of "up", and then the other axis aligns the two (Paden 1986,
//! subproblems 1 and 2). There are two solutions, plus whole turns of each axis; `holder` chooses among them.

use super::machine::Keys;
use bead_plan::limit::{Broken, Limit, limit};
use glam::{DQuat, DVec3};
use serde::{Deserialize, Serialize};

/// Axes nearer to each other than this, °, do not give two solutions.
const APART: f64 = 10.0;
/// A normal within this angle of an axis is not turned by it, rad.
const ON_AXIS: f64 = 1e-6;
/// When the positioner turns.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub enum Turning {
    /// Between passes only, with the arc off: each pass is welded in one position.
    Index,
    /// The same, while the torch is at home: for axes that the robot's controller does not move.
    IndexAtHome,
    /// At every point, together with the torch, as the controller coordinates them.
    Follow,
}

/// An axis of a positioner.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct PositionerAxis {
    /// Its direction with all axes at 0, in the part's x, y and z, of any length: a positive angle turns the part counter-clockwise
    /// as seen against it.
    pub direction: [f64; 3],
    /// A point on it, likewise, mm; default 0, 0, 0. `beadwright reach` needs it, and G-code for the way to the first pass: robots know
    /// where their axes lie.
    #[serde(default)]
    pub through: [f64; 3],
    /// The least and the greatest angle, °.
    pub limits: [f64; 2],
    /// The greatest speed, °/s.
    pub speed: f64,
}

/// The section `[program.positioner]`: one or two axes that turn the part so that layers lie level under the torch.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Keys")]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Positioner {
    /// `"index"` turns it between passes, `"index-at-home"` too, with the torch at home (URScript), `"follow"` at every point.
    pub turning: Turning,
    /// From the floor to the part: one axis, or the one that tilts and the one that it carries.
    pub axes: Vec<PositionerAxis>,
    /// What is up in the cell when all axes are at 0, in the part's x, y and z.
    pub up: [f64; 3],
}

/// How a positioner holds the part.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Held {
    /// Angles of its axes, °; a single axis is the first.
    pub angles: [f64; 2],
    /// Rotation from directions of the part to those of the cell, where z is up.
    pub turn: DQuat,
    /// Position of the part's origin in the cell, mm; 0 with all axes at 0.
    pub shift: DVec3,
}

impl Held {
    /// A table with a vertical axis at this angle, °.
    pub fn on_table(angle: f64) -> Self {
        Self { angles: [angle, 0.0], turn: DQuat::from_rotation_z(angle.to_radians()), shift: DVec3::ZERO }
    }

    /// How the part is held at the fraction `part` of the way to another position.
    pub(super) fn towards(&self, to: &Self, part: f64) -> Self {
        let (turn, shift) = (self.turn.slerp(to.turn, part), self.shift.lerp(to.shift, part));
        Self { angles: between(self.angles, to.angles, part), turn, shift }
    }
}

impl Positioner {
    /// Number of its axes.
    pub fn count(&self) -> usize {
        self.axes.len()
    }

    /// How it holds the part at these angles, °.
    pub fn held(&self, angles: [f64; 2]) -> Held {
        let places = self.axes.iter().map(|axis| DVec3::from(axis.through));
        let axes = self.directions().zip(places).zip(angles);
        // From the part outwards, each about its own axis.
        let (turn, shift) =
            axes.rev().fold((DQuat::IDENTITY, DVec3::ZERO), |(turn, shift), ((direction, on), angle)| {
                let own = DQuat::from_axis_angle(direction, angle.to_radians());
                (own * turn, own * (shift - on) + on)
            });
        let standing = self.standing();
        Held { angles, turn: (standing * turn).normalize(), shift: standing * shift }
    }

    /// A table that turns about the part's z axis as far as it likes.
    pub fn table() -> Self {
        let axis = PositionerAxis { direction: [0.0, 0.0, 1.0], through: [0.0; 3], limits: [-1e5, 1e5], speed: 1.0 };
        Self { turning: Turning::Follow, axes: vec![axis], up: [0.0, 0.0, 1.0] }
    }

    /// Rotation from the part's directions, with all axes at 0, to those of the cell.
    fn standing(&self) -> DQuat {
        DQuat::from_rotation_arc(self.upwards(), DVec3::Z)
    }

    fn upwards(&self) -> DVec3 {
        DVec3::from(self.up).try_normalize().unwrap_or(DVec3::Z)
    }

    fn directions(&self) -> impl DoubleEndedIterator<Item = DVec3> + ExactSizeIterator + '_ {
        self.axes.iter().map(|axis| DVec3::from(axis.direction).normalize_or_zero())
    }

    /// All solutions within half a turn that bring a normal as near to "up" as possible, °; an axis without effect
    /// keeps its angle in `before`.
    pub(super) fn ways(&self, normal: DVec3, before: [f64; 2]) -> Vec<[f64; 2]> {
        let (up, directions) = (self.upwards(), self.directions().collect::<Vec<_>>());
        match directions[..] {
            [axis] => vec![[turn_onto(normal, up, axis).unwrap_or(before[0]), 0.0]],
            [first, second] => onto_cone(normal, up, first, second)
                .into_iter()
                .map(|angle| {
                    let angle = angle.unwrap_or(before[1]);
                    let turned = DQuat::from_axis_angle(second, angle.to_radians()) * normal;
                    [turn_onto(turned, up, first).unwrap_or(before[0]), angle]
                })
                .collect(),
            _ => vec![before],
        }
    }

    /// The best angle of the first axis for this angle of the second, °.
    pub(super) fn first_for(&self, normal: DVec3, angles: [f64; 2]) -> f64 {
        let directions: Vec<DVec3> = self.directions().collect();
        let [first, second] = directions[..] else { return angles[0] };
        let turned = DQuat::from_axis_angle(second, angles[1].to_radians()) * normal;
        turn_onto(turned, self.upwards(), first).map_or(angles[0], |angle| near(angle, angles[0]))
    }

    /// Angle between a normal and "up", °.
    pub fn off_level(&self, normal: DVec3, angles: [f64; 2]) -> f64 {
        (self.held(angles).turn * normal).angle_between(DVec3::Z).to_degrees()
    }

    pub(super) fn within(&self, mut angles: [f64; 2]) -> [f64; 2] {
        for (angle, axis) in angles.iter_mut().zip(&self.axes) {
            *angle = angle.clamp(axis.limits[0], axis.limits[1]);
        }
        angles
    }

    /// Time that the slower axis takes between two positions, s.
    pub(super) fn seconds(&self, from: [f64; 2], to: [f64; 2]) -> f64 {
        let each = self.axes.iter().enumerate().map(|(k, axis)| (to[k] - from[k]).abs() / axis.speed);
        each.fold(0.0, f64::max)
    }

    /// The farthest that one of its axes turns, °.
    pub(super) fn farthest(&self, from: [f64; 2], to: [f64; 2]) -> f64 {
        (0..self.axes.len()).map(|k| (to[k] - from[k]).abs()).fold(0.0, f64::max)
    }

    /// The same without limits.
    pub(super) fn endless(&self) -> Self {
        let endless = |axis: &PositionerAxis| PositionerAxis { limits: [f64::NEG_INFINITY, f64::INFINITY], ..*axis };
        Self { axes: self.axes.iter().map(endless).collect(), ..self.clone() }
    }

    /// The limits of its numbers.
    pub(super) fn limits(&self) -> Vec<Limit> {
        let why = "values outside this range make no sense";
        let numbers = self.axes.iter().flat_map(|axis| {
            let ends = axis.limits.map(|end| ("program.positioner.axes.limits", end, (-1e5, 1e5), "°"));
            let through = axis.through.map(|place| ("program.positioner.axes.through", place, (-1e5, 1e5), "mm"));
            let speed = [("program.positioner.axes.speed", axis.speed, (0.01, 1e4), "°/s")];
            ends.into_iter().chain(through).chain(speed)
        });
        numbers.map(|(key, value, range, unit)| limit(key, value, range, unit, why)).collect()
    }

    /// The first contradiction.
    pub(super) fn broken(&self) -> Option<Broken> {
        let directions: Vec<DVec3> = self.directions().collect();
        let broken = |key: &str, value: String, reason: &str| {
            Some(Broken { key: format!("program.positioner.{key}"), value, reason: reason.to_owned() })
        };
        if !(1..=2).contains(&self.axes.len()) {
            return broken("axes", format!("{} axes", self.axes.len()), "a positioner has one axis or two.");
        }
        if directions.iter().any(|direction| direction.length_squared() < 0.5) {
            return broken("axes", "direction = [0, 0, 0]".to_owned(), "an axis needs a direction, such as [1, 0, 0].");
        }
        if DVec3::from(self.up).try_normalize().is_none() {
            return broken("up", format!("{:?}", self.up), "it needs a direction, such as [0, 0, 1].");
        }
        if let Some(axis) = self.axes.iter().find(|axis| axis.limits[0] >= axis.limits[1]) {
            return broken("axes", format!("limits = {:?}", axis.limits), "the least angle comes first.");
        }
        if let [first, second] = directions[..]
            && first.cross(second).length() < APART.to_radians().sin()
        {
            return broken(
                "axes",
                "two directions".to_owned(),
                "both axes turn the part in the same way: remove one of them.",
            );
        }
        None
    }
}

/// The angle by which an axis brings a direction as near as possible to another, °; `None` if one of them lies on the
/// axis.
fn turn_onto(from: DVec3, to: DVec3, axis: DVec3) -> Option<f64> {
    let (from, to) = (from.reject_from(axis), to.reject_from(axis));
    let apart = from.length().min(to.length()) > ON_AXIS;
    apart.then(|| axis.dot(from.cross(to)).atan2(from.dot(to)).to_degrees())
}

/// The angles by which the second axis brings a normal to where the first can bring it up, or as near as possible, °;
/// `None` for an angle without effect.
fn onto_cone(normal: DVec3, up: DVec3, first: DVec3, second: DVec3) -> Vec<Option<f64>> {
    if normal.reject_from(second).length() <= ON_AXIS {
        return vec![None];
    }
    // The direction whose angle to the first axis equals that of "up", and to the second that of the normal.
    let (between, across) = (first.dot(second), first.cross(second));
    let (along_first, along_second) = (up.dot(first), normal.dot(second));
    let scale = 1.0 - between * between;
    let in_plane = first * ((along_first - between * along_second) / scale)
        + second * ((along_second - between * along_first) / scale);
    let left = (1.0 - in_plane.length_squared()) / scale;
    let targets = if left >= 0.0 {
        [1.0, -1.0].map(|side| in_plane + across * (side * left.sqrt()))
    } else {
        // Out of reach: as near as the plane of both axes allows, on either side.
        let towards = first.reject_from(second);
        [towards, -towards]
    };
    targets.into_iter().map(|target| turn_onto(normal, target, second)).collect()
}

/// The equivalent angle, whole turns away, that is nearest to another, °.
pub(super) fn near(angle: f64, to: f64) -> f64 {
    angle + ((to - angle) / 360.0).round() * 360.0
}

/// Angles at the fraction `part` of the way.
pub(super) fn between(from: [f64; 2], to: [f64; 2], part: f64) -> [f64; 2] {
    std::array::from_fn(|k| from[k] + (to[k] - from[k]) * part)
}

#[cfg(test)]
mod tests {
    use super::{Positioner, PositionerAxis, Turning};
    use glam::DVec3;

    #[test]
    fn the_part_is_turned_about_the_lines_of_its_axes() {
        let axis = |direction, through| PositionerAxis { direction, through, limits: [-360.0, 360.0], speed: 30.0 };
        let axes = vec![axis([1.0, 0.0, 0.0], [0.0, 0.0, -200.0]), axis([0.0, 0.0, 1.0], [30.0, 0.0, 0.0])];
        let positioner = Positioner { turning: Turning::Follow, axes, up: [0.0, 0.0, 1.0] };
        let held = positioner.held([90.0, 180.0]);
        // Half a turn about x = 30, then a quarter about the line 200 mm below: y becomes z, and z becomes -y.
        let p = held.turn * DVec3::new(0.0, 10.0, 5.0) + held.shift;
        assert!(p.distance(DVec3::new(60.0, -205.0, -210.0)) < 1e-9, "{p}");
    }
}
