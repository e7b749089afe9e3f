//! What is wrong with a program on a cell, in sentences for a welder.

use super::track::Stop;
use serde::Serialize;
use std::collections::BTreeMap;

/// What is wrong at a stop.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case", tag = "kind")]
pub enum Trouble {
    /// No joint angles put the torch there.
    OutOfReach {
        /// How far the wrist would have to go beyond the arm's reach (or inside of it), mm; 0 where only the chosen
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
}

impl Trouble {
    /// Whether this keeps the program from being welded. Slower travels and a near singularity are only reported.
    pub fn is_fatal(&self) -> bool {
        match self {
            Self::OutOfReach { .. } | Self::Limit { .. } => true,
            Self::Speed { arc, .. } => *arc,
            Self::Wrist { .. } => false,
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
        }
    }

    /// How bad, in the unit of the kind.
    fn size(&self) -> f64 {
        match *self {
            Self::OutOfReach { beyond, .. } => beyond,
            Self::Limit { angle, low, high, .. } => (low - angle).max(angle - high),
            Self::Speed { speed, limit, .. } => speed / limit,
            Self::Wrist { margin } => -margin,
        }
    }
}

/// All troubles of one kind and joint.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ReachFinding {
    /// The first stop that has it.
    pub stop: Stop,
    /// What is wrong there.
    pub trouble: Trouble,
    /// Where it is worst, and what is wrong there.
    pub worst: (Stop, Trouble),
    /// Number of stops.
    pub count: usize,
}

impl ReachFinding {
    /// One sentence with place, size and remedy.
    pub fn sentence(&self) -> String {
        let place = place(&self.stop);
        let more = self.more();
        match self.trouble {
            Trouble::OutOfReach { beyond, reach } if beyond > 0.0 => format!(
                "{place}: out of reach; the wrist misses the place by {beyond:.0} mm (the arm is {reach:.0} mm long from \
                 axis 2 to the wrist){more}. Move the part nearer to the robot, or try --suggest."
            ),
            Trouble::OutOfReach { .. } => format!(
                "{place}: out of reach; the arm cannot get there without changing over to another posture{more}. Move the \
                 part, or try --suggest."
            ),
            Trouble::Limit { joint, angle, low, high } => format!(
                "{place}: joint {} would have to stand at {angle:.1}°, its limits are {low:.0}° and {high:.0}°{more}. \
                 Move or turn the part, or try --suggest.",
                joint + 1
            ),
            Trouble::Speed { joint, speed, limit, arc } => format!(
                "{place}: joint {} would have to turn at {speed:.0} °/s, it can do {limit:.0} °/s{more}. {}",
                joint + 1,
                if arc {
                    "The robot would slow down and the bead swell: move the part, or weld more slowly there."
                } else {
                    "The robot will travel more slowly there."
                }
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
        };
        let Stop { layer, pass, point, .. } = self.worst.0;
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
    let Stop { layer, pass, point, at, arc, .. } = stop;
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

/// Troubles gathered on the way.
#[derive(Debug, Default)]
pub(super) struct Findings(BTreeMap<(u8, usize), ReachFinding>);

impl Findings {
    pub(super) fn add(&mut self, stop: &Stop, trouble: Trouble) {
        let new = || ReachFinding { stop: *stop, trouble, worst: (*stop, trouble), count: 0 };
        let finding = self.0.entry(trouble.key()).or_insert_with(new);
        finding.count += 1;
        if trouble.size() > finding.worst.1.size() {
            finding.worst = (*stop, trouble);
        }
    }

    /// By kind and joint, the fatal kinds first.
    pub(super) fn sorted(self) -> Vec<ReachFinding> {
        self.0.into_values().collect()
    }
}
