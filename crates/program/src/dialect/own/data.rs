//! The data of templates: the job, a layer's steps, and the points and circles in them.

use crate::dialect::writing::{Job, PLACEHOLDERS, ascii, upper_name};
use crate::program::{Circle, Instruction, LayerProgram};
use glam::DVec3;
use minijinja::value::{Enumerator, Object};
use minijinja::{Error, ErrorKind, Value};
use std::sync::Arc;

/// Placeholders of the other dialects that are not values of a whole job.
const CHANGING: [&str; 13] = [
    "positioner_1",
    "positioner_2",
    "program",
    "layer",
    "layers",
    "z",
    "pass",
    "pass_number",
    "job",
    "dwell",
    "dwell_ms",
    "wire_feed",
    "wire_feed_ratio",
];

/// The values that are the same throughout a program.
pub(super) fn job(job: &Job<'_>) -> Vec<(&'static str, Value)> {
    let number = |text: String| text.parse::<f64>().map_or_else(|_| Value::from(text), Value::from);
    let mut values = vec![
        ("part", Value::from(ascii(&job.part))),
        ("name", Value::from(upper_name(&job.part))),
        ("profile", Value::from(ascii(&job.profile))),
        ("dry_run", Value::from(job.dry_run)),
        ("layer_height", Value::from(job.layer_height)),
        ("bead_width", Value::from(job.bead.width)),
        ("bead_height", Value::from(job.bead.height)),
        ("wire_diameter", Value::from(job.wire_diameter)),
        ("travel_speed", Value::from(job.weld.travel.speed)),
    ];
    let steady = PLACEHOLDERS.iter().filter(|(name, _)| !CHANGING.contains(name));
    values.extend(steady.map(|(name, value)| (*name, number(value(job)))));
    values
}

/// Turns instructions into steps, remembering where the torch is.
#[derive(Debug, Clone)]
pub(super) struct Steps {
    at: Option<DVec3>,
    travel_speed: f64,
    wire_feed_speed: f64,
}

impl Steps {
    pub(super) fn new(job: &Job<'_>) -> Self {
        let (travel_speed, wire_feed_speed) = (job.weld.travel.speed, job.weld.process.wire_feed_speed);
        Self { at: None, travel_speed, wire_feed_speed }
    }

    pub(super) fn layer(&mut self, program: &LayerProgram) -> Vec<Value> {
        let between = |i: &&Instruction| {
            matches!(
                i,
                Instruction::PassStart { .. } | Instruction::Turn { .. } | Instruction::Above | Instruction::PassEnd
            )
        };
        let steps = program.instructions.iter().filter(|i| !between(i));
        steps.map(|&instruction| self.step(instruction)).collect()
    }

    pub(super) fn step(&mut self, instruction: Instruction) -> Value {
        let from = self.at;
        self.at = instruction.target().or(self.at);
        let Self { travel_speed, wire_feed_speed, .. } = *self;
        Value::from_object(Step { instruction, from, travel_speed, wire_feed_speed })
    }
}

/// An instruction, with the state that follows from those before it.
#[derive(Debug)]
struct Step {
    instruction: Instruction,
    from: Option<DVec3>,
    /// Travel speed, mm/s.
    travel_speed: f64,
    /// Wire feed speed, m/min.
    wire_feed_speed: f64,
}

