//! A positioner that turns the part so that the layer lies level under the torch.
//!
//! The angles that bring a layer's normal upright have closed forms: the normal turns about the axis next to the part
//! until its angle to the other axis equals that of "up", and then the other axis aligns the two (Paden 1986,
//! subproblems 1 and 2). There are two solutions, plus whole turns of each axis; a pass begins where it can be followed
//! to its end.

use super::machine::Keys;
use super::turning::{MOST_PER_MM, WOUND, whole_turns};
use super::{Attitude, Instruction};
use bead_plan::limit::{Broken, Limit, limit};
use glam::{DQuat, DVec3};
use serde::{Deserialize, Serialize};

/// Axes nearer to each other than this, °, do not give two solutions.
const APART: f64 = 10.0;
/// A normal within this angle of an axis is not turned by it, rad.
const ON_AXIS: f64 = 1e-6;
/// With the arc on, an axis may also turn this many times as far as the normal does: on small parts that is more than
/// its length allows. Beyond that, where a normal passes near an axis, the axis would spin to keep the pool level to
/// the last degree.
const MOST_PER_TURN: f64 = 2.0;

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
    fn ways(&self, normal: DVec3, before: [f64; 2]) -> Vec<[f64; 2]> {
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
    fn first_for(&self, normal: DVec3, angles: [f64; 2]) -> f64 {
        let directions: Vec<DVec3> = self.directions().collect();
        let [first, second] = directions[..] else { return angles[0] };
        let turned = DQuat::from_axis_angle(second, angles[1].to_radians()) * normal;
        turn_onto(turned, self.upwards(), first).map_or(angles[0], |angle| near(angle, angles[0]))
    }

    /// Angle between a normal and "up", °.
    pub fn off_level(&self, normal: DVec3, angles: [f64; 2]) -> f64 {
        (self.held(angles).turn * normal).angle_between(DVec3::Z).to_degrees()
    }

    fn within(&self, mut angles: [f64; 2]) -> [f64; 2] {
        for (angle, axis) in angles.iter_mut().zip(&self.axes) {
            *angle = angle.clamp(axis.limits[0], axis.limits[1]);
        }
        angles
    }

    /// Time that the slower axis takes between two positions, s.
    fn seconds(&self, from: [f64; 2], to: [f64; 2]) -> f64 {
        let each = self.axes.iter().enumerate().map(|(k, axis)| (to[k] - from[k]).abs() / axis.speed);
        each.fold(0.0, f64::max)
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
fn near(angle: f64, to: f64) -> f64 {
    angle + ((to - angle) / 360.0).round() * 360.0
}

/// The state of a positioner during a program.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Holder {
    positioner: Positioner,
    /// Angles of the axes, °.
    angles: [f64; 2],
    /// Position of the torch, mm.
    at: Option<DVec3>,
    /// Speed of travels, mm/s.
    travel_speed: f64,
    /// Time that travels have waited for the axes, s.
    waited: f64,
}

/// A point of a pass.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Step {
    /// Normal of the layer.
    normal: DVec3,
    /// Length of the move there, mm.
    length: f64,
    /// Greatest turn of an axis on the way, °.
    most: f64,
}

impl Step {
    fn to(normal: DVec3, before: DVec3, length: f64) -> Self {
        let most = MOST_PER_MM * length + MOST_PER_TURN * before.angle_between(normal).to_degrees();
        Self { normal, length, most }
    }
}

impl Holder {
    /// A positioner as in the profile, at 0; `None` without one.
    pub(super) fn new(positioner: Option<&Positioner>, travel_speed: f64) -> Option<Self> {
        positioner.map(|own| Self { positioner: own.clone(), angles: [0.0; 2], at: None, travel_speed, waited: 0.0 })
    }

    /// Time that travels have waited for the axes so far, s.
    pub(super) fn waited(&self) -> f64 {
        self.waited
    }

