//! Collision checks of arm and torch with the table and the metal on it.
//!
//! Capsules are coarse, and their radii are those of the cell: a finding says where to look; a walk without findings
//! proves nothing about cables, wire feeders and fixtures.

use crate::arm::{Arm, Frame, Joints};
use crate::body::{Body, Capsule, Fixture, Solid, capsules};
use crate::cell::Cell;
use crate::metal::Metal;
use crate::track::Stop;
use glam::{DVec2, DVec3};

/// Two solids that overlap or come too near.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Contact {
    pub(crate) solids: [Solid; 2],
    /// Depth of the overlap, mm.
    pub(crate) depth: f64,
}

/// Capsules are compared with table and fixtures at points this far apart, mm.
const STEP_MM: f64 = 10.0;

/// Arm, torch, table and part during a program.
pub(crate) struct Room<'a> {
    arm: &'a Arm,
    body: &'a Body,
    flange_from_tool: Frame,
    part_from_base: Frame,
    /// The metal welded so far, in the part's frame.
    metal: Metal,
}

impl<'a> Room<'a> {
    /// Without metal, for beads of this width, mm; `None` if the cell has no body.
    pub(crate) fn new(cell: &'a Cell, arm: &'a Arm, base_from_part: &Frame, bead_width: f64) -> Option<Self> {
        let body = cell.body.as_ref()?;
        Some(Self {
            arm,
            body,
            flange_from_tool: cell.flange_from_tool(),
            part_from_base: base_from_part.inverse(),
            metal: Metal::new(bead_width),
        })
    }

    /// Adds a bead from one stop to another.
    pub(crate) fn lay(&mut self, from: &Stop, to: &Stop) {
        self.metal.lay([from.at, to.at], [from, to].map(|stop| stop.attitude.layer * DVec3::Z));
    }

    /// The deepest contact of each pair of solids, with the table turned by `turned_table`.
    pub(crate) fn contacts(&self, joints: &Joints, turned_table: &Frame) -> Vec<Contact> {
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
            // The base stands on the floor next to the table, and does not move.
            if a.solid != Solid::Base {
                note([a.solid, Solid::Table], self.above_table(a));
                note([a.solid, Solid::Part], self.metal.gap(a));
                self.body.fixtures.iter().for_each(|fixture| note([a.solid, Solid::Fixture], gap_to(fixture, a)));
            }
        }
        found
    }

    /// Distance of a capsule from the table, mm; negative if it is inside.
    fn above_table(&self, capsule: &Capsule) -> f64 {
        let [x, y] = self.body.table;
        let half = DVec2::new(x, y) / 2.0;
        let gap = |place: DVec3| {
            let beside = (place.truncate().abs() - half).max(DVec2::ZERO);
            beside.extend(place.z.max(0.0)).length() - capsule.radius
        };
        places(capsule.ends[0], capsule.ends[1]).into_iter().map(gap).fold(f64::INFINITY, f64::min)
    }
}

/// Whether two solids are neighbours at a joint, which keeps them apart.
fn joined(a: Solid, b: Solid) -> bool {
    use Solid::{Base, Forearm, Hand, Torch, UpperArm};
    matches!((a, b), (Torch, Torch | Hand) | (Hand, Forearm) | (Forearm, UpperArm) | (UpperArm, Base))
}

/// Distance of a capsule from a fixture, mm; negative if it is inside.
fn gap_to(fixture: &Fixture, capsule: &Capsule) -> f64 {
    let [low, high] = [fixture.low, fixture.high].map(DVec3::from);
    let gap = |place: DVec3| (low - place).max(place - high).max(DVec3::ZERO).length() - capsule.radius;
    places(capsule.ends[0], capsule.ends[1]).into_iter().map(gap).fold(f64::INFINITY, f64::min)
}

/// Points on a straight line, ends included.
fn places(from: DVec3, to: DVec3) -> Vec<DVec3> {
    // No arm or part needs more.
    let steps = (from.distance(to) / STEP_MM).ceil().clamp(1.0, 1e4) as usize;
    (0..=steps).map(|k| from.lerp(to, k as f64 / steps as f64)).collect()
}

/// Distance of two segments, mm.
fn between([p, q]: [DVec3; 2], [r, s]: [DVec3; 2]) -> f64 {
    let (u, v, w) = (q - p, s - r, p - r);
    let (a, b, c, d, e) = (u.dot(u), u.dot(v), v.dot(v), u.dot(w), v.dot(w));
    let on = |along: f64, length: f64| if length > 1e-12 { (along / length).clamp(0.0, 1.0) } else { 0.0 };
    let across = a * c - b * b;
    let first = if across > 1e-9 * a * c { ((b * e - c * d) / across).clamp(0.0, 1.0) } else { 0.0 };
    let second = on(b * first + e, c);
    // The point of the first segment nearest to that on the second.
    let first = on(b * second - d, a);
    (p + u * first).distance(r + v * second)
}
