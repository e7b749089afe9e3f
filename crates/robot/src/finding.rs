//! What is wrong with a program on a cell, in sentences for a welder.

use crate::body::Solid;
use crate::track::{Leg, Stop};
use bead_part::finding::{Finding, Severity};
use serde::Serialize;
use std::collections::BTreeMap;

/// What is wrong at a stop.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case", tag = "kind")]
#[non_exhaustive]
pub enum Trouble {
    /// No joint angles put the torch there.
    OutOfReach {
        /// Distance by which the wrist is outside the arm's reach (or inside its inner limit), mm; 0 if only the chosen
        /// branch cannot get there.
        beyond: f64,
        /// Greatest distance of the wrist from axis 2, mm.
        reach: f64,
    },
    /// A joint would have to go beyond its limit.
    Limit {
        /// Joint, from 0.
        joint: usize,
        /// Angle needed, °.
        angle: f64,
        /// Least angle, °.
        low: f64,
        /// Greatest angle, °.
        high: f64,
    },
    /// A joint would have to turn faster than it can.
    Speed {
        /// Joint, from 0.
        joint: usize,
        /// Speed needed, °/s.
        speed: f64,
        /// Greatest speed, °/s.
        limit: f64,
        /// Whether the arc burns.
        arc: bool,
    },
    /// Axes 4 and 6 nearly coincide.
    Wrist {
        /// Distance of joint 5 from the angle at which they do, °.
        margin: f64,
    },
    /// A straight move from home leads to other joint angles than those that were checked for the program.
    Posture {
        /// The joint that differs most, from 0.
        joint: usize,
        /// Angle to which the straight move leads, °.
        angle: f64,
        /// Angle that was checked, °.
        judged: f64,
    },
    /// Two solids, as capsules, overlap.
    Collision {
        /// The solid that is hit, and the one that hits it.
        solids: [Solid; 2],
        /// Depth, mm.
        depth: f64,
    },
}

impl Trouble {
    /// Whether this keeps the program from being welded. Slower travels, near singularities and collisions of coarse
    /// capsules are only reported.
    pub fn is_fatal(&self) -> bool {
        match self {
            Self::OutOfReach { .. } | Self::Limit { .. } => true,
            Self::Speed { arc, .. } => *arc,
            Self::Wrist { .. } | Self::Posture { .. } | Self::Collision { .. } => false,
        }
    }

    /// Kind and joint: findings that agree in both are reported together. Fatal kinds come first.
    fn key(&self) -> (u8, usize) {
        match *self {
            Self::OutOfReach { .. } => (0, 0),
            Self::Limit { joint, .. } => (1, joint),
            Self::Speed { joint, arc: true, .. } => (2, joint),
            Self::Wrist { .. } => (3, 4),
            Self::Speed { joint, arc: false, .. } => (4, joint),
            Self::Posture { .. } => (5, 0),
            Self::Collision { solids: [a, b], .. } => (6, 8 * a as usize + b as usize),
        }
    }

    /// Severity, in the unit of the kind.
    fn size(&self) -> f64 {
        match *self {
            Self::OutOfReach { beyond, .. } => beyond,
            Self::Limit { angle, low, high, .. } => (low - angle).max(angle - high),
            Self::Speed { speed, limit, .. } => speed / limit,
            Self::Wrist { margin } => -margin,
            Self::Posture { angle, judged, .. } => (angle - judged).abs(),
            Self::Collision { depth, .. } => depth,
        }
    }
}

/// All troubles of one kind and joint on one leg of the path.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ReachFinding {
    /// The first stop where it occurs.
    pub stop: Stop,
    /// What is wrong there.
    pub trouble: Trouble,
    /// The stop where it is worst, and the trouble there.
    pub worst: (Stop, Trouble),
    /// Number of stops where it occurs.
    pub count: usize,
}

impl From<&ReachFinding> for Finding {
    fn from(found: &ReachFinding) -> Self {
        let severity = if found.trouble.is_fatal() { Severity::Serious } else { Severity::Doubt };
        let on_part = found.stop.leg == Leg::Part;
        Self {
            count: found.count,
            layer: on_part.then_some(found.stop.layer),
            pass: on_part.then_some(found.stop.pass),
            place: Some(found.stop.at),
            size: Some(found.worst.1.size()),
            ..Self::new("reach", severity, found.sentence())
        }
    }
}