    /// Adds the turns that the instructions of a layer need.
    pub(super) fn hold(&mut self, instructions: &mut Vec<Instruction>) {
        let starts = |i: &Instruction| matches!(i, Instruction::PassStart { .. });
        let mut rest = std::mem::take(instructions);
        while !rest.is_empty() {
            let end = rest.iter().skip(1).position(starts).map_or(rest.len(), |at| at + 1);
            let after = rest.split_off(end);
            self.hold_pass(&mut rest);
            instructions.append(&mut rest);
            rest = after;
        }
    }

    fn hold_pass(&mut self, pass: &mut Vec<Instruction>) {
        let welds = |i: &Instruction| matches!(i, Instruction::Weld { .. });
        let Some(first) = pass.iter().position(welds) else { return };
        let (steps, before) = (self.steps(pass, first), self.angles);
        let start = match self.positioner.turning {
            Turning::Index | Turning::IndexAtHome => self.indexed(&steps),
            Turning::Follow => self.begun(&steps),
        };
        self.waited += self.waits(&pass[..first], before, start);
        let way = self.positioner.farthest(before, start);
        // When it is wound back by a turn, the torch cannot follow the part around: it is a joint move.
        let most = if self.positioner.turning == Turning::IndexAtHome { 0.0 } else { WOUND };
        let before = if way > most { start } else { before };
        let first = if way > most { jumped(pass, first) } else { first };
        self.approach(&mut pass[..first], before, start);
        self.angles = start;
        let mut steps = steps[1..].iter();
        for instruction in &mut pass[first..] {
            let step = if welds(instruction) { steps.next() } else { None };
            if let Some(step) = step.filter(|_| self.positioner.turning == Turning::Follow) {
                self.angles = self.followed(self.angles, *step);
            }
            if let Some(attitude) = instruction.attitude_mut() {
                attitude.held = Some(self.positioner.held(self.angles));
            }
        }
        self.at = pass.iter().rev().find_map(Instruction::target).or(self.at);
    }

    /// The points of a pass, beginning with its start.
    fn steps(&self, pass: &[Instruction], first: usize) -> Vec<Step> {
        let normal = |attitude: Attitude| attitude.layer * DVec3::Z;
        let begins = pass[..first].iter().rev().find_map(Instruction::attitude).unwrap_or_default();
        let mut at = pass[..first].iter().rev().find_map(Instruction::target).or(self.at);
        let mut steps = vec![Step::to(normal(begins), normal(begins), 0.0)];
        for instruction in &pass[first..] {
            if let Instruction::Weld { to, attitude, .. } = instruction {
                let before = steps.last().map_or(DVec3::Z, |step| step.normal);
                steps.push(Step::to(normal(*attitude), before, at.map_or(0.0, |at| at.distance(*to))));
                at = Some(*to);
            }
        }
        steps
    }

    /// Lengths of the moves of a path, mm; 0 for instructions that do not move.
    fn lengths(&self, way: &[Instruction]) -> Vec<f64> {
        let mut at = self.at;
        let mut length = |instruction: &Instruction| {
            let target = instruction.target()?;
            Some(at.replace(target).map_or(0.0, |at| at.distance(target)))
        };
        way.iter().map(|instruction| length(instruction).unwrap_or(0.0)).collect()
    }

    /// Time by which the axes take longer than the torch for a path, s; 0 for the first, which may come from anywhere.
    fn waits(&self, way: &[Instruction], from: [f64; 2], to: [f64; 2]) -> f64 {
        let travel = self.lengths(way).iter().sum::<f64>() / self.travel_speed;
        self.at.map_or(0.0, |_| (self.positioner.seconds(from, to) - travel).max(0.0))
    }

    /// On the way to a pass the part turns in proportion to the torch's progress.
    fn approach(&self, way: &mut [Instruction], from: [f64; 2], to: [f64; 2]) {
        let lengths = self.lengths(way);
        let all: f64 = lengths.iter().sum();
        let joints = way.iter().any(|i| matches!(i, Instruction::Approach { .. }));
        for k in 0..way.len() {
            let starts = matches!(way[k], Instruction::PassStart { .. });
            let Some(attitude) = way[k].attitude_mut() else { continue };
            // A turn applies to the end of the next move.
            let next = lengths[k..].iter().position(|length| *length > 0.0).map_or(lengths.len(), |at| k + at + 1);
            let part = if starts || joints || all <= 0.0 { 1.0 } else { lengths[..next].iter().sum::<f64>() / all };
            attitude.held = Some(self.positioner.held(between(from, to, part)));
        }
    }

