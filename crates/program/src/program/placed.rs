//! Transforms instructions of layers that are not level from their chart to space: straight lines on a layer become as
//! many straight moves as it takes to follow the layer, and the torch is aligned with the layer's normal.

use super::{Attitude, Instruction, rounded};
use bead_part::chart::{At, Sheet};
use bead_plan::weld::Transfer;
use glam::{DMat3, DQuat, DVec3};

/// For moves with the arc on: greatest distance from the line on the layer, mm, and greatest turn of the torch in a
/// move, rad.
const WELDING: (f64, f64) = (0.05, 0.087);
/// The same for travels.
const TRAVELLING: (f64, f64) = (1.0, 0.175);

/// Transforms the instructions of a pass to space; `from` is the torch's previous position in the chart.
pub(super) fn placed(instructions: Vec<Instruction>, sheet: &Sheet<'_>, from: Option<DVec3>) -> Vec<Instruction> {
    let mut placing =
        Placing { sheet, at: from, start: Attitude::default(), out: Vec::with_capacity(instructions.len()) };
    instructions.into_iter().for_each(|instruction| placing.add(instruction));
    placing.out
}

/// The moves to another body.
pub(super) fn transferred(transfer: &Transfer) -> impl Iterator<Item = Instruction> {
    transfer.legs.iter().flat_map(|leg| {
        let attitude = Attitude { layer: frame(leg), ..Attitude::default() };
        [Instruction::Turn { attitude }, Instruction::Travel { to: rounded(leg.place) }]
    })
}

struct Placing<'a> {
    sheet: &'a Sheet<'a>,
    /// Position in the chart.
    at: Option<DVec3>,
    /// Attitude at the start of the pass.
    start: Attitude,
    out: Vec<Instruction>,
}

impl Placing<'_> {
    fn add(&mut self, instruction: Instruction) {
        match instruction {
            Instruction::Approach { to } => {
                self.turn(to);
                self.out.push(Instruction::Approach { to: self.point(to) });
                self.at = Some(to);
            }
            Instruction::Travel { to } => self.travel(self.at.unwrap_or(to), to),
            // Along the normal.
            Instruction::Retract { to } => {
                self.at = Some(to);
                self.out.push(Instruction::Retract { to: self.point(to) });
            }
            Instruction::PassStart { pass, above, attitude } => {
                self.start = attitude;
                let (above, attitude) = (self.point(above), self.turned(attitude, above));
                self.out.push(Instruction::PassStart { pass, above, attitude });
            }
            Instruction::Weld { to, speed, last, attitude, .. } => {
                self.weld(self.at.unwrap_or(to), to, |piece| Instruction::Weld {
                    last: last && piece.last,
                    speed: speed * piece.longer,
                    to: piece.to,
                    circle: None,
                    attitude: Attitude { layer: piece.layer, ..attitude },
                });
            }
            Instruction::Turn { attitude } => self.out.push(Instruction::Turn { attitude }),
            Instruction::Above
            | Instruction::PassEnd
            | Instruction::ArcOn { .. }
            | Instruction::WireFeed { .. }
            | Instruction::Crater { .. }
            | Instruction::ArcOff { .. }
            | Instruction::Dwell { .. } => self.out.push(instruction),
        }
    }

    fn point(&self, p: DVec3) -> DVec3 {
        rounded(self.sheet.at(p).place)
    }

    fn turned(&self, attitude: Attitude, at: DVec3) -> Attitude {
        Attitude { layer: frame(&self.sheet.at(at)), ..attitude }
    }

    /// Turns the torch to its attitude at a point.
    fn turn(&mut self, p: DVec3) {
        self.out.push(Instruction::Turn { attitude: self.turned(self.start, p) });
    }

    fn travel(&mut self, from: DVec3, to: DVec3) {
        let (tolerance, angle) = TRAVELLING;
        for p in self.sheet.divided(from, to, tolerance, angle) {
            self.turn(p);
            self.out.push(Instruction::Travel { to: self.point(p) });
        }
        self.at = Some(to);
    }

    fn weld(&mut self, from: DVec3, to: DVec3, instruction: impl Fn(Piece) -> Instruction) {
        let (tolerance, angle) = WELDING;
        let mut before = from;
        for p in self.sheet.divided(from, to, tolerance, angle) {
            let [start, end] = [before, p].map(|p| self.sheet.at(p));
            let (space, chart) = (start.place.distance(end.place), before.distance(p));
            // A piece's metal is measured at the middle of its layer; the torch moves on top of it.
            let longer = if chart > 0.0 && space > 0.0 { space / chart } else { 1.0 };
            self.out.push(instruction(Piece { to: rounded(end.place), layer: frame(&end), longer, last: p == to }));
            before = p;
        }
        self.at = Some(to);
    }
}

/// A straight piece in space.
struct Piece {
    to: DVec3,
    layer: DQuat,
    /// Its length over that in the chart.
    longer: f64,
    last: bool,
}

fn frame(at: &At) -> DQuat {
    DQuat::from_mat3(&DMat3::from_cols(at.along[0], at.along[1], at.normal)).normalize()
}
