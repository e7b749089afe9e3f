//! The path of the torch through a plan, travels included, in pieces short enough to be checked point by point.

use crate::{Frame, part_from_tool};
use bead_plan::layer::Layer;
use bead_program::program::{Attitude, Held, Instruction, LayerProgram, Programmer};
use glam::DVec3;
use serde::Serialize;
use std::borrow::Borrow;

/// Longer moves are divided, mm, so that no joint can swing out unnoticed between two stops.
pub const PIECE_MM: f64 = 20.0;

/// A point of the path.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Stop {
    /// Layer, from 0.
    pub layer: usize,
    /// Pass in its layer, from 0; a travel belongs to the pass that it leads to, a move up to the pass that it leaves.
    pub pass: usize,
    /// Point of the pass as in the program, from 0; on the way to a point, the index of that point.
    pub point: usize,
    /// Tool point in the part's space, mm.
    pub at: DVec3,
    /// Time since the previous stop at the wanted speed, s.
    pub seconds: f64,
    /// Whether the arc burns on the way to this stop.
    pub arc: bool,
    /// The attitude of torch and part there.
    #[serde(skip)]
    pub attitude: Attitude,
    /// Whether it belongs to the program, or to the move from or to home.
    pub leg: Leg,
}

impl Stop {
    /// The tool frame here, turned by `angle` (°) about the torch's axis, in the part's space with the axes that turn
    /// the part at 0.
    pub fn tool(&self, angle: f64) -> Frame {
        let upright = part_from_tool(self.at, angle);
        let leaning = Frame { rotation: self.attitude.rotation() * upright.rotation, ..upright };
        self.turned_table().then(&leaning)
    }

    /// Frame of the part as held by a table or a positioner here.
    pub fn turned_table(&self) -> Frame {
        self.attitude.held.map_or(Frame::IDENTITY, Frame::from)
    }
}

/// The frame of a part that is held so.
impl From<Held> for Frame {
    fn from(held: Held) -> Self {
        Self { position: held.shift, rotation: held.turn }
    }
}

/// A leg of the path.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Leg {
    /// From home to the first point.
    FromHome,
    /// The program itself.
    #[default]
    Part,
    /// From the last point to home.
    ToHome,
}

/// The path of the torch.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Track {
    /// Its stops.
    pub stops: Vec<Stop>,
    /// Speed of travels, mm/s.
    pub travel_speed: f64,
    /// The greatest width at the start of any pass, mm.
    pub bead_width: f64,
}

impl Track {
    /// The path through a plan's layers, as the programs of `programmer` follow it; `travel_speed` in mm/s.
    ///
    /// ```
    /// use bead_plan::layer::Layer;
    /// use bead_plan::pass::{Along, Pass, PassKind};
    /// use bead_program::program::Programmer;
    /// use bead_robot::Track;
    /// use glam::DVec3;
    ///
    /// // Down by the clearance of 20 mm, along the pass of 100 mm, and up again.
    /// let (points, width, pace) = (vec![DVec3::ZERO, DVec3::X * 100.0], Along::Same(5.0), Along::Same(10.0));
    /// let pass = Pass { kind: PassKind::Wall, closed: false, points, width, pace, wait: 0.0 };
    /// let track = Track::of(&[Layer { height: 2.0, passes: vec![pass], ..Layer::default() }], Programmer::new(20.0), 100.0);
    /// assert!((track.length() - (20.0 + 100.0 + 20.0)).abs() < 1e-9);
    /// ```
    pub fn of<L: Borrow<Layer>>(layers: &[L], programmer: Programmer, travel_speed: f64) -> Self {
        let passes = layers.iter().flat_map(|layer| &layer.borrow().passes);
        let bead_width = passes.map(|pass| pass.width.after(0)).fold(0.0, f64::max);
        let mut track = Self { travel_speed, bead_width, ..Self::default() };
        let mut programmer = programmer.unfitted();
        for layer in layers.iter().map(L::borrow) {
            track.add(&programmer.layer(layer), layer.index, travel_speed);
        }
        track
    }

    /// Length of the path, mm.
    pub fn length(&self) -> f64 {
        self.stops.windows(2).map(|w| w[0].at.distance(w[1].at)).sum()
    }

    fn add(&mut self, program: &LayerProgram, layer: usize, travel_speed: f64) {
        let (mut pass, mut point, mut attitude) = (0, 0, Attitude::default());
        for instruction in &program.instructions {
            attitude = instruction.attitude().unwrap_or(attitude);
            match *instruction {
                Instruction::Approach { to } | Instruction::Travel { to } => {
                    self.go(Stop {
                        layer,
                        pass,
                        point: 0,
                        at: to,
                        seconds: travel_speed,
                        arc: false,
                        attitude,
                        leg: Leg::Part,
                    });
                }
                Instruction::Retract { to } => {
                    let pass = pass.saturating_sub(1);
                    self.go(Stop {
                        layer,
                        pass,
                        point: 0,
                        at: to,
                        seconds: travel_speed,
                        arc: false,
                        attitude,
                        leg: Leg::Part,
                    });
                }
                Instruction::ArcOn { .. } => point = 0,
                Instruction::Weld { to, speed, .. } => {
                    point += 1;
                    self.go(Stop { layer, pass, point, at: to, seconds: speed, arc: true, attitude, leg: Leg::Part });
                }
                Instruction::PassStart { .. }
                | Instruction::Turn { .. }
                | Instruction::Above
                | Instruction::PassEnd
                | Instruction::WireFeed { .. }
                | Instruction::Crater { .. }
                | Instruction::Dwell { .. } => {}
                // Numbers count from 1 and `pass` from 0, so the number is the index of the next pass.
                Instruction::ArcOff { pass: number } => pass = number,
            }
        }
    }

    /// Moves straight to a stop, whose `seconds` still contain the speed (mm/s).
    fn go(&mut self, stop: Stop) {
        let speed = stop.seconds.max(1e-6);
        let Some((from, standing)) = self.stops.last().map(|s| (s.at, s.attitude)) else {
            self.stops.push(Stop { seconds: 0.0, ..stop });
            return;
        };
        let length = from.distance(stop.at);
        // No move is long enough to need more stops.
        let pieces = (length / PIECE_MM).ceil().clamp(1.0, 1e4);
        let part = |k: usize| Stop {
            at: from.lerp(stop.at, (k as f64 / pieces).min(1.0)),
            attitude: standing.towards(&stop.attitude, (k as f64 / pieces).min(1.0)),
            seconds: length / pieces / speed,
            ..stop
        };
        self.stops.extend((1..=pieces as usize).map(part));
    }
}