    /// The start angles with which a pass is followed to its end with the least lean, within the limits, near the
    /// previous angles.
    fn begun(&self, steps: &[Step]) -> [f64; 2] {
        let ways = self.positioner.ways(steps[0].normal, self.angles);
        let started = ways.into_iter().map(|start| {
            let free = Self { positioner: self.positioner.endless(), ..self.clone() };
            let (mut angles, mut least, mut most, mut lean) = (start, start, start, 0.0_f64);
            for step in steps {
                angles = free.followed(angles, *step);
                lean = lean.max(self.positioner.off_level(step.normal, angles));
                for k in 0..2 {
                    (least[k], most[k]) = (least[k].min(angles[k]), most[k].max(angles[k]));
                }
            }
            let (mut start, mut beyond) = (start, 0.0);
            for (k, axis) in self.positioner.axes.iter().enumerate() {
                let (turns, over) = whole_turns(axis.limits, [least[k], most[k]], start[k] - self.angles[k]);
                start[k] += turns;
                beyond += over;
            }
            (beyond, lean, self.positioner.seconds(self.angles, start), start)
        });
        let better = |a: &(f64, f64, f64, [f64; 2]), b: &(f64, f64, f64, [f64; 2])| {
            a.0.total_cmp(&b.0).then((a.1 - b.1 > SAME).cmp(&(b.1 - a.1 > SAME))).then(a.2.total_cmp(&b.2))
        };
        let best = started.min_by(better).map_or(self.angles, |(.., start)| start);
        self.positioner.within(best)
    }

    /// The single position for a pass: the current one if it suffices, otherwise the one whose worst lean is least.
    fn indexed(&self, steps: &[Step]) -> [f64; 2] {
        let lean = |angles: [f64; 2]| {
            steps.iter().map(|step| self.positioner.off_level(step.normal, angles)).fold(0.0, f64::max)
        };
        let mean: DVec3 = steps.iter().map(|step| step.normal * step.length.max(f64::MIN_POSITIVE)).sum();
        let ways = self.positioner.ways(mean.try_normalize().unwrap_or(steps[0].normal), self.angles);
        let placed = ways.into_iter().map(|mut way| {
            for (k, axis) in self.positioner.axes.iter().enumerate() {
                way[k] += whole_turns(axis.limits, [way[k]; 2], way[k] - self.angles[k]).0;
            }
            self.positioner.within(way)
        });
        let key = |angles: &[f64; 2]| (lean(*angles), self.positioner.seconds(self.angles, *angles));
        let better = |a: &[f64; 2], b: &[f64; 2]| {
            let (a, b) = (key(a), key(b));
            (a.0 - b.0 > SAME).cmp(&(b.0 - a.0 > SAME)).then(a.1.total_cmp(&b.1))
        };
        let best = placed.min_by(better).unwrap_or(self.angles);
        if lean(self.angles) <= lean(best) + WORTH_TURNING { self.angles } else { best }
    }

    /// The angles at the next point of a pass.
    fn followed(&self, before: [f64; 2], Step { normal, most, .. }: Step) -> [f64; 2] {
        let ways = self.positioner.ways(normal, before).into_iter();
        let ways = ways.map(|way| [near(way[0], before[0]), near(way[1], before[1])]);
        let seconds = |way: &[f64; 2]| self.positioner.seconds(before, *way);
        let Some(best) = ways.min_by(|a, b| seconds(a).total_cmp(&seconds(b))) else { return before };
        let step = |k: usize, to: f64| before[k] + (to - before[k]).clamp(-most, most);
        let second = step(1, best[1]);
        let first = if second == best[1] { best[0] } else { self.positioner.first_for(normal, [before[0], second]) };
        self.positioner.within([step(0, first), second])
    }
}

/// Leans that differ by less than this are equal, °.
const SAME: f64 = 0.1;
/// An indexed part is turned for a pass if that reduces its lean by more than this, °.
const WORTH_TURNING: f64 = 1.0;

