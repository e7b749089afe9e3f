//! What takes up room: arm and torch as capsules, the table and the metal that stands on it.
//!
//! Capsules are coarse, and their radii are the cell's: a finding tells where to look, a silent walk proves nothing about
//! cables, wire feeders and fixtures.

use super::arm::{Arm, Frame, Joints};
use super::cell::Cell;
use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};
use std::collections::HashMap;

/// How thick the arm is, and how large the table: a section of a cell. Lengths in mm.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Body {
    /// Radius of the base, from the floor to axis 2, mm.
    pub base: f64,
    /// Radius of the upper arm, mm.
    pub upper_arm: f64,
    /// Radius of the forearm, mm.
    pub forearm: f64,
    /// Radius of the hand, from the wrist to the flange, mm.
    pub hand: f64,
    /// Radius of the torch, mm.
    pub torch: f64,
    /// From the nozzle to the wire's tip, mm.
    pub stick_out: f64,
    /// Size of the table along the part's x and y, about the part's origin and level with it, mm.
    pub table: [f64; 2],
}

/// Something that may be hit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Solid {
    /// The torch, without its wire.
    Torch,
    /// From the wrist to the flange.
    Hand,
    /// From the elbow to the wrist.
    Forearm,
    /// From axis 2 to the elbow.
    UpperArm,
    /// From the floor to axis 2.
    Base,
    /// The table, down to the floor.
    Table,
    /// The part, as far as it is welded.
    Part,
}

impl Solid {
    /// The word for people.
    pub fn name(self) -> &'static str {
        match self {
            Self::Torch => "the torch",
            Self::Hand => "the hand",
            Self::Forearm => "the forearm",
            Self::UpperArm => "the upper arm",
            Self::Base => "the robot's base",
            Self::Table => "the table",
            Self::Part => "the part",
        }
    }
}

/// Two solids that come too near.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Contact {
    pub(super) solids: [Solid; 2],
    /// How deep they would be in each other, mm.
    pub(super) depth: f64,
}

/// A line with a thickness.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Capsule {
    /// What it stands for.
    pub solid: Solid,
    /// Its two ends, mm.
    pub ends: [DVec3; 2],
    /// Its radius, mm.
    pub radius: f64,
}

/// Arm and torch for angles of the joints, °: in the robot's frame, moved by `part_from_base`.
pub fn capsules(
    arm: &Arm,
    body: &Body,
    flange_from_tool: &Frame,
    joints: &Joints,
    part_from_base: &Frame,
) -> Vec<Capsule> {
    let [foot, shoulder, elbow, wrist] = arm.links(joints);
    let flange = arm.forward(joints);
    let Body { base, upper_arm, forearm, hand, torch, stick_out, .. } = *body;
    let tip = flange_from_tool.position;
    let along = flange_from_tool.rotation * DVec3::Z;
    // The neck bends where the wire's line is nearest to the flange's axis; a straight torch has its whole length there.
    let (sideways, bent) = (along.truncate(), along.truncate().length_squared());
    let back = if bent > 1e-6 { tip.truncate().dot(sideways) / bent } else { tip.z };
    let neck = tip - along * back.clamp(0.0, tip.length());
    let nozzle = tip - along * (stick_out + torch).min(tip.distance(neck));
    // Capsules are round at their ends, links are not: the forearm ends at the wrist, the torch begins at the flange.
    let shortened = |from: DVec3, to: DVec3, by: f64| to - (to - from).normalize_or_zero() * by.min(from.distance(to));
    let capsule = |solid, from: DVec3, to: DVec3, radius| Capsule {
        solid,
        ends: [from, to].map(|end| part_from_base.apply(end)),
        radius,
    };
    vec![
        capsule(Solid::Torch, flange.position, flange.apply(neck), torch),
        capsule(Solid::Torch, flange.apply(neck), flange.apply(nozzle), torch),
        capsule(Solid::Hand, wrist, shortened(wrist, flange.position, hand), hand),
        capsule(Solid::Forearm, elbow, shortened(elbow, wrist, forearm), forearm),
        capsule(Solid::UpperArm, shoulder, elbow, upper_arm),
        capsule(Solid::Base, foot, shoulder, base),
    ]
}

/// Cells in which the standing metal is kept, mm.
const CELL_MM: f64 = 10.0;
/// Capsules are compared with table and part at places this far apart, mm.
const STEP_MM: f64 = 10.0;

/// Arm, torch, table and part while a program runs.
pub(super) struct Room<'a> {
    arm: &'a Arm,
    body: &'a Body,
    flange_from_tool: Frame,
    part_from_base: Frame,
    /// Top of the metal by cell, in the part's frame, mm.
    tops: HashMap<[i64; 2], f64>,
    low: DVec3,
    high: DVec3,
}

impl<'a> Room<'a> {
    /// A room without metal; none where the cell tells no body.
    pub(super) fn new(cell: &'a Cell, arm: &'a Arm, base_from_part: &Frame) -> Option<Self> {
        let body = cell.body.as_ref()?;
        Some(Self {
            arm,
            body,
            flange_from_tool: cell.flange_from_tool(),
            part_from_base: base_from_part.inverse(),
            tops: HashMap::new(),
            low: DVec3::INFINITY,
            high: DVec3::NEG_INFINITY,
        })
    }