impl Step {
    fn kind(&self) -> &'static str {
        match self.instruction {
            Instruction::Approach { .. } | Instruction::Travel { .. } | Instruction::Retract { .. } => "travel",
            Instruction::ArcOn { .. } => "arc-on",
            Instruction::WireFeed { .. } => "wire-feed",
            Instruction::Weld { .. } => "weld",
            Instruction::Crater { .. } => "crater",
            Instruction::ArcOff { .. } => "arc-off",
            Instruction::Dwell { .. } => "dwell",
            // Templates see what comes between them.
            Instruction::PassStart { .. } | Instruction::Turn { .. } | Instruction::Above | Instruction::PassEnd => {
                "pass"
            }
        }
    }

    fn keys(&self) -> &'static [&'static str] {
        match self.instruction {
            Instruction::Approach { .. } | Instruction::Travel { .. } | Instruction::Retract { .. } => {
                &["kind", "x", "y", "z", "from", "speed", "length", "seconds", "first"]
            }
            Instruction::Weld { .. } => {
                &["kind", "x", "y", "z", "from", "speed", "length", "seconds", "circle", "last"]
            }
            Instruction::ArcOn { .. } => &["kind", "pass", "pass_kind"],
            Instruction::WireFeed { .. } => &["kind", "ratio", "wire_feed"],
            Instruction::Crater { .. } => &["kind", "seconds", "ratio", "wire_feed"],
            Instruction::ArcOff { .. } => &["kind", "pass"],
            Instruction::Dwell { .. } => &["kind", "seconds"],
            Instruction::PassStart { .. } | Instruction::Turn { .. } | Instruction::Above | Instruction::PassEnd => {
                &["kind"]
            }
        }
    }

    /// Length of a move, mm; 0 for the first one, which may begin anywhere.
    fn length(&self, to: DVec3, circle: Option<Circle>) -> f64 {
        circle.map_or_else(|| self.from.map_or(0.0, |from| from.distance(to)), |circle| circle.length())
    }

    fn motion(&self, key: &str, to: DVec3, speed: f64, circle: Option<Circle>) -> Option<Value> {
        let place = |at: DVec3| Value::from_object(Fields([("x", at.x), ("y", at.y), ("z", at.z)]));
        Some(match key {
            "x" => Value::from(to.x),
            "y" => Value::from(to.y),
            "z" => Value::from(to.z),
            "from" => self.from.map_or_else(|| Value::from(()), place),
            "speed" => Value::from(speed),
            "length" => Value::from(self.length(to, circle)),
            "seconds" => Value::from(self.length(to, circle) / speed),
            _ => return None,
        })
    }

    fn feed(&self, key: &str, ratio: f64) -> Option<Value> {
        match key {
            "ratio" => Some(Value::from(ratio)),
            "wire_feed" => Some(Value::from(ratio * self.wire_feed_speed)),
            _ => None,
        }
    }

    fn value(&self, key: &str) -> Option<Value> {
        if key == "kind" {
            return Some(Value::from(self.kind()));
        }
        match (self.instruction, key) {
            (Instruction::Weld { last, .. }, "last") => Some(Value::from(last)),
            (Instruction::Weld { circle, .. }, "circle") => {
                Some(circle.map_or_else(|| Value::from(()), |circle| self.circle(circle)))
            }
            (Instruction::Weld { to, circle, speed, .. }, _) => self.motion(key, to, speed, circle),
            (Instruction::Approach { .. }, "first") => Some(Value::from(true)),
            (Instruction::Travel { .. } | Instruction::Retract { .. }, "first") => Some(Value::from(false)),
            (Instruction::Approach { to } | Instruction::Travel { to } | Instruction::Retract { to }, _) => {
                self.motion(key, to, self.travel_speed, None)
            }
            (Instruction::ArcOn { pass, .. } | Instruction::ArcOff { pass }, "pass") => Some(Value::from(pass)),
            (Instruction::ArcOn { kind, .. }, "pass_kind") => Some(Value::from(kind.name())),
            (Instruction::Crater { seconds, .. } | Instruction::Dwell { seconds }, "seconds") => {
                Some(Value::from(seconds))
            }
            (Instruction::WireFeed { ratio } | Instruction::Crater { ratio: Some(ratio), .. }, _) => {
                self.feed(key, ratio)
            }
            (Instruction::Crater { ratio: None, .. }, "ratio" | "wire_feed") => Some(Value::from(())),
            _ => None,
        }
    }

    fn circle(&self, circle: Circle) -> Value {
        let to_centre = circle.centre - self.from.unwrap_or(circle.centre);
        Value::from_object(Fields([
            ("x", circle.centre.x),
            ("y", circle.centre.y),
            ("i", to_centre.x),
            ("j", to_centre.y),
            ("radius", circle.radius),
            ("sweep", circle.sweep.to_degrees()),
            ("via_x", circle.via.x),
            ("via_y", circle.via.y),
        ]))
    }
}

impl Object for Step {
    fn get_value(self: &Arc<Self>, key: &Value) -> Option<Value> {
        let key = key.as_str()?;
        Some(self.value(key).unwrap_or_else(|| unknown(&format!("a step \"{}\"", self.kind()), key, self.keys())))
    }

    fn enumerate(self: &Arc<Self>) -> Enumerator {
        Enumerator::Str(self.keys())
    }
}

/// Named numbers: a point or a circle.
#[derive(Debug)]
struct Fields<const N: usize>([(&'static str, f64); N]);

impl<const N: usize> Object for Fields<N> {
    fn get_value(self: &Arc<Self>, key: &Value) -> Option<Value> {
        let key = key.as_str()?;
        let value = self.0.iter().find(|(name, _)| *name == key).map(|(_, value)| Value::from(*value));
        Some(value.unwrap_or_else(|| unknown("this", key, &self.0.map(|(name, _)| name))))
    }

    fn enumerate(self: &Arc<Self>) -> Enumerator {
        Enumerator::Values(self.0.iter().map(|(name, _)| Value::from(*name)).collect())
    }
}

/// A value that reports, when used, that there is none with this name.
fn unknown(owner: &str, key: &str, keys: &[&str]) -> Value {
    let reason = format!("{owner} has no \"{key}\"; it has {}", keys.join(", "));
    Value::from(Error::new(ErrorKind::InvalidOperation, reason))
}
