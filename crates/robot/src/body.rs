//! Arm and torch as capsules, for collision checks.

use crate::arm::{Arm, Frame, Joints};
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// Thickness of the arm and size of the table: a section of a cell. Lengths in mm.
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
    /// Clamps, vices, jaws and other boxes on the table that turn with it; default none.
    #[serde(default)]
    pub fixtures: Vec<Fixture>,
}

/// A box beside the part, in the part's x, y and z.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Fixture {
    /// Its corner with the least coordinates, mm.
    pub low: [f64; 3],
    /// Its corner with the greatest coordinates, mm.
    pub high: [f64; 3],
}

/// A body that may collide.
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
    /// The part as welded so far.
    Part,
    /// Something that holds the part.
    Fixture,
}

impl Solid {
    /// Its name in words.
    pub fn name(self) -> &'static str {
        match self {
            Self::Torch => "the torch",
            Self::Hand => "the hand",
            Self::Forearm => "the forearm",
            Self::UpperArm => "the upper arm",
            Self::Base => "the robot's base",
            Self::Table => "the table",
            Self::Part => "the part",
            Self::Fixture => "a fixture",
        }
    }
}

/// A line with a thickness.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Capsule {
    /// The body that it represents.
    pub solid: Solid,
    /// Its two ends, mm.
    pub ends: [DVec3; 2],
    /// Its radius, mm.
    pub radius: f64,
}

/// Arm and torch for joint angles, °, as capsules in the robot's frame, transformed by `part_from_base`.
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
    // The neck bends where the wire's line is nearest to the flange's axis; a straight torch has its full length there.
    let (sideways, bent) = (along.truncate(), along.truncate().length_squared());
    let back = if bent > 1e-6 { tip.truncate().dot(sideways) / bent } else { tip.z };
    let neck = tip - along * back.clamp(0.0, tip.length());
    let nozzle = tip - along * (stick_out + torch).min(tip.distance(neck));
    // Capsules have round ends, links do not: the forearm ends at the wrist, the torch begins at the flange.
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
