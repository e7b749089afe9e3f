//! How a positioner holds the part during a program: at each pass and at its points, among the angles that bring the
//! layer's normal upright, those with which the pass is followed to its end, within the limits and near the angles before.

use super::positioner::{Positioner, Turning, between, near};
use super::turning::{MOST_PER_MM, WOUND, whole_turns};
use super::{Attitude, Instruction};
use glam::DVec3;

/// With the arc on, an axis may also turn this many times as far as the normal does: on small parts that is more than
/// its length allows. Beyond that, where a normal passes near an axis, the axis would spin to keep the pool level to
/// the last degree.
const MOST_PER_TURN: f64 = 2.0;

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

#[cfg(test)]
mod tests {
    use super::{Holder, Positioner, Step, Turning};
    use crate::program::PositionerAxis;
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