fn between(from: [f64; 2], to: [f64; 2], part: f64) -> [f64; 2] {
    std::array::from_fn(|k| from[k] + (to[k] - from[k]) * part)
}

/// Removes the path to a pass except for its last point, to which a joint move leads; returns the new index of the
/// first weld.
fn jumped(pass: &mut Vec<Instruction>, first: usize) -> usize {
    let above = pass[..first].iter().position(|i| matches!(i, Instruction::Above)).unwrap_or(first);
    let Some(last) = pass[..above].iter().rposition(|i| matches!(i, Instruction::Travel { .. })) else { return first };
    if let Instruction::Travel { to } = pass[last] {
        pass[last] = Instruction::Approach { to };
    }
    let turn = pass[..last].iter().rposition(|i| matches!(i, Instruction::Turn { .. }));
    let mut index = 0;
    pass.retain(|i| {
        let of_way = index < last && matches!(i, Instruction::Travel { .. } | Instruction::Turn { .. });
        let kept = !of_way || Some(index) == turn;
        index += 1;
        kept
    });
    pass.iter().position(|i| matches!(i, Instruction::Weld { .. })).unwrap_or(first)
}

impl Positioner {
    /// The farthest that one of its axes turns, °.
    fn farthest(&self, from: [f64; 2], to: [f64; 2]) -> f64 {
        (0..self.axes.len()).map(|k| (to[k] - from[k]).abs()).fold(0.0, f64::max)
    }

    /// The same without limits.
    fn endless(&self) -> Self {
        let endless = |axis: &PositionerAxis| PositionerAxis { limits: [f64::NEG_INFINITY, f64::INFINITY], ..*axis };
        Self { axes: self.axes.iter().map(endless).collect(), ..self.clone() }
    }
}

#[cfg(test)]
mod tests {
    use super::{Holder, Positioner, PositionerAxis, Step, Turning};
    use glam::{DQuat, DVec3};
    use std::f64::consts::TAU;

    fn axis(direction: [f64; 3], limits: [f64; 2]) -> PositionerAxis {
        PositionerAxis { direction, through: [0.0; 3], limits, speed: 30.0 }
    }

    fn of(axes: &[[f64; 3]], up: [f64; 3]) -> Positioner {
        let axes = axes.iter().map(|direction| axis(*direction, [-3600.0, 3600.0])).collect();
        Positioner { turning: Turning::Follow, axes, up }
    }

    /// Directions spread over the sphere (Fibonacci).
    fn sphere(count: usize) -> impl Iterator<Item = DVec3> {
        (0..count).map(move |k| {
            let z = 1.0 - (2.0 * k as f64 + 1.0) / count as f64;
            let angle = TAU * (0.618_033_988_75 * k as f64).fract();
            DVec3::new(angle.cos() * (1.0 - z * z).sqrt(), angle.sin() * (1.0 - z * z).sqrt(), z)
        })
    }

    /// A pass along which these are the normals, some mm apart.
    fn steps(normals: impl Iterator<Item = DVec3>, apart: f64) -> Vec<Step> {
        let mut before = None;
        let step = |normal| Step::to(normal, before.replace(normal).unwrap_or(normal), apart);
        normals.map(step).collect()
    }

    fn holder(positioner: &Positioner) -> Holder {
        Holder::new(Some(positioner), 100.0).unwrap()
    }