impl ReachFinding {
    /// One sentence with position, size and remedy.
    pub fn sentence(&self) -> String {
        let place = place(&self.stop);
        let more = self.more();
        match self.trouble {
            Trouble::OutOfReach { beyond, reach } if beyond > 0.0 => format!(
                "{place}: out of reach; the wrist misses the target by {beyond:.0} mm (the arm is {reach:.0} mm long from \
                 axis 2 to the wrist){more}. Move the part nearer to the robot."
            ),
            Trouble::OutOfReach { .. } => format!(
                "{place}: out of reach; the arm cannot get there without changing to another posture{more}. Move the \
                 part."
            ),
            Trouble::Limit { joint, angle, low, high } => format!(
                "{place}: joint {} would have to be at {angle:.1}°, but its limits are {low:.0}° and {high:.0}°{more}. \
                 Move or turn the part.",
                joint + 1
            ),
            Trouble::Speed { joint, speed, limit, arc } => format!(
                "{place}: joint {} would have to turn at {speed:.0} °/s, but it can do only {limit:.0} °/s{more}. {}",
                joint + 1,
                if arc {
                    "The robot would slow down and the bead swell: move the part, or weld more slowly there."
                } else {
                    "The robot will travel more slowly there."
                }
            ),
            Trouble::Wrist { margin } if self.stop.leg != Leg::Part => format!(
                "{place}: joint 5 is {margin:.1}° from the singularity of the wrist on a straight move{more}; joints 4 and 6 may \
                 swing round. Make this a joint move (PTP, MoveJ), or choose a home position with joint 5 bent."
            ),
            Trouble::Posture { joint, angle, judged } => format!(
                "{place}: the straight move leads joint {} to {angle:.1}°, but the program was judged with {judged:.1}°{more}. \
                 Make this a joint move (PTP, MoveJ), or choose a home position nearer to that posture.",
                joint + 1
            ),
            Trouble::Collision { solids: [a, b], depth } => format!(
                "{place}: {} hits {}, by {depth:.0} mm according to the cell's capsules{more}. Move or turn the part, bend the \
                 torch differently, or correct [body] of the cell.",
                a.name(),
                b.name()
            ),
            Trouble::Wrist { margin } => format!(
                "{place}: joint 5 is {margin:.1}° from the singularity of the wrist{more}; joints 4 and 6 may swing round. \
                 Move the part, or bend the torch more."
            ),
        }
    }

    fn more(&self) -> String {
        if self.count == 1 {
            return String::new();
        }
        let worst = match self.worst.1 {
            _ if self.worst.0 == self.stop => return format!(", and at {} points in all", self.count),
            Trouble::OutOfReach { beyond, .. } => format!("{beyond:.0} mm"),
            Trouble::Limit { angle, .. } => format!("{angle:.1}°"),
            Trouble::Speed { speed, .. } => format!("{speed:.0} °/s"),
            Trouble::Wrist { margin } => format!("{margin:.1}°"),
            Trouble::Posture { angle, .. } => format!("{angle:.1}°"),
            Trouble::Collision { depth, .. } => format!("{depth:.0} mm"),
        };
        let Stop { layer, pass, point, at, leg, .. } = self.worst.0;
        if leg != Leg::Part {
            let count = self.count;
            return format!(
                ", and at {count} points in all, the worst {worst} (x {:.1} y {:.1} z {:.1} mm)",
                at.x, at.y, at.z
            );
        }
        format!(
            ", and at {} points in all, the worst {worst} (layer {}, pass {}, point {})",
            self.count,
            layer + 1,
            pass + 1,
            point + 1
        )
    }
}

fn place(stop: &Stop) -> String {
    let Stop { layer, pass, point, at, arc, leg, .. } = stop;
    let way = match leg {
        Leg::Part => None,
        Leg::FromHome => Some("from home to the first point"),
        Leg::ToHome => Some("from the last point to home"),
    };
    if let Some(way) = way {
        return format!("On the way {way}, at x {:.1} y {:.1} z {:.1} mm", at.x, at.y, at.z);
    }
    let travel = if *arc { "" } else { " (travel)" };
    format!(
        "Layer {}, pass {}, point {}{travel} at x {:.1} y {:.1} z {:.1} mm",
        layer + 1,
        pass + 1,
        point + 1,
        at.x,
        at.y,
        at.z
    )
}

/// Troubles, collected along the path.
#[derive(Debug, Default)]
pub(crate) struct Findings(BTreeMap<(u8, usize, Leg), ReachFinding>);

impl Findings {
    pub(crate) fn add(&mut self, stop: &Stop, trouble: Trouble) {
        let new = || ReachFinding { stop: *stop, trouble, worst: (*stop, trouble), count: 0 };
        let (kind, joint) = trouble.key();
        let finding = self.0.entry((kind, joint, stop.leg)).or_insert_with(new);
        finding.count += 1;
        if trouble.size() > finding.worst.1.size() {
            finding.worst = (*stop, trouble);
        }
    }

    /// By kind and joint, the fatal kinds first.
    pub(crate) fn sorted(self) -> Vec<ReachFinding> {
        self.0.into_values().collect()
    }
}