    /// A bead was laid from one place of the part to another.
    pub(super) fn lay(&mut self, from: DVec3, to: DVec3) {
        for place in places(from, to) {
            let top = self.tops.entry(cell_of(place)).or_insert(f64::NEG_INFINITY);
            *top = top.max(place.z);
        }
        (self.low, self.high) = (self.low.min(from.min(to)), self.high.max(from.max(to)));
    }

    /// The deepest contact of each pair of solids, with a table turned like this.
    pub(super) fn contacts(&self, joints: &Joints, turned_table: &Frame) -> Vec<Contact> {
        let part_from_base = turned_table.inverse().then(&self.part_from_base);
        let capsules = capsules(self.arm, self.body, &self.flange_from_tool, joints, &part_from_base);
        let mut found: Vec<Contact> = Vec::new();
        let mut note = |solids: [Solid; 2], gap: f64| {
            let contact = Contact { solids, depth: -gap };
            match found.iter_mut().find(|c| c.solids == solids) {
                _ if gap >= 0.0 => {}
                Some(known) => known.depth = known.depth.max(contact.depth),
                None => found.push(contact),
            }
        };
        for (i, a) in capsules.iter().enumerate() {
            for b in &capsules[i + 1..] {
                if !joined(a.solid, b.solid) {
                    note([a.solid, b.solid], between(a.ends, b.ends) - a.radius - b.radius);
                }
            }
            // The base stands on the floor beside the table, and does not move.
            if a.solid != Solid::Base {
                note([a.solid, Solid::Table], self.above_table(a));
                note([a.solid, Solid::Part], self.above_part(a));
            }
        }
        found
    }

    /// How far a capsule stays from the table, mm; below 0 where it is in it.
    fn above_table(&self, capsule: &Capsule) -> f64 {
        let [x, y] = self.body.table;
        let half = DVec2::new(x, y) / 2.0;
        let gap = |place: DVec3| {
            let beside = (place.truncate().abs() - half).max(DVec2::ZERO);
            beside.extend(place.z.max(0.0)).length() - capsule.radius
        };
        places(capsule.ends[0], capsule.ends[1]).into_iter().map(gap).fold(f64::INFINITY, f64::min)
    }

    /// How far a capsule stays from the metal that stands, mm.
    fn above_part(&self, capsule: &Capsule) -> f64 {
        let reach = (capsule.radius / CELL_MM).ceil() as i64 + 1;
        let gap = |place: DVec3| {
            let beside = (self.low - place).max(place - self.high).max(DVec3::ZERO);
            // Below the part is the table.
            if beside.with_z((place.z - self.high.z).max(0.0)).length() >= capsule.radius {
                return f64::INFINITY;
            }
            let [x, y] = cell_of(place);
            let around = (-reach..=reach).flat_map(|i| (-reach..=reach).map(move |j| [x + i, y + j]));
            let distance = |cell: [i64; 2]| {
                let top = self.tops.get(&cell)?;
                let centre = (DVec2::new(cell[0] as f64, cell[1] as f64) + 0.5) * CELL_MM;
                let beside = ((place.truncate() - centre).abs() - CELL_MM / 2.0).max(DVec2::ZERO);
                Some(beside.extend((place.z - top).max(0.0)).length() - capsule.radius)
            };
            around.filter_map(distance).fold(f64::INFINITY, f64::min)
        };
        if self.tops.is_empty() {
            f64::INFINITY
        } else {
            places(capsule.ends[0], capsule.ends[1]).into_iter().map(gap).fold(f64::INFINITY, f64::min)
        }
    }
}

/// Whether two links move against each other in a joint that keeps them apart.
fn joined(a: Solid, b: Solid) -> bool {
    use Solid::{Base, Forearm, Hand, Torch, UpperArm};
    matches!((a, b), (Torch, Torch | Hand) | (Hand, Forearm) | (Forearm, UpperArm) | (UpperArm, Base))
}

fn cell_of(place: DVec3) -> [i64; 2] {
    (place.truncate() / CELL_MM).floor().as_i64vec2().to_array()
}

/// Places on a straight way, ends included.
fn places(from: DVec3, to: DVec3) -> Vec<DVec3> {
    // No arm or part needs more.
    let steps = (from.distance(to) / STEP_MM).ceil().clamp(1.0, 1e4) as usize;
    (0..=steps).map(|k| from.lerp(to, k as f64 / steps as f64)).collect()
}

/// Distance of two segments.
fn between([p, q]: [DVec3; 2], [r, s]: [DVec3; 2]) -> f64 {
    let (u, v, w) = (q - p, s - r, p - r);
    let (a, b, c, d, e) = (u.dot(u), u.dot(v), v.dot(v), u.dot(w), v.dot(w));
    let on = |along: f64, length: f64| if length > 1e-12 { (along / length).clamp(0.0, 1.0) } else { 0.0 };
    let across = a * c - b * b;
    let first = if across > 1e-9 * a * c { ((b * e - c * d) / across).clamp(0.0, 1.0) } else { 0.0 };
    let second = on(b * first + e, c);
    // The place on the first segment that is nearest to that on the second.
    let first = on(b * second - d, a);
    (p + u * first).distance(r + v * second)
}