    #[test]
    fn two_axes_square_to_each_other_bring_every_normal_up() {
        for axes in [
            [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]],
            [[0.0, -2.0, 0.0], [0.0, 0.0, 5.0]],
            [[0.0, 0.6, 0.8], [1.0, 0.0, 0.0]],
        ] {
            // The first axis must be level, or it cannot bring what lies along the second up.
            let positioner = of(&axes, if axes[0][2] == 0.0 { [0.0, 0.0, 1.0] } else { [0.0, 0.8, -0.6] });
            for normal in sphere(500) {
                let angles = holder(&positioner).begun(&[Step::to(normal, normal, 0.0)]);
                assert!(positioner.off_level(normal, angles) < 1e-5, "{axes:?} {normal} {angles:?}");
            }
        }
    }

    /// One axis, and two that lean by 45 degrees to each other as those of an orbital positioner: no angles on a grid are better.
    #[test]
    fn what_cannot_be_brought_up_comes_as_near_as_any_angles_bring_it() {
        let grid = |count: usize| (0..count).map(move |k| 360.0 * k as f64 / count as f64);
        for axes in [vec![[0.0, 0.0, 1.0]], vec![[1.0, 0.3, 0.0]], vec![[0.0, 0.0, 1.0], [0.0, 1.0, 1.0]]] {
            let positioner = of(&axes, [0.0, 0.3, 1.0]);
            let second: Vec<f64> = if axes.len() == 2 { grid(180).collect() } else { vec![0.0] };
            for normal in sphere(60) {
                let angles = holder(&positioner).begun(&[Step::to(normal, normal, 0.0)]);
                let found = positioner.off_level(normal, angles);
                let tried = grid(180).flat_map(|a| second.iter().map(move |b| [a, *b]));
                let best = tried.map(|angles| positioner.off_level(normal, angles)).fold(180.0, f64::min);
                assert!(found <= best + 1e-6, "{axes:?} {normal}: {found} {best}");
            }
        }
    }

    #[test]
    fn the_part_is_turned_about_the_lines_of_its_axes() {
        let mut positioner = of(&[[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]], [0.0, 0.0, 1.0]);
        positioner.axes[0].through = [0.0, 0.0, -200.0];
        positioner.axes[1].through = [30.0, 0.0, 0.0];
        let held = positioner.held([90.0, 180.0]);
        // Half a turn about x = 30, then a quarter about the line 200 mm below: y becomes z, and z becomes -y.
        let p = held.turn * DVec3::new(0.0, 10.0, 5.0) + held.shift;
        assert!(p.distance(DVec3::new(60.0, -205.0, -210.0)) < 1e-9, "{p}");
    }

    /// Rings around a level axis: the part turns once for each, on and on; with limits it is wound back before a ring that would pass
    /// them.
    #[test]
    fn rings_are_followed_to_their_end() {
        // Of a radius so small that each millimetre turns the part by 6 degrees.
        let ring = |turns: f64| {
            let normal = |k: i32| DQuat::from_rotation_z(TAU * turns * f64::from(k) / 720.0) * DVec3::X;
            steps((0..=720).map(normal), TAU * turns / 720.0 * 10.0)
        };
        let mut positioner = of(&[[0.0, 0.0, 1.0]], [1.0, 0.0, 0.0]);
        positioner.axes[0].limits = [-400.0, 400.0];
        let mut holder = holder(&positioner);
        let mut wound = 0;
        for _ in 0..7 {
            let (before, steps) = (holder.angles, ring(1.05));
            holder.angles = holder.begun(&steps);
            wound += usize::from((holder.angles[0] - before[0]).abs() > 180.0);
            for step in &steps {
                holder.angles = holder.followed(holder.angles, *step);
                assert!(positioner.off_level(step.normal, holder.angles) < 1e-5 && holder.angles[0].abs() <= 400.0);
            }
        }
        assert!((2..=6).contains(&wound), "{wound} times");
    }

    /// Where a normal passes close by the second axis, the axis does not spin.
    #[test]
    fn near_its_own_axis_it_turns_slowly_and_stays_nearly_level() {
        let positioner = of(&[[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]], [0.0, 0.0, 1.0]);
        let normal = |k: i32| DVec3::new(0.002, 0.001 * f64::from(k), 1.0).normalize();
        let steps = steps((-100..=100).map(normal), 1.0);
        let mut holder = holder(&positioner);
        holder.angles = holder.begun(&steps);
        for step in &steps {
            let before = holder.angles;
            holder.angles = holder.followed(before, *step);
            assert!((0..2).all(|k| (holder.angles[k] - before[k]).abs() <= 2.2));
            assert!(positioner.off_level(step.normal, holder.angles) < 6.0, "{:?}", holder.angles);
        }
    }
}
